// Quads: corners (4, 2), clockwise on the screen from the text's top left.
#include "core/core.hpp"
#include "textplane/geometry/quad_projection.hpp"

namespace binding {
namespace of_quads {

const char kQuad[] = "quad";

py::object projected(const py::object& corners, const py::object& host, const py::object& theta,
                     const py::object& T_t_h, const py::object& target) {
  tp::Quad<double> out;
  const tp::Pinhole<double>& from = object<Camera>(host, "host", "a textplane.Camera").model.pinhole();
  const tp::CameraView to = object<Camera>(target, "target", "a textplane.Camera").view();
  const tp::Status status =
      tp::project_quad(quad(corners, kQuad), from, vector<3>(theta, "theta"), pose(T_t_h, "T_t_h"), to, &out);
  return tp::is_ok(status) ? to_python(out) : py::none();
}

py::object on_plane(const py::object& corners, const py::object& host, const py::object& theta) {
  std::array<Vec3, 4> points;
  const tp::Pinhole<double>& from = object<Camera>(host, "host", "a textplane.Camera").model.pinhole();
  if (!tp::is_ok(tp::quad_points(quad(corners, kQuad), from, vector<3>(theta, "theta"), &points))) return py::none();
  py::array_t<double> out({4, 3});
  double* p = out.mutable_data();
  for (const Vec3& point : points)
    for (const int k : {0, 1, 2}) *p++ = point[k];
  return std::move(out);
}

void bind(py::module_& m) {
  using namespace py::literals;
  m.def(
      "quad_area", [](const py::object& q) { return tp::area(quad(q, kQuad)); }, "quad"_a,
      "quad_area(quad: Numbers) -> float\n\nSigned area, px^2, positive for clockwise corners (4, 2).");
  m.def(
      "quad_is_convex", [](const py::object& q) { return tp::is_convex(quad(q, kQuad)); }, "quad"_a,
      "quad_is_convex(quad: Numbers) -> bool\n\nWhether the corners (4, 2) are those of a strictly convex quad.");
  m.def(
      "quad_contains",
      [](const py::object& q, const py::object& p) {
        return tp::contains(quad(q, kQuad), Vec2(vector<2>(p, "point")));
      },
      "quad"_a, "point"_a,
      "quad_contains(quad: Numbers, point: Numbers) -> bool\n\nWhether the convex quad (4, 2) holds the point (2,), "
      "edge "
      "included.");
  m.def(
      "quad_iou", [](const py::object& a, const py::object& b) { return tp::iou(quad(a, "a"), quad(b, "b")); }, "a"_a,
      "b"_a, "quad_iou(a: Numbers, b: Numbers) -> float\n\nIntersection over union of two quads (4, 2).");
  m.def(
      "quad_overlap", [](const py::object& a, const py::object& b) { return tp::overlap(quad(a, "a"), quad(b, "b")); },
      "a"_a, "b"_a,
      "quad_overlap(a: Numbers, b: Numbers) -> float\n\nThe area that two convex quads (4, 2) share, of the smaller "
      "one's.");
  m.def(
      "project_quad", &projected, "quad"_a, "host"_a, "theta"_a, "T_t_h"_a, "target"_a,
      "project_quad(quad: Numbers, host: Camera, theta: Numbers, T_t_h: Pose, target: Camera) -> Array | None\n\nThe "
      "image in the target, px (4, 2), of a host quad (4, 2), px of the undistorted image, on the plane; None where a "
      "corner has none.");
  m.def("quad_points", &on_plane, "quad"_a, "host"_a, "theta"_a,
        "quad_points(quad: Numbers, host: Camera, theta: Numbers) -> Array | None\n\nThe corners on the plane, in the "
        "host "
        "frame, (4, 3); None where one is behind the camera.");
}

}  // namespace of_quads
}  // namespace binding
