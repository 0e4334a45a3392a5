#include "renderer/sensor.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/motion.hpp"
#include "renderer/random.hpp"

namespace textslam {

namespace {

constexpr double kTwoPi = 6.28318530717958647692;
constexpr double kGlareReach = 4.0;  // standard deviations

}  // namespace

SensorProgram steady_sensor() {
  SensorState state;
  state.vignette = 0.08;
  return [state](double) { return state; };
}

SensorProgram changing_lights(std::uint64_t seed, int width, int height) {
  const double phase = kTwoPi * unit(hash(seed, 31));
  return [=](double t) {
    SensorState state;
    // Auto exposure hunting, two lamps that go out and on again, and the beat of 100 Hz light with the frame rate.
    const double swing = 0.82 + 0.23 * std::sin(kTwoPi * t / 3.1 + phase) + 0.08 * std::sin(kTwoPi * t / 0.83);
    const double s = std::fmod(t, 8.0);
    const double dimmed = 1.0 - 0.42 * (smooth_step(s, 2.4, 0.1) - smooth_step(s, 4.1, 0.1));
    const double flicker = 1.0 + (s > 5.0 && s < 7.0 ? 0.13 * std::sin(kTwoPi * 100.0 * t + phase) : 0.0);
    state.gain = swing * dimmed * flicker;
    state.bias = 14.0 * std::sin(kTwoPi * t / 2.3) + 6.0;
    state.vignette = 0.4;
    state.noise = 2.5;
    state.shot = 0.02;
    state.glare.push_back(
        {{width * (0.5 + 0.4 * std::sin(0.9 * t + phase)), height * (0.35 + 0.25 * std::cos(0.7 * t))},
         0.06 * width,
         55.0});
    state.glare.push_back(
        {{width * (0.5 + 0.45 * std::cos(0.6 * t + 2.0)), height * (0.6 + 0.3 * std::sin(1.1 * t + phase))},
         0.035 * width,
         70.0});
    return state;
  };
}

SensorProgram night(std::uint64_t seed) {
  constexpr double kDim = 0.25, kPeriod = 3.0, kStep = 0.1;  // s, but for the gain
  const double up = 0.5 + 0.4 * unit(hash(seed, 41)), down = up + 1.1 + 0.6 * unit(hash(seed, 42));
  return [=](double t) {
    SensorState state;
    const double s = std::fmod(t, kPeriod);
    const double raised = smooth_step(s, up, kStep) - smooth_step(s, down, kStep);  // 0 or 1 between the steps
    state.gain = kDim * std::exp2(raised);
    state.vignette = 0.5;
    state.noise = 20.0;
    state.shot = 0.0;
    return state;
  };
}

Image<std::uint8_t> develop(const Image<double>& light, const SensorState& state, std::uint64_t noise_seed) {
  const int width = light.width(), height = light.height();
  const double cx = 0.5 * (width - 1), cy = 0.5 * (height - 1);
  const double corner2 = std::max(1.0, cx * cx + cy * cy);
  Image<double> values(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double r2 = ((x - cx) * (x - cx) + (y - cy) * (y - cy)) / corner2;
      values(x, y) = state.gain * (1.0 - state.vignette * r2) * light(x, y) + state.bias;
    }
  }
  for (const Glare& glare : state.glare) {
    const double reach = kGlareReach * glare.radius;
    const auto index = [](double v, int size) {
      return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(size)));
    };
    for (int y = index(glare.centre[1] - reach, height); y < index(glare.centre[1] + reach, height); ++y) {
      for (int x = index(glare.centre[0] - reach, width); x < index(glare.centre[0] + reach, width); ++x) {
        const double r2 = (Vector2<double>(x, y) - glare.centre).squaredNorm() / (glare.radius * glare.radius);
        values(x, y) += glare.strength * std::exp(-0.5 * r2);
      }
    }
  }
  Image<std::uint8_t> picture(width, height);
  std::uint64_t place = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x, ++place) {
      const double value = values(x, y);
      const double sigma = std::sqrt(state.noise * state.noise + state.shot * std::max(0.0, value));
      const double noisy = value + sigma * near_normal(mix(noise_seed + place * 0x9e3779b97f4a7c15ULL));
      const double grey = std::clamp(noisy, 0.0, 255.0);
      const int whole = static_cast<int>(grey);
      picture(x, y) = static_cast<std::uint8_t>(grey - whole >= 0.5 ? whole + 1 : whole);
    }
  }
  return picture;
}

}  // namespace textslam
