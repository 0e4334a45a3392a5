// Ray casting: one ray a sample into the rectangles of a scene. A filtered texture lookup shades the nearest hit.
#ifndef TEXTSLAM_RENDERER_RAY_CASTER_HPP
#define TEXTSLAM_RENDERER_RAY_CASTER_HPP

#include <vector>

#include "io/sequence.hpp"
#include "renderer/scene.hpp"

namespace textslam {

/// Casts the rays of one camera. It keeps the ray of every pixel for a few sub-pixel offsets, so that lens distortion
/// costs nothing in each frame. Any number of threads may call const functions.
///
/// A lens that sees farther than 80 degrees off its axis, or has pixels beyond the circle of its image, is cast by unit
/// vectors; its footprints follow the lens, and pixels without a ray stay dark. All others are cast on the plane z = 1.
class RayCaster {
 public:
  /// `offsets`: positions of the samples in the pixel (px from its centre).
  RayCaster(const CameraModel& camera, std::vector<Vector2<double>> offsets);

  int offsets() const noexcept { return static_cast<int>(offsets_.size()); }
  const CameraModel& camera() const noexcept { return camera_; }

  /// Adds weight * intensity to every pixel of `sum` (of the camera's size), seen from T_w_c at the sample `offset`,
  /// with the scene as it is at `time`. Textures are averaged over `footprint` pixels. A ray that leaves the scene adds
  /// nothing.
  void add(const Scene& scene, const SE3d& T_w_c, int offset, double footprint, double weight, Image<double>& sum,
           double time = 0.0) const {
    add_rows(scene, T_w_c, offset, footprint, weight, 0, camera_.height, sum, time);
  }
  /// The same to the rows from `first` to before `end`.
  void add_rows(const Scene& scene, const SE3d& T_w_c, int offset, double footprint, double weight, int first, int end,
                Image<double>& sum, double time) const;

 private:
  template <class Vector>
  const Vector& at(const std::vector<std::vector<Vector>>& rays, int offset, int x, int y) const noexcept {
    return rays[static_cast<std::size_t>(offset)]
               [static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width) + static_cast<std::size_t>(x)];
  }
  Vector2<double> ray(int offset, int x, int y) const noexcept;
  Vector3<double> step(int offset, int x, int y, int along_x, int along_y) const noexcept;
  void add_plane(const Scene& scene, const SE3d& T_w_c, int offset, double footprint, double weight, int first, int end,
                 Image<double>& sum, double time) const;
  void add_sphere(const Scene& scene, const SE3d& T_w_c, int offset, double footprint, double weight, int first,
                  int end, Image<double>& sum, double time) const;

  CameraModel camera_;
  std::vector<Vector2<double>> offsets_;
  // By offset, row by row. A pinhole has neither.
  std::vector<std::vector<Vector2<double>>> rays_;        // normalised points
  std::vector<std::vector<Vector3<double>>> directions_;  // unit vectors, zero where there is no ray
};

/// Direction that a pixel sees, of any length; false where it sees none.
bool ray_of(const CameraModel& camera, const Vector2<double>& px, Vector3<double>* ray) noexcept;

/// Pixel of the world point, or false where the camera does not see it: behind, or beyond what the lens takes in.
bool project(const CameraModel& camera, const SE3d& T_c_w, const Vector3<double>& p_w, Vector2<double>* px) noexcept;

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_RAY_CASTER_HPP
