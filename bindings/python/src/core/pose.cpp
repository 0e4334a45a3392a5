// Pose solvers: align_pose() for one object, refine_pose() for texts and points, and the search for a first guess.
#include <vector>

#include "core/core.hpp"
#include "textplane/photometry/candidates.hpp"
#include "textplane/solver/pose.hpp"
#include "textplane/solver/search.hpp"

namespace binding {
namespace of_pose {

// A term and the patch that it refers to.
struct Text {
  py::object patch;
  tp::PoseTextTerm term;
};

// What refine_pose() found, with its numbers a term.
struct Refined : tp::PoseFit {
  py::array_t<float> text_zncc, point_chi2;
};

struct Found {
  tp::SE3d T_t_h;
  float zncc = -1;
};

template <class C>
void bind_pose_result(py::class_<C>& c) {
  using R = tp::PoseResult;
  field(c, "information", &R::information,
        "Array: Of xi = (v, omega), left, (6, 6); its inverse is the covariance under Weighting.variance.");
  field(c, "cost", &R::cost, "float: Of the finest level.");
  field(c, "zncc", &R::zncc, "float: Mean over the texts that took part.");
  field(c, "texts", &R::texts, "int: Texts that took part.");
  field(c, "visible_pixels", &R::visible_pixels, "int: Of these texts.");
  field(c, "inlier_points", &R::inlier_points, "int: Points within the 95 % bound of chi-square.");
  field(c, "iterations", &R::iterations, "int: Trials over all levels.");
  field(c, "path", &R::path, "Path: What computed it.");
  result_class(c);
}

void bind_types_of_pose(py::module_& m) {
  using O = tp::PoseOptions;
  auto o = options_class<O>(m, "PoseOptions", "Settings of align_pose() and refine_pose().");
  option(o, "photometric", &O::photometric, "PhotometricOptions: Of every pixel of the texts.");
  option(o, "weighting", &O::weighting, "Weighting: How texts weigh against points.");
  option(o, "sigma_photo", &O::sigma_photo, "float: Of a pixel's residual, in units of 1/sqrt(N).");
  option(o, "sigma_rep", &O::sigma_rep, "float: px, of a point with sigma 1.");
  option(o, "point_robust", &O::point_robust, "Robust: On |e| / sigma.");
  option(o, "solve", &O::solve, "SolveOptions: Of the finest level.");
  option(o, "coarsest_level", &O::coarsest_level, "int: First pyramid level.");
  option(o, "finest_level", &O::finest_level, "int: Last pyramid level; 0 is the image itself.");
  option(o, "policy", &O::policy, "LinearisePolicy: Whose gradients linearise the texts.");
  option(o, "min_zncc", &O::min_zncc, "float: A smaller ZNCC is Status.diverged; align_pose() only.");

  py::class_<tp::PoseAlignment> alignment(m, "PoseAlignment", "What align_pose() found.");
  field(alignment, "T_t_h", &tp::PoseAlignment::T_t_h, "SE3: Host to target.");
  field(alignment, "scale_shift", &tp::PoseAlignment::scale_shift, "int: Pyramid levels between host and target.");
  bind_pose_result(alignment);

  py::class_<Refined> refined(m, "PoseFit", "What refine_pose() found.");
  field(refined, "T_t_w", &Refined::T_t_w, "SE3: World to target.");
  field(refined, "text_zncc", &Refined::text_zncc, "Array: Of each text, float32 (n,); -1: it took no part.");
  field(refined, "point_chi2", &Refined::point_chi2, "Array: Of each point, float32 (n,); -1: it took no part.");
  bind_pose_result(refined);

  py::class_<Found> found(m, "PoseSearch", "What search_pose() found.");
  field(found, "T_t_h", &Found::T_t_h, "SE3: Host to target.");
  field(found, "zncc", &Found::zncc, "float: Of that pose; -1 where nothing could be compared.");
}

Text make_text(const py::object& patch, const py::object& theta, const py::object& T_w_h, double weight,
               int scale_shift) {
  Text text;
  text.patch = patch;
  text.term.patch = &object<const tp::TextPatch>(patch, "patch", "a textplane.TextPatch");
  text.term.theta = vector<3>(theta, "theta");
  text.term.T_w_h = pose(T_w_h, "T_w_h");
  text.term.weight = weight;
  text.term.scale_shift = scale_shift;
  return text;
}

py::object align(const py::object& patch, const py::object& theta, const py::object& T_t_h, const py::object& target,
                 const py::object& target_camera, const py::object& settings, bool raise) {
  const auto& from = object<const tp::TextPatch>(patch, "patch", "a textplane.TextPatch");
  const Vec3 plane = vector<3>(theta, "theta");
  const tp::SE3d guess = pose(T_t_h, "T_t_h");
  const Levels pyramid(target, "target");
  const tp::CameraView view = camera(target_camera);
  const auto chosen = options<tp::PoseOptions>(settings, "options", "a textplane.PoseOptions");
  return finish(unlocked([&] { return tp::align_pose(from, plane, guess, pyramid.view(), view, chosen); }), raise,
                "align_pose");
}

std::vector<tp::PosePointTerm> point_terms(const py::object& points, const py::object& pixels,
                                           const py::object& sigma) {
  std::vector<tp::PosePointTerm> out;
  if (points.is_none() && pixels.is_none()) return out;
  const auto p = points3(points, "points");
  const auto px = span<double>(pixels, "pixels", 2);
  same_length(p.n, "points", px.n, "pixels");
  Span<const double> sigmas;
  if (!sigma.is_none()) {
    sigmas = span<double>(sigma, "sigma", 0);
    same_length(p.n, "points", sigmas.n, "sigma");
  }
  out.resize(static_cast<std::size_t>(p.n));
  for (int i = 0; i < p.n; ++i) {
    tp::PosePointTerm& term = out[static_cast<std::size_t>(i)];
    term.p_w = p.data[i];
    term.px = {px.data[2 * i], px.data[2 * i + 1]};
    if (sigmas.data) term.sigma = sigmas.data[i];
  }
  return out;
}

py::object refine(const py::object& texts, const py::object& target, const py::object& target_camera,
                  const py::object& T_t_w, const py::object& points, const py::object& pixels, const py::object& sigma,
                  const py::object& settings, bool raise) {
  if (!PySequence_Check(texts.ptr())) expected("texts", "a sequence of textplane.PoseText", texts);
  std::vector<tp::PoseTextTerm> terms;
  std::vector<py::object> patches;  // kept while the lock is away
  for (const py::object text : py::reinterpret_borrow<py::sequence>(texts)) {
    const Text& one = object<Text>(text, "texts", "a sequence of textplane.PoseText");
    terms.push_back(one.term);
    patches.push_back(one.patch);
  }
  const Levels pyramid(target, "target");
  const tp::CameraView view = camera(target_camera);
  const tp::SE3d guess = pose(T_t_w, "T_t_w");
  const auto point = point_terms(points, pixels, sigma);
  const auto chosen = options<tp::PoseOptions>(settings, "options", "a textplane.PoseOptions");
  const int text_count = static_cast<int>(terms.size()), point_count = static_cast<int>(point.size());
  Refined out;
  out.text_zncc = py::array_t<float>(text_count);
  out.point_chi2 = py::array_t<float>(point_count);
  float *zncc = out.text_zncc.mutable_data(), *chi2 = out.point_chi2.mutable_data();
  static_cast<tp::PoseFit&>(out) = unlocked([&] {
    static thread_local tp::PoseWorkspace workspace;
    workspace.reserve(terms.data(), text_count, point_count);
    return tp::refine_pose(terms.data(), text_count, point.data(), point_count, pyramid.view(), view, guess, chosen,
                           workspace, zncc, chi2);
  });
  return finish(std::move(out), raise, "refine_pose");
}

py::object search(const py::object& patch, const py::object& theta, const py::object& T_t_h, const py::object& target,
                  const py::object& target_camera, const py::object& settings) {
  const auto& from = object<const tp::TextPatch>(patch, "patch", "a textplane.TextPatch");
  const Vec3 plane = vector<3>(theta, "theta");
  const tp::SE3d guess = pose(T_t_h, "T_t_h");
  const Levels pyramid(target, "target");
  const tp::CameraView view = camera(target_camera);
  const auto chosen = options<tp::SearchOptions>(settings, "options", "a textplane.SearchOptions");
  return py::cast(unlocked([&] {
    static thread_local tp::PhotometricWorkspace workspace;
    workspace.reserve(from.max_pixels());
    Found found;
    found.T_t_h = tp::search_pose(from, plane, guess, pyramid.view(), view, chosen, workspace, nullptr, &found.zncc);
    return found;
  }));
}

py::object candidates(const py::object& patch, const py::object& theta, const py::object& T_t_h,
                      const py::object& target, const py::object& target_camera, int level,
                      const py::object& settings) {
  const auto& from = object<const tp::TextPatch>(patch, "patch", "a textplane.TextPatch");
  const Vec3 plane = vector<3>(theta, "theta");
  if (!PySequence_Check(T_t_h.ptr())) expected("T_t_h", "a sequence of poses", T_t_h);
  std::vector<tp::SE3d> poses;
  for (const py::object T : py::reinterpret_borrow<py::sequence>(T_t_h)) poses.push_back(pose(T, "T_t_h"));
  const Levels pyramid(target, "target");
  const tp::CameraView view = camera(target_camera);
  const auto chosen = options<tp::PhotometricOptions>(settings, "options", "a textplane.PhotometricOptions");
  py::array_t<float> out(static_cast<py::ssize_t>(poses.size()));
  float* zncc = out.mutable_data();
  const tp::Status status = unlocked([&] {
    static thread_local tp::PhotometricWorkspace workspace;
    workspace.reserve(from.max_pixels());
    const tp::PhotometricInput in = tp::photometric_input(from, level, pyramid.view(), view);
    tp::TemplatePatch prepared;
    if (in.patch.n > 0) prepared.prepare(in.patch);
    return tp::zncc_candidates(in, plane, poses.data(), static_cast<int>(poses.size()), chosen, workspace, zncc,
                               &prepared);
  });
  return py::make_tuple(std::move(out), status);
}

void bind(py::module_& m) {
  using namespace py::literals;
  bind_types_of_pose(m);
  py::class_<Text> text(m, "PoseText", "A text object whose host pose and plane refine_pose() holds.");
  text.def(
      py::init(&make_text), "patch"_a, "theta"_a, "T_w_h"_a = tp::SE3d(), "weight"_a = 1.0, "scale_shift"_a = 0,
      "__init__(patch: TextPatch, theta: Numbers, T_w_h: Pose = ..., weight: float = 1.0, scale_shift: int = 0) -> "
      "None\n\ntheta: plane in the host frame, (3,); T_w_h: host to world; scale_shift: pyramid levels between host "
      "and target.");
  text.def_property_readonly(
      "patch", [](const Text& self) { return self.patch; }, "TextPatch: Its pixels in the host.");

  auto s = options_class<tp::SearchOptions>(m, "SearchOptions", "Range of search_pose(), in px of its level.");
  option(s, "level", &tp::SearchOptions::level, "int: Pyramid level.");
  option(s, "radius", &tp::SearchOptions::radius, "int: Shifts to each side, at most 8.");
  option(s, "step", &tp::SearchOptions::step, "float: px between shifts.");
  option(s, "roll", &tp::SearchOptions::roll, "float: rad, to each side; 0: none.");
  option(s, "photometric", &tp::SearchOptions::photometric, "PhotometricOptions: Of every pixel.");

  m.def(
      "align_pose", &align, "patch"_a, "theta"_a, "T_t_h"_a, "target"_a, "camera"_a, "options"_a = py::none(),
      "raise_on_failure"_a = false,
      "align_pose(patch: TextPatch, theta: Numbers, T_t_h: Pose, target: Pyramid | Array, camera: Camera, options: "
      "PoseOptions | None = None, raise_on_failure: bool = False) -> PoseAlignment\n\nThe pose of one text object with "
      "the plane theta (3,), host frame, from the guess T_t_h, host to target, coarse to fine.");
  m.def("refine_pose", &refine, "texts"_a, "target"_a, "camera"_a, "T_t_w"_a, "points"_a = py::none(),
        "pixels"_a = py::none(), "sigma"_a = py::none(), "options"_a = py::none(), "raise_on_failure"_a = false,
        "refine_pose(texts: Sequence[PoseText], target: Pyramid | Array, camera: Camera, T_t_w: Pose, points: Array | "
        "None "
        "= None, pixels: Array | None = None, sigma: Array | None = None, options: PoseOptions | None = None, "
        "raise_on_failure: bool = False) -> PoseFit\n\nThe pose of an image, world to target, from the guess T_t_w, by "
        "texts and by points (n, 3) of the world seen at pixels (n, 2); sigma (n,): of a pixel, times sigma_rep.");
  m.def(
      "search_pose", &search, "patch"_a, "theta"_a, "T_t_h"_a, "target"_a, "camera"_a, "options"_a = py::none(),
      "search_pose(patch: TextPatch, theta: Numbers, T_t_h: Pose, target: Pyramid | Array, camera: Camera, options: "
      "SearchOptions | None = None) -> PoseSearch\n\nThe pose with the best ZNCC among shifts and rolls of the guess.");
  m.def(
      "zncc_candidates", &candidates, "patch"_a, "theta"_a, "T_t_h"_a, "target"_a, "camera"_a, "level"_a = 0,
      "options"_a = py::none(),
      "zncc_candidates(patch: TextPatch, theta: Numbers, T_t_h: Sequence[Pose], target: Pyramid | Array, camera: "
      "Camera, "
      "level: int = 0, options: PhotometricOptions | None = None) -> tuple[Array, Status]\n\nZNCC of the patch in the "
      "target under each pose, float32 (n,); -1 where it cannot be compared.");
}

}  // namespace of_pose
}  // namespace binding
