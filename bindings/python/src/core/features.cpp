// FAST corners and KLT tracks.
#include <vector>

#include "core/core.hpp"
#include "textplane/features/fast.hpp"
#include "textplane/features/klt.hpp"

namespace binding {
namespace of_features {

// The tracks of one call, a number a point.
struct Tracks {
  py::array_t<float> px, zncc, fb_error;
  py::array_t<std::uint8_t> status;
};

py::object detect(const py::object& pixels, int threshold, bool suppress) {
  const tp::ImageView8 view = image<const std::uint8_t>(pixels, "image");
  std::vector<tp::Corner> corners;
  unlocked([&] { tp::detect_fast(view, threshold, suppress, corners); });
  static_assert(sizeof(tp::Corner) == 3 * sizeof(float), "a corner is a row of three numbers");
  py::array_t<float> out({static_cast<py::ssize_t>(corners.size()), py::ssize_t{3}});
  float* p = out.mutable_data();
  for (const tp::Corner& c : corners)
    for (const float value : {c.x, c.y, c.score}) *p++ = value;
  return std::move(out);
}

Span<const tp::Vector2<float>> points2(Handle from, const char* name) {
  static_assert(sizeof(tp::Vector2<float>) == 8 && alignof(tp::Vector2<float>) == alignof(float), "rows are points");
  const Span<const float> numbers = span<float>(from, name, 2);
  return {reinterpret_cast<const tp::Vector2<float>*>(numbers.data), numbers.n};
}

py::object track(const py::object& from, const py::object& to, const py::object& points, const py::object& guess,
                 const py::object& settings) {
  const Levels first(from, "from_image"), second(to, "to_image");
  const auto source = points2(points, "points");
  Span<const tp::Vector2<float>> start;
  if (!guess.is_none()) {
    start = points2(guess, "guess");
    same_length(source.n, "points", start.n, "guess");
  }
  const auto chosen = options<tp::KltOptions>(settings, "options", "a textplane.KltOptions");
  std::vector<tp::KltResult> results(static_cast<std::size_t>(source.n));
  unlocked(
      [&] { tp::track_klt(first.view(), second.view(), source.data, start.data, source.n, chosen, results.data()); });
  const py::ssize_t n = source.n;
  Tracks out{py::array_t<float>({n, py::ssize_t{2}}), py::array_t<float>(n), py::array_t<float>(n),
             py::array_t<std::uint8_t>(n)};
  float *px = out.px.mutable_data(), *zncc = out.zncc.mutable_data(), *error = out.fb_error.mutable_data();
  std::uint8_t* status = out.status.mutable_data();
  for (const tp::KltResult& result : results) {
    *px++ = result.px[0];
    *px++ = result.px[1];
    *zncc++ = result.zncc;
    *error++ = result.fb_error;
    *status++ = static_cast<std::uint8_t>(result.status);
  }
  return py::cast(std::move(out));
}

void bind(py::module_& m) {
  using namespace py::literals;
  using O = tp::KltOptions;
  auto o = options_class<O>(m, "KltOptions", "Settings of track_klt(); px of the current level unless said otherwise.");
  option(o, "radius", &O::radius, "int: A patch has 2 radius + 1 pixels a side.");
  option(o, "levels", &O::levels, "int: Pyramid levels used.");
  option(o, "max_iterations", &O::max_iterations, "int: On every level.");
  option(o, "epsilon", &O::epsilon, "float: px: a shorter step ends a level.");
  option(o, "min_contrast", &O::min_contrast, "float: Grey levels, of the patch and of its image.");
  option(o, "min_eigenvalue", &O::min_eigenvalue, "float: 1/px^2, of the patch: a straight edge has 0.");
  option(o, "min_zncc", &O::min_zncc, "float: Of a successful track.");
  option(o, "max_forward_backward", &O::max_forward_backward, "float: px of level 0; 0: no backward pass.");

  py::class_<Tracks> c(m, "Tracks", "What track_klt() found, a row a point.");
  field(c, "px", &Tracks::px, "Array: Positions, px of level 0, float32 (n, 2).");
  field(c, "zncc", &Tracks::zncc, "Array: Correlations, float32 (n,).");
  field(c, "fb_error", &Tracks::fb_error, "Array: Forward-backward errors, px, float32 (n,).");
  field(c, "status", &Tracks::status, "Array: Numbers of the statuses, uint8 (n,): Status(status[i]).");
  c.def_property_readonly(
      "ok",
      [](const Tracks& self) {
        py::array_t<bool> out(self.status.size());
        for (py::ssize_t i = 0; i < self.status.size(); ++i)
          out.mutable_at(i) = tp::is_ok(static_cast<tp::Status>(self.status.at(i)));
        return out;
      },
      "Array: Whether a track passed every check, bool (n,).");

  m.def("detect_fast", &detect, "image"_a, "threshold"_a = 20, "suppress"_a = true,
        "detect_fast(image: Array, threshold: int = 20, suppress: bool = True) -> Array\n\nFAST-9/16 corners of an "
        "image of "
        "uint8 in raster order: x, y in px, and the score, float32 (n, 3). threshold: grey levels; suppress: local "
        "maxima "
        "of the score alone.");
  m.def("track_klt", &track, "from_image"_a, "to_image"_a, "points"_a, "guess"_a = py::none(), "options"_a = py::none(),
        "track_klt(from_image: Pyramid | Array, to_image: Pyramid | Array, points: Array, guess: Array | None = None, "
        "options: KltOptions | None = None) -> Tracks\n\nWhere the points, float32 (n, 2), px of level 0, of one image "
        "are "
        "in another; guess: predicted positions, float32 (n, 2).");
}

}  // namespace of_features
}  // namespace binding
