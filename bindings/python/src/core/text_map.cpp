// TextMap: text objects for a system that has its own poses and points.
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/core.hpp"
#include "textplane/landmarks/text_map.hpp"

namespace binding {
namespace of_text_map {

// The map, and the camera that it looks through.
struct Map {
  Map(const py::object& of_all, const tp::TextMapOptions& options)
      : camera(of_all), map(binding::camera(of_all), options) {}

  py::object camera;
  tp::TextMap map;
  bool busy = false;  // a call works on it without the interpreter's lock
};

// Marks the map as busy: it is for one thread at a time.
class Claim {
 public:
  explicit Claim(Map& map) : map_(map) {
    if (map.busy) throw std::runtime_error("TextMap: another thread is working on it");
    map.busy = true;
  }
  ~Claim() { map_.busy = false; }
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

 private:
  Map& map_;
};

template <class T>
std::vector<T> list_of(const py::object& from, const char* name, const char* what) {
  if (!PySequence_Check(from.ptr()) || PyUnicode_Check(from.ptr())) expected(name, what, from);
  std::vector<T> out;
  for (const py::object item : py::reinterpret_borrow<py::sequence>(from)) {
    py::detail::make_caster<T> caster;
    if (!caster.load(item, true)) expected(name, what, item);
    out.push_back(py::detail::cast_op<T>(caster));
  }
  return out;
}

std::vector<tp::TextPoint> text_points(const py::object& pixels, const py::object& points, const py::object& ids) {
  std::vector<tp::TextPoint> out;
  if (pixels.is_none()) return out;
  const auto px = span<double>(pixels, "pixels", 2);
  Span<const Vec3> world;
  if (!points.is_none()) {
    world = points3(points, "points");
    same_length(px.n, "pixels", world.n, "points");
  }
  std::vector<int> names;
  if (!ids.is_none()) {
    names = list_of<int>(ids, "ids", "a sequence of whole numbers");
    same_length(px.n, "pixels", static_cast<int>(names.size()), "ids");
  }
  for (int i = 0; i < px.n; ++i) {
    const Vec2 at(px.data[2 * i], px.data[2 * i + 1]);
    const int id = names.empty() ? -1 : names[static_cast<std::size_t>(i)];
    // NaN: a track without a place
    const bool known = world.data && tp::all_finite(world.data[i]);
    out.push_back(known ? tp::TextPoint::at(at, world.data[i], id) : tp::TextPoint::track(at, id));
  }
  return out;
}

std::vector<tp::TextDetection> detections_of(const py::object& quads, const py::object& words) {
  std::vector<tp::TextDetection> out;
  if (quads.is_none()) return out;
  if (!PySequence_Check(quads.ptr())) expected("quads", "a sequence of corners (4, 2)", quads);
  for (const py::object corners : py::reinterpret_borrow<py::sequence>(quads)) out.emplace_back(quad(corners, "quads"));
  if (words.is_none()) return out;
  const auto read = list_of<std::string>(words, "words", "a sequence of strings");
  same_length(static_cast<int>(out.size()), "quads", static_cast<int>(read.size()), "words");
  for (std::size_t i = 0; i < out.size(); ++i) out[i].word = read[i].empty() ? std::string(tp::kUnreadText) : read[i];
  return out;
}

py::object track(Map& self, const py::object& target, const py::object& T_c_w, const py::object& pixels,
                 const py::object& points, bool raise) {
  const Levels pyramid(target, "image");
  const tp::SE3d guess = pose(T_c_w, "T_c_w");
  const auto seen = text_points(pixels, points, py::none());
  const Claim claim(self);
  return finish(unlocked([&] { return tp::TextFit(self.map.track(pyramid.view(), guess, seen)); }), raise, "track");
}

tp::Status add_keyframe(Map& self, int id, const py::object& target, const py::object& T_c_w, const py::object& quads,
                        const py::object& words, const py::object& pixels, const py::object& points,
                        const py::object& ids) {
  const tp::SE3d at = pose(T_c_w, "T_c_w");
  const auto detections = detections_of(quads, words);
  const auto seen = text_points(pixels, points, ids);
  const Levels levels(target, "image");
  const Claim claim(self);
  return unlocked([&] {
    tp::Pyramid own(levels.view().level[0], levels.view().levels);
    return self.map.add_keyframe(id, std::move(own), at, detections, seen);
  });
}

py::object corners(Map& self, int id) {
  const Claim claim(self);
  for (const tp::TextObject& text : self.map.objects()) {
    std::array<Vec3, 4> points;
    if (text.id != id || !self.map.corners(text, &points)) continue;
    py::array_t<double> out({4, 3});
    double* p = out.mutable_data();
    for (const Vec3& point : points)
      for (const int k : {0, 1, 2}) *p++ = point[k];
    return std::move(out);
  }
  return py::none();
}

void move(Map& self, const py::dict& poses) {
  std::map<int, tp::SE3d> moved;
  for (const auto& [id, T] : poses) moved[id.cast<int>()] = pose(T, "poses");
  const Claim claim(self);
  tp::SE3d unknown;  // one that is not finite changes nothing
  unknown.t = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  self.map.move([&](int id) {
    const auto found = moved.find(id);
    return found != moved.end() ? found->second : unknown;
  });
}

void bind_results(py::module_& m) {
  using F = tp::TextFit;
  py::class_<F> fit(m, "TextFit", "The pose of a frame by TextMap.track().");
  field(fit, "T_c_w", &F::T_c_w, "SE3: World to camera: refined, or as it was given.");
  field(fit, "refined", &F::refined, "bool: Which of the two.");
  field(fit, "information", &F::information, "Array: Of T_c_w, xi = (v, omega) left, (6, 6).");
  field(fit, "gain", &F::gain, "float: Share by which the texts lower the deviation of the position.");
  field(fit, "drift", &F::drift, "float: Factor by which points err more than their residuals say.");
  field(fit, "texts", &F::texts, "int: Texts that took part.");
  result_class(fit);
  py::enum_<tp::TextState>(m, "TextState", "Where a text object is in its life.")
      .value("candidate", tp::TextState::candidate)
      .value("tentative", tp::TextState::tentative)
      .value("mapped", tp::TextState::mapped)
      .value("dropped", tp::TextState::dropped);
  using T = tp::TextObject;
  py::class_<T> text(m, "TextObject", "A planar text of a map, as it was when it was asked for.");
  field(text, "id", &T::id, "int: Never used twice.");
  field(text, "state", &T::state, "TextState: Where it is in its life.");
  field(text, "host", &T::host, "int: Key frame that its patch was cut out of.");
  field(text, "patch", &T::patch, "TextPatch: Its pixels there.");
  field(text, "theta", &T::theta, "Array: The plane in the host's frame, (3,).");
  field(text, "covariance", &T::covariance, "Array: Of theta, (3, 3).");
  field(text, "detections", &T::detections, "int: Frames in which the detector saw it.");
  field(text, "zncc", &T::zncc, "float: Mean over its last refinement.");
  text.def_property_readonly(
      "views",
      [](const T& self) { return py::array_t<int>(static_cast<py::ssize_t>(self.views.size()), self.views.data()); },
      "Array: Key frames, without the host, that observe it well, int32 (n,).");
  text.def_property_readonly(
      "word",
      [](const T& self) {
        const py::object bytes = py::bytes(self.votes.empty() ? std::string() : tp::consensus(self.votes));
        return bytes.attr("decode")("utf-8", "replace");
      },
      "str: The word that most readings agree on; empty or ### where it is not read.");
  text.def_property_readonly(
      "votes",
      [](const T& self) {
        py::dict out;
        for (const auto& [word, score] : self.votes)
          out[py::str(py::bytes(word).attr("decode")("utf-8", "replace"))] = score;
        return out;
      },
      "dict[str, float]: Words read, and the sums of their scores.");
}

void bind_options_of_map(py::module_& m) {
  using O = tp::TextMapOptions;
  auto o = options_class<O>(m, "TextMapOptions", "Settings of a TextMap.");
  option(o, "min_zncc", &O::min_zncc, "float: Of a text that takes part in a pose.");
  option(o, "near_zncc", &O::near_zncc, "float: Where all texts begin with it, coarser levels are not asked.");
  option(o, "least_gain", &O::least_gain, "float: Of TextFit.gain; with less the pose stays as it is.");
  option(o, "least_sigma", &O::least_sigma, "float: px: points are not taken to be better.");
  option(o, "most_shift", &O::most_shift, "float: Factor by which texts may raise the points' residuals.");
  option(o, "text_huber", &O::text_huber, "float: Standard deviations by which a text may disagree at full weight.");
  option(o, "most_disagreement", &O::most_disagreement, "float: The same: beyond it a text takes no part.");
  option(o, "drift_frames", &O::drift_frames, "int: Of the mean that TextFit.drift is.");
  option(o, "max_images", &O::max_images, "int: Key frames whose images are kept.");
}

void bind(py::module_& m) {
  using namespace py::literals;
  bind_results(m);
  bind_options_of_map(m);
  py::class_<Map> c(
      m, "TextMap",
      "Text objects for a system that has its own poses and points: docs/integrate.md. Poses are of world to "
      "camera. One thread at a time.");
  c.def(py::init([](const py::object& camera, const py::object& settings) {
          return std::make_unique<Map>(camera,
                                       options<tp::TextMapOptions>(settings, "options", "a textplane.TextMapOptions"));
        }),
        "camera"_a, "options"_a = py::none(),
        "__init__(camera: Camera, options: TextMapOptions | None = None) -> None\n\nWithout texts.");
  c.def("track", &track, "image"_a, "T_c_w"_a, "pixels"_a = py::none(), "points"_a = py::none(),
        "raise_on_failure"_a = false,
        "track(image: Pyramid | Array, T_c_w: Pose, pixels: Array | None = None, points: Array | None = None, "
        "raise_on_failure: bool = False) -> TextFit\n\nThe pose of a frame by the mapped texts in view, and by points "
        "(n, 3) "
        "of the world seen at pixels (n, 2).");
  c.def("add_keyframe", &add_keyframe, "id"_a, "image"_a, "T_c_w"_a, "quads"_a = py::none(), "words"_a = py::none(),
        "pixels"_a = py::none(), "points"_a = py::none(), "ids"_a = py::none(),
        "add_keyframe(id: int, image: Pyramid | Array, T_c_w: Pose, quads: Sequence[Numbers] | None = None, words: "
        "Sequence[str] | None = None, pixels: Array | None = None, points: Array | None = None, ids: Sequence[int] | "
        "None = "
        "None) -> Status\n\nA key frame. quads: corners (4, 2) of detections, with words; pixels (n, 2): tracked "
        "corners, "
        "with the points (n, 3) of the world, NaN where unknown, and the ids of their tracks.");
  c.def(
      "remove_keyframe",
      [](Map& self, int id) {
        const Claim claim(self);
        self.map.remove_keyframe(id);
      },
      "id"_a, "remove_keyframe(id: int) -> None\n\nA key frame has left the system's map.");
  c.def("move", &move, "poses"_a,
        "move(poses: dict[int, Pose]) -> None\n\nPoses of key frames anew, world to camera, by their ids.");
  c.def(
      "objects",
      [](Map& self) {
        const Claim claim(self);
        py::list out;
        for (const tp::TextObject& text : self.map.objects()) out.append(py::cast(text));
        return out;
      },
      "objects() -> list[TextObject]\n\nThe texts of now.");
  c.def("corners", &corners, "id"_a,
        "corners(id: int) -> Array | None\n\nCorners of a text in the world, (4, 3); None where it has no plane.");
}

}  // namespace of_text_map
}  // namespace binding
