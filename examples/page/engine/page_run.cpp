#include "page_run.hpp"

#include <algorithm>
#include <cstdio>

#include "io/input_error.hpp"

namespace textslam {
namespace {

constexpr std::size_t kMostImageBytes = std::size_t{3} << 29;  // of 4 GB that a module can have

Sequence without_images(const std::string& folder, const std::string& video) {
  Sequence sequence;
  sequence.folder = folder;
  sequence.images_file = folder + "/" + video;
  if (const std::string camera = find_camera(folder); !camera.empty()) sequence.camera = read_camera(camera);
  sequence.groundtruth = read_groundtruth(folder);
  return sequence;
}

Sequence read(const std::string& folder, const std::string& video) {
  if (!video.empty()) return without_images(folder, video);
  SequenceOptions options;
  options.needs_camera = false;
  return read_sequence(folder, options);
}

std::string size_text(int width, int height) { return std::to_string(width) + " x " + std::to_string(height); }

}  // namespace

// The frames that self-calibration maps again and again.
class KeptFrames : public VideoFile {
 public:
  const std::vector<double>& times() const override { return times_; }
  Image<std::uint8_t> load(std::size_t index) override { return images_.at(index); }
  Image<std::uint8_t> load_colour(std::size_t) override { return {}; }
  std::size_t damaged() const override { return 0; }
  void add(double time, ImageView8 image) {
    times_.push_back(time);
    Image<std::uint8_t>& copy = images_.emplace_back(image.width(), image.height());
    for (int y = 0; y < image.height(); ++y) std::copy_n(image.row(y), image.width(), copy.row(y));
  }

 private:
  std::vector<double> times_;
  std::vector<Image<std::uint8_t>> images_;
};

PageRun::PageRun(const std::string& folder, const std::string& video) : sequence_(read(folder, video)) {}

Json PageRun::sequence() const {
  Json frames = Json::array();
  for (const FrameRef& frame : sequence_.frames) frames.push_back({{"path", frame.path}, {"time", frame.timestamp}});
  const CameraModel& camera = sequence_.camera;
  return {{"frames", frames},
          {"camera", camera.width > 0 ? Json{{"width", camera.width}, {"height", camera.height}} : Json(nullptr)},
          {"truth", sequence_.groundtruth.size()}};
}

void PageRun::keep(double time, ImageView8 image) {
  if (!kept_) kept_ = std::make_shared<KeptFrames>();
  kept_->add(time, image);
}

Json PageRun::calibrate(double fov, const std::function<void(std::size_t, std::size_t)>& progress) {
  const Image<std::uint8_t> first = kept_->load(0);
  assume_camera(first.width(), first.height(), fov);
  if (fov == kAssumedFov) sequence_.camera_origin = CameraOrigin::assumed;
  Sequence sequence = sequence_;
  sequence.video = kept_;
  sequence.frames.clear();
  std::vector<std::size_t> frames;
  for (const double time : kept_->times()) {
    frames.push_back(frames.size());
    sequence.frames.push_back({time, sequence.images_file, std::to_string(frames.back()), 0});
  }
  calibration_ = take_estimated_camera(&sequence, frames, Parameters(), false, progress);
  kept_.reset();
  sequence_.camera = sequence.camera;
  sequence_.approximate_fov = sequence.approximate_fov;
  return {{"determined", calibration_->determined}};
}

void PageRun::assume_camera(int width, int height, double fov) {
  sequence_.camera = camera_from_fov(fov, width, height);
  sequence_.camera.shutter = all_at_once(height);
  sequence_.approximate_fov = fov;
  sequence_.camera_origin = CameraOrigin::fov;
}

void PageRun::begin(int width, int height, double fov, const std::string& detector) {
  CameraModel& camera = sequence_.camera;
  if (camera.width == 0) assume_camera(width, height, fov);
  if (camera.width != width || camera.height != height)
    throw InputError(sequence_.images_file, 0,
                     "the frames are " + size_text(width, height) + " px, the camera file says " +
                         size_text(camera.width, camera.height));
  if (camera.shutter.rows != height) camera.shutter = all_at_once(height);  // as know_rows() has it
  SessionOptions options;
  options.most_image_bytes = kMostImageBytes;
  options.detector = detector;
  options.calibration = calibration_;
  options.command = {"textslam", "in", "the", "browser"};
  session_ = std::make_unique<Session>(sequence_, options);
}

Json PageRun::frame(double time, ImageView8 image) {
  const std::size_t index = session_->frames();
  FrameRef ref;
  if (index < sequence_.frames.size()) {
    ref = sequence_.frames[index];
  } else {
    char number[24];
    std::snprintf(number, sizeof number, "%06zu", index);
    ref.stem = number;
    ref.path = sequence_.images_file + "#" + ref.stem;
  }
  ref.timestamp = time;
  session_->process(std::move(ref), image, {}, 0);
  return live_frame(session_->system());
}

void PageRun::add_detections(int frame, std::vector<Detection> detections, double ms) {
  session_->add_detections(frame, std::move(detections), ms);
}

Json PageRun::map() { return live_map(session_->system(), sequence_, pictures_); }

Json PageRun::finish(const std::string& folder) {
  session_->save(folder);
  const RunSummary summary = session_->summary();
  const Fields fields = describe(summary);
  return {{"metrics", fields.file}, {"table", fields.table}, {"warnings", warnings(summary)}};
}

}  // namespace textslam
