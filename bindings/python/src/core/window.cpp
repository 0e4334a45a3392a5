// solve_window(): bundle adjustment of poses, points and text planes.
#include <vector>

#include "core/core.hpp"
#include "textplane/solver/window.hpp"

namespace binding {
namespace of_window {

// A window, and the objects that it refers to.
struct Window {
  explicit Window(const py::object& of_all) : camera(of_all) { data.camera = binding::camera(of_all); }

  py::object camera;
  std::vector<py::object> images, patches;
  tp::Window data;
};

template <class T>
T& at(std::vector<T>& all, int index, const char* what) {
  if (index < 0 || index >= static_cast<int>(all.size()))
    throw py::index_error(std::string(what) + ": the window has no number " + std::to_string(index));
  return all[static_cast<std::size_t>(index)];
}

int add_frame(Window& w, const py::object& T_w_c, bool fixed, const py::object& pixels) {
  tp::WindowFrame frame;
  frame.T_w_c = pose(T_w_c, "T_w_c");
  frame.fixed = fixed;
  if (!pixels.is_none()) frame.image = object<tp::Pyramid>(pixels, "image", "a textplane.Pyramid").view();
  w.images.push_back(pixels);
  w.data.frames.push_back(frame);
  return static_cast<int>(w.data.frames.size()) - 1;
}

int add_point(Window& w, const py::object& p_w, bool fixed) {
  tp::WindowPoint point;
  point.p_w = vector<3>(p_w, "p_w");
  point.fixed = fixed;
  w.data.points.push_back(point);
  return static_cast<int>(w.data.points.size()) - 1;
}

int add_text(Window& w, int host, const py::object& patch, const py::object& theta, bool fixed) {
  tp::WindowText text;
  text.host = host;
  text.patch = &object<const tp::TextPatch>(patch, "patch", "a textplane.TextPatch");
  text.theta = vector<3>(theta, "theta");
  text.fixed = fixed;
  w.patches.push_back(patch);
  w.data.texts.push_back(text);
  return static_cast<int>(w.data.texts.size()) - 1;
}

void see_point(Window& w, int frame, int point, const py::object& px, double sigma) {
  tp::WindowPointObservation seen;
  seen.frame = frame;
  seen.point = point;
  seen.px = vector<2>(px, "px");
  seen.sigma = sigma;
  w.data.point_observations.push_back(seen);
}

void see_text(Window& w, int frame, int text, double weight, int scale_shift) {
  tp::WindowTextObservation seen;
  seen.frame = frame;
  seen.text = text;
  seen.weight = weight;
  seen.scale_shift = scale_shift;
  w.data.text_observations.push_back(seen);
}

// The lock stays where other threads could change the window: it is worked on as a copy, which then takes its place.
py::object solve(const py::object& window, const py::object& settings, bool raise) {
  auto& w = object<Window>(window, "window", "a textplane.Window");
  const auto chosen = options<tp::WindowOptions>(settings, "options", "a textplane.WindowOptions");
  tp::Window data = w.data;
  const std::vector<py::object> images = w.images, patches = w.patches;
  const tp::WindowSummary summary = unlocked([&] { return tp::solve_window(data, chosen); });
  w.data = std::move(data);
  w.images = images;
  w.patches = patches;
  return finish(summary, raise, "solve_window");
}

void bind_window_options(py::module_& m) {
  using O = tp::WindowOptions;
  auto o = options_class<O>(m, "WindowOptions", "Settings of solve_window().");
  option(o, "photometric", &O::photometric, "PhotometricOptions: Of every pixel of the texts.");
  option(o, "point_robust", &O::point_robust, "Robust: On |e| / sigma.");
  option(o, "weighting", &O::weighting, "Weighting: How texts weigh against points.");
  option(o, "sigma_rep", &O::sigma_rep, "float: px.");
  option(o, "sigma_photo", &O::sigma_photo, "float: Of a pixel's residual, in units of 1/sqrt(N).");
  option(o, "text_level", &O::text_level, "int: Pyramid level of patches and images.");
  option(o, "max_iterations", &O::max_iterations, "int: Steps tried, rejected ones included.");
  option(o, "cost_tolerance", &O::cost_tolerance, "float: Converged where a step lowers the cost by this share.");
  option(o, "step_tolerance", &O::step_tolerance, "float: Converged where all move by this share of their scale.");
  option(o, "initial_lambda", &O::initial_lambda, "float: First damping.");
  option(o, "max_lambda", &O::max_lambda, "float: Status.diverged beyond.");
  option(o, "max_lost_fraction", &O::max_lost_fraction, "float: Share of lost pixels that rejects a step.");
  option(o, "min_depth", &O::min_depth, "float: A point with less is behind the camera.");
  option(o, "scale_frame_a", &O::scale_frame_a, "int: Frame whose distance from the next is held; -1: none.");
  option(o, "scale_frame_b", &O::scale_frame_b, "int: The other frame; -1: none.");
  option(o, "covariance", &O::covariance, "bool: Compute the covariances of the texts.");

  using S = tp::WindowSummary;
  py::class_<S> s(m, "WindowSummary", "What solve_window() did.");
  field(s, "initial_cost", &S::initial_cost, "float: Of the terms used, at the start.");
  field(s, "final_cost", &S::final_cost, "float: At the end.");
  field(s, "iterations", &S::iterations, "int: Steps tried.");
  field(s, "accepted", &S::accepted, "int: Steps taken.");
  field(s, "gauge_freedom", &S::gauge_freedom, "int: Degrees of freedom that nothing fixes.");
  field(s, "free_frames", &S::free_frames, "int: Frames adjusted.");
  field(s, "free_points", &S::free_points, "int: Points adjusted.");
  field(s, "free_texts", &S::free_texts, "int: Texts adjusted.");
  field(s, "point_observations", &S::point_observations, "int: Used.");
  field(s, "text_observations", &S::text_observations, "int: Used to the end.");
  field(s, "undetermined", &S::undetermined, "int: Frames, points and texts that are rank deficient.");
  result_class(s);
}

void bind_answers(py::class_<Window>& c) {
  using namespace py::literals;
  c.def(
      "pose", [](Window& w, int frame) { return at(w.data.frames, frame, "frame").T_w_c; }, "frame"_a,
      "pose(frame: int) -> SE3\n\nOf a frame, camera to world.");
  c.def(
      "point", [](Window& w, int point) { return to_python(at(w.data.points, point, "point").p_w); }, "point"_a,
      "point(point: int) -> Array\n\nIn the world, (3,).");
  c.def(
      "theta", [](Window& w, int text) { return to_python(at(w.data.texts, text, "text").theta); }, "text"_a,
      "theta(text: int) -> Array\n\nPlane of a text in its host's frame, (3,).");
  c.def(
      "covariance", [](Window& w, int text) { return to_python(at(w.data.texts, text, "text").covariance); }, "text"_a,
      "covariance(text: int) -> Array\n\nOf theta, (3, 3), as solve_window() found it.");
  c.def(
      "zncc", [](Window& w, int text) { return at(w.data.texts, text, "text").zncc; }, "text"_a,
      "zncc(text: int) -> float\n\nMean over its observations, as solve_window() found it.");
  c.def(
      "status_of_text", [](Window& w, int text) { return at(w.data.texts, text, "text").status; }, "text"_a,
      "status_of_text(text: int) -> Status\n\nWhat became of it.");
  c.def(
      "status_of_frame", [](Window& w, int frame) { return at(w.data.frames, frame, "frame").status; }, "frame"_a,
      "status_of_frame(frame: int) -> Status\n\nWhat became of it.");
  c.def_property_readonly(
      "chi2",
      [](const Window& w) {
        py::array_t<double> out(static_cast<py::ssize_t>(w.data.point_observations.size()));
        double* p = out.mutable_data();
        for (const auto& seen : w.data.point_observations) *p++ = seen.chi2;
        return out;
      },
      "Array: |e|^2 / sigma^2 of each observation of a point, (n,).");
}

void bind(py::module_& m) {
  using namespace py::literals;
  bind_window_options(m);
  py::class_<Window> c(
      m, "Window",
      "A bundle adjustment: frames, points, texts, and who sees what. It keeps images and patches alive. "
      "Fix at least one frame, and two or hold a distance for the scale. One thread at a time.");
  c.def(py::init<const py::object&>(), "camera"_a,
        "__init__(camera: Camera) -> None\n\nWithout frames; one camera for all.");
  c.def("add_frame", &add_frame, "T_w_c"_a, "fixed"_a = false, "image"_a = py::none(),
        "add_frame(T_w_c: Pose, fixed: bool = False, image: Pyramid | None = None) -> int\n\nA key frame, camera to "
        "world; "
        "its number. image: where it sees texts.");
  c.def("add_point", &add_point, "p_w"_a, "fixed"_a = false,
        "add_point(p_w: Numbers, fixed: bool = False) -> int\n\nA point of the world, (3,); its number.");
  c.def("add_text", &add_text, "host"_a, "patch"_a, "theta"_a, "fixed"_a = false,
        "add_text(host: int, patch: TextPatch, theta: Numbers, fixed: bool = False) -> int\n\nA text object with its "
        "host "
        "frame, and the plane (3,) there; its number.");
  c.def("see_point", &see_point, "frame"_a, "point"_a, "px"_a, "sigma"_a = 1.0,
        "see_point(frame: int, point: int, px: Numbers, sigma: float = 1.0) -> None\n\nThe frame sees the point at px, "
        "(2,), "
        "with this standard deviation, px.");
  c.def("see_text", &see_text, "frame"_a, "text"_a, "weight"_a = 1.0, "scale_shift"_a = 0,
        "see_text(frame: int, text: int, weight: float = 1.0, scale_shift: int = 0) -> None\n\nThe frame, which is not "
        "the "
        "host, sees the text.");
  bind_answers(c);
  m.def("solve_window", &solve, "window"_a, "options"_a = py::none(), "raise_on_failure"_a = false,
        "solve_window(window: Window, options: WindowOptions | None = None, raise_on_failure: bool = False) -> "
        "WindowSummary\n\nAdjusts what is not fixed, in place. Coarse to fine: once a level, with options.text_level.");
}

}  // namespace of_window
}  // namespace binding
