#include "textslam/run.hpp"

#include <exception>
#include <memory>
#include <mutex>
#include <optional>

#include "cli/progress.hpp"
#include "io/clock.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "io/interrupt.hpp"
#include "io/output_file.hpp"
#include "textslam/common/bounded_sampler.hpp"
#include "textslam/detect/detection_thread.hpp"
#include "textslam/detect/text_detector.hpp"
#include "textslam/input/frame_clock.hpp"
#include "textslam/input/make_frame.hpp"
#include "textslam/input/sequence_camera.hpp"
#include "textslam/map_session.hpp"
#include "textslam/report/calibration.hpp"
#include "textslam/report/frame_line.hpp"
#include "textslam/report/outputs.hpp"
#include "textslam/report/report.hpp"
#include "textslam/report/report_frames.hpp"
#include "textslam/run_camera.hpp"

namespace textslam {
namespace {

using RawImage = DetectionThread::RawImage;
using Pixels = DetectionThread::Pixels;

// Loads and detects. Frames are numbered in the order in which they were taken. Another thread may call
// detect().
class FrameSource {
 public:
  FrameSource(const Sequence& sequence, const RunOptions& options)
      : sequence_(sequence),
        parameters_(at_size(options.parameters, sequence.camera.width, sequence.camera.height)),
        detector_(options.own_detector ? options.own_detector : make_detector(options.detector, sequence)),
        reader_(options.parameters.mode == Mode::points ? nullptr : make_reader(options.detector)) {}

  /// Takes the frame `at` of the sequence as the next one. Throws InputError where it cannot be read.
  RawImage take(std::size_t at) {
    Pixels pixels{load_frame(sequence_, at)};
    if (parameters_.mode != Mode::points && detector_->wants_colour()) pixels.colour = load_colour(sequence_, at);
    const std::lock_guard<std::mutex> lock(mutex_);
    taken_.push_back(at);
    return std::make_shared<const Pixels>(std::move(pixels));
  }
  double timestamp(int index) const { return sequence_.frames[at(index)].timestamp; }
  /// The frame of the sequence that was taken last; -1: none.
  int last() const { return taken_.empty() ? -1 : static_cast<int>(taken_.back()); }
  std::string name(int index) const { return frame_name(sequence_, at(index)); }
  std::vector<Detection> detect(int index, const Pixels& raw) {
    FrameRef frame = sequence_.frames[at(index)];
    frame.colour = raw.colour;
    return detector_->detect(frame, raw.grey.view());
  }
  Frame frame(int index, Image<std::uint8_t> image) const {
    return make_frame(index, timestamp(index), std::move(image), parameters_);
  }
  Frame frame(int index) const { return frame(index, load_frame(sequence_, at(index))); }
  void read_texts(System& system) const {
    if (reader_) system.read_texts(*reader_);
  }

 private:
  std::size_t at(int index) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return taken_[static_cast<std::size_t>(index)];
  }

