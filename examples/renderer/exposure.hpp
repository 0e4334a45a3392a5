// Exposure: the shutter as a mean over instants symmetric about the frame's time. The pose at that time is the truth.
#ifndef TEXTSLAM_RENDERER_EXPOSURE_HPP
#define TEXTSLAM_RENDERER_EXPOSURE_HPP

#include <vector>

#include "renderer/motion.hpp"
#include "renderer/ray_caster.hpp"

namespace textslam {

/// The samples of a pixel: a 2 x 2 grid. Samples i and 3 - i are opposite.
std::vector<Vector2<double>> pixel_grid();

/// `n` instants, evenly spaced over [middle - exposure/2, middle + exposure/2] and symmetric about `middle`.
std::vector<double> exposure_times(double middle, double exposure, int n);

/// How far the images of scene points move while the shutter is open (px): lengths at points all over the image.
struct Blur {
  double median = 0.0, max = 0.0;
};
Blur blur_of(const Scene& scene, const CameraModel& camera, const Motion& motion, double middle, double exposure);

/// The direction (unit vector, px) in which most of the image moves at a time; the x axis where the camera does not
/// move.
Vector2<double> image_direction(const Scene& scene, const CameraModel& camera, const Motion& motion, double time);

/// Number of instants for a blur of so many pixels: four for a blur that is not visible, else a multiple of eight, at
/// least eight, and more than one a pixel.
int instants_for(double blur);

/// The sample of the grid at an instant: 0 1 2 3 3 2 1 0. This order makes place and time of samples independent.
/// Otherwise the blur of a moving point would depend on the sign of its motion, as in no camera, and planes seen in
/// passing would seem rotated.
int sample_at(int instant);

/// Light (0 to 255) that the shutter collects: one sample of the grid at each instant, averaged. `caster` holds
/// pixel_grid(). Throws std::invalid_argument for another grid, or if the number of instants is not a multiple of four.
/// `middle` is the time of the caster's shutter's row0; other rows are exposed before or after it.
Image<double> expose(const Scene& scene, const RayCaster& caster, const Motion& motion, double middle, double exposure,
                     int instants);

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_EXPOSURE_HPP
