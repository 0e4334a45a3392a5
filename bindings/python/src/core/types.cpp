// Status, Failure, SE3.
#include "core/core.hpp"
#include "textplane/photometry/residual_result.hpp"

namespace binding {
namespace of_types {

void bind_status(py::module_& m) {
  py::enum_<tp::Status>(m, "Status",
                        "Outcome of a kernel or a solve. ok, converged and iteration_limit come with a usable result.")
      .value("ok", tp::Status::ok)
      .value("converged", tp::Status::converged)
      .value("iteration_limit", tp::Status::iteration_limit)
      .value("too_few", tp::Status::too_few)
      .value("no_contrast", tp::Status::no_contrast)
      .value("behind_camera", tp::Status::behind_camera)
      .value("out_of_view", tp::Status::out_of_view)
      .value("rank_deficient", tp::Status::rank_deficient)
      .value("degenerate", tp::Status::degenerate)
      .value("non_finite", tp::Status::non_finite)
      .value("invalid_argument", tp::Status::invalid_argument)
      .value("diverged", tp::Status::diverged)
      .value("unsupported", tp::Status::unsupported);
  m.def(
      "is_ok", [](tp::Status status) { return tp::is_ok(status); }, py::arg("status"),
      "is_ok(status: Status) -> bool\n\nWhether the result that comes with this status can be used.");
  py::enum_<tp::Path>(m, "Path", "What computed a result.")
      .value("kernel", tp::Path::kernel)
      .value("reference", tp::Path::reference);

  const py::object failure = py::reinterpret_steal<py::object>(
      PyErr_NewExceptionWithDoc("textplane._core.Failure",
                                "A status that is no success, where raise_on_failure was asked for. It has the status, "
                                "and the result as it would have been returned.",
                                PyExc_RuntimeError, nullptr));
  m.attr("Failure") = failure;
}

py::array_t<double> matrix_of(const tp::SE3d& T) {
  py::array_t<double> out({4, 4});
  double* p = out.mutable_data();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) *p++ = T.R(r, c);
    *p++ = T.t[r];
  }
  for (int c = 0; c < 4; ++c) *p++ = c == 3;
  return out;
}

tp::SE3d made(Handle R, Handle t) {
  if (R.is_none() && t.is_none()) return {};
  if (t.is_none()) return pose(R, "matrix");
  tp::SE3d T;
  if (!R.is_none()) {
    py::array_t<double> both({3, 4});
    const tp::Matrix3<double> rotation = matrix3(R, "R");
    const Vec3 translation = vector<3>(t, "t");
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) both.mutable_at(r, c) = c < 3 ? rotation(r, c) : translation[r];
    return pose(both, "R");
  }
  T.t = vector<3>(t, "t");
  return T;
}

py::object product(const tp::SE3d& T, Handle right) {
  if (py::isinstance<tp::SE3d>(right)) return py::cast(T * right.cast<tp::SE3d>());
  if (py::isinstance<py::array>(right) && py::reinterpret_borrow<py::array>(right).ndim() == 2) {
    const Span<const Vec3> points = points3(right, "points");
    py::array_t<double> out({static_cast<py::ssize_t>(points.n), py::ssize_t{3}});
    double* p = out.mutable_data();
    for (int i = 0; i < points.n; ++i) {
      const Vec3 moved = T * points.data[i];
      for (const int k : {0, 1, 2}) *p++ = moved[k];
    }
    return std::move(out);
  }
  return to_python(Vec3(T * vector<3>(right, "point")));
}

void bind_pose_type(py::module_& m) {
  py::class_<tp::SE3d> c(
      m, "SE3",
      "A rigid motion p -> R p + t. T_a_b maps points of frame b to frame a; a perturbation xi = (v, "
      "omega), translation first, acts from the left: T <- exp(xi) T. Where a pose is asked for, a "
      "matrix (4, 4) or (3, 4) will do.");
  c.def(
      py::init(&made), py::arg("R") = py::none(), py::arg("t") = py::none(),
      "__init__(R: Numbers | None = None, t: Numbers | None = None) -> None\n\nOf R (3, 3) and t (3,), of a matrix (4, "
      "4) alone, or the identity.");
  field(c, "R", &tp::SE3d::R, "Array: Rotation, (3, 3).");
  field(c, "t", &tp::SE3d::t, "Array: Translation, (3,), in the unit of the map.");
  c.def("matrix", &matrix_of, "matrix() -> Array\n\nAs a matrix, (4, 4).");
  c.def(
      "inverse", [](const tp::SE3d& T) { return T.inverse(); }, "inverse() -> SE3\n\nThe way back.");
  c.def(
      "log", [](const tp::SE3d& T) { return to_python(tp::se3_log(T)); },
      "log() -> Array\n\nThe twist (v, omega), (6,), omega in rad, with SE3.exp(xi) = T.");
  c.def_static(
      "exp", [](py::object xi) { return tp::se3_exp<double>(vector<6>(xi, "xi")); }, py::arg("xi"),
      "exp(xi: Numbers) -> SE3\n\nOf the twist xi = (v, omega), (6,), omega in rad.");
  c.def(
      "adjoint", [](const tp::SE3d& T) { return to_python(tp::adjoint(T)); },
      "adjoint() -> Array\n\nAd with T exp(xi) = exp(Ad xi) T, (6, 6).");
  c.def("__matmul__", &product, py::arg("right"),
        "__matmul__(right: Any) -> Any\n\nFirst `right`, an SE3, then this; or the moved points, (3,) or (n, 3).");
  c.def(
      "__repr__", [](const tp::SE3d& T) { return "SE3(" + std::string(py::repr(matrix_of(T).attr("tolist")())) + ")"; },
      "__repr__() -> str\n\nIts numbers.");
  c.def(py::pickle([](const tp::SE3d& T) { return py::make_tuple(to_python(T.R), to_python(T.t)); },
                   [](const py::tuple& state) {
                     if (state.size() != 2) throw py::value_error("state: expected R and t");
                     tp::SE3d T;
                     T.R = matrix3(state[0], "R");
                     T.t = vector<3>(state[1], "t");
                     return T;
                   }));
}

void bind(py::module_& m) {
  bind_status(m);
  bind_pose_type(m);
}

}  // namespace of_types
}  // namespace binding