  const Sequence& sequence_;
  Parameters parameters_;
  mutable std::mutex mutex_;        // of taken_
  std::vector<std::size_t> taken_;  // frames of the sequence
  std::shared_ptr<TextDetector> detector_;
  std::unique_ptr<TextReader> reader_;
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
        [&source](int index, const Pixels& raw) { return source.detect(index, raw); });
  }

  /// Before the frame is processed. Returns the ms it took.
  double before(Frame& frame, const Pixels& raw, System& system) {
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
  /// Boxes of all frames.
  std::size_t count() const { return count_; }
  /// By the index of the frame, of as many as a report can show.
  const std::map<int, std::vector<Detection>>& of_frames() const { return of_frames_.kept(); }

 private:
  void remember(int frame, const std::vector<Detection>& detections) {
    count_ += detections.size();
    if (std::vector<Detection>* kept = of_frames_.find(frame)) *kept = detections;
  }

  FrameSource& source_;
  bool in_step_ = false;
  std::size_t count_ = 0;
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

// The frames that the options ask for.
std::vector<std::size_t> frames_asked(const Sequence& sequence, const RunOptions& options) {
  const int count = static_cast<int>(sequence.frames.size());
  const int last = options.last < 0 ? count - 1 : options.last;
  if (options.first < 0 || options.first > last || last >= count)
    throw InputError(sequence.images_file, 0,
                     "frames " + std::to_string(options.first) + " to " + std::to_string(last) +
                         " asked for, but it has 0 to " + std::to_string(count - 1));
  std::vector<std::size_t> frames;
  for (int at = options.first; at <= last; at += options.every) frames.push_back(static_cast<std::size_t>(at));
  return frames;
}

// The next frame; null where it is broken and is to be passed over.
RawImage take(std::size_t at, const RunOptions& options, FrameSource& source, RunResult& result) {
  try {
    return source.take(at);
  } catch (const InputError&) {
    if (!options.skip_broken) throw;
    ++result.summary.broken;
    return nullptr;
  }
}

// Takes the frames one by one, until the last or a signal.
void track_frames(const RunOptions& options, const Sequence& sequence, const std::vector<std::size_t>& asked,
                  FrameSource& source, FrameClock& clock, Detections& detections, System& system, RunResult& result) {
  Progress progress("tracking");
  int index = 0;
  for (std::size_t i = 0; i < asked.size() && !result.interrupted; ++i) {
    clock.wait_for(sequence.frames[asked[i]].timestamp);
    const RawImage raw = take(asked[i], options, source, result);
    if (!raw) continue;
    Frame frame = source.frame(index, raw->grey);
    const double detect_ms = detections.before(frame, *raw, system);
    const FrameRecord& record = system.process(frame, detect_ms);
    clock.done();
    detections.after(index, raw, system.map());
    progress.show(i + 1, asked.size(),
                  std::string(to_string(record.state)) + ", " + counted(record.points, "point") + ", " +
                      counted(record.texts, "text"));
    if (options.json_lines) print_line(frame_line(index, record, system.map(), system.live_world()));
    ++index;
    if (interrupted() == 0 || i + 1 == asked.size()) continue;
    result.interrupted = true;
    result.error =
        "interrupted after frame " + std::to_string(index - 1) + "; what was computed is in " + options.output;
  }
}

std::string no_scale(const std::vector<KnownLength>& lengths) {
  const KnownLength& first = lengths.front();
  return (first.other.empty() ? "no mapped text reads '" + first.word + "'"
                              : "'" + first.word + "' and '" + first.other + "' are not on one mapped text each") +
         (lengths.size() > 1 ? ", and no other length counts" : "") + ": the map has no scale";
}

// By what is known of signs.
std::optional<MetricScale> make_metric(const RunOptions& options, System* system) {
  if (options.lengths.empty()) return std::nullopt;
  const Map& map = system->map();
  const MetricScale scale = metric_scale(map, at_size(options.parameters, map.width, map.height), options.lengths);
  if (scale.texts == 0) throw InputError("--scale", 0, no_scale(options.lengths));
  system->scale_by(scale.metres);
  return scale;
}

void write_camera(const RunOptions& options, CameraModel camera, double readout,
                  const std::optional<SelfCalibration>& calibration) {
  camera.shutter.readout = readout;
  write_file(options.output + "/camera.yaml", camera_yaml(camera, calibration));
}

void name_detector(const RunOptions& options, std::size_t detected, RunSummary* summary) {
  summary->detected = detected;
  if (options.parameters.mode == Mode::points) return;
  summary->detector = options.own_detector ? "of the program" : options.detector.name;
  if (summary->detector == "files") summary->median_detect_ms = 0;  // they were only read
}

RunResult run_with_camera(const RunOptions& options, const Sequence& sequence, const std::vector<std::size_t>& asked,
                          const std::optional<SelfCalibration>& calibration, MapSession& session) {
  const SequenceCamera camera(sequence.camera);
  FrameSource source(sequence, options);
  create_output_folder(options.output);

  RunResult result;
  System system(camera.view(), sequence.camera.width, sequence.camera.height, options.parameters,
                sequence.camera.shutter);
  session.begin(&system);
  FrameClock clock(options.parameters.real_time);
  Detections detections(source, options);
  keep_going(result, [&] { track_frames(options, sequence, asked, source, clock, detections, system, result); });
  detections.end();
  system.finish();
  source.read_texts(system);
  keep_going(result, [&] { system.fill_in([&](int index) { return source.frame(index); }); });

  std::optional<MetricScale> metric;
  keep_going(result, [&] { metric = make_metric(options, &system); });

  RunSummary& summary = result.summary;
  const std::size_t broken = summary.broken;
  summary = summarise(system, sequence, asked.size());
  summary.calibration = calibration;
  summary.metric = metric;
  summary.broken = broken;
  summary.latency_ms = clock.latency_ms();
  name_detector(options, detections.count(), &summary);
  std::vector<TrueSign> signs;
  if (is_aligned(summary))
    keep_going(result, [&] {
      signs = read_true_signs(sequence);
      summary.text = evaluate_text(system.map(), signs, summary.trajectory.alignment);
    });
  std::exception_ptr failure;
  try {
    const auto image = [&](int index) { return index < 0 ? session.image(index) : source.name(index); };
    write_outputs(options.output, system, summary, image);
    result.unmapped = session.save(system, sequence.camera, metric, image);
    if (calibration || options.parameters.estimate_readout)
      write_camera(options, sequence.camera, system.map().shutter.readout, calibration);
  } catch (const std::exception&) {
    failure = std::current_exception();
  }
  if (options.report)
    keep_going(result, [&] {
      const auto picture = [&](int index) { return source.frame(index).image; };
      const ReportInput input{system,        options.parameters,     sequence,     summary,
                              signs,         detections.of_frames(), picture,      options.command,
                              options.first, source.last(),          options.every};
      const std::string path = options.output + "/report.html";
      write_file(path, report_html(input));
      result.report = path;
    });
  if (options.json_lines) print_line(Json{{"summary", describe(summary).file}}.dump());
  if (failure) std::rethrow_exception(failure);
  return result;
}

}  // namespace

RunResult run(const RunOptions& options) {
  SequenceOptions input = options.input;
  input.assumes_camera = options.calibrate != Calibrate::never;
  Sequence sequence = read_sequence(options.sequence, input);
  know_rows(options, &sequence.camera);
  const std::vector<std::size_t> asked = frames_asked(sequence, options);
  MapSession session(options, &sequence);
  std::optional<SelfCalibration> calibration;
  if (!session.has_earlier()) calibration = know_camera(options, asked, &sequence);
  RunOptions known = options;
  known.parameters.estimate_readout = know_turns(options, asked, &sequence);
  return run_with_camera(known, sequence, asked, calibration, session);
}

}  // namespace textslam
