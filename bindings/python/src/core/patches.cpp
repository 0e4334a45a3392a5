// TextPatch: the pixels of a text object in its host image.
#include <vector>

#include "core/core.hpp"
#include "textplane/features/select.hpp"

namespace binding {
namespace of_patches {

using Patch = tp::TextPatch;

const tp::PatchLevel& level_of(const Patch& patch, int level) {
  if (level < 0 || level >= patch.level_count())
    throw py::index_error("level: the patch has no level " + std::to_string(level));
  return patch.levels[static_cast<std::size_t>(level)];
}

// A property of a level as a function of the level, in place.
void level_field(py::class_<Patch>& c, const char* name, std::vector<float> tp::PatchLevel::*member, const char* doc) {
  c.def(
      name,
      [member](Handle self, int level) -> py::object {
        const std::vector<float>& values = level_of(self.cast<const Patch&>(), level).*member;
        return borrowed(values.data(), values.size(), self);
      },
      py::arg("level") = 0, doc);
}

py::object made(const py::object& host, const py::object& host_camera, const py::object& corners,
                const py::object& settings, bool raise) {
  const Levels pyramid(host, "host");
  const tp::CameraView view = camera(host_camera);
  const tp::Quad<double> where = quad(corners, "quad");
  const auto selection = options<tp::SelectOptions>(settings, "options", "a textplane.SelectOptions");
  return finish(unlocked([&] { return tp::make_patch(pyramid.view(), view, where, selection); }), raise, "make_patch");
}

py::object selected(const py::object& pixels, const py::object& corners, const py::object& settings) {
  const tp::ImageView8 view = image<const std::uint8_t>(pixels, "image");
  const tp::Quad<double> where = quad(corners, "quad");
  const auto selection = options<tp::SelectOptions>(settings, "options", "a textplane.SelectOptions");
  std::vector<tp::Vector2<float>> found;
  const tp::Status status = unlocked([&] { return tp::select_pixels(view, where, selection, found); });
  py::array_t<float> out({static_cast<py::ssize_t>(found.size()), py::ssize_t{2}});
  float* p = out.mutable_data();
  for (const tp::Vector2<float>& px : found)
    for (const int i : {0, 1}) *p++ = px[i];
  return py::make_tuple(std::move(out), status);
}

void bind(py::module_& m) {
  using namespace py::literals;
  auto s = options_class<tp::SelectOptions>(m, "SelectOptions", "Settings of make_patch() and select_pixels().");
  option(s, "min_pixels", &tp::SelectOptions::min_pixels, "int: Fewer is Status.too_few.");
  option(s, "max_pixels", &tp::SelectOptions::max_pixels, "int: On each level.");
  option(s, "levels", &tp::SelectOptions::levels, "int: Pyramid levels of a patch.");
  option(s, "fast_threshold", &tp::SelectOptions::fast_threshold, "int: Grey levels, of the first corners.");
  option(s, "lowest_fast_threshold", &tp::SelectOptions::lowest_fast_threshold,
         "int: Grey levels, of the last corners.");
  option(s, "min_gradient", &tp::SelectOptions::min_gradient, "float: Grey levels a px, of a pixel that fills a gap.");

  py::class_<Patch> c(m, "TextPatch",
                      "The pixels of a text object in its host image, on every pyramid level. The host image may go. "
                      "Positions are those of the undistorted image. It never changes.");
  field(c, "quad", &Patch::quad, "Array: Corners, px of level 0, (4, 2).");
  field(c, "area", &Patch::area, "float: px^2 that it covers in the host image.");
  c.def_property_readonly(
      "levels", [](const Patch& self) { return self.level_count(); }, "int: Pyramid levels that it has pixels of.");
  c.def_property_readonly(
      "camera", [](const Patch& self) { return std::make_unique<Camera>(self.camera); },
      "Camera: Of the undistorted host image, level 0.");
  level_field(c, "x", &tp::PatchLevel::x,
              "x(level: int = 0) -> Array\n\nColumns, px of the level, float32 (n,), in place.");
  level_field(c, "y", &tp::PatchLevel::y,
              "y(level: int = 0) -> Array\n\nRows, px of the level, float32 (n,), in place.");
  level_field(c, "intensity", &tp::PatchLevel::intensity,
              "intensity(level: int = 0) -> Array\n\nGrey levels of the host there, float32 (n,), in place.");
  level_field(c, "gx", &tp::PatchLevel::gx,
              "gx(level: int = 0) -> Array\n\nGradient along x, grey levels a px, float32 (n,), in place.");
  level_field(c, "gy", &tp::PatchLevel::gy,
              "gy(level: int = 0) -> Array\n\nGradient along y, grey levels a px, float32 (n,), in place.");
  result_class(c);

  m.def(
      "make_patch", &made, "host"_a, "camera"_a, "quad"_a, "options"_a = py::none(), "raise_on_failure"_a = false,
      "make_patch(host: Pyramid | Array, camera: Camera, quad: Numbers, options: SelectOptions | None = None, "
      "raise_on_failure: bool = False) -> TextPatch\n\nThe patch of the text with these corners (4, 2), px, clockwise "
      "from the text's top left, in its host image.");
  m.def(
      "select_pixels", &selected, "image"_a, "quad"_a, "options"_a = py::none(),
      "select_pixels(image: Array, quad: Numbers, options: SelectOptions | None = None) -> tuple[Array, Status]\n\nThe "
      "pixels that stand for a quad (4, 2) of an image of uint8: corners and strong gradients, float32 (n, 2), px.");
}

}  // namespace of_patches
}  // namespace binding
