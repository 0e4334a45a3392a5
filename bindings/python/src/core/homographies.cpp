// Homographies of planes, warped points and world poses.
#include <limits>

#include "core/core.hpp"
#include "textplane/geometry/homography.hpp"

namespace binding {
namespace of_homographies {

struct Warped {
  Vec2 value = Vec2::Zero();
  tp::FixedMatrix<double, 2, 6> by_pose = tp::FixedMatrix<double, 2, 6>::Zero();
  tp::FixedMatrix<double, 2, 3> by_theta = tp::FixedMatrix<double, 2, 3>::Zero();
  tp::Status status = tp::Status::invalid_argument;
};

py::object inverse_homography(const py::object& theta, const py::object& T_t_h) {
  tp::Matrix3<double> H = tp::Matrix3<double>::Zero();
  const tp::Status status = tp::plane_homography_inverse(vector<3>(theta, "theta"), pose(T_t_h, "T_t_h"), &H);
  return tp::is_ok(status) ? to_python(H) : py::none();
}

const tp::Pinhole<double>& pinhole(Handle from, const char* name) {
  return object<Camera>(from, name, "a textplane.Camera").model.pinhole();
}

py::object warp_points(const py::object& H, const py::object& points) {
  const tp::Matrix3<double> map = matrix3(H, "H");
  const Span<const double> in = span<double>(points, "points", 2);
  py::array_t<double> out({static_cast<py::ssize_t>(in.n), py::ssize_t{2}});
  double* to = out.mutable_data();
  unlocked([&] {
    for (int i = 0; i < in.n; ++i) {
      Vec2 p = Vec2::Constant(std::numeric_limits<double>::quiet_NaN());
      tp::warp<double>(map, {in.data[2 * i], in.data[2 * i + 1], 1.0}, &p);
      to[2 * i] = p[0];
      to[2 * i + 1] = p[1];
    }
  });
  return std::move(out);
}

py::object warp_point(const py::object& theta, const py::object& T_t_h, const py::object& m, bool raise) {
  Warped out;
  tp::WarpJacobians<double> J;
  out.status = tp::warp_point(vector<3>(theta, "theta"), pose(T_t_h, "T_t_h"), vector<3>(m, "m"), &out.value, &J);
  if (tp::is_ok(out.status)) {
    out.by_pose = J.pose;
    out.by_theta = J.theta;
  }
  return finish(std::move(out), raise, "warp_point");
}

py::object relative_jacobians(const py::object& T_w_h, const py::object& T_w_t, bool right) {
  const auto J = tp::relative_pose_jacobians(pose(T_w_h, "T_w_h"), pose(T_w_t, "T_w_t"),
                                             right ? tp::PerturbationSide::right : tp::PerturbationSide::left);
  return py::make_tuple(to_python(J.host), to_python(J.target));
}

void bind(py::module_& m) {
  using namespace py::literals;
  py::class_<Warped> warped(m, "WarpedPoint", "A normalised point m' of the target, and its derivatives.");
  field(warped, "value", &Warped::value, "Array: m', (2,); zero after a failure.");
  field(warped, "by_pose", &Warped::by_pose, "Array: By the left perturbation of T_t_h, xi = (v, omega), (2, 6).");
  field(warped, "by_theta", &Warped::by_theta, "Array: By theta, (2, 3).");
  result_class(warped);
  m.def(
      "plane_homography",
      [](const py::object& theta, const py::object& T_t_h) {
        return to_python(tp::plane_homography(vector<3>(theta, "theta"), pose(T_t_h, "T_t_h")));
      },
      "theta"_a, "T_t_h"_a,
      "plane_homography(theta: Numbers, T_t_h: Pose) -> Array\n\nH = R + t theta^T, (3, 3): normalised host "
      "coordinates to "
      "normalised target coordinates, scale kept.");
  m.def(
      "plane_homography_inverse", &inverse_homography, "theta"_a, "T_t_h"_a,
      "plane_homography_inverse(theta: Numbers, T_t_h: Pose) -> Array | None\n\nTarget to host, (3, 3); None where the "
      "target's centre is on the plane or behind it.");
  m.def(
      "pixel_homography",
      [](const py::object& H, const py::object& host, const py::object& target) {
        return to_python(tp::pixel_homography(matrix3(H, "H"), pinhole(host, "host"), pinhole(target, "target")));
      },
      "H"_a, "host"_a, "target"_a,
      "pixel_homography(H: Numbers, host: Camera, target: Camera) -> Array\n\nThe same map between pixels of "
      "undistorted "
      "images, K_t H K_h^-1, (3, 3).");
  m.def(
      "warp_points", &warp_points, "H"_a, "points"_a,
      "warp_points(H: Numbers, points: Array) -> Array\n\nPoints (n, 2) under H (3, 3), normalised or px as H is; NaN "
      "where one ends behind the camera.");
  m.def(
      "warp_point", &warp_point, "theta"_a, "T_t_h"_a, "m"_a, "raise_on_failure"_a = false,
      "warp_point(theta: Numbers, T_t_h: Pose, m: Numbers, raise_on_failure: bool = False) -> WarpedPoint\n\nm' of the "
      "ray m, (3,), through the plane, with derivatives.");
  m.def("relative_pose_jacobians", &relative_jacobians, "T_w_h"_a, "T_w_t"_a, "right"_a = true,
        "relative_pose_jacobians(T_w_h: Pose, T_w_t: Pose, right: bool = True) -> tuple[Array, Array]\n\nHow "
        "perturbations "
        "of the world poses of host and target move T_t_h: two (6, 6). right: T <- T exp(xi), else T <- exp(xi) T.");
}

}  // namespace of_homographies
}  // namespace binding
