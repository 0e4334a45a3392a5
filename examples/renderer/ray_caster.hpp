// Ray casting: one ray a sample into the rectangles of a scene. A filtered texture lookup shades the nearest hit.
#ifndef TEXTSLAM_RENDERER_RAY_CASTER_HPP
#define TEXTSLAM_RENDERER_RAY_CASTER_HPP

#include <vector>

#include "io/sequence.hpp"
#include "renderer/scene.hpp"

namespace textslam {

/// Casts the rays of one camera. It keeps the ray of every pixel for a few sub-pixel offsets, so that lens distortion
/// costs nothing in each frame. Any number of threads may call const functions.
class RayCaster {
 public:
  /// `offsets`: positions of the samples in the pixel (px from its centre). Throws std::invalid_argument where the
  /// camera cannot unproject a pixel.
  RayCaster(const CameraModel& camera, std::vector<Vector2<double>> offsets);

  int offsets() const noexcept { return static_cast<int>(offsets_.size()); }
  const CameraModel& camera() const noexcept { return camera_; }
  /// Normalised point that the sample sees.
  Vector2<double> ray(int offset, int x, int y) const noexcept;

  /// Adds weight * intensity to every pixel of `sum` (of the camera's size), seen from T_w_c at the sample `offset`,
  /// with the scene as it is at `time`.
  /// Textures are averaged over `footprint` pixels. A ray that leaves the scene adds nothing.
  void add(const Scene& scene, const SE3d& T_w_c, int offset, double footprint, double weight, Image<double>& sum,
           double time = 0.0) const;

 private:
  CameraModel camera_;
  std::vector<Vector2<double>> offsets_;
  std::vector<std::vector<Vector2<double>>> rays_;  // by offset, row by row; empty for a pinhole
};

/// Pixel of the world point, or false where it is not in front of the camera.
bool project(const CameraModel& camera, const SE3d& T_c_w, const Vector3<double>& p_w, Vector2<double>* px) noexcept;

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_RAY_CASTER_HPP
