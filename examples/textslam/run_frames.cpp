#include "textslam/run_frames.hpp"

#include <utility>

#include "io/clock.hpp"
#include "textslam/input/make_frame.hpp"
#include "textslam/report/report_frames.hpp"

namespace textslam {

FrameSource::FrameSource(const Sequence& sequence, const RunOptions& options)
    : sequence_(sequence),
      parameters_(at_size(options.parameters, sequence.camera.width, sequence.camera.height)),
      detector_(options.own_detector ? options.own_detector : make_detector(options.detector, sequence)),
      reader_(options.parameters.mode == Mode::points ? nullptr : make_reader(options.detector)) {}

FrameSource::RawImage FrameSource::take(std::size_t at) {
  Pixels pixels{load_frame(sequence_, at)};
  if (parameters_.mode != Mode::points && detector_->wants_colour()) pixels.colour = load_colour(sequence_, at);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (next_ == taken_.size()) taken_.push_back(at);
  ++next_;
  return std::make_shared<const Pixels>(std::move(pixels));
}

std::vector<Detection> FrameSource::detect(int index, const Pixels& raw) {
  FrameRef frame = sequence_.frames[at(index)];
  frame.colour = raw.colour;
  return detector_->detect(frame, raw.grey.view());
}

Frame FrameSource::frame(int index, Image<std::uint8_t> image) const {
  return make_frame(index, timestamp(index), std::move(image), parameters_);
}

void FrameSource::read_texts(System& system) const {
  if (reader_) system.read_texts(*reader_);
}

std::size_t FrameSource::at(int index) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return taken_[static_cast<std::size_t>(index)];
}

Detections::Detections(FrameSource& source, const RunOptions& options)
    : source_(source), of_frames_(2 * kReportFrames) {
  const Parameters& parameters = options.parameters;
  if (parameters.mode == Mode::points) return;
  in_step_ = !parameters.real_time || (!options.own_detector && options.detector.name == "files");
  if (in_step_) return;
  thread_ =
      std::make_unique<DetectionThread>([&source](int index, const Pixels& raw) { return source.detect(index, raw); });
}

double Detections::before(Frame& frame, const Pixels& raw, System& system) {
  if (frame.index < frames_) {
    if (!in_step_) return 0;
    const Said& said = said_[static_cast<std::size_t>(frame.index)];
    frame.detections = said.boxes;
    return said.ms;
  }
  ++frames_;
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
  said_.push_back({frame.detections, ms});
  return ms;
}

void Detections::after(int index, const RawImage& raw, const Map& map) {
  if (!thread_) return;
  const bool keyframe = !map.keyframes.empty() && map.keyframes.back().frame.index == index;
  thread_->offer(index, raw, keyframe);
}

void Detections::remember(int frame, const std::vector<Detection>& detections) {
  count_ += detections.size();
  if (std::vector<Detection>* kept = of_frames_.find(frame)) *kept = detections;
}

}  // namespace textslam
