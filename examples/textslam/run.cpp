#include "textslam/run.hpp"

#include <chrono>
#include <exception>
#include <memory>
#include <thread>

#include "cli/progress.hpp"
#include "io/clock.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "io/interrupt.hpp"
#include "io/output_file.hpp"
#include "textslam/common/bounded_sampler.hpp"
#include "textslam/detect/detection_thread.hpp"
#include "textslam/detect/text_detector.hpp"
#include "textslam/input/undistorter.hpp"
#include "textslam/report/frame_line.hpp"
#include "textslam/report/outputs.hpp"
#include "textslam/report/report.hpp"
#include "textslam/report/report_frames.hpp"

namespace textslam {
namespace {

using RawImage = DetectionThread::RawImage;

// Loads, detects and undistorts. Frame indices count from the run's first frame. Another thread may call detect().
class FrameSource {
 public:
  FrameSource(const Sequence& sequence, const RunOptions& options)
      : sequence_(sequence),
        pyramid_levels_(at_size(options.parameters, sequence.camera.width, sequence.camera.height).pyramid_levels),
        first_(static_cast<std::size_t>(options.first)),
        undistort_(sequence.camera),
        detector_(options.own_detector ? options.own_detector : make_detector(options.detector, sequence)),
        reader_(options.parameters.mode == Mode::points ? nullptr : make_reader(options.detector)) {}

  double timestamp(int index) const { return sequence_.frames[at(index)].timestamp; }
  RawImage load(int index) const {
    return std::make_shared<const Image<std::uint8_t>>(load_frame(sequence_, at(index)));
  }
  std::vector<Detection> detect(int index, const Image<std::uint8_t>& raw) {
    return undistort_(detector_->detect(sequence_.frames[at(index)], raw.view()));
  }
  Frame frame(int index, const Image<std::uint8_t>& raw) const { return {index, timestamp(index), pyramid(raw), {}}; }
  void read_texts(System& system) const {
    if (reader_) system.read_texts(*reader_);
  }
  std::shared_ptr<const Pyramid> image(int index) { return pyramid(load_frame(sequence_, at(index))); }

 private:
  std::size_t at(int index) const { return first_ + static_cast<std::size_t>(index); }
  std::shared_ptr<const Pyramid> pyramid(const Image<std::uint8_t>& raw) const {
    const Image<std::uint8_t> image = undistort_(raw);
    return std::make_shared<const Pyramid>(image.view(), pyramid_levels_);
  }

  const Sequence& sequence_;
  int pyramid_levels_;
  std::size_t first_;
  Undistorter undistort_;
  std::shared_ptr<TextDetector> detector_;
  std::unique_ptr<TextReader> reader_;
};

// Real time: frames come at their time stamps, counted from the first. A late frame is processed at once, none skipped.
class Clock {
 public:
  explicit Clock(bool real_time) : real_time_(real_time) {}

  void wait_for(double timestamp) {
    if (!real_time_) return;
    if (start_ms_ < 0) {
      start_ms_ = now_ms();
      first_ = timestamp;
    }
    due_ms_ = start_ms_ + 1000 * (timestamp - first_);
    const double early = due_ms_ - now_ms();
    if (early > 0) std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(early));
  }
  void done() {
    if (real_time_) latency_ms_.push_back(now_ms() - due_ms_);
  }
  /// Of each frame: from its arrival to its pose.
  std::vector<double> latency_ms() { return std::move(latency_ms_); }

 private:
  bool real_time_;
  double start_ms_ = -1, due_ms_ = 0, first_ = 0;
  std::vector<double> latency_ms_;
};

// Detection before each frame or, in real time, on a thread beside tracking. Files are always read before the frame.
class Detections {
 public:
  Detections(FrameSource& source, const RunOptions& options) : source_(source) {
    const Parameters& parameters = options.parameters;
    if (parameters.mode == Mode::points) return;
    in_step_ = !parameters.real_time || (!options.own_detector && options.detector.name == "files");
    if (in_step_) return;
    thread_ = std::make_unique<DetectionThread>(
        [&source](int index, const Image<std::uint8_t>& raw) { return source.detect(index, raw); });
  }

  /// Before the frame is processed. Returns the ms it took.
  double before(Frame& frame, const Image<std::uint8_t>& raw, System& system) {
    of_frames_.add({});
    if (thread_)
      for (DetectionThread::Result& result : thread_->collect()) {
        remember(result.frame, result.detections);
        system.add_detections(result.frame, std::move(result.detections), result.ms);
      }
    if (!in_step_) return 0;
    const double start = now_ms();
    frame.detections = source_.detect(frame.index, raw);
    const double ms = now_ms() - start;
    remember(frame.index, frame.detections);
    return ms;
  }
  void after(int index, const RawImage& raw, const Map& map) {
    if (!thread_) return;
    const bool keyframe = !map.keyframes.empty() && map.keyframes.back().frame.index == index;
    thread_->offer(index, raw, keyframe);
  }
  void end() { thread_.reset(); }
  /// By the index of the frame, of as many as a report can show.
  const std::map<int, std::vector<Detection>>& of_frames() const { return of_frames_.kept(); }

