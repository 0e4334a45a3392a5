// The photometric residual and its normal equations, for one's own solver.
#include "core/core.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/photometry/residual_policy.hpp"

namespace binding {
namespace of_residuals {

using Request = tp::ResidualRequest<std::uint8_t>;
using P = tp::Parameters;

// A request, and what it refers to.
struct Asked {
  Asked(const py::object& patch, const py::object& theta, const py::object& T_t_h, const py::object& image_or_pyramid,
        const py::object& target_camera, int level, int scale_shift, const py::object& settings)
      : from(object<const tp::TextPatch>(patch, "patch", "a textplane.TextPatch")),
        pyramid(image_or_pyramid, "target") {
    request.input = tp::photometric_input(from, level, pyramid.view(), camera(target_camera), scale_shift);
    request.theta = vector<3>(theta, "theta");
    request.T_t_h = pose(T_t_h, "T_t_h");
    request.options = options<tp::PhotometricOptions>(settings, "options", "a textplane.PhotometricOptions");
  }

  const tp::TextPatch& from;
  Levels pyramid;
  Request request;
};

tp::PhotometricWorkspace& workspace_of(const tp::TextPatch& patch) {
  static thread_local tp::PhotometricWorkspace workspace;
  workspace.reserve(patch.max_pixels());
  return workspace;
}

template <P Unknowns>
py::object linearise(const py::object& patch, const py::object& theta, const py::object& T_t_h,
                     const py::object& target, const py::object& target_camera, int level, int scale_shift,
                     const py::object& settings, tp::LinearisePolicy policy, bool raise) {
  const Asked asked(patch, theta, T_t_h, target, target_camera, level, scale_shift, settings);
  return finish(unlocked([&] {
                  tp::PhotometricWorkspace& workspace = workspace_of(asked.from);
                  return policy == tp::LinearisePolicy::forward
                             ? tp::linearise<Unknowns>(asked.request, workspace)
                             : tp::linearise<Unknowns>(asked.request.by(policy), workspace);
                }),
                raise, "linearise");
}

py::object linearise_world(const py::object& patch, const py::object& theta, const py::object& T_w_h,
                           const py::object& T_w_t, const py::object& target, const py::object& target_camera,
                           bool right, int level, int scale_shift, const py::object& settings, bool raise) {
  const tp::SE3d host = pose(T_w_h, "T_w_h"), seen = pose(T_w_t, "T_w_t");
  Asked asked(patch, theta, py::cast(tp::SE3d()), target, target_camera, level, scale_shift, settings);
  const auto side = right ? tp::PerturbationSide::right : tp::PerturbationSide::left;
  asked.request = tp::world_request(asked.request.input, asked.request.theta, host, seen, side, asked.request.options);
  return finish(unlocked([&] { return tp::linearise<P::host_target_plane>(asked.request, workspace_of(asked.from)); }),
                raise, "linearise_host_target_plane");
}

py::object evaluate(const py::object& patch, const py::object& theta, const py::object& T_t_h, const py::object& target,
                    const py::object& target_camera, int level, int scale_shift, const py::object& settings,
                    bool raise) {
  const Asked asked(patch, theta, T_t_h, target, target_camera, level, scale_shift, settings);
  return finish(unlocked([&] { return tp::evaluate(asked.request, workspace_of(asked.from)); }), raise, "evaluate");
}

struct Residuals : tp::ResidualSummary {
  py::array_t<double> r, J;
  py::array_t<std::uint8_t> mask;
};

py::object residuals(const py::object& patch, const py::object& theta, const py::object& T_t_h,
                     const py::object& target, const py::object& target_camera, int level, int scale_shift,
                     const py::object& settings, bool raise) {
  const Asked asked(patch, theta, T_t_h, target, target_camera, level, scale_shift, settings);
  const py::ssize_t n = asked.request.input.patch.n;
  Residuals out;
  out.r = py::array_t<double>(n);
  out.J = py::array_t<double>({n, py::ssize_t{9}});
  out.mask = py::array_t<std::uint8_t>(n);
  double *r = out.r.mutable_data(), *J = out.J.mutable_data();
  std::uint8_t* mask = out.mask.mutable_data();
  static_cast<tp::ResidualSummary&>(out) = unlocked([&] {
    tp::PhotometricWorkspace& workspace = workspace_of(asked.from);
    const auto summary = tp::reference::residuals<P::pose_plane>(asked.request, workspace, r, J);
    for (py::ssize_t i = 0; i < n; ++i) mask[i] = tp::is_ok(summary.status) ? workspace.visible()[i] : 0;
    return summary;
  });
  return finish(std::move(out), raise, "residuals");
}

template <int N>
void bind_equations(py::module_& m, const char* name, const char* doc, const std::string& shape) {
  using E = tp::NormalEquations<N>;
  using S = tp::ResidualStats;
  py::class_<E> c(m, name, doc);
  field(c, "H", &E::H, ("Array: J^T W J, (" + shape + ", " + shape + ").").c_str());
  field(c, "b", &E::b, ("Array: J^T W r, (" + shape + ",); the Gauss-Newton step is -H^-1 b.").c_str());
  field(c, "cost", &S::cost, "float: Sum of rho(N r^2) / N.");
  field(c, "error", &S::error, "float: E = sum of r^2, in [0, 4].");
  field(c, "zncc", &S::zncc, "float: 1 - E / 2.");
  field(c, "visible", &S::visible, "int: N, the visible pixels.");
  field(c, "mean", &S::mean, "float: Of the target's intensities there.");
  field(c, "s", &S::s, "float: Norm of these less their mean.");
  field(c, "path", &S::path, "Path: What computed it.");
  result_class(c);
}

void bind_result_types(py::module_& m) {
  bind_equations<6>(m, "PoseEquations", "Normal equations by (v, omega): T_t_h <- exp(xi) T_t_h.", "6");
  bind_equations<3>(m, "PlaneEquations", "Normal equations by theta.", "3");
  bind_equations<9>(m, "PosePlaneEquations", "Normal equations by (v, omega, theta).", "9");
  bind_equations<15>(m, "WorldEquations",
                     "Normal equations by (xi_host, xi_target, theta), xi = (v, omega) of a world pose.", "15");
  using C = tp::PhotometricCost;
  py::class_<C> cost(m, "PhotometricCost", "Value of the photometric cost.");
  field(cost, "cost", &C::cost, "float: Sum of rho(N r^2) / N.");
  field(cost, "error", &C::error, "float: E = sum of r^2, in [0, 4].");
  field(cost, "zncc", &C::zncc, "float: 1 - E / 2.");
  field(cost, "visible", &C::visible, "int: N, the visible pixels.");
  field(cost, "path", &C::path, "Path: What computed it.");
  result_class(cost);
  py::class_<Residuals> r(m, "Residuals", "Residuals without weights, in double.");
  field(r, "r", &Residuals::r, "Array: Of each pixel, (n,); 0 where it is not visible.");
  field(r, "J", &Residuals::J, "Array: Their derivatives by (v, omega, theta), (n, 9).");
  field(r, "mask", &Residuals::mask, "Array: 1 where the pixel is visible, uint8 (n,).");
  field(r, "visible", &tp::ResidualSummary::visible, "int: N, the visible pixels.");
  field(r, "mean", &tp::ResidualSummary::mean, "float: Of the target's intensities there.");
  field(r, "s", &tp::ResidualSummary::s, "float: Norm of these less their mean.");
  result_class(r);
}

template <P Unknowns>
void bind_linearise(py::module_& m, const char* name, const char* result) {
  using namespace py::literals;
  const std::string doc =
      std::string(name) +
      "(patch: TextPatch, theta: Numbers, T_t_h: Pose, target: Pyramid | Array, camera: Camera, level: int = 0, "
      "scale_shift: int = 0, options: PhotometricOptions | None = None, policy: LinearisePolicy = ..., "
      "raise_on_failure: "
      "bool = False) -> " +
      result +
      "\n\nNormal equations of the residual on a pyramid level; theta (3,), host frame; T_t_h: host to target; camera: "
      "of "
      "level 0.";
  m.def(name, &linearise<Unknowns>, "patch"_a, "theta"_a, "T_t_h"_a, "target"_a, "camera"_a, "level"_a = 0,
        "scale_shift"_a = 0, "options"_a = py::none(), "policy"_a = tp::LinearisePolicy::forward,
        "raise_on_failure"_a = false, doc.c_str());
}

void bind(py::module_& m) {
  using namespace py::literals;
  bind_result_types(m);
  bind_linearise<P::pose>(m, "linearise_pose", "PoseEquations");
  bind_linearise<P::plane>(m, "linearise_plane", "PlaneEquations");
  bind_linearise<P::pose_plane>(m, "linearise_pose_plane", "PosePlaneEquations");
  m.def(
      "linearise_host_target_plane", &linearise_world, "patch"_a, "theta"_a, "T_w_h"_a, "T_w_t"_a, "target"_a,
      "camera"_a, "right"_a = true, "level"_a = 0, "scale_shift"_a = 0, "options"_a = py::none(),
      "raise_on_failure"_a = false,
      "linearise_host_target_plane(patch: TextPatch, theta: Numbers, T_w_h: Pose, T_w_t: Pose, target: Pyramid | "
      "Array, "
      "camera: Camera, right: bool = True, level: int = 0, scale_shift: int = 0, options: PhotometricOptions | None = "
      "None, raise_on_failure: bool = False) -> WorldEquations\n\nThe same by both world poses (camera to world) and "
      "theta. right: T <- T exp(xi), else T <- exp(xi) T.");
  m.def("evaluate", &evaluate, "patch"_a, "theta"_a, "T_t_h"_a, "target"_a, "camera"_a, "level"_a = 0,
        "scale_shift"_a = 0, "options"_a = py::none(), "raise_on_failure"_a = false,
        "evaluate(patch: TextPatch, theta: Numbers, T_t_h: Pose, target: Pyramid | Array, camera: Camera, level: int = "
        "0, "
        "scale_shift: int = 0, options: PhotometricOptions | None = None, raise_on_failure: bool = False) -> "
        "PhotometricCost\n\nThe cost alone.");
  m.def(
      "residuals", &residuals, "patch"_a, "theta"_a, "T_t_h"_a, "target"_a, "camera"_a, "level"_a = 0,
      "scale_shift"_a = 0, "options"_a = py::none(), "raise_on_failure"_a = false,
      "residuals(patch: TextPatch, theta: Numbers, T_t_h: Pose, target: Pyramid | Array, camera: Camera, level: int = "
      "0, "
      "scale_shift: int = 0, options: PhotometricOptions | None = None, raise_on_failure: bool = False) -> "
      "Residuals\n\nThe residuals themselves and their derivatives by (v, omega, theta), for solvers such as SciPy's.");
}

}  // namespace of_residuals
}  // namespace binding
