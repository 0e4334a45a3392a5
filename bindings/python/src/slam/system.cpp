// textplane.slam.System.
#include <memory>
#include <stdexcept>

#include "slam/results.hpp"
#include "slam/slam.hpp"
#include "textslam/map_file/map_file.hpp"
#include "textslam/report/text_map.hpp"
#include "textslam/session.hpp"

namespace binding {

namespace {

using textslam::FrameRecord;
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

// Of the arguments; of the map's file where there is none.
textslam::CameraModel camera_of(const Camera* camera, int width, int height, const std::string& map) {
  if (!camera && map.empty()) throw py::value_error("camera: expected one, as there is no map that has it");
  if (!camera) return textslam::load_map_camera(map);
  if (width < 32 || height < 32 || width > 65535 || height > 65535)
    throw py::value_error("width, height: expected 32 to 65535 pixels");
  textslam::CameraModel model;
  model.raw = camera->model;
  model.width = width;
  model.height = height;
  return model;
}

std::unique_ptr<System> make_system(const Camera* camera, int width, int height, const std::string& mode,
                                    const py::object& detector, bool keep_images, const py::dict& parameters,
                                    const std::string& map, bool localise) {
  if (!detector.is_none() && !PyCallable_Check(detector.ptr())) expected("detector", "a callable", detector);
  if (localise && map.empty()) throw py::value_error("localise: expected a map as well");
  auto out = std::make_unique<System>();
  textslam::SessionOptions options;
  options.parameters = parameters_of(mode, parameters);
  options.keep_images = keep_images;
  options.command = {"textplane.slam.System"};
  options.map = map;
  options.localise = localise;
  out->session = std::make_unique<Session>(textslam::sequence_of(camera_of(camera, width, height, map)), options);
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
    return result_of(r, static_cast<int>(self.session->frames()) - 1);
  });
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
  c.def_property_readonly(
      "in_map",
      [](System& self) {
        const Claim claim(self);
        return self.session->system().is_in_earlier();
      },
      "bool: Whether its world is that of the map it was given: a frame was found there.");
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
  bind_results(m);
  py::class_<System> c(
      m, "System",
      "Monocular SLAM with points and planar text, frame by frame. The map has no scale of its own. One "
      "thread at a time.");
  c.def(
      py::init(&make_system), "camera"_a = py::none(), "width"_a = 0, "height"_a = 0, "mode"_a = "text",
      "detector"_a = py::none(), "keep_images"_a = true, "parameters"_a = py::dict(), "map"_a = "",
      "localise"_a = false,
      "__init__(camera: Camera | None = None, width: int = 0, height: int = 0, mode: str = \"text\", detector: "
      "Callable[[Array], Any] | None = None, keep_images: bool = True, parameters: dict[str, float] = ..., map: str = "
      "\"\", localise: bool = False) -> None\n\nwidth, height: of all images, px. "
      "mode: text, points or loose. detector: image -> quads, or (quads, scores, words), called for each frame without "
      "detections. keep_images: for poses before the map began and for the report; 0.3 MB a frame of 640 x 480. "
      "parameters: by the names of docs/textslam.md. map: a file of save_map() or textslam --save-map to go on in; it "
      "has the camera, its size too. localise: frames only find their place in that map, which stays as it is.");
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
  c.def(
      "save_map",
      [](System& self, const std::string& path) {
        const Claim claim(self);
        return unlocked([&] { return self.session->save_map(path); });
      },
      "path"_a = "",
      "save_map(path: str = \"\") -> str\n\nEnds the run and writes its map for later sessions: docs/map.md. No path: "
      "into "
      "the map that it began in. Returns why that map stays as it is where no frame was found in it, else an empty "
      "string; what the run made is then in unjoined_map.db beside it.");
  bind_answers(c);
}

}  // namespace binding
