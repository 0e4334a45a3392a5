#include "textslam/run.hpp"

#include <memory>

#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "io/output_file.hpp"
#include "textslam/progress.hpp"
#include "textslam/text_detector.hpp"
#include "textslam/undistorter.hpp"

namespace textslam {
namespace {

// Loads, detects and undistorts; frame indices count from the run's first frame.
class FrameSource {
 public:
  FrameSource(const Sequence& sequence, const RunOptions& options)
      : sequence_(sequence),
        parameters_(options.parameters),
        first_(static_cast<std::size_t>(options.first)),
        undistort_(sequence.camera),
        detector_(make_detector(options.detector, sequence)) {}

  Frame load(int index, double* detect_ms) {
    const std::size_t at = first_ + static_cast<std::size_t>(index);
    const Image<std::uint8_t> raw = load_frame(sequence_, at);
    Frame frame;
    frame.index = index;
    frame.timestamp = sequence_.frames[at].timestamp;
    const double start = now_ms();
    if (parameters_.mode != Mode::points)
      frame.detections = undistort_(detector_->detect(sequence_.frames[at], raw.view()));
    if (detect_ms) *detect_ms = now_ms() - start;
    const Image<std::uint8_t> image = undistort_(raw);
    frame.image = std::make_shared<const Pyramid>(image.view(), parameters_.pyramid_levels);
    return frame;
  }

 private:
  const Sequence& sequence_;
  const Parameters& parameters_;
  std::size_t first_;
  Undistorter undistort_;
  std::unique_ptr<TextDetector> detector_;
};

// Broken input ends a step but not the run: what was computed is written. The first message is the one reported.
template <class Step>
void keep_going(RunResult& result, Step step) {
  try {
    step();
  } catch (const InputError& error) {
    if (result.error.empty()) result.error = error.what();
  }
}

}  // namespace

RunResult run(const RunOptions& options) {
  const Sequence sequence = read_sequence(options.sequence);
  const int count = static_cast<int>(sequence.frames.size());
  const int last = options.last < 0 ? count - 1 : options.last;
  if (options.first < 0 || options.first > last || last >= count)
    throw InputError(sequence.images_file, 0,
                     "frames " + std::to_string(options.first) + " to " + std::to_string(last) +
                         " asked for, but it has 0 to " + std::to_string(count - 1));
  create_output_folder(options.output);

  RunResult result;
  const int total = last - options.first + 1;
  FrameSource source(sequence, options);
  System system(sequence.camera.pinhole, sequence.camera.width, sequence.camera.height, options.parameters);
  keep_going(result, [&] {
    Progress progress("tracking");
    for (int index = 0; index < total; ++index) {
      double detect_ms = 0;
      const Frame frame = source.load(index, &detect_ms);
      const FrameRecord& record = system.process(frame, detect_ms);
      const char* state = record.state == FrameState::tracked ? "tracked"
                          : record.state == FrameState::lost  ? "lost"
                                                              : "waiting";
      progress.show(static_cast<std::size_t>(index + 1), static_cast<std::size_t>(total),
                    std::string(state) + ", " + std::to_string(record.points) + " points, " +
                        std::to_string(record.texts) + " texts");
    }
  });
  system.finish();
  keep_going(result, [&] { system.fill_in([&](int index) { return source.load(index, nullptr); }); });
  RunSummary& summary = result.summary;
  summary = summarise(system, sequence, static_cast<std::size_t>(total));
  if (summary.has_truth && textplane::is_ok(summary.trajectory.status))
    keep_going(result, [&] {
      summary.text = evaluate_text(system.map(), read_true_signs(sequence), summary.trajectory.alignment);
    });
  write_outputs(options.output, system, summary);
  return result;
}

}  // namespace textslam
