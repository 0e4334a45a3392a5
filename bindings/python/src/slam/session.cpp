#include "slam/session.hpp"

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "io/output_file.hpp"
#include "textslam/input/make_frame.hpp"
#include "textslam/report/outputs.hpp"
#include "textslam/report/report.hpp"

namespace textslam {

namespace {

Sequence sequence_of(const CameraModel& camera) {
  Sequence sequence;
  sequence.folder = "images given one by one";
  sequence.images_file = sequence.folder;
  sequence.camera = camera;
  sequence.camera.shutter = all_at_once(camera.height);
  return sequence;
}

}  // namespace

Session::Session(const CameraModel& camera, const Parameters& parameters, bool keep_images)
    : parameters_(at_size(parameters, camera.width, camera.height)),
      sequence_(sequence_of(camera)),
      camera_(sequence_.camera),
      system_(camera_.view(), camera.width, camera.height, parameters, sequence_.camera.shutter),
      keep_images_(keep_images) {}

const FrameRecord& Session::process(ImageView8 image, double timestamp, std::vector<Detection> detections,
                                    double detect_ms) {
  if (finished_) throw std::invalid_argument("process: the run has ended");
  if (image.width() != sequence_.camera.width || image.height() != sequence_.camera.height)
    throw std::invalid_argument("image: expected " + std::to_string(sequence_.camera.width) + " x " +
                                std::to_string(sequence_.camera.height) + " pixels");
  if (!std::isfinite(timestamp) || (!sequence_.frames.empty() && !(timestamp > sequence_.frames.back().timestamp)))
    throw std::invalid_argument("timestamp: expected a later time than the frame before");
  Image<std::uint8_t> pixels(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y)
    std::memcpy(pixels.row(y), image.row(y), static_cast<std::size_t>(image.width()));
  const int index = static_cast<int>(sequence_.frames.size());
  FrameRef ref;
  ref.timestamp = timestamp;
  ref.stem = std::to_string(index);
  ref.path = ref.stem;
  sequence_.frames.push_back(std::move(ref));
  Frame frame = make_frame(index, timestamp, std::move(pixels), parameters_);
  if (keep_images_) {
    kept_.push_back(frame);
    detections_[index] = detections;
  }
  detected_ += detections.size();
  frame.detections = std::move(detections);
  return system_.process(frame, detect_ms);
}

void Session::finish() {
  if (finished_) return;
  finished_ = true;
  system_.finish();
  if (keep_images_) system_.fill_in([this](int index) { return kept_[static_cast<std::size_t>(index)]; });
}

RunSummary Session::summary() const {
  RunSummary summary = summarise(system_, sequence_, sequence_.frames.size());
  if (parameters_.mode != Mode::points) summary.detector = "of the program";
  summary.detected = detected_;
  return summary;
}

void Session::save(const std::string& folder) {
  finish();
  create_output_folder(folder);
  write_outputs(folder, system_, summary(),
                [this](int index) { return sequence_.frames[static_cast<std::size_t>(index)].path; });
  const std::string page = report();
  if (!page.empty()) write_file(folder + "/report.html", page);
}

std::string Session::report() {
  if (!keep_images_ || kept_.empty()) return {};
  finish();
  const RunSummary numbers = summary();
  const ReportInput input{system_,
                          parameters_,
                          sequence_,
                          numbers,
                          {},
                          detections_,
                          [this](int index) { return kept_[static_cast<std::size_t>(index)].image; },
                          {"textplane.slam.System"},
                          0,
                          static_cast<int>(sequence_.frames.size()) - 1,
                          1};
  return report_html(input);
}

}  // namespace textslam
