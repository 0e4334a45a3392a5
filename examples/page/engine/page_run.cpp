#include "page_run.hpp"

#include <cmath>
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

PageRun::PageRun(const std::string& folder, const std::string& video) : sequence_(read(folder, video)) {}

Json PageRun::sequence() const {
  Json frames = Json::array();
  for (const FrameRef& frame : sequence_.frames) frames.push_back({{"path", frame.path}, {"time", frame.timestamp}});
  const CameraModel& camera = sequence_.camera;
  return {{"frames", frames},
          {"camera", camera.width > 0 ? Json{{"width", camera.width}, {"height", camera.height}} : Json(nullptr)},
          {"truth", sequence_.groundtruth.size()}};
}

void PageRun::begin(int width, int height, double fov, const std::string& detector) {
  CameraModel& camera = sequence_.camera;
  if (camera.width == 0) {
    camera = camera_from_fov(fov, width, height);
    sequence_.approximate_fov = fov;
    sequence_.camera_origin = CameraOrigin::fov;
  }
  if (camera.width != width || camera.height != height)
    throw InputError(sequence_.images_file, 0,
                     "the frames are " + size_text(width, height) + " px, the camera file says " +
                         size_text(camera.width, camera.height));
  if (camera.shutter.rows != height) camera.shutter = all_at_once(height);  // as know_rows() has it
  SessionOptions options;
  options.most_image_bytes = kMostImageBytes;
  options.detector = detector;
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
