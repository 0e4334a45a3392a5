#include "textslam/session.hpp"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "io/input_error.hpp"
#include "io/output_file.hpp"
#include "textslam/input/make_frame.hpp"
#include "textslam/report/calibration.hpp"
#include "textslam/report/outputs.hpp"
#include "textslam/report/report.hpp"

namespace textslam {

namespace {

Sequence without_frames(Sequence sequence) {
  sequence.frames.clear();
  return sequence;
}

}  // namespace

Sequence sequence_of(const CameraModel& camera) {
  Sequence sequence;
  sequence.folder = "images given one by one";
  sequence.images_file = sequence.folder;
  sequence.camera = camera;
  sequence.camera.shutter = all_at_once(camera.height);
  return sequence;
}

Session::Session(Sequence sequence, const SessionOptions& options)
    : options_(options),
      at_size_(at_size(options.parameters, sequence.camera.width, sequence.camera.height)),
      sequence_(without_frames(std::move(sequence))),
      map_({options.map, options.localise, sequence_.folder, options.command, options.parameters}, &sequence_),
      camera_(sequence_.camera),
      system_(camera_.view(), sequence_.camera.width, sequence_.camera.height, options.parameters,
              sequence_.camera.shutter) {
  map_.begin(&system_);
}

const FrameRecord& Session::process(ImageView8 image, double timestamp, std::vector<Detection> detections,
                                    double detect_ms) {
  FrameRef frame;
  frame.timestamp = timestamp;
  frame.stem = std::to_string(frames());
  frame.path = sequence_.folder + "/" + frame.stem;
  return process(std::move(frame), image, std::move(detections), detect_ms);
}

const FrameRecord& Session::process(FrameRef ref, ImageView8 image, std::vector<Detection> detections,
                                    double detect_ms) {
  if (finished_) throw std::invalid_argument("process: the run has ended");
  if (image.width() != sequence_.camera.width || image.height() != sequence_.camera.height)
    throw std::invalid_argument("image: expected " + std::to_string(sequence_.camera.width) + " x " +
                                std::to_string(sequence_.camera.height) + " pixels");
  const double timestamp = ref.timestamp;
  if (!std::isfinite(timestamp) || (!sequence_.frames.empty() && !(timestamp > sequence_.frames.back().timestamp)))
    throw std::invalid_argument("timestamp: expected a later time than the frame before");
  Image<std::uint8_t> pixels(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y)
    std::memcpy(pixels.row(y), image.row(y), static_cast<std::size_t>(image.width()));
  const int index = static_cast<int>(sequence_.frames.size());
  sequence_.frames.push_back(std::move(ref));
  const std::size_t bytes = static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
  const bool all_before = images_.size() == static_cast<std::size_t>(index);
  if (options_.keep_images && all_before && image_bytes_ + bytes <= options_.most_image_bytes) {
    image_bytes_ += bytes;
    images_.push_back(pixels);
    detections_[index] = detections;
  }
  detected_ += detections.size();
  Frame frame = make_frame(index, timestamp, std::move(pixels), at_size_);
  frame.detections = std::move(detections);
  return system_.process(frame, detect_ms);
}

void Session::add_detections(int frame, std::vector<Detection> detections, double detect_ms) {
  if (finished_ || frame < 0 || static_cast<std::size_t>(frame) >= frames())
    throw std::invalid_argument("add_detections: no frame " + std::to_string(frame));
  detected_ += detections.size();
  if (const auto shown = detections_.find(frame); shown != detections_.end()) shown->second = detections;
  system_.add_detections(frame, std::move(detections), detect_ms);
}

Frame Session::kept(int index) const {
  const auto at = static_cast<std::size_t>(index);
  if (at >= images_.size()) throw InputError("frame " + std::to_string(index), 0, "its image was not kept");
  return make_frame(index, sequence_.frames[at].timestamp, images_[at], at_size_);
}

void Session::finish() {
  if (finished_) return;
  finished_ = true;
  system_.finish();
  if (images_.empty()) return;
  try {
    system_.fill_in([this](int index) { return kept(index); });
  } catch (const InputError&) {
    sequence_.notes.push_back("only the images of the first " + std::to_string(images_.size()) +
                              " frames were kept: frames without a pose were not filled in");
  }
}

void Session::read_texts(TextReader& reader) {
  finish();
  system_.read_texts(reader);
}

RunSummary Session::summary() {
  finish();
  RunSummary summary = summarise(system_, sequence_, sequence_.frames.size());
  if (options_.parameters.mode != Mode::points) summary.detector = options_.detector;
  summary.detected = detected_;
  summary.calibration = options_.calibration;
  if (!is_aligned(summary)) return summary;
  signs_ = read_true_signs(sequence_);
  summary.text = evaluate_text(system_.map(), signs_, summary.trajectory.alignment);
  return summary;
}

std::string Session::save(const std::string& folder) {
  create_output_folder(folder);
  const auto image = [this](int index) { return image_name(index); };
  write_outputs(folder, system_, summary(), image);
  std::string unmapped;
  if (options_.localise) unmapped = map_.save(system_, sequence_.camera, {"", folder, std::nullopt, image});
  if (options_.calibration) write_file(folder + "/camera.yaml", camera_yaml(sequence_.camera, options_.calibration));
  const std::string page = report();
  if (!page.empty()) write_file(folder + "/report.html", page);
  return unmapped;
}

std::string Session::image_name(int index) const {
  return index < 0 ? map_.image(index) : frame_name(sequence_, static_cast<std::size_t>(index));
}

std::string Session::save_map(const std::string& path) {
  if (options_.localise) throw std::invalid_argument("save_map: the run only localises");
  const std::string& file = path.empty() ? options_.map : path;
  if (file.empty()) throw std::invalid_argument("save_map: expected a path, as the run began in no map");
  finish();
  if (!has_map(system_)) throw std::invalid_argument("save_map: there is no map of two key frames");
  const std::string folder = std::filesystem::path(file).parent_path().string();
  return map_.save(system_, sequence_.camera, {path, folder.empty() ? "." : folder, std::nullopt, [this](int index) {
                                                 return image_name(index);
                                               }});
}

std::string Session::report() {
  if (images_.empty()) return {};
  const RunSummary numbers = summary();
  const ReportInput input{system_,
                          options_.parameters,
                          sequence_,
                          numbers,
                          signs_,
                          detections_,
                          [this](int index) { return kept(index).image; },
                          options_.command,
                          0,
                          static_cast<int>(sequence_.frames.size()) - 1,
                          1};
  return report_html(input);
}

}  // namespace textslam
