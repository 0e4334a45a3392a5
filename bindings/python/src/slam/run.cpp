// textplane.slam.run(): a whole sequence, as the program textslam runs it.
#include "textslam/run.hpp"

#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "plugins/plugins.hpp"
#include "slam/slam.hpp"
#include "textslam/report/summary.hpp"

namespace binding {

namespace {

// Python's callable as a detector. What it raises ends the run as broken input does: what came before is written.
class PythonDetector : public textslam::TextDetector {
 public:
  explicit PythonDetector(py::object callable) : callable_(std::move(callable)) {}
  ~PythonDetector() override {
    const py::gil_scoped_acquire lock;
    callable_ = py::object();
  }
  PythonDetector(const PythonDetector&) = delete;
  PythonDetector& operator=(const PythonDetector&) = delete;

  std::vector<textslam::Detection> detect(const textslam::FrameRef& frame, tp::ImageView8 view) override {
    const py::gil_scoped_acquire lock;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      py::array_t<std::uint8_t> pixels({py::ssize_t{view.height()}, py::ssize_t{view.width()}},
                                       {static_cast<py::ssize_t>(view.stride()), py::ssize_t{1}},
                                       view.data());  // a copy
      return detections_of(callable_(pixels));
    } catch (const py::error_already_set& error) {
      throw textslam::InputError(frame.path, 0, std::string("the detector raised ") + error.what());
    } catch (const py::builtin_exception& error) {
      throw textslam::InputError(frame.path, 0, std::string("what the detector returned: ") + error.what());
    }
  }

 private:
  py::object callable_;
};

struct Run {
  textslam::RunResult result;
  std::string output;
};

Run run(const std::string& folder, const std::string& output, const py::object& detector, const std::string& mode,
        int first, int last, int every, bool report, const std::string& camera, const py::dict& parameters) {
  textslam::RunOptions options;
  options.sequence = folder;
  options.output = output;
  options.input.camera = camera;
  options.parameters = parameters_of(mode, parameters);
  options.first = first;
  options.last = last;
  if (every < 1) throw py::value_error("every: expected 1 or more");
  options.every = every;
  options.report = report;
  options.command = {"textplane.slam.run"};
  if (PyUnicode_Check(detector.ptr())) {
    options.detector.name = detector.cast<std::string>();
  } else if (PyCallable_Check(detector.ptr())) {
    options.own_detector = std::make_shared<PythonDetector>(detector);
  } else {
    expected("detector", "a callable, or the name of a built-in one", detector);
  }
  Run out;
  out.output = output;
  out.result = unlocked([&] { return textslam::run(options); });
  return out;
}

}  // namespace

void bind_run(py::module_& m) {
  using namespace py::literals;
  textslam::register_plugins();
  py::class_<Run> c(m, "Run", "What run() did; its files are in `output`.");
  field(c, "output", &Run::output, "str: The folder of the outputs.");
  const auto count = [&c](const char* name, std::size_t textslam::RunSummary::*member, const char* doc) {
    c.def_property_readonly(
        name, [member](const Run& self) { return self.result.summary.*member; }, doc);
  };
  count("frames", &textslam::RunSummary::frames, "int: Frames of the run.");
  count("tracked", &textslam::RunSummary::tracked, "int: Frames with a pose.");
  count("keyframes", &textslam::RunSummary::keyframes, "int: Key frames of the map.");
  count("points", &textslam::RunSummary::points, "int: Points of the map.");
  count("texts", &textslam::RunSummary::texts, "int: Texts of the map.");
  c.def_property_readonly(
      "ate",
      [](const Run& self) -> py::object {
        if (!textslam::is_aligned(self.result.summary)) return py::none();
        return py::float_(self.result.summary.trajectory.ate.rmse);
      },
      "float | None: Rms error of the positions, m; None without ground truth.");
  c.def_property_readonly(
      "report", [](const Run& self) { return self.result.report; }, "str: Path of the report; empty: there is none.");
  c.def_property_readonly(
      "error", [](const Run& self) { return self.result.error; },
      "str: What ended the run early; what came before is written. Empty: nothing did.");
  c.def(
      "__repr__", [](Handle self) { return describe(self); }, "__repr__() -> str\n\nIts numbers.");
  m.def(
      "run", &run, "folder"_a, "output"_a, "detector"_a = "files", "mode"_a = "text", "first"_a = 0, "last"_a = -1,
      "every"_a = 1, "report"_a = true, "camera"_a = "", "parameters"_a = py::dict(),
      "run(folder: str, output: str, detector: Callable[[Array], Any] | str = \"files\", mode: str = \"text\", first: "
      "int "
      "= 0, last: int = -1, every: int = 1, report: bool = True, camera: str = \"\", parameters: dict[str, float] = "
      "...) "
      "-> Run\n\nA sequence, a folder or a video, as the program textslam runs it: docs/textslam.md. detector: files, "
      "classical, or a callable: image, uint8 (height, width), -> quads, or (quads, scores, words). first, last, "
      "every: "
      "frames. camera: a camera file in place of the sequence's. A broken input raises RuntimeError.");
  m.def(
      "load_image",
      [](const std::string& path) {
        const tp::Image<std::uint8_t> loaded = unlocked([&] { return textslam::load_grey(path); });
        return py::array_t<std::uint8_t>({py::ssize_t{loaded.height()}, py::ssize_t{loaded.width()}}, loaded.data());
      },
      "path"_a,
      "load_image(path: str) -> Array\n\nThe grey levels of a JPEG, PNG or PNM file, uint8 (height, width). "
      "RuntimeError "
      "that names the file where it cannot be read.");
}

}  // namespace binding
