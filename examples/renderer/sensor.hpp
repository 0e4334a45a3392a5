// Sensor: what happens to light between the scene and the 8-bit pixel: gain, bias, vignette, glare, noise.
#ifndef TEXTSLAM_RENDERER_SENSOR_HPP
#define TEXTSLAM_RENDERER_SENSOR_HPP

#include <cstdint>
#include <functional>
#include <vector>

#include "io/names.hpp"

namespace textslam {

/// A soft bright spot in the image.
struct Glare {
  Vector2<double> centre;  ///< px
  double radius;           ///< px, one standard deviation
  double strength;         ///< grey levels at its centre
};

/// The sensor at one instant: pixel = gain * falloff * light + bias + glare + noise, falloff = 1 - vignette * r^2 with
/// r = 1 in the corners; the noise has the variance noise^2 + shot * value.
struct SensorState {
  double gain = 1.0, bias = 0.0;
  double vignette = 0.0;
  double noise = 1.0;  ///< grey levels
  double shot = 0.01;
  std::vector<Glare> glare;
};

/// The sensor as a function of time in seconds.
using SensorProgram = std::function<SensorState(double)>;

/// A camera in steady light.
SensorProgram steady_sensor();
/// Light that swings, dims and recovers within a tenth of a second, and flickers as lamps on 50 Hz mains do, with a
/// strong vignette and a glare that wanders over a picture of this size.
SensorProgram changing_lights(std::uint64_t seed, int width, int height);
/// A dark room: noise of 20 grey levels, a vignette that leaves the corners half their light, and auto exposure that
/// doubles or halves the gain within three frames of 1/30 s, every one to two seconds.
SensorProgram night(std::uint64_t seed);

/// The 8-bit picture. The noise of a pixel depends only on the seed and its position.
Image<std::uint8_t> develop(const Image<double>& light, const SensorState& state, std::uint64_t noise_seed);

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_SENSOR_HPP
