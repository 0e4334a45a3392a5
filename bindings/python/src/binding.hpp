// What all bindings share: names, results as Python sees them, failures, and the interpreter's lock.
//
// A function takes its arguments as objects and reads them by arguments.hpp. So an exception says what was expected,
// and nothing is copied unasked. The first line of a docstring is the signature; a property's is "type: what"; of both
// make_stubs.py makes the type stubs.
#ifndef TEXTPLANE_PYTHON_BINDING_HPP
#define TEXTPLANE_PYTHON_BINDING_HPP

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <type_traits>
#include <utility>

#include "textplane/core/se3.hpp"
#include "textplane/core/status.hpp"
#include "textplane/geometry/quad.hpp"

namespace binding {

namespace py = pybind11;
namespace tp = textplane;
using Handle = py::handle;
using Vec2 = tp::Vector2<double>;
using Vec3 = tp::Vector3<double>;

/// f() without the interpreter's lock. It must not touch Python.
template <class F>
auto unlocked(F f) {
  const py::gil_scoped_release release;
  return f();
}

/// A copy as an array: (n,) for a vector, (rows, columns) for a matrix.
template <class S, int Rows, int Columns, int Options, int MaxRows, int MaxColumns>
py::object to_python(const Eigen::Matrix<S, Rows, Columns, Options, MaxRows, MaxColumns>& m) {
  if constexpr (Columns == 1) {
    py::array_t<S> out(m.rows());
    S* p = out.mutable_data();
    for (Eigen::Index i = 0; i < m.rows(); ++i) p[i] = m[i];
    return std::move(out);
  } else {
    py::array_t<S> out({m.rows(), m.cols()});
    S* p = out.mutable_data();
    for (Eigen::Index r = 0; r < m.rows(); ++r)
      for (Eigen::Index c = 0; c < m.cols(); ++c) *p++ = m(r, c);
    return std::move(out);
  }
}
/// The corners, (4, 2).
inline py::object to_python(const tp::Quad<double>& quad) {
  py::array_t<double> out({4, 2});
  double* p = out.mutable_data();
  for (const Vec2& corner : quad.corner)
    for (const int i : {0, 1}) *p++ = corner[i];
  return std::move(out);
}
template <class T>
py::object to_python(const T& value) {
  if constexpr (std::is_base_of<py::object, T>::value) {
    return value;
  } else {
    return py::cast(value);
  }
}

/// An array of n numbers that `owner` keeps alive; read only.
template <class S>
py::array_t<S> borrowed(const S* data, std::size_t n, Handle owner) {
  py::array_t<S> out(static_cast<py::ssize_t>(n), data, owner);
  out.attr("flags").attr("writeable") = false;
  return out;
}

/// A read-only property of a result.
template <class C, class... Extra, class M, class Base>
void field(py::class_<C, Extra...>& c, const char* name, M Base::*member, const char* doc) {
  c.def_property_readonly(
      name, [member](const C& self) { return to_python(self.*member); }, doc);
}

/// Raises textplane.Failure, which carries status and result.
[[noreturn]] void fail(tp::Status status, const char* function, py::object result);

/// The result as Python has it. Where `raise_on_failure`, a status that is no success raises.
template <class R>
py::object finish(R&& result, tp::Status status, bool raise_on_failure, const char* function) {
  py::object object = py::cast(std::forward<R>(result));
  if (raise_on_failure && !tp::is_ok(status)) fail(status, function, std::move(object));
  return object;
}
template <class R>
py::object finish(R&& result, bool raise_on_failure, const char* function) {
  const tp::Status status = result.status;
  return finish(std::forward<R>(result), status, raise_on_failure, function);
}

/// "Name(a=1, b=2)" of these attributes, arrays left out.
std::string describe(Handle object);
/// Gives a class of results `ok` and a repr().
template <class C, class... Extra>
void result_class(py::class_<C, Extra...>& c) {
  field(c, "status", &C::status, "Status: Why it ended.");
  c.def_property_readonly(
      "ok", [](const C& self) { return tp::is_ok(self.status); }, "bool: Whether the result can be used.");
  c.def(
      "__repr__", [](Handle self) { return describe(self); }, "__repr__() -> str\n\nIts numbers.");
}

/// A class of options: made with keywords, which set its attributes.
template <class C>
py::class_<C> options_class(py::module_& m, const char* name, const char* doc) {
  py::class_<C> c(m, name, doc);
  c.def(py::init([name](const py::kwargs& settings) {
          py::object made = py::cast(C());
          for (const auto& [key, value] : settings) {
            if (!py::hasattr(made, key))
              throw py::type_error(std::string(name) + " has no option " + std::string(py::str(key)));
            made.attr(key) = value;
          }
          return made.cast<C>();
        }),
        "__init__(**settings: Any) -> None\n\nThe defaults, but for these settings.");
  c.def(
      "__repr__", [](Handle self) { return describe(self); }, "__repr__() -> str\n\nIts settings.");
  return c;
}
template <class C, class M, class Base>
void option(py::class_<C>& c, const char* name, M Base::*member, const char* doc) {
  c.def_property(
      name, [member](const C& self) { return self.*member; },
      [member](C& self, const M& value) { self.*member = value; }, doc);
}

}  // namespace binding

#endif  // TEXTPLANE_PYTHON_BINDING_HPP
