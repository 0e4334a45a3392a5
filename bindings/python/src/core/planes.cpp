// theta: conversion, depth, change of frame, and its fits.
#include <vector>

#include "core/core.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/plane_fit.hpp"
#include "textplane/geometry/triangulate.hpp"

namespace binding {
namespace of_planes {

using Fit = tp::PlaneFit<double>;

struct Point {
  Vec3 value = Vec3::Zero();
  tp::Matrix3<double> covariance = tp::Matrix3<double>::Zero();
  tp::Status status = tp::Status::invalid_argument;
};

const double* weights_of(Handle from, int n) {
  if (from.is_none()) return nullptr;
  const Span<const double> w = span<double>(from, "weight", 0);
  same_length(w.n, "weight", n, "the points");
  return w.data;
}

py::object from_inverse_depths(const py::object& m, const py::object& rho, const py::object& weight, bool raise) {
  const auto points = points3(m, "m");
  const auto depths = span<double>(rho, "rho", 0);
  same_length(points.n, "m", depths.n, "rho");
  const double* w = weights_of(weight, points.n);
  Fit fit = unlocked([&] { return tp::plane_from_inverse_depths<double>(points.data, depths.data, w, points.n); });
  return finish(std::move(fit), raise, "plane_from_inverse_depths");
}

py::object from_matches(const py::object& host_m, const py::object& target_m, const py::object& T_t_h,
                        const py::object& weight, bool raise) {
  const auto host = points3(host_m, "host_m"), target = points3(target_m, "target_m");
  same_length(host.n, "host_m", target.n, "target_m");
  const tp::SE3d T = pose(T_t_h, "T_t_h");
  const double* w = weights_of(weight, host.n);
  Fit fit = unlocked([&] { return tp::plane_from_matches<double>(host.data, target.data, host.n, T, w); });
  return finish(std::move(fit), raise, "plane_from_matches");
}

py::object from_points(const py::object& p, const py::object& weight, bool raise) {
  const auto points = points3(p, "p");
  const double* w = weights_of(weight, points.n);
  Fit fit = unlocked([&] { return tp::plane_from_points<double>(points.data, points.n, w); });
  return finish(std::move(fit), raise, "plane_from_points");
}

py::object triangulate(const py::object& T_c_w, const py::object& m, bool raise) {
  const auto rays = points3(m, "m");
  if (!PySequence_Check(T_c_w.ptr())) expected("T_c_w", "a sequence of poses", T_c_w);
  std::vector<tp::SE3d> poses;
  for (const py::object T : py::reinterpret_borrow<py::sequence>(T_c_w)) poses.push_back(pose(T, "T_c_w"));
  same_length(static_cast<int>(poses.size()), "T_c_w", rays.n, "m");
  Point point;
  point.status = tp::triangulate_views(poses.data(), rays.data, rays.n, &point.value, &point.covariance);
  return finish(std::move(point), raise, "triangulate");
}

void bind_results(py::module_& m) {
  py::class_<Fit> fit(m, "PlaneFit", "A fitted plane.");
  field(fit, "value", &Fit::value, "Array: theta in the host frame, (3,); zero after a failure.");
  field(fit, "covariance", &Fit::covariance,
        "Array: Of theta, (3, 3), with weights of 1 / variance; else times sigma^2.");
  field(fit, "rank", &Fit::rank, "int: Of the design matrix, 0 to 3.");
  field(fit, "condition", &Fit::condition, "float: Its largest over its smallest singular value.");
  field(fit, "sigma", &Fit::sigma, "float: sqrt(sum w r^2 / degrees of freedom).");
  result_class(fit);
  py::class_<Point> point(m, "TriangulatedPoint", "A point seen in several views.");
  field(point, "value", &Point::value, "Array: In the world, (3,); zero after a failure.");
  field(point, "covariance", &Point::covariance, "Array: (3, 3), for noise of 1 on each normalised coordinate.");
  result_class(point);
}

void bind_fits(py::module_& m) {
  using namespace py::literals;
  m.def(
      "plane_from_inverse_depths", &from_inverse_depths, "m"_a, "rho"_a, "weight"_a = py::none(),
      "raise_on_failure"_a = false,
      "plane_from_inverse_depths(m: Array, rho: Array, weight: Array | None = None, raise_on_failure: bool = False) -> "
      "PlaneFit\n\ntheta from n >= 3 inverse depths: least squares of m~_i . theta = rho_i. m: rays (n, 3); rho: their "
      "inverse depths (n,); weight: 1 / variance of each rho (n,).");
  m.def(
      "plane_from_matches", &from_matches, "host_m"_a, "target_m"_a, "T_t_h"_a, "weight"_a = py::none(),
      "raise_on_failure"_a = false,
      "plane_from_matches(host_m: Array, target_m: Array, T_t_h: Pose, weight: Array | None = None, raise_on_failure: "
      "bool = False) -> PlaneFit\n\ntheta from n >= 3 matches of two views of known pose. host_m, target_m: rays (n, "
      "3), "
      "Camera.unproject() of the pixels; T_t_h: host to target; weight: 1 / variance of a normalised coordinate (n,).");
  m.def("plane_from_points", &from_points, "p"_a, "weight"_a = py::none(), "raise_on_failure"_a = false,
        "plane_from_points(p: Array, weight: Array | None = None, raise_on_failure: bool = False) -> PlaneFit\n\ntheta "
        "from "
        "n >= 3 points (n, 3) of the host frame: least squares of their distances from the plane. weight: 1 / variance "
        "(n,).");
  m.def("triangulate", &triangulate, "T_c_w"_a, "m"_a, "raise_on_failure"_a = false,
        "triangulate(T_c_w: Sequence[Pose], m: Array, raise_on_failure: bool = False) -> TriangulatedPoint\n\nThe "
        "point of "
        "the world that n >= 2 views of poses T_c_w (world to camera) see at the rays m, (n, 3).");
}

py::object reanchor(const py::object& theta, const py::object& T_t_h) {
  return to_python(tp::reanchor_plane(vector<3>(theta, "theta"), pose(T_t_h, "T_t_h")));
}

void bind(py::module_& m) {
  using namespace py::literals;
  bind_results(m);
  bind_fits(m);
  m.def(
      "plane_from_normal",
      [](const py::object& n, double d) { return to_python(tp::plane_from_normal(vector<3>(n, "n"), d)); }, "n"_a,
      "d"_a,
      "plane_from_normal(n: Numbers, d: float) -> Array\n\ntheta = -n / d of the plane n . p + d = 0, (3,), in the "
      "inverse "
      "of the unit of d; zero where d is.");
  m.def(
      "from_negated", [](const py::object& t) { return to_python(tp::from_negated(vector<3>(t, "negated_theta"))); },
      "negated_theta"_a,
      "from_negated(negated_theta: Numbers) -> Array\n\ntheta, (3,), from a source that stores n / d, as the code "
      "published "
      "with the paper does.");
  m.def(
      "plane_normal", [](const py::object& t) { return to_python(tp::plane_normal(vector<3>(t, "theta"))); }, "theta"_a,
      "plane_normal(theta: Numbers) -> Array\n\nUnit normal towards the host camera, (3,).");
  m.def(
      "plane_distance", [](const py::object& t) { return tp::plane_distance(vector<3>(t, "theta")); }, "theta"_a,
      "plane_distance(theta: Numbers) -> float\n\nDistance of the plane from the host camera's centre.");
  m.def(
      "inverse_depth",
      [](const py::object& t, const py::object& ray) {
        return tp::inverse_depth(vector<3>(t, "theta"), vector<3>(ray, "m"));
      },
      "theta"_a, "m"_a,
      "inverse_depth(theta: Numbers, m: Numbers) -> float\n\nrho = theta . m~ along the ray m, (3,).");
  m.def(
      "plane_point",
      [](const py::object& t, const py::object& ray) {
        return to_python(tp::plane_point(vector<3>(t, "theta"), vector<3>(ray, "m")));
      },
      "theta"_a, "m"_a,
      "plane_point(theta: Numbers, m: Numbers) -> Array\n\nThe plane's point on the ray m, (3,); zero where it is "
      "behind the "
      "camera.");
  m.def("reanchor_plane", &reanchor, "theta"_a, "T_t_h"_a,
        "reanchor_plane(theta: Numbers, T_t_h: Pose) -> Array\n\nThe same plane in the target frame, (3,); zero where "
        "the "
        "target's centre is on it or behind it.");
}

}  // namespace of_planes
}  // namespace binding
