// textplane.slam.System.
#include <memory>
#include <stdexcept>

#include "slam/slam.hpp"
#include "textplane/landmarks/text_view.hpp"
#include "textslam/report/text_map.hpp"
#include "textslam/session.hpp"

namespace binding {

namespace {

using textslam::FrameRecord;
using textslam::FrameState;
using textslam::Session;

// A session, its detector, and whether a thread is in it.
struct System {
  std::unique_ptr<Session> session;
  py::object detector;
  bool busy = false;
};

class Claim {
 public:
  explicit Claim(System& system) : system_(system) {
    if (system.busy) throw std::runtime_error("System: another thread is working on it");
    system.busy = true;
  }
  ~Claim() { system_.busy = false; }
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

 private:
  System& system_;
};

struct FrameResult {
  int index = -1;
  double timestamp = 0;
  FrameState state = FrameState::waiting;
  tp::SE3d T_w_c;
  int map = -1, keyframe = -1, points = 0, texts = 0;
};

struct MappedText {
  int id = -1, observations = 0, host = -1;
  std::string word;
  std::array<Vec3, 4> corners{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  Vec3 normal = Vec3::Zero(), theta = Vec3::Zero();
  double zncc = 0;
};

std::unique_ptr<System> make_system(const Camera& camera, int width, int height, const std::string& mode,
                                    const py::object& detector, bool keep_images, const py::dict& parameters) {
  if (width < 32 || height < 32 || width > 65535 || height > 65535)
    throw py::value_error("width, height: expected 32 to 65535 pixels");
  if (!detector.is_none() && !PyCallable_Check(detector.ptr())) expected("detector", "a callable", detector);
  textslam::CameraModel model;
  model.raw = camera.model;
  model.width = width;
  model.height = height;
  auto out = std::make_unique<System>();
  textslam::SessionOptions options;
  options.parameters = parameters_of(mode, parameters);
  options.keep_images = keep_images;
  options.command = {"textplane.slam.System"};
  out->session = std::make_unique<Session>(textslam::sequence_of(model), options);
  out->detector = detector;
  return out;
}

FrameResult process(System& self, const py::object& pixels, double timestamp, const py::object& detections) {
  const tp::ImageView8 view = image<const std::uint8_t>(pixels, "image");
  py::object found = detections;
  if (found.is_none() && !self.detector.is_none()) found = self.detector(pixels);
  std::vector<textslam::Detection> seen = detections_of(found);
  const Claim claim(self);
  return unlocked([&] {
    const FrameRecord& r = self.session->process(view, timestamp, std::move(seen), 0);
    FrameResult out;
    out.index = static_cast<int>(self.session->frames()) - 1;
    out.timestamp = r.timestamp;
    out.state = r.state;
    if (r.state == FrameState::tracked) out.T_w_c = r.T_w_c_live;
    out.map = r.map;
    out.keyframe = r.keyframe;
    out.points = r.points;
    out.texts = r.texts;
    return out;
  });
}

std::vector<MappedText> texts_of(const textslam::Map& map) {
  std::vector<MappedText> out;
  for (const tp::TextObject& text : map.texts) {
    MappedText one;
    if (text.state != tp::TextState::mapped || !tp::is_ok(tp::text_corners(text, &one.corners))) continue;
    const tp::SE3d& T_w_h = map.keyframe(text.host).T_w_c;
    for (Vec3& corner : one.corners) corner = T_w_h * corner;
    one.id = text.id;
    one.observations = static_cast<int>(text.views.size()) + 1;
    one.host = map.keyframe(text.host).frame.index;
    one.word = text.votes.empty() ? std::string() : tp::consensus(text.votes);
    one.theta = text.theta;
    one.normal = tp::product(T_w_h.R, tp::plane_normal(text.theta));
    one.zncc = text.zncc;
    out.push_back(std::move(one));
  }
  return out;
}

py::object points_of(System& self) {
  const Claim claim(self);
  std::vector<double> numbers;
  for (const textslam::MapPoint& point : self.session->system().map().points)
    if (!point.bad)
      for (const int k : {0, 1, 2}) numbers.push_back(point.p_w[k]);
  py::array_t<double> out({static_cast<py::ssize_t>(numbers.size() / 3), py::ssize_t{3}});
  std::copy(numbers.begin(), numbers.end(), out.mutable_data());
  return std::move(out);
}

// Time stamps (n,) and poses (n, 4, 4).
py::object trajectory_of(System& self) {
  const Claim claim(self);
  const auto poses = textslam::final_trajectory(self.session->system());
  py::array_t<double> times(static_cast<py::ssize_t>(poses.size()));
  py::array_t<double> out({static_cast<py::ssize_t>(poses.size()), py::ssize_t{4}, py::ssize_t{4}});
  double *t = times.mutable_data(), *p = out.mutable_data();
  for (const textslam::StampedPose& pose : poses) {
    *t++ = pose.timestamp;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) *p++ = pose.T_w_c.R(r, c);
      *p++ = pose.T_w_c.t[r];
    }
    for (int c = 0; c < 4; ++c) *p++ = c == 3;
  }
  return py::make_tuple(times, out);
}

void bind_frame(py::module_& m) {
  py::enum_<FrameState>(m, "FrameState", "What became of a frame.")
      .value("waiting", FrameState::waiting)
      .value("tracked", FrameState::tracked)
      .value("lost", FrameState::lost);
  py::class_<FrameResult> c(m, "FrameResult", "What System.process() found.");
  field(c, "index", &FrameResult::index, "int: Of the frame, from 0.");
  field(c, "timestamp", &FrameResult::timestamp, "float: Of the frame, s.");
  field(c, "state", &FrameResult::state, "FrameState: Whether it has a pose.");
  c.def_property_readonly(
      "T_w_c",
      [](const FrameResult& self) {
        return self.state == FrameState::tracked ? py::cast(self.T_w_c) : py::object(py::none());
      },
      "SE3 | None: Camera to the live world; None unless it is tracked.");
  field(c, "map", &FrameResult::map, "int: Number of its map; -1: none.");
  field(c, "keyframe", &FrameResult::keyframe, "int: Key frame that its pose is relative to; -1: none.");
  field(c, "points", &FrameResult::points, "int: Points that its pose rests on.");
  field(c, "texts", &FrameResult::texts, "int: Texts that its pose rests on.");
  c.def(
      "__repr__", [](Handle self) { return describe(self); }, "__repr__() -> str\n\nIts numbers.");

  py::class_<MappedText> text(m, "MappedText", "A text of the map, in its world.");
  field(text, "id", &MappedText::id, "int: Never used twice.");
  field(text, "observations", &MappedText::observations, "int: Key frames that show it.");
  field(text, "host", &MappedText::host, "int: Index of its host frame.");
  text.def_property_readonly(
      "word", [](const MappedText& self) { return py::bytes(self.word).attr("decode")("utf-8", "replace"); },
      "str: What most readings agree on; empty or ### where it is not read.");
  text.def_property_readonly(
      "corners",
      [](const MappedText& self) {
        py::array_t<double> out({4, 3});
        double* p = out.mutable_data();
        for (const Vec3& corner : self.corners)
          for (const int k : {0, 1, 2}) *p++ = corner[k];
        return out;
      },
      "Array: Clockwise from the text's top left, (4, 3).");
  field(text, "normal", &MappedText::normal, "Array: Unit normal towards the host camera, (3,).");
  field(text, "theta", &MappedText::theta, "Array: The plane in the host's frame, (3,).");
  field(text, "zncc", &MappedText::zncc, "float: Mean over its last refinement.");
  text.def(
      "__repr__", [](Handle self) { return describe(self); }, "__repr__() -> str\n\nIts numbers.");
}

// What it knows so far.
void bind_answers(py::class_<System>& c) {
  c.def_property_readonly(
      "texts",
      [](System& self) {
        const Claim claim(self);
        py::list out;
        for (MappedText& text : texts_of(self.session->system().map())) out.append(py::cast(std::move(text)));
        return out;
      },
      "list[MappedText]: The mapped texts of now.");
  c.def_property_readonly(
      "finished", [](const System& self) { return self.session->finished(); }, "bool: Whether the run has ended.");
  c.def_property_readonly("points", &points_of, "Array: The points of the map, (n, 3).");
  c.def_property_readonly("trajectory", &trajectory_of,
                          "tuple[Array, Array]: Time stamps, s, (n,), and poses, camera to world, (n, 4, 4), of the "
                          "tracked frames, as the map has them now.");
  c.def(
      "report",
      [](System& self) {
        const Claim claim(self);
        return unlocked([&] { return self.session->report(); });
      },
      "report() -> str\n\nEnds the run; the report as one page of HTML. Empty without images.");
  c.def(
      "__repr__",
      [](System& self) {
        const Claim claim(self);
        const auto& map = self.session->system().map();
        return "System(" + std::to_string(self.session->frames()) + " frames, " +
               std::to_string(map.keyframe_ids().size()) + " key frames, " + std::to_string(texts_of(map).size()) +
               " texts)";
      },
      "__repr__() -> str\n\nIts counts.");
}

}  // namespace

