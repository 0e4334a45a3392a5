#include "sign_index/planar_pose.hpp"

#include <Eigen/LU>
#include <cmath>
#include <utility>

namespace textslam {
namespace {

using textplane::Status;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;

// Plane coordinates: x to the reader's right, y down, z away from the reader; the origin is the mean of the corners.
struct PlaneFrame {
  SE3d T_q_p;
  Quad<double> quad;
};

Status plane_frame(const std::array<Vec3, 4>& c, PlaneFrame* out) {
  const Vec3 right = c[1] - c[0] + c[2] - c[3], away = (c[2] - c[0]).cross(c[3] - c[1]);
  if (!right.allFinite() || !away.allFinite()) return Status::non_finite;
  if (!(away.norm() > 1e-12 * right.squaredNorm())) return Status::degenerate;
  const Vec3 z = away.normalized();
  const Vec3 x = (right - z.dot(right) * z).normalized();
  out->T_q_p.R << x, z.cross(x), z;
  out->T_q_p.t = (c[0] + c[1] + c[2] + c[3]) / 4;
  const SE3d T_p_q = out->T_q_p.inverse();
  for (std::size_t i = 0; i < 4; ++i) out->quad.corner[i] = (T_p_q * c[i]).head<2>();
  return textplane::is_convex(out->quad) ? Status::ok : Status::degenerate;
}

// Plane corners to image corners. The origin lies inside the quad, so the last element can be 1.
Status homography(const Quad<double>& plane, const Quad<double>& image, Mat3* H) {
  Eigen::Matrix<double, 8, 8> A = Eigen::Matrix<double, 8, 8>::Zero();
  Eigen::Matrix<double, 8, 1> b;
  for (int i = 0; i < 4; ++i) {
    const Vec2 &p = plane.corner[static_cast<std::size_t>(i)], &m = image.corner[static_cast<std::size_t>(i)];
    A.row(2 * i) << p.x(), p.y(), 1, 0, 0, 0, -m.x() * p.x(), -m.x() * p.y();
    A.row(2 * i + 1) << 0, 0, 0, p.x(), p.y(), 1, -m.y() * p.x(), -m.y() * p.y();
    b.segment<2>(2 * i) = m;
  }
  const Eigen::Matrix<double, 8, 1> h = A.partialPivLu().solve(b);
  if (!h.allFinite()) return Status::degenerate;
  *H << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1;
  return Status::ok;
}

// Rotation that takes the optical axis to the ray of the normalised point m.
Mat3 turn_to(const Vec2& m) {
  const Vec3 ray = m.homogeneous().normalized(), axis = Vec3::UnitZ().cross(ray);
  const double sine = axis.norm();
  if (sine < 1e-12) return Mat3::Identity();
  return textplane::so3_exp<double>(Vec3(std::atan2(sine, ray.z()) / sine * axis));
}

// With the rotation known, the translation is linear in the images; false where a corner falls behind the camera.
bool place(const Quad<double>& plane, const Quad<double>& image, SE3d* T_c_p, double* error) {
  Mat3 N = Mat3::Zero();
  Vec3 b = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 turned = T_c_p->R.leftCols<2>() * plane.corner[i];
    Eigen::Matrix<double, 2, 3> P;
    P << 1, 0, -image.corner[i].x(), 0, 1, -image.corner[i].y();
    N += P.transpose() * P;
    b -= P.transpose() * (P * turned);
  }
  T_c_p->t = N.inverse() * b;
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 p = *T_c_p * Vec3(plane.corner[i].x(), plane.corner[i].y(), 0);
    if (!(p.z() > 0)) return false;
    sum += (p.hnormalized() - image.corner[i]).squaredNorm();
  }
  *error = std::sqrt(sum / 4);
  return std::isfinite(*error);
}

}  // namespace

PlanarPose planar_pose(const std::array<Vec3, 4>& corners, const Quad<double>& image) {
  PlanarPose out;
  PlaneFrame frame;
  out.status = plane_frame(corners, &frame);
  if (!textplane::is_ok(out.status)) return out;
  out.status = !textplane::all_finite(image)   ? Status::non_finite
               : !textplane::is_convex(image)  ? Status::degenerate
               : !(textplane::area(image) > 0) ? Status::behind_camera
                                               : Status::ok;
  Mat3 H;
  if (textplane::is_ok(out.status)) out.status = homography(frame.quad, image, &H);
  if (!textplane::is_ok(out.status)) return out;

  // The derivative of the image by the plane's coordinates at the origin is [I | -m] R [e1 e2] / depth. Turned so that
  // the ray of m is the axis, it is a 2 x 2 block of a rotation over the depth; its largest singular value is one over
  // the depth, and the rest of the rotation follows up to a sign.
  const Vec2 m = H.topRightCorner<2, 1>();
  const Mat2 J = H.topLeftCorner<2, 2>() - m * H.bottomLeftCorner<1, 2>();
  const Mat3 V = turn_to(m);
  Eigen::Matrix<double, 2, 3> P;
  P << 1, 0, -m.x(), 0, 1, -m.y();
  const Mat2 A = Mat2(P * V.leftCols<2>()).inverse() * J;
  const double half_trace = 0.5 * A.squaredNorm(), det = A.determinant();
  const double largest = std::sqrt(half_trace + std::sqrt(std::max(0.0, half_trace * half_trace - det * det)));
  if (!(largest > 0) || !std::isfinite(largest)) {
    out.status = Status::degenerate;
    return out;
  }
  const Mat2 block = A / largest, rest = Mat2::Identity() - block.transpose() * block;
  const double b0 = std::sqrt(std::max(0.0, rest(0, 0)));
  const double b1 = std::copysign(std::sqrt(std::max(0.0, rest(1, 1))), rest(0, 1));
  const SE3d T_p_q = frame.T_q_p.inverse();
  for (const double sign : {1.0, -1.0}) {
    SE3d T_c_p;
    Mat3 R;
    R.topLeftCorner<2, 2>() = block;
    R.bottomLeftCorner<1, 2>() << sign * b0, sign * b1;
    R.col(2) = R.col(0).cross(R.col(1));
    T_c_p.R = V * R;
    T_c_p = textplane::renormalised(T_c_p);
    const auto slot = static_cast<std::size_t>(out.count);
    if (!place(frame.quad, image, &T_c_p, &out.error[slot])) continue;
    out.T_c_q[slot] = T_c_p * T_p_q;
    ++out.count;
  }
  if (out.count == 0) out.status = Status::behind_camera;
  if (out.count == 2 && out.error[1] < out.error[0]) {
    std::swap(out.T_c_q[0], out.T_c_q[1]);
    std::swap(out.error[0], out.error[1]);
  }
  return out;
}

}  // namespace textslam
