// Cameras of all models.
#include <limits>
#include <vector>

#include "core/core.hpp"

namespace binding {
namespace of_cameras {

tp::AnyCamera<double> camera_of(const std::string& model, Handle parameters) {
  const auto numbers = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(parameters);
  if (!numbers || numbers.ndim() != 1 || numbers.size() > tp::AnyCamera<double>::kMaxParameters)
    expected("parameters", "fx, fy, cx, cy and the coefficients of the lens, at most 12 numbers",
             numbers ? Handle(numbers) : parameters);
  tp::AnyCamera<double>::Parameters p(numbers.size());
  for (py::ssize_t i = 0; i < numbers.size(); ++i) p[i] = numbers.at(i);
  tp::AnyCamera<double> camera;
  if (!tp::is_ok(tp::AnyCamera<double>::make(model, p, &camera)))
    throw py::value_error(
        "Camera: no camera \"" + model + "\" of these " + std::to_string(p.size()) +
        " parameters; models are pinhole (4), radial_tangential (9), rational (12), kannala_brandt (8), "
        "double_sphere (6), extended_unified (6) and fov (5)");
  return camera;
}

// Rows of `columns` numbers: one, or one a row.
py::array_t<double> rows_of(Handle from, const char* name, int columns) {
  const auto all = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(from);
  if (!all || (all.ndim() != 1 && all.ndim() != 2) || all.shape(all.ndim() - 1) != columns)
    expected(name, "numbers of shape (" + std::to_string(columns) + ",) or (n, " + std::to_string(columns) + ")",
             all ? Handle(all) : from);
  return all;
}

// f(input of In numbers, output of Out numbers) of each row.
template <int In, int Out, class F>
py::object each_row(Handle from, const char* name, F f) {
  const py::array_t<double> in = rows_of(from, name, In);
  const py::ssize_t n = in.ndim() == 1 ? 1 : in.shape(0);
  py::array_t<double> out = in.ndim() == 1 ? py::array_t<double>(Out) : py::array_t<double>({n, py::ssize_t{Out}});
  const double* a = in.data();
  double* b = out.mutable_data();
  unlocked([&] {
    for (py::ssize_t i = 0; i < n; ++i) f(a + i * In, b + i * Out);
  });
  return std::move(out);
}

py::object project(const Camera& camera, Handle points) {
  return each_row<3, 2>(points, "points", [&](const double* p, double* px) {
    const Vec3 point(p[0], p[1], p[2]);
    const bool seen = camera.model.in_domain(point);
    const Vec2 pixel = seen ? camera.model.project(point) : Vec2::Constant(std::numeric_limits<double>::quiet_NaN());
    px[0] = pixel[0];
    px[1] = pixel[1];
  });
}

py::object unproject(const Camera& camera, Handle pixels) {
  return each_row<2, 3>(pixels, "pixels", [&](const double* px, double* m) {
    Vec3 ray = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    camera.model.unproject(Vec2(px[0], px[1]), &ray);
    for (const int k : {0, 1, 2}) m[k] = ray[k];
  });
}

void bind(py::module_& m) {
  py::class_<Camera> c(
      m, "Camera",
      "A camera of one of the models of docs/cameras.md, with its lens. Pixels are those of the image as "
      "it was taken; the centre of the top-left one is (0, 0).");
  c.def(py::init([](const std::string& model, const py::object& parameters) {
          return std::make_unique<Camera>(camera_of(model, parameters));
        }),
        py::arg("model"), py::arg("parameters"),
        "__init__(model: str, parameters: Numbers) -> None\n\n`model`: pinhole, radial_tangential, rational, "
        "kannala_brandt, double_sphere, extended_unified or fov. `parameters`: fx, fy, cx, cy in px, then the "
        "coefficients "
        "of the lens.");
  c.def_property_readonly(
      "model", [](const Camera& self) { return self.model.name(); }, "str: Name of the model.");
  c.def_property_readonly(
      "parameters", [](const Camera& self) { return to_python(self.model.parameters()); },
      "Array: fx, fy, cx, cy in px, then the coefficients of the lens.");
  c.def(
      "project", &project, py::arg("points"),
      "project(points: Numbers) -> Array\n\nPixels (2,) or (n, 2) of points (3,) or (n, 3) of the camera's frame; NaN "
      "where the camera does not see them.");
  c.def("unproject", &unproject, py::arg("pixels"),
        "unproject(pixels: Numbers) -> Array\n\nRays m~ = (x/z, y/z, 1), (3,) or (n, 3), of pixels (2,) or (n, 2); NaN "
        "where there is none.");
  c.def(
      "at_level",
      [](const Camera& self, int level) {
        if (level < 0 || level >= tp::kMaxPyramidLevels) throw py::value_error("level: expected 0 to 7");
        return std::make_unique<Camera>(self.model.at_level(level));
      },
      py::arg("level"),
      "at_level(level: int) -> Camera\n\nThe camera of a pyramid level, whose pixels are (x + 0.5) / 2^level - 0.5.");
  c.def(
      "pinhole", [](const Camera& self) { return std::make_unique<Camera>(self.model.pinhole()); },
      "pinhole() -> Camera\n\nThe camera of the undistorted image.");
  c.def(
      "__repr__",
      [](const Camera& self) {
        return "Camera(\"" + std::string(self.model.name()) + "\", " +
               std::string(py::repr(to_python(self.model.parameters()).attr("tolist")())) + ")";
      },
      "__repr__() -> str\n\nModel and parameters.");
  m.def(
      "Pinhole",
      [](double fx, double fy, double cx, double cy) {
        const tp::Pinhole<double> camera(fx, fy, cx, cy);
        if (!camera.valid()) throw py::value_error("Pinhole: expected finite numbers and positive focal lengths");
        return std::make_unique<Camera>(camera);
      },
      py::arg("fx"), py::arg("fy"), py::arg("cx"), py::arg("cy"),
      "Pinhole(fx: float, fy: float, cx: float, cy: float) -> Camera\n\nA camera without a lens; all px.");
}

}  // namespace of_cameras
}  // namespace binding
