#include "arguments.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace binding {

namespace {

std::string shape_of(const py::array& array) {
  std::string out = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) out += (i ? ", " : "") + std::to_string(array.shape(i));
  return out + (array.ndim() == 1 ? ",)" : ")");
}

std::string shape_text(int rows, int columns) {
  if (columns == 0) return std::to_string(rows) + " numbers";
  return "numbers of shape (" + std::to_string(rows) + ", " + std::to_string(columns) + ")";
}

template <class S>
const char* type_name() {
  return sizeof(S) == 1 ? "uint8" : sizeof(S) == 4 ? "float32" : "float64";
}

bool fits_int(py::ssize_t n) { return n <= (std::numeric_limits<int>::max)(); }

bool is_aligned(const py::array& array, std::size_t to) {
  bool aligned = reinterpret_cast<std::uintptr_t>(array.data()) % to == 0;
  for (py::ssize_t i = 0; i < array.ndim(); ++i)
    aligned = aligned && array.strides(i) % static_cast<py::ssize_t>(to) == 0;
  return aligned;
}

// The numbers of an array of float64, whatever its strides.
bool copy_numbers(const py::array& array, int rows, int columns, double* to) {
  const int dimensions = columns == 0 ? 1 : 2;
  if (array.ndim() != dimensions || array.shape(0) != rows || (columns > 0 && array.shape(1) != columns)) return false;
  const auto* bytes = static_cast<const unsigned char*>(array.data());
  const py::ssize_t down = array.strides(0), along = columns > 0 ? array.strides(1) : 0;
  const int count = columns > 0 ? columns : 1;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < count; ++c) std::memcpy(to++, bytes + r * down + c * along, sizeof(double));
  return true;
}

}  // namespace

void expected(const char* name, const std::string& what, Handle got) {
  std::string text = std::string(name) + ": expected " + what + ", got ";
  if (!py::isinstance<py::array>(got)) {
    const std::string type = py::str(py::type::handle_of(got).attr("__name__"));
    throw py::type_error(text + (got.is_none() ? std::string("None") : "an object of type " + type));
  }
  const auto array = py::reinterpret_borrow<py::array>(got);
  text += "an array of " + std::string(py::str(array.dtype())) + ", shape " + shape_of(array) + ", strides (bytes) ";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) text += (i ? ", " : "") + std::to_string(array.strides(i));
  throw py::value_error(text);
}

void read_numbers(Handle from, const char* name, int rows, int columns, double* to) {
  if (is_array_of<double>(from)) {
    if (!copy_numbers(py::reinterpret_borrow<py::array>(from), rows, columns, to))
      expected(name, shape_text(rows, columns), from);
    return;
  }
  if (from.is_none() || PyUnicode_Check(from.ptr()) || PyBytes_Check(from.ptr()))
    expected(name, shape_text(rows, columns), from);
  if (py::isinstance<py::array>(from) &&
      std::strchr("biuf", py::reinterpret_borrow<py::array>(from).dtype().kind()) == nullptr)
    expected(name, shape_text(rows, columns), from);
  // Lists, tuples and arrays of other numbers.
  const auto array = py::array_t<double>::ensure(from);
  if (!array) expected(name, shape_text(rows, columns), from);
  if (!copy_numbers(array, rows, columns, to))
    expected(name, shape_text(rows, columns), py::isinstance<py::array>(from) ? from : Handle(array));
}

tp::Matrix3<double> matrix3(Handle from, const char* name) {
  double m[9];
  read_numbers(from, name, 3, 3, m);
  tp::Matrix3<double> out;
  out << m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8];
  return out;
}

tp::Quad<double> quad(Handle from, const char* name) {
  double c[8];
  read_numbers(from, name, 4, 2, c);
  tp::Quad<double> out;
  for (std::size_t i = 0; i < 4; ++i) out.corner[i] = {c[2 * i], c[2 * i + 1]};
  return out;
}

tp::SE3d pose(Handle from, const char* name) {
  py::detail::make_caster<tp::SE3d> caster;
  if (!from.is_none() && caster.load(from, false)) return py::detail::cast_op<tp::SE3d&>(caster);
  const std::string what = "a textplane.SE3 or a matrix of shape (4, 4) or (3, 4)";
  if (from.is_none() || !py::isinstance<py::array>(from)) expected(name, what, from);
  const auto array = py::reinterpret_borrow<py::array>(from);
  if (array.ndim() != 2 || (array.shape(0) != 4 && array.shape(0) != 3) || array.shape(1) != 4)
    expected(name, what, from);
  const int rows = static_cast<int>(array.shape(0));
  double m[16] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
  read_numbers(from, name, rows, 4, m);
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    throw py::value_error(std::string(name) + ": expected the last row 0, 0, 0, 1");
  tp::SE3d T;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) T.R(r, c) = m[4 * r + c];
    T.t[r] = m[4 * r + 3];
  }
  const tp::Matrix3<double> gram = tp::transposed_product(T.R, T.R);
  const double det = T.R.col(0).dot(T.R.col(1).cross(T.R.col(2)));
  double off = det > 0 ? 0 : 1;
  for (int i = 0; i < 9; ++i) off = (std::max)(off, std::abs(gram.data()[i] - (i % 4 == 0 ? 1 : 0)));
  if (tp::all_finite(T.R) && off > 1e-4)  // what is not finite has a status
    throw py::value_error(std::string(name) + ": expected a rotation in the first three columns");
  return T;
}