void bind_system(py::module_& m) {
  using namespace py::literals;
  bind_frame(m);
  py::class_<System> c(
      m, "System",
      "Monocular SLAM with points and planar text, frame by frame. The map has no scale of its own. One "
      "thread at a time.");
  c.def(
      py::init(&make_system), "camera"_a, "width"_a, "height"_a, "mode"_a = "text", "detector"_a = py::none(),
      "keep_images"_a = true, "parameters"_a = py::dict(),
      "__init__(camera: Camera, width: int, height: int, mode: str = \"text\", detector: Callable[[Array], Any] | None "
      "= "
      "None, keep_images: bool = True, parameters: dict[str, float] = ...) -> None\n\nwidth, height: of all images, "
      "px. "
      "mode: text, points or loose. detector: image -> quads, or (quads, scores, words), called for each frame without "
      "detections. keep_images: for poses before the map began and for the report; 0.3 MB a frame of 640 x 480. "
      "parameters: by the names of docs/textslam.md.");
  c.def("process", &process, "image"_a, "timestamp"_a, "detections"_a = py::none(),
        "process(image: Array, timestamp: float, detections: Any = None) -> FrameResult\n\nThe next image, uint8 "
        "(height, "
        "width), with its time, s, and its texts: corners (4, 2) each, px, clockwise from the text's top left, or a "
        "tuple "
        "(quads, scores, words).");
  c.def(
      "finish",
      [](System& self) {
        const Claim claim(self);
        unlocked([&] { self.session->finish(); });
      },
      "finish() -> None\n\nEnds the run: the adjustment of the whole map, and poses of the frames before it began.");
  c.def(
      "save",
      [](System& self, const std::string& folder) {
        const Claim claim(self);
        unlocked([&] { self.session->save(folder); });
      },
      "folder"_a,
      "save(folder: str) -> None\n\nEnds the run and writes trajectories, map and report, as the program textslam "
      "does: "
      "docs/textslam.md.");
  bind_answers(c);
}

}  // namespace binding
