// RowMotion: a rolling shutter takes the rows of an image one after the other. Within a frame the camera moves with
// constant velocity.
//
//   time(row) = readout (row - row0) / (rows - 1)                 s from the time stamp
//   T_row_w   = Exp(time(row) velocity) T_c_w                     left, xi = (v, omega), as core/se3.hpp has it
//
// T_c_w, world to camera, is the pose at the time stamp, the time of row0. Rows are px of level 0 of the image as it
// was taken.
#ifndef TEXTPLANE_CORE_ROW_MOTION_HPP
#define TEXTPLANE_CORE_ROW_MOTION_HPP

#include <cmath>

#include "textplane/core/se3.hpp"
#include "textplane/core/status.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// When each row is taken. By default all at once.
struct RollingShutter {
  double readout = 0;  ///< s from the first row to the last; negative where the last comes first; 0: all at once.
  double row0 = 0;     ///< The row that the time stamp belongs to.
  int rows = 0;        ///< Of the image.

  /// Whether rows differ in time.
  bool active() const noexcept { return readout != 0 && rows > 1; }
  /// s from one row to the next.
  double line() const noexcept { return active() ? readout / (rows - 1) : 0; }
  /// s from the time stamp to the time of a row.
  double time(double row) const noexcept { return line() * (row - row0); }
  /// Whether the numbers make sense: finite, and no readout without rows.
  bool valid() const noexcept { return is_finite(readout) && is_finite(row0) && (readout == 0 || rows > 1); }
};

/// How one frame moves while its rows are taken.
TEXTPLANE_DEFERRED
struct BasicRowMotion {
  Vector6<Real> velocity = Vector6<Real>::Zero();  ///< (v, omega) a second, a left increment of T_c_w.
  RollingShutter shutter;                          ///< Of its camera.

  /// Whether rows differ in pose. False for a still camera, too.
  bool active() const noexcept {
    if (!shutter.active()) return false;
    for (int i = 0; i < 6; ++i)
      if (velocity[i] != 0) return true;
    return false;
  }
  /// The left increment of T_c_w at a time (s).
  SE3d after(double time) const noexcept { return se3_exp<double>(time * velocity); }
  /// The same at a row: T_row_w = at(row) T_c_w.
  SE3d at(double row) const noexcept { return after(shutter.time(row)); }
  /// Whether all numbers are finite.
  bool valid() const noexcept { return shutter.valid() && all_finite(velocity); }
};

using RowMotion = BasicRowMotion<>;  ///< It is compiled only where it is used.

/// d xi / d velocity of Exp(time velocity): Exp(time (velocity + d)) = Exp(M d) Exp(time velocity) to first order, with
/// M = time (I + a / 2 + a^2 / 6), a = ad(time velocity). Its error is a^3 / 24, 1e-7 for a motion of 0.01.
TEXTPLANE_DEFERRED
inline FixedMatrix<double, 6, 6> velocity_jacobian(const Vector6<double>& velocity, double time) noexcept {
  const Vector6<double> xi = scaled(time, velocity);
  const Matrix3<double> V = hat(block<3, 1>(xi, 0, 0)), W = hat(block<3, 1>(xi, 3, 0));
  FixedMatrix<Real, 6, 6> a;
  for (int c = 0; c < 6; ++c)
    for (int r = 0; r < 6; ++r) a(r, c) = (r < 3) == (c < 3) ? W(r % 3, c % 3) : r < 3 ? V(r, c - 3) : 0;
  const FixedMatrix<Real, 6, 6> a2 = product(a, a);
  FixedMatrix<Real, 6, 6> out;
  for (int c = 0; c < 6; ++c)
    for (int r = 0; r < 6; ++r) out(r, c) = time * ((r == c ? 1 : 0) + a(r, c) / 2 + a2(r, c) / 6);
  return out;
}

/// Velocity of a camera between two poses (world to camera) `seconds` apart: T_b_w = Exp(seconds velocity) T_a_w. Poses
/// less than pi apart in rotation; zero where `seconds` is.
TEXTPLANE_DEFERRED
inline Vector6<double> velocity_between(const SE3d& T_a_w, const SE3d& T_b_w, double seconds) noexcept {
  if (!(std::abs(seconds) > 0)) return Vector6<Real>::Zero();
  const Vector6<Real> twist = se3_log<double>(T_b_w * T_a_w.inverse());
  return twist / seconds;
}

/// The row-time projection of a camera-frame point p = T_c_w p_w of a moving frame.
struct RowProjection {
  Vector2<double> px = Vector2<double>::Zero();  ///< Where the image shows it.
  Vector3<double> p = Vector3<double>::Zero();   ///< The point as its row sees it.
  Status status = Status::diverged;              ///< See project_rows().
};

/// Where the image shows the point `p` (in the camera at the time stamp): px = pi(Exp(time(row) velocity) p) with row
/// the second coordinate of px, by Newton's method in the row. `camera` has in_domain(p), and project(p, J) with the
/// 2 x 3 Jacobian J, as CameraView and camera models have. Converged to 1e-9 rows. behind_camera where the point leaves
/// the camera's domain, non_finite for NaN, diverged where the row moves as fast as the point: it may then be
/// seen in many rows, or in none.
template <class Camera>
RowProjection project_rows(const RowMotion& motion, const Camera& camera, const Vector3<double>& p) noexcept {
  RowProjection out;
  out.p = p;
  const double line = motion.shutter.line();
  const Vector3<double> v = block<3, 1>(motion.velocity, 0, 0), w = block<3, 1>(motion.velocity, 3, 0);
  double row = motion.shutter.row0;
  for (int iteration = 0; iteration < 10; ++iteration) {
    out.p = motion.at(row) * p;
    if (!all_finite(out.p)) {
      out.status = Status::non_finite;
      return out;
    }
    if (!camera.in_domain(out.p)) {
      out.status = Status::behind_camera;
      return out;
    }
    FixedMatrix<double, 2, 3> J;
    out.px = camera.project(out.p, &J);
    const double off = out.px[1] - row;
    if (!motion.active() || std::abs(off) < 1e-9) {
      out.status = Status::ok;
      return out;
    }
    double slope = 0;
    for (int i = 0; i < 3; ++i) {
      const int j = i < 2 ? i + 1 : 0, k = i > 0 ? i - 1 : 2;
      slope += J(1, i) * (v[i] + w[j] * out.p[k] - w[k] * out.p[j]);
    }
    const double denominator = 1 - line * slope;
    if (!(std::abs(denominator) > 0.05)) return out;
    row += off / denominator;
  }
  return out;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_ROW_MOTION_HPP