template <class S>
Span<const S> span(Handle from, const char* name, int columns) {
  const std::string what = std::string("a C-contiguous array of ") + type_name<S>() + ", shape " +
                           (columns == 0 ? "(n,)" : "(n, " + std::to_string(columns) + ")");
  if (!is_array_of<S>(from)) expected(name, what, from);
  const auto array = py::reinterpret_borrow<py::array>(from);
  const auto size = static_cast<py::ssize_t>(sizeof(S));
  const bool shape = columns == 0 ? array.ndim() == 1 : array.ndim() == 2 && array.shape(1) == columns;
  if (!shape || !fits_int(array.shape(0))) expected(name, what, from);
  const bool row = columns == 0 || array.shape(0) == 0 || array.strides(1) == size;
  const bool rows = array.shape(0) < 2 || array.strides(0) == size * (columns == 0 ? 1 : columns);
  const bool aligned = reinterpret_cast<std::uintptr_t>(array.data()) % alignof(S) == 0;
  if (!row || !rows || !aligned) expected(name, what, from);
  return {static_cast<const S*>(array.data()), static_cast<int>(array.shape(0))};
}
template Span<const double> span<double>(Handle, const char*, int);
template Span<const float> span<float>(Handle, const char*, int);
template Span<const std::uint8_t> span<std::uint8_t>(Handle, const char*, int);

Span<const Vec3> points3(Handle from, const char* name) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double) && alignof(Vec3) == alignof(double), "rows of an array are points");
  const Span<const double> numbers = span<double>(from, name, 3);
  return {reinterpret_cast<const Vec3*>(numbers.data), numbers.n};
}

void same_length(int a, const char* name_a, int b, const char* name_b) {
  if (a == b) return;
  throw py::value_error(std::string(name_a) + " and " + name_b + ": expected one length, got " + std::to_string(a) +
                        " and " + std::to_string(b));
}

template <class T>
tp::ImageView<T> image(Handle from, const char* name) {
  using S = std::remove_const_t<T>;
  const std::string what = std::string("an image of ") + type_name<S>() +
                           ", shape (height, width), with the pixels of a row side by side and rows in order";
  if (!is_array_of<S>(from)) expected(name, what, from);
  const auto array = py::reinterpret_borrow<py::array>(from);
  if (array.ndim() != 2 || array.size() == 0 || !fits_int(array.shape(0)) || !fits_int(array.shape(1)))
    expected(name, what, from);
  const auto size = static_cast<py::ssize_t>(sizeof(S));
  const py::ssize_t height = array.shape(0), width = array.shape(1);
  const py::ssize_t stride = height > 1 ? array.strides(0) : width * size;
  const bool row = width == 1 || array.strides(1) == size;
  if (!row || stride < width * size || (height > 1 && width > 1 && !is_aligned(array, alignof(S))))
    expected(name, what, from);
  if (reinterpret_cast<std::uintptr_t>(array.data()) % alignof(S) != 0 ||
      stride % static_cast<py::ssize_t>(alignof(S)) != 0)
    expected(name, what, from);
  if constexpr (!std::is_const<T>::value) {
    if (!array.writeable()) throw py::value_error(std::string(name) + ": expected an array that may be written to");
  }
  auto* data = const_cast<S*>(static_cast<const S*>(array.data()));
  return {data, static_cast<int>(width), static_cast<int>(height), stride};
}
template tp::ImageView8 image<const std::uint8_t>(Handle, const char*);
template tp::ImageViewF image<const float>(Handle, const char*);
template tp::ImageView<std::uint8_t> image<std::uint8_t>(Handle, const char*);
template tp::ImageView<float> image<float>(Handle, const char*);

Levels::Levels(Handle from, const char* name) {
  py::detail::make_caster<tp::Pyramid> caster;
  if (!from.is_none() && caster.load(from, false)) {
    view_ = py::detail::cast_op<tp::Pyramid&>(caster).view();
    return;
  }
  if (!py::isinstance<py::array>(from)) expected(name, "a textplane.Pyramid or an image of uint8", from);
  own_.emplace(image<const std::uint8_t>(from, name));
  view_ = own_->view();
}

void fail(tp::Status status, const char* function, py::object result) {
  const py::object type = py::module_::import("textplane._core").attr("Failure");
  py::object error = type(std::string(function) + ": " + tp::to_string(status));
  error.attr("status") = status;
  error.attr("result") = std::move(result);
  PyErr_SetObject(type.ptr(), error.ptr());
  throw py::error_already_set();
}

std::string describe(Handle object) {
  const py::object type = py::type::of(object);
  std::string out = std::string(py::str(type.attr("__name__"))) + "(";
  bool first = true;
  for (const Handle c : py::reinterpret_steal<py::list>(PySequence_List(type.attr("__mro__").ptr()))) {
    for (const Handle item : py::reinterpret_steal<py::list>(PyMapping_Items(c.attr("__dict__").ptr()))) {
      const auto pair = py::reinterpret_borrow<py::tuple>(item);
      if (!PyObject_TypeCheck(pair[1].ptr(), &PyProperty_Type)) continue;
      const py::object value = object.attr(pair[0]);
      if (py::isinstance<py::array>(value)) continue;
      const bool is_enum = py::hasattr(value, "name") && py::hasattr(py::type::of(value), "__members__");
      out += (first ? "" : ", ") + std::string(py::str(pair[0])) + "=";
      out += is_enum ? std::string(py::str(value.attr("name"))) : std::string(py::repr(value));
      first = false;
    }
  }
  return out + ")";
}

}  // namespace binding
