// CameraView: what kernels and solvers take for the camera of an image: a pinhole, or one behind a lens.
#ifndef TEXTPLANE_CORE_CAMERAS_CAMERA_VIEW_HPP
#define TEXTPLANE_CORE_CAMERAS_CAMERA_VIEW_HPP

#include "textplane/core/cameras/lens_map.hpp"
#include "textplane/core/cameras/pinhole.hpp"
#include "textplane/core/row_motion.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A camera, of which the lens is somebody else's and must outlive the view. A pinhole becomes one by itself. Pixels
/// are those of the image as it was taken; `pinhole` is the camera of the undistorted one.
TEXTPLANE_DEFERRED
struct BasicCameraView {
  Pinhole<Real> pinhole;          ///< px of level 0, or of the level that at_level() was asked for.
  const LensMap* lens = nullptr;  ///< Of normalised coordinates, on all levels the same; null: none.
  /// How the camera moves while it takes the rows of the image, in px of level 0; null: it takes all at once. Its
  /// owner must outlive the view. What takes a pose together with a camera means the pose at the time stamp. Members of
  /// this view know nothing of rows: project_rows() does.
  const RowMotion* rows = nullptr;

  BasicCameraView() = default;
  /// Without a lens.
  BasicCameraView(const Pinhole<Real>& camera) noexcept : pinhole(camera) {}  // NOLINT(google-explicit-constructor)
  BasicCameraView(double fx, double fy, double cx, double cy) noexcept
      : pinhole(fx, fy, cx, cy) {}  ///< Without a lens.
  /// `map` may be null.
  BasicCameraView(const Pinhole<Real>& camera, const LensMap* map, const RowMotion* motion = nullptr) noexcept
      : pinhole(camera), lens(map), rows(motion) {}

  /// Finite, with positive focal lengths, a lens that sees something, and rows that are valid().
  bool valid() const noexcept { return pinhole.valid() && (!lens || lens->max_r2() > 0) && (!rows || rows->valid()); }
  /// In front of the camera, where the lens has a pixel for it.
  bool in_domain(const Vector3<Real>& p) const noexcept {
    return p[2] > 0 && (!lens || p[0] * p[0] + p[1] * p[1] <= lens->max_r2() * p[2] * p[2]);
  }

  /// Pixel of the normalised point m, which is in the domain.
  Vector2<Real> pixel(const Vector2<Real>& m) const noexcept { return pinhole.pixel(lens ? lens->distort(m) : m); }
  /// Pixel of the camera-frame point p, which is in the domain. If J is given it receives d pixel / d p (2 x 3).
  Vector2<Real> project(const Vector3<Real>& p, FixedMatrix<Real, 2, 3>* J = nullptr) const noexcept {
    if (!lens) return pinhole.project(p, J);
    const Vector2<Real> m(p[0] / p[2], p[1] / p[2]);
    if (!J) return pinhole.pixel(lens->distort(m));
    FixedMatrix<Real, 2, 2> D;
    const Vector2<Real> distorted = lens->distort(m, &D);
    D.row(0) *= pinhole.fx;
    D.row(1) *= pinhole.fy;
    Pinhole<Real>().project(p, J);  // d m / d p
    *J = product(D, *J);
    return pinhole.pixel(distorted);
  }
  /// Ray m~ = (x/z, y/z, 1) of a pixel. Status::degenerate where it has none, non_finite for NaN; then `m` is
  /// untouched.
  Status unproject(const Vector2<Real>& px, Vector3<Real>* m) const noexcept {
    if (!lens) return pinhole.unproject(px, m);
    Vector2<Real> straight;
    const Status status = lens->undistort(pinhole.unproject(px).template head<2>(), &straight);
    if (is_ok(status)) *m = {straight[0], straight[1], 1.0};
    return status;
  }

  /// The same camera for pyramid level l.
  BasicCameraView at_level(int level) const noexcept { return {pinhole.at_level(level), lens, rows}; }
};
using CameraView = BasicCameraView<>;  ///< It is compiled only where it is used.

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERAS_CAMERA_VIEW_HPP
