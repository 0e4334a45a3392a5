#include "textslam/run.hpp"

#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "cli/progress.hpp"
#include "io/input_error.hpp"
#include "io/interrupt.hpp"
#include "io/output_file.hpp"
#include "textslam/calibrate/camera_check.hpp"
#include "textslam/input/frame_clock.hpp"
#include "textslam/input/sequence_camera.hpp"
#include "textslam/map_session.hpp"
#include "textslam/report/calibration.hpp"
#include "textslam/report/frame_line.hpp"
#include "textslam/report/outputs.hpp"
#include "textslam/report/report.hpp"
#include "textslam/run_camera.hpp"
#include "textslam/run_frames.hpp"

namespace textslam {
namespace {

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

// The frames mapped with one camera.
struct Mapping {
  Mapping(const RunOptions& options, const Sequence& sequence)
      : camera(sequence.camera),
        system(camera.view(), sequence.camera.width, sequence.camera.height, options.parameters,
               sequence.camera.shutter),
        clock(options.parameters.real_time) {}

  SequenceCamera camera;
  System system;
  FrameClock clock;
  RunResult result;
};

// A run: what its steps share.
class Run {
 public:
  Run(const RunOptions& options, Sequence* sequence, std::vector<std::size_t> asked, MapSession& session)
      : options_(options),
        sequence_(*sequence),
        asked_(std::move(asked)),
        session_(session),
        source_(sequence_, options_),
        detections_(source_, options_) {
    create_output_folder(options.output);
  }

  RunResult run(std::optional<SelfCalibration> calibration, bool checks_camera) {
    calibration_ = std::move(calibration);
    mapping_ = map_frames("tracking");
    if (checks_camera) check_camera();
    System& system = mapping_->system;
    RunResult& result = mapping_->result;
    source_.read_texts(system);
    keep_going(result, [&] { system.fill_in([&](int index) { return source_.frame(index); }); });
    keep_going(result, [&] { metric_ = make_metric(options_, &system); });
    summarise_run();
    std::exception_ptr failure;
    try {
      write();
    } catch (const std::exception&) {
      failure = std::current_exception();
    }
    if (options_.report) keep_going(result, [&] { report(); });
    if (options_.json_lines) print_line(Json{{"summary", describe(result.summary).file}}.dump());
    if (failure) std::rethrow_exception(failure);
    return std::move(result);
  }

 private:
  std::unique_ptr<Mapping> map_frames(const char* step) {
    auto mapping = std::make_unique<Mapping>(options_, sequence_);
    session_.begin(&mapping->system);
    keep_going(mapping->result, [&] { track_frames(step, mapping.get()); });
    detections_.end();
    mapping->system.finish();
    return mapping;
  }

  // Takes the frames one by one, until the last or a signal.
  void track_frames(const char* step, Mapping* mapping) {
    System& system = mapping->system;
    RunResult& result = mapping->result;
    Progress progress(step);
    int index = 0;
    for (std::size_t i = 0; i < asked_.size() && !result.interrupted; ++i) {
      mapping->clock.wait_for(sequence_.frames[asked_[i]].timestamp);
      const FrameSource::RawImage raw = take(asked_[i], &result);
      if (!raw) continue;
      Frame frame = source_.frame(index, raw->grey);
      const double detect_ms = detections_.before(frame, *raw, system);
      const FrameRecord& record = system.process(frame, detect_ms);
      mapping->clock.done();
      detections_.after(index, raw, system.map());
      progress.show(i + 1, asked_.size(),
                    std::string(to_string(record.state)) + ", " + counted(record.points, "point") + ", " +
                        counted(record.texts, "text"));
      if (options_.json_lines) print_line(frame_line(index, record, system.map(), system.live_world()));
      ++index;
      if (interrupted() == 0 || i + 1 == asked_.size()) continue;
      result.interrupted = true;
      result.error =
          "interrupted after frame " + std::to_string(index - 1) + "; what was computed is in " + options_.output;
    }
  }

  // The next frame; null where it is broken and is to be passed over.
  FrameSource::RawImage take(std::size_t at, RunResult* result) {
    try {
      return source_.take(at);
    } catch (const InputError&) {
      if (!options_.skip_broken) throw;
      ++result->summary.broken;
      return nullptr;
    }
  }

