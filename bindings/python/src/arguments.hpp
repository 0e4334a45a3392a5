// Arguments: what Python gives, as the library takes it. Large arrays are used in place, small ones are copied. What
// does not fit raises ValueError, or TypeError where it is no array at all, and says which argument, what was expected
// and what came.
#ifndef TEXTPLANE_PYTHON_ARGUMENTS_HPP
#define TEXTPLANE_PYTHON_ARGUMENTS_HPP

#include <cstdint>
#include <optional>

#include "binding.hpp"
#include "textplane/core/cameras/camera_view.hpp"
#include "textplane/core/image_view.hpp"
#include "textplane/photometry/pyramid.hpp"

namespace binding {

[[noreturn]] void expected(const char* name, const std::string& what, Handle got);

/// rows x columns numbers, or a vector of `rows` where `columns` is 0, row by row: any array or nested sequence.
void read_numbers(Handle from, const char* name, int rows, int columns, double* to);

/// A vector of N numbers.
template <int N>
Eigen::Matrix<double, N, 1> vector(Handle from, const char* name) {
  Eigen::Matrix<double, N, 1> out;
  read_numbers(from, name, N, 0, out.data());
  return out;
}
tp::Matrix3<double> matrix3(Handle from, const char* name);
tp::Quad<double> quad(Handle from, const char* name);  ///< (4, 2).
/// An SE3, or a matrix (4, 4) or (3, 4) whose rotation is one.
tp::SE3d pose(Handle from, const char* name);

/// Numbers in somebody else's array.
template <class T>
struct Span {
  T* data = nullptr;
  int n = 0;
};
/// A C-contiguous array (n, columns), or (n,) where `columns` is 0, of exactly this type of number, used in place.
template <class S>
Span<const S> span(Handle from, const char* name, int columns);
extern template Span<const double> span<double>(Handle, const char*, int);
extern template Span<const float> span<float>(Handle, const char*, int);
extern template Span<const std::uint8_t> span<std::uint8_t>(Handle, const char*, int);
/// (n, 3) of float64, in place.
Span<const Vec3> points3(Handle from, const char* name);
/// Such that both have one length.
void same_length(int a, const char* name_a, int b, const char* name_b);

/// An image (height, width) whose pixels of a row are neighbours, in place. T: std::uint8_t or float, const or not.
template <class T>
tp::ImageView<T> image(Handle from, const char* name);
extern template tp::ImageView8 image<const std::uint8_t>(Handle, const char*);
extern template tp::ImageViewF image<const float>(Handle, const char*);
extern template tp::ImageView<std::uint8_t> image<std::uint8_t>(Handle, const char*);
extern template tp::ImageView<float> image<float>(Handle, const char*);
/// Whether it is an array of numbers of this type.
template <class T>
bool is_array_of(Handle from) {
  return py::isinstance<py::array_t<std::remove_const_t<T>>>(from);
}

/// A camera and its lens, which views of it point to.
struct Camera {
  explicit Camera(const tp::AnyCamera<double>& camera) : model(camera) {
    if (!model.is_pinhole()) lens.emplace(model);
  }
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;
  tp::CameraView view() const noexcept { return {model.pinhole(), lens ? &*lens : nullptr}; }

  tp::AnyCamera<double> model;
  std::optional<tp::LensMap> lens;
};

/// The object of a class of ours; it lives as long as the argument.
template <class C>
C& object(Handle from, const char* name, const char* what) {
  py::detail::make_caster<C> caster;
  if (from.is_none() || !caster.load(from, false)) expected(name, what, from);
  return py::detail::cast_op<C&>(caster);
}
inline tp::CameraView camera(Handle from) { return object<Camera>(from, "camera", "a textplane.Camera").view(); }

/// A Pyramid, or an image of which one is built.
class Levels {
 public:
  Levels(Handle from, const char* name);
  const tp::PyramidView& view() const noexcept { return view_; }

 private:
  std::optional<tp::Pyramid> own_;
  tp::PyramidView view_;
};

/// The object, or `otherwise` for None.
template <class C>
C options(Handle from, const char* name, const char* what, const C& otherwise = {}) {
  return from.is_none() ? otherwise : object<C>(from, name, what);
}

}  // namespace binding

#endif  // TEXTPLANE_PYTHON_ARGUMENTS_HPP
