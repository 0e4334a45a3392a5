// The scene of the benchmarks: a textured plane in two 640 x 480 images. The target has another exposure and noise, the
// host has outliers. The texture is a formula, so that the target is rendered without resampling.
#ifndef TEXTPLANE_BENCH_SCENE_HPP
#define TEXTPLANE_BENCH_SCENE_HPP

#include <cstdint>
#include <memory>
#include <vector>

#include "problem.hpp"
#include "textplane/core/image_view.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/photometry/residual.hpp"

namespace textplane_bench {

namespace tp = textplane;

/// Grey level of the texture at host pixel (x, y), in [20, 235]. Its edges and strokes are 4 px wide or more.
double texture(double x, double y, unsigned seed);

/// Change of light and noise of the target, outliers of the host.
struct Light {
  double gain = 0.85, bias = 18, noise = 2, outliers = 0.1;
};

/// Two views of the plane and n of its host pixels.
struct Scene {
  static constexpr int kWidth = 640, kHeight = 480;

  tp::Image<std::uint8_t> host, target;
  tp::Pinhole<double> camera{480, 480, 319.5, 239.5};
  tp::Vector3<double> theta, theta_start;  ///< The truth, and where iterations begin.
  tp::SE3d T_t_h, T_start;
  std::vector<float> x, y, intensity;
  int left = 0, top = 0, columns = 0, rows = 0;  ///< The rectangle of the pixels.
  std::shared_ptr<const tp::LensMap> lens;       ///< Of the target; null: none.

  int n() const { return static_cast<int>(x.size()); }
  tp::ImageView8 target_view() const { return target.view(); }
  tp::ImageView8 host_view() const { return host.view(); }
  tp::PhotometricInput input() const;
  /// With theta and T_t_h of the start.
  Problem problem() const;
  /// Host pixels to target pixels, by the given pose and plane.
  tp::Matrix3<double> pixel_homography(const tp::SE3d& T, const tp::Vector3<double>& plane) const;
  /// Mean distance in px of the corners of the rectangle from where they truly are.
  double corner_error(const tp::Matrix3<double>& H) const;
};

/// n scattered pixels of a rectangle of 100 x 40; all of them for n = 4000, a larger rectangle beyond. The start has a
/// mean corner error of `px` pixels. `motion` scales the motion between the views; 1 is up to some 25 px.
Scene make_scene(int n, unsigned seed, double px = 1.0, const Light& light = Light(), double motion = 1.0,
                 const std::shared_ptr<const tp::LensMap>& lens = nullptr);

/// All pixels of the upper left columns x rows, at most 100 x 40, of make_scene(4000, seed, px).
Scene make_dense_scene(int columns, int rows, unsigned seed, double px = 1.0);

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_SCENE_HPP
