// Images: pyramids, samples, warps, correlation and noise.
#include <vector>

#include "core/core.hpp"
#include "textplane/photometry/noise.hpp"
#include "textplane/photometry/warp_patch.hpp"
#include "textplane/photometry/zncc.hpp"

namespace binding {
namespace of_images {

// A level of a pyramid as an array that keeps the pyramid alive; read only.
py::object level_of(Handle self, int level) {
  const tp::ImageView8 view = self.cast<const tp::Pyramid&>().level(level);
  if (!view.valid()) throw py::index_error("level: the pyramid has no level " + std::to_string(level));
  py::array_t<std::uint8_t> out({py::ssize_t{view.height()}, py::ssize_t{view.width()}},
                                {static_cast<py::ssize_t>(view.stride()), py::ssize_t{1}}, view.data(), self);
  out.attr("flags").attr("writeable") = false;
  return std::move(out);
}

std::unique_ptr<tp::Pyramid> make_pyramid(const py::object& pixels, int levels) {
  const tp::ImageView8 view = image<const std::uint8_t>(pixels, "image");
  if (levels < 1 || levels > tp::kMaxPyramidLevels) throw py::value_error("levels: expected 1 to 8");
  return unlocked([&] { return std::make_unique<tp::Pyramid>(view, levels); });
}

void bind_pyramid(py::module_& m) {
  py::class_<tp::Pyramid> c(
      m, "Pyramid",
      "An image and its repeated halves, level 0 being a copy of the image. Pixel x of level l lies "
      "at (x + 0.5) 2^l - 0.5 of level 0.");
  c.def(py::init(&make_pyramid), py::arg("image"), py::arg("levels") = 4,
        "__init__(image: Array, levels: int = 4) -> None\n\nOf an image of uint8, (height, width); at most 8 levels.");
  c.def_property_readonly(
      "levels", [](const tp::Pyramid& self) { return self.levels(); }, "int: How many levels it has.");
  c.def("level", &level_of, py::arg("level"),
        "level(level: int) -> Array\n\nThe pixels of a level, uint8 (height, width), in place and read only.");
}

py::object summary_of(const tp::WarpSummary& summary, py::object out) {
  return py::make_tuple(std::move(out), summary.inside, summary.status);
}

template <class S, class D>
tp::WarpSummary warped(const py::object& source, const tp::Matrix3<double>& H, const py::object& out, double fill,
                       const py::object& mask) {
  const tp::ImageView<const S> from = image<const S>(source, "source");
  const tp::ImageView<D> to = image<D>(out, "out");
  tp::ImageView<std::uint8_t> flags;
  if (!mask.is_none()) flags = image<std::uint8_t>(mask, "mask");
  return unlocked([&] { return tp::warp_patch(from, H, to, static_cast<float>(fill), flags); });
}

// `out`: an array to write to, or the shape (height, width) of a new one.
py::object warp(const py::object& source, const py::object& H, const py::object& out, double fill,
                const py::object& mask) {
  const tp::Matrix3<double> map = matrix3(H, "H");
  const bool bytes = is_array_of<std::uint8_t>(source);
  py::object to = out;
  if (py::isinstance<py::tuple>(out)) {
    const auto shape = py::reinterpret_borrow<py::tuple>(out);
    if (shape.size() != 2) throw py::value_error("out: expected an array, or a shape (height, width)");
    const auto height = shape[0].cast<py::ssize_t>(), width = shape[1].cast<py::ssize_t>();
    if (height < 1 || width < 1 || height > 65536 || width > 65536)
      throw py::value_error("out: expected a shape of 1 to 65536 pixels a side");
    to = bytes ? py::object(py::array_t<std::uint8_t>({height, width}))
               : py::object(py::array_t<float>({height, width}));
  }
  tp::WarpSummary summary;
  if (!bytes) {
    summary = warped<float, float>(source, map, to, fill, mask);
  } else if (is_array_of<float>(to)) {
    summary = warped<std::uint8_t, float>(source, map, to, fill, mask);
  } else {
    summary = warped<std::uint8_t, std::uint8_t>(source, map, to, fill, mask);
  }
  if (summary.status == tp::Status::invalid_argument) throw py::value_error("mask: expected the shape of the output");
  return summary_of(summary, std::move(to));
}

template <class T>
py::object correlation_of(const py::object& a, const py::object& b, const py::object& mask) {
  const auto x = span<T>(a, "a", 0), y = span<T>(b, "b", 0);
  same_length(x.n, "a", y.n, "b");
  const std::uint8_t* flags = nullptr;
  if (!mask.is_none()) {
    const auto bytes = span<std::uint8_t>(mask, "mask", 0);
    same_length(x.n, "a", bytes.n, "mask");
    flags = bytes.data;
  }
  return py::float_(unlocked([&] { return tp::zncc(x.data, y.data, flags, x.n); }));
}

py::object correlation(const py::object& a, const py::object& b, const py::object& mask) {
  if (is_array_of<std::uint8_t>(a)) return correlation_of<std::uint8_t>(a, b, mask);
  if (is_array_of<float>(a)) return correlation_of<float>(a, b, mask);
  return correlation_of<double>(a, b, mask);
}

// Value and gradient at each point, NaN outside.
py::object samples(const py::object& pixels, const py::object& points) {
  const bool bytes = is_array_of<std::uint8_t>(pixels);
  const tp::ImageView8 view8 = bytes ? image<const std::uint8_t>(pixels, "image") : tp::ImageView8();
  const tp::ImageViewF viewf = bytes ? tp::ImageViewF() : image<const float>(pixels, "image");
  const Span<const double> at = span<double>(points, "points", 2);
  py::array_t<double> out({py::ssize_t{at.n}, py::ssize_t{3}});
  double* to = out.mutable_data();
  unlocked([&] {
    for (int i = 0; i < at.n; ++i, to += 3) {
      to[0] = to[1] = to[2] = std::numeric_limits<double>::quiet_NaN();
      const double x = at.data[2 * i], y = at.data[2 * i + 1];
      if (bytes)
        tp::sample_bilinear(view8, x, y, to, to + 1, to + 2);
      else
        tp::sample_bilinear(viewf, x, y, to, to + 1, to + 2);
    }
  });
  return std::move(out);
}

void bind(py::module_& m) {
  using namespace py::literals;
  bind_pyramid(m);
  m.def("warp_patch", &warp, "source"_a, "H"_a, "out"_a, "fill"_a = 0.0, "mask"_a = py::none(),
        "warp_patch(source: Array, H: Numbers, out: Array | tuple[int, int], fill: float = 0.0, mask: Array | None = "
        "None) "
        "-> tuple[Array, int, Status]\n\nout(x, y) = source(H (x, y, 1)), bilinear; H (3, 3) maps output pixels to "
        "source "
        "pixels. source: uint8 or float32 (height, width); out: an array to fill, uint8 or float32, or the shape of a "
        "new "
        "one; mask: uint8 of the shape of out, receives 1 inside. Returns out, the number of pixels inside, and the "
        "status.");
  m.def("zncc", &correlation, "a"_a, "b"_a, "mask"_a = py::none(),
        "zncc(a: Array, b: Array, mask: Array | None = None) -> float\n\nZero-mean normalised cross-correlation of two "
        "arrays (n,), both of uint8, float32 or float64, where the mask, uint8 (n,), is not zero; 0 without contrast.");
  m.def("sample_bilinear", &samples, "image"_a, "points"_a,
        "sample_bilinear(image: Array, points: Array) -> Array\n\nValue, and gradient along x and y, of the bilinear "
        "interpolant at the points (n, 2), px: (n, 3), in grey levels and grey levels a px; NaN outside the image.");
  py::class_<tp::NoiseEstimate> noise(m, "NoiseEstimate", "What estimate_noise() found.");
  field(noise, "sigma", &tp::NoiseEstimate::sigma, "float: Standard deviation of a pixel's noise, grey levels.");
  field(noise, "blocks", &tp::NoiseEstimate::blocks, "int: How many blocks counted.");
  result_class(noise);
  m.def(
      "estimate_noise",
      [](const py::object& pixels, bool raise) {
        const tp::ImageView8 view = image<const std::uint8_t>(pixels, "image");
        return finish(unlocked([&] { return tp::estimate_noise(view); }), raise, "estimate_noise");
      },
      "image"_a, "raise_on_failure"_a = false,
      "estimate_noise(image: Array, raise_on_failure: bool = False) -> NoiseEstimate\n\nThe noise of an image of "
      "uint8, "
      "(height, width), where it is white.");
}

}  // namespace of_images
}  // namespace binding
