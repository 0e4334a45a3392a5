#include "page_run.hpp"

#include <algorithm>
#include <cstdio>

#include "io/input_error.hpp"
#include "textslam/map_file/map_file.hpp"

namespace textslam {
namespace {

constexpr int kMostSide = 960;                                 // px, of frames without a camera file
constexpr std::size_t kMostImageBytes = std::size_t{3} << 29;  // of 4 GB that a module can have

Sequence without_images(const std::string& folder, const std::string& video) {
  Sequence sequence;
  sequence.folder = folder;
  sequence.images_file = folder + "/" + video;
  if (const std::string camera = find_camera(folder); !camera.empty()) sequence.camera = read_camera(camera);
  sequence.groundtruth = read_groundtruth(folder);
  return sequence;
}

Sequence sequence_in(const std::string& folder, const std::string& video) {
  if (!video.empty()) return without_images(folder, video);
  SequenceOptions options;
  options.needs_camera = false;
  return read_sequence(folder, options);
}

Image<std::uint8_t> copy_of(ImageView8 image) {
  Image<std::uint8_t> copy(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y) std::copy_n(image.row(y), image.width(), copy.row(y));
  return copy;
}

// Where a network answers later than a reader may, the texts are read twice in the same order: first for the pictures,
// then with the answers.
class PictureTaker : public TextReader {
 public:
  explicit PictureTaker(std::vector<TextPicture>* pictures) : pictures_(pictures) {}
  Reading read(ImageView8 image, const Quad<double>& quad) override {
    pictures_->push_back({copy_of(image), quad});
    return {};
  }

 private:
  std::vector<TextPicture>* pictures_;
};

class ReadingGiver : public TextReader {
 public:
  explicit ReadingGiver(const std::vector<Reading>& readings) : next_(readings.begin()) {}
  Reading read(ImageView8, const Quad<double>&) override { return *next_++; }

 private:
  std::vector<Reading>::const_iterator next_;
};

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
    images_.push_back(copy_of(image));
  }

 private:
  std::vector<double> times_;
  std::vector<Image<std::uint8_t>> images_;
};

PageRun::PageRun(const std::string& folder, const std::string& video, const std::string& map)
    : map_(map), sequence_(sequence_in(folder, video)), has_camera_file_(sequence_.camera.width > 0) {
  if (!map.empty() && !has_camera_file_) sequence_.camera = load_map_camera(map);
}

Json PageRun::sequence() const {
  Json frames = Json::array();
  for (const FrameRef& frame : sequence_.frames) frames.push_back({{"path", frame.path}, {"time", frame.timestamp}});
  const CameraModel& camera = sequence_.camera;
  const bool known = camera.width > 0;
  // A file's camera is of its images as they are; a map's may be of images that were made smaller.
  const int side = has_camera_file_ ? 0 : known ? std::max(camera.width, camera.height) : kMostSide;
  return {{"frames", frames}, {"known_camera", known}, {"most_side", side}, {"truth", sequence_.groundtruth.size()}};
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

void PageRun::begin(int width, int height, double fov, const std::string& detector, bool localise) {
  CameraModel& camera = sequence_.camera;
  if (camera.width == 0) assume_camera(width, height, fov);
  if (camera.width != width || camera.height != height)
    throw InputError(sequence_.images_file, 0,
                     "the frames are " + size_text(width, height) + " px, " +
                         (has_camera_file_ ? "the camera file says " : "those of the map ") +
                         size_text(camera.width, camera.height));
  if (camera.shutter.rows != height) camera.shutter = all_at_once(height);  // as know_rows() has it
  SessionOptions options;
  options.most_image_bytes = kMostImageBytes;
  options.detector = detector;
  options.calibration = calibration_;
  options.command = {"textslam", "in", "the", "browser"};
  options.map = map_;
  options.localise = localise_ = localise && !map_.empty();
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

std::size_t PageRun::unread() {
  unread_.clear();
  PictureTaker taker(&unread_);
  session_->read_texts(taker);
  return unread_.size();
}

void PageRun::take_readings(const std::vector<TextReader::Reading>& readings) {
  if (readings.size() != unread_.size())
    throw std::invalid_argument("take_readings: as many readings as pictures are expected");
  ReadingGiver giver(readings);
  session_->read_texts(giver);
}

// Into the map that it began in, else into the folder; empty where there is none.
std::string PageRun::write_map(const std::string& folder, std::vector<std::string>* lines) {
  if (localise_ || !has_map(session_->system())) return {};
  const std::string path = map_.empty() ? folder + "/map.db" : map_;
  const std::string line = session_->save_map(path);
  if (line.empty()) return path;
  lines->push_back(line);
  return "unjoined_map.db";  // beside it
}

Json PageRun::finish(const std::string& folder) {
  const std::string unmapped = session_->save(folder);
  const RunSummary summary = session_->summary();
  const Fields fields = describe(summary);
  std::vector<std::string> lines = warnings(summary);
  const std::string map = write_map(folder, &lines);
  if (!unmapped.empty()) lines.push_back(unmapped);
  return {{"metrics", fields.file},
          {"table", fields.table},
          {"warnings", lines},
          {"map", map.empty() ? Json(nullptr) : Json(map)}};
}

}  // namespace textslam
