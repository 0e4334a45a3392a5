// Plane solvers: theta of a text object from targets of known poses.
#include <vector>

#include "core/core.hpp"
#include "textplane/solver/plane.hpp"

namespace binding {
namespace of_plane_solver {

// The targets, and the pyramids that they refer to.
struct Targets {
  std::vector<py::object> pyramids;
  std::vector<tp::PlaneTarget> targets;
};

Targets targets_of(const py::object& from) {
  const char* what = "a sequence of pairs (Pyramid, T_t_h)";
  if (!PySequence_Check(from.ptr())) expected("targets", what, from);
  Targets out;
  for (const py::object item : py::reinterpret_borrow<py::sequence>(from)) {
    if (!py::isinstance<py::tuple>(item) || py::len(item) != 2) expected("targets", what, item);
    const auto pair = py::reinterpret_borrow<py::tuple>(item);
    tp::PlaneTarget target;
    target.image = object<tp::Pyramid>(pair[0], "targets", what).view();
    target.T_t_h = pose(pair[1], "targets: T_t_h");
    out.targets.push_back(target);
    out.pyramids.push_back(pair[0]);
  }
  return out;
}

py::object refine(const py::object& patch, const py::object& theta, const py::object& targets,
                  const py::object& target_camera, const py::object& settings, bool raise) {
  const auto& from = object<const tp::TextPatch>(patch, "patch", "a textplane.TextPatch");
  const Vec3 plane = vector<3>(theta, "theta");
  const Targets to = targets_of(targets);
  const tp::CameraView view = camera(target_camera);
  const auto chosen = options<tp::PlaneOptions>(settings, "options", "a textplane.PlaneOptions");
  const int count = static_cast<int>(to.targets.size());
  return finish(unlocked([&] {
                  static thread_local tp::PlaneWorkspace workspace;
                  workspace.reserve(from, count);
                  return tp::refine_plane(from, plane, to.targets.data(), count, view, chosen, workspace);
                }),
                raise, "refine_plane");
}

py::object align(const py::object& patch, const py::object& theta, const py::object& T_t_h, const py::object& target,
                 const py::object& target_camera, const py::object& settings, bool raise) {
  const auto& from = object<const tp::TextPatch>(patch, "patch", "a textplane.TextPatch");
  const Vec3 plane = vector<3>(theta, "theta");
  const tp::SE3d T = pose(T_t_h, "T_t_h");
  const Levels pyramid(target, "target");
  const tp::CameraView view = camera(target_camera);
  const auto chosen = options<tp::PlaneOptions>(settings, "options", "a textplane.PlaneOptions");
  return finish(unlocked([&] { return tp::align_plane(from, plane, T, pyramid.view(), view, chosen); }), raise,
                "align_plane");
}

void bind(py::module_& m) {
  using namespace py::literals;
  using O = tp::PlaneOptions;
  auto o = options_class<O>(m, "PlaneOptions", "Settings of refine_plane() and align_plane().");
  option(o, "photometric", &O::photometric, "PhotometricOptions: Of every pixel.");
  option(o, "solve", &O::solve, "SolveOptions: Of the finest level.");
  option(o, "coarsest_level", &O::coarsest_level, "int: First pyramid level.");
  option(o, "finest_level", &O::finest_level, "int: Last pyramid level.");

  using R = tp::PlaneRefinement;
  py::class_<R> c(m, "PlaneRefinement", "What refine_plane() found.");
  field(c, "theta", &R::theta, "Array: The plane in the host frame, (3,).");
  field(c, "covariance", &R::covariance, "Array: Of theta, (3, 3).");
  field(c, "information", &R::information, "Array: Its inverse, (3, 3).");
  field(c, "residual_variance", &R::residual_variance, "float: Of a pixel, on patches of unit variance.");
  field(c, "cost", &R::cost, "float: At theta.");
  field(c, "zncc", &R::zncc, "float: Mean over the targets used.");
  field(c, "targets_used", &R::targets_used, "int: Targets that took part.");
  field(c, "visible_pixels", &R::visible_pixels, "int: Over the targets used.");
  field(c, "iterations", &R::iterations, "int: Trials over all levels.");
  field(c, "path", &R::path, "Path: What computed it.");
  result_class(c);

  m.def("refine_plane", &refine, "patch"_a, "theta"_a, "targets"_a, "camera"_a, "options"_a = py::none(),
        "raise_on_failure"_a = false,
        "refine_plane(patch: TextPatch, theta: Numbers, targets: Sequence[tuple[Pyramid, Pose]], camera: Camera, "
        "options: "
        "PlaneOptions | None = None, raise_on_failure: bool = False) -> PlaneRefinement\n\ntheta (3,) of a text object "
        "from targets of known poses T_t_h, host to target, coarse to fine.");
  m.def("align_plane", &align, "patch"_a, "theta"_a, "T_t_h"_a, "target"_a, "camera"_a, "options"_a = py::none(),
        "raise_on_failure"_a = false,
        "align_plane(patch: TextPatch, theta: Numbers, T_t_h: Pose, target: Pyramid | Array, camera: Camera, options: "
        "PlaneOptions | None = None, raise_on_failure: bool = False) -> PlaneRefinement\n\nThe same with one target.");
}

}  // namespace of_plane_solver
}  // namespace binding