 private:
  void remember(int frame, const std::vector<Detection>& detections) {
    if (std::vector<Detection>* kept = of_frames_.find(frame)) *kept = detections;
  }

  FrameSource& source_;
  bool in_step_ = false;
  BoundedSampler<std::vector<Detection>> of_frames_{2 * kReportFrames};
  std::unique_ptr<DetectionThread> thread_;
};

// Broken input ends a step but not the run: what was computed is written. The first message is reported.
template <class Step>
void keep_going(RunResult& result, Step step) {
  try {
    step();
  } catch (const InputError& error) {
    if (result.error.empty()) result.error = error.what();
  }
}

// How many frames the options ask for.
int count_frames(const Sequence& sequence, const RunOptions& options) {
  const int count = static_cast<int>(sequence.frames.size());
  const int last = options.last < 0 ? count - 1 : options.last;
  if (options.first < 0 || options.first > last || last >= count)
    throw InputError(sequence.images_file, 0,
                     "frames " + std::to_string(options.first) + " to " + std::to_string(last) +
                         " asked for, but it has 0 to " + std::to_string(count - 1));
  return last - options.first + 1;
}

// Takes the frames one by one, until the last or a signal.
void track_frames(const RunOptions& options, int total, FrameSource& source, Clock& clock, Detections& detections,
                  System& system, RunResult& result) {
  Progress progress("tracking");
  for (int index = 0; index < total && !result.interrupted; ++index) {
    clock.wait_for(source.timestamp(index));
    const RawImage raw = source.load(index);
    Frame frame = source.frame(index, *raw);
    const double detect_ms = detections.before(frame, *raw, system);
    const FrameRecord& record = system.process(frame, detect_ms);
    clock.done();
    detections.after(index, raw, system.map());
    progress.show(static_cast<std::size_t>(index + 1), static_cast<std::size_t>(total),
                  std::string(to_string(record.state)) + ", " + std::to_string(record.points) + " points, " +
                      std::to_string(record.texts) + " texts");
    if (options.json_lines) print_line(frame_line(index, record, system.map()));
    if (interrupted() == 0 || index + 1 == total) continue;
    result.interrupted = true;
    result.error = "interrupted after frame " + std::to_string(index) + "; what was computed is in " + options.output;
  }
}

}  // namespace

RunResult run(const RunOptions& options) {
  const Sequence sequence = read_sequence(options.sequence, options.input);
  const int total = count_frames(sequence, options);
  FrameSource source(sequence, options);
  create_output_folder(options.output);

  RunResult result;
  System system(sequence.camera.pinhole(), sequence.camera.width, sequence.camera.height, options.parameters);
  Clock clock(options.parameters.real_time);
  Detections detections(source, options);
  keep_going(result, [&] { track_frames(options, total, source, clock, detections, system, result); });
  detections.end();
  system.finish();
  source.read_texts(system);
  keep_going(result, [&] { system.fill_in([&](int index) { return source.frame(index, *source.load(index)); }); });

  RunSummary& summary = result.summary;
  summary = summarise(system, sequence, static_cast<std::size_t>(total));
  summary.latency_ms = clock.latency_ms();
  std::vector<TrueSign> signs;
  if (is_aligned(summary))
    keep_going(result, [&] {
      signs = read_true_signs(sequence);
      summary.text = evaluate_text(system.map(), signs, summary.trajectory.alignment);
    });
  std::exception_ptr failure;
  try {
    const auto image = [&](int index) { return frame_name(sequence, static_cast<std::size_t>(options.first + index)); };
    write_outputs(options.output, system, summary, image);
  } catch (const std::exception&) {
    failure = std::current_exception();
  }
  if (options.report)
    keep_going(result, [&] {
      const auto picture = [&](int index) { return source.image(index); };
      const ReportInput input{system,  options.parameters, sequence,     summary, signs, detections.of_frames(),
                              picture, options.command,    options.first};
      const std::string path = options.output + "/report.html";
      write_file(path, report_html(input));
      result.report = path;
    });
  if (options.json_lines) print_line(Json{{"summary", describe(summary).file}}.dump());
  if (failure) std::rethrow_exception(failure);
  return result;
}

}  // namespace textslam
