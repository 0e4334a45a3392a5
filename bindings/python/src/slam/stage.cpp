// The stage of the numbered examples: one sign on a wall, with the exact truth; and the tracker of planes.
#include "stage/stage.hpp"

#include "planar/plane_tracker.hpp"
#include "renderer/render_sequence.hpp"
#include "slam/slam.hpp"

namespace binding {

namespace {

using textslam::Stage;
using Tracker = planar::PlaneTracker;

py::object picture(const tp::Image<std::uint8_t>& image) {
  return py::array_t<std::uint8_t>({py::ssize_t{image.height()}, py::ssize_t{image.width()}}, image.data());
}

py::object view(const Stage& stage, const py::object& T_w_c, double gain, double bias, double vignette,
                const py::object& glare) {
  textslam::SensorState sensor;
  sensor.gain = gain;
  sensor.bias = bias;
  sensor.vignette = vignette;
  if (!glare.is_none()) {
    const auto g = vector<4>(glare, "glare");
    sensor.glare.push_back({{g[0], g[1]}, g[2], g[3]});
  }
  const tp::SE3d T = pose(T_w_c, "T_w_c");
  return picture(unlocked([&] { return stage.view(T, sensor); }));
}

void bind_render(py::module_& m) {
  using namespace py::literals;
  m.def(
      "render",
      [](const std::string& output, const std::string& kind, int frames, std::uint64_t seed, int width, int height) {
        textslam::RenderOptions o;
        o.output = output;
        o.kind = kind;
        o.frames = frames;
        o.seed = seed;
        o.width = width;
        o.height = height;
        unlocked([&] { textslam::render_sequence(o); });
      },
      "output"_a, "kind"_a = "room", "frames"_a = 0, "seed"_a = 1, "width"_a = 640, "height"_a = 480,
      "render(output: str, kind: str = \"room\", frames: int = 0, seed: int = 1, width: int = 640, height: int = 480) "
      "-> "
      "None\n\nA rendered sequence with exact truth, in the folder `output`, for textplane.slam.run(). frames: 30 a "
      "second; 0: as many as the kind has. RuntimeError for an unknown kind, which names those that are.");
}

void bind_tracker(py::module_& m) {
  using namespace py::literals;
  py::class_<Tracker> tracker(
      m, "PlaneTracker",
      "Follows a planar object through a video from its corners in the first frame, with a camera "
      "that is not calibrated. One thread at a time.");
  tracker.def(
      py::init([](const py::object& first, const py::object& corners) {
        return std::make_unique<Tracker>(image<const std::uint8_t>(first, "first"), quad(corners, "quad"));
      }),
      "first"_a, "quad"_a,
      "__init__(first: Array, quad: Numbers) -> None\n\nfirst: uint8 (height, width); quad: corners (4, 2), px.");
  tracker.def_property_readonly(
      "status", [](const Tracker& self) { return self.status(); }, "Status: Whether the object can be tracked.");
  tracker.def(
      "track",
      [](Tracker& self, const py::object& pixels) { return self.track(image<const std::uint8_t>(pixels, "image")); },
      "image"_a, "track(image: Array) -> Status\n\nThe object in the next image; ok where it was found.");
  tracker.def_property_readonly(
      "quad", [](const Tracker& self) { return to_python(self.quad()); }, "Array: Its corners there, px, (4, 2).");
  tracker.def_property_readonly(
      "zncc", [](const Tracker& self) { return self.zncc(); }, "float: Its correlation with the first frame.");
}

}  // namespace

void bind_stage(py::module_& m) {
  using namespace py::literals;
  py::class_<Stage> c(
      m, "Stage",
      "One sign on a plastered wall, seen from anywhere, with the exact truth: for examples and tests. Axes "
      "are those of a camera that faces the wall, in metres; the sign is centred at (0, 0, 2).");
  c.def(py::init([](const std::string& word, const py::object& turn) {
          const Vec3 by = vector<3>(turn, "turn");
          return unlocked([&] { return std::make_unique<Stage>(word, by); });
        }),
        "word"_a, "turn"_a = py::make_tuple(0, 0, 0),
        "__init__(word: str, turn: Numbers = ...) -> None\n\nturn: of the wall about the sign's centre, a rotation "
        "vector, "
        "rad. RuntimeError where no font is found.");
  c.def_property_readonly(
      "camera", [](const Stage& self) { return std::make_unique<Camera>(self.camera()); },
      "Camera: Of all views, 480 x 360 px.");
  c.def(
      "view", &view, "T_w_c"_a, "gain"_a = 1.0, "bias"_a = 0.0, "vignette"_a = 0.0, "glare"_a = py::none(),
      "view(T_w_c: Pose, gain: float = 1.0, bias: float = 0.0, vignette: float = 0.0, glare: Numbers | None = None) -> "
      "Array\n\nThe image of the camera at T_w_c, camera to world, uint8 (360, 480). vignette: share of light lost in "
      "the "
      "corners; glare: x, y and radius in px, and strength in grey levels.");
  c.def(
      "quad", [](const Stage& self, const py::object& T) { return to_python(self.quad(pose(T, "T_w_c"))); }, "T_w_c"_a,
      "quad(T_w_c: Pose) -> Array\n\nCorners of the text in that view, px, (4, 2).");
  c.def(
      "theta", [](const Stage& self, const py::object& T) { return to_python(self.theta(pose(T, "T_w_c"))); },
      "T_w_c"_a, "theta(T_w_c: Pose) -> Array\n\nThe sign's plane in the frame of that camera, (3,).");
  m.def(
      "camera_at",
      [](const py::object& position, const py::object& turn) {
        return textslam::camera_at(vector<3>(position, "position"), vector<3>(turn, "turn"));
      },
      "position"_a, "turn"_a = py::make_tuple(0, 0, 0),
      "camera_at(position: Numbers, turn: Numbers = ...) -> SE3\n\nT_w_c of a camera at the position, m, turned by the "
      "rotation vector, rad, from facing the wall.");

  bind_render(m);
  bind_tracker(m);
}

}  // namespace binding