  // Maps again where the map says that another camera took the images.
  void check_camera() {
    const CameraModel given = sequence_.camera;
    if (!mapping_->result.error.empty()) return;
    const CameraCheckOptions check;
    const std::optional<SelfCalibration> better =
        better_camera(mapping_->system.map(), given, at_size(options_.parameters, given.width, given.height), check);
    if (!better) return;
    sequence_.camera = better->camera;
    source_.rewind();
    std::unique_ptr<Mapping> again = map_frames("tracking again");
    if (again->result.error.empty() && static_cast<double>(again->system.live_frames()) >=
                                           check.least_live * static_cast<double>(mapping_->system.live_frames())) {
      mapping_ = std::move(again);
      calibration_ = better;
      return;
    }
    sequence_.camera = given;
    mapping_->result.interrupted = again->result.interrupted;
    if (!again->result.error.empty())
      mapping_->result.error = again->result.error + " (that was with a better camera; the map is of the one given)";
  }

  void summarise_run() {
    RunResult& result = mapping_->result;
    RunSummary& summary = result.summary;
    const std::size_t broken = summary.broken;
    summary = summarise(mapping_->system, sequence_, asked_.size());
    summary.calibration = calibration_;
    summary.metric = metric_;
    summary.broken = broken;
    summary.latency_ms = mapping_->clock.latency_ms();
    name_detector(options_, detections_.count(), &summary);
    if (!is_aligned(summary)) return;
    keep_going(result, [&] {
      signs_ = read_true_signs(sequence_);
      summary.text = evaluate_text(mapping_->system.map(), signs_, summary.trajectory.alignment);
    });
  }

  void write() {
    const System& system = mapping_->system;
    RunResult& result = mapping_->result;
    const auto image = [&](int index) { return index < 0 ? session_.image(index) : source_.name(index); };
    write_outputs(options_.output, system, result.summary, image);
    result.unmapped = session_.save(system, sequence_.camera, {options_.save_map, options_.output, metric_, image});
    if (calibration_ || options_.parameters.estimate_readout)
      write_camera(options_, sequence_.camera, system.map().shutter.readout, calibration_);
  }

  void report() {
    const auto picture = [&](int index) { return source_.frame(index).image; };
    RunResult& result = mapping_->result;
    const ReportInput input{mapping_->system, options_.parameters,     sequence_,     result.summary,
                            signs_,           detections_.of_frames(), picture,       options_.command,
                            options_.first,   source_.last(),          options_.every};
    const std::string path = options_.output + "/report.html";
    write_file(path, report_html(input));
    result.report = path;
  }

  const RunOptions& options_;
  Sequence& sequence_;
  std::vector<std::size_t> asked_;
  MapSession& session_;
  FrameSource source_;
  Detections detections_;
  std::unique_ptr<Mapping> mapping_;
  std::optional<SelfCalibration> calibration_;
  std::optional<MetricScale> metric_;
  std::vector<TrueSign> signs_;
};

// Only a calibration is checked, and only where nobody follows the frames while they come. A map of earlier sessions
// keeps its camera.
bool checks_camera(const RunOptions& options, const Sequence& sequence, const MapSession& session) {
  const bool is_followed = options.parameters.real_time || options.json_lines;
  return options.calibrate == Calibrate::automatic && sequence.camera_origin == CameraOrigin::file && !is_followed &&
         !session.has_earlier();
}

}  // namespace

RunResult run(const RunOptions& options) {
  SequenceOptions input = options.input;
  input.assumes_camera = options.calibrate != Calibrate::never;
  Sequence sequence = read_sequence(options.sequence, input);
  know_rows(options, &sequence.camera);
  std::vector<std::size_t> asked = frames_asked(sequence, options);
  if (!options.localise && !options.save_map.empty()) check_can_save(options.save_map);
  MapSession session({options.map, options.localise, options.sequence, options.command, options.parameters}, &sequence);
  if (session.has_earlier() && !options.localise && options.save_map.empty()) check_can_save(options.map);
  std::optional<SelfCalibration> calibration;
  if (!session.has_earlier()) calibration = know_camera(options, asked, &sequence);
  RunOptions known = options;
  known.parameters.estimate_readout = know_turns(options, asked, &sequence);
  return Run(known, &sequence, std::move(asked), session)
      .run(std::move(calibration), checks_camera(options, sequence, session));
}

}  // namespace textslam
