#include "io/sequence.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "io/detections.hpp"
#include "io/euroc.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "io/paths.hpp"
#include "io/text_file.hpp"

namespace textslam {

namespace fs = std::filesystem;

namespace {

constexpr double kUsualFps = 30;

std::string inside(const std::string& folder, const char* name) { return (fs::path(folder) / name).string(); }

std::string size_text(int width, int height) { return std::to_string(width) + " x " + std::to_string(height); }

void use_fov(Sequence* sequence, double fov) {
  const Image<std::uint8_t> first = load_image(*sequence, 0);
  sequence->camera = camera_from_fov(fov, first.width(), first.height());
  sequence->camera_source = "the first one is";
  sequence->approximate_fov = fov;
  sequence->camera_origin = CameraOrigin::fov;
}

// EXIF's focal length is that of the diagonal of film.
void assume_camera(Sequence* sequence) {
  constexpr double kDiagonal = 43.2666;  // mm, of 36 x 24 mm
  const int mm = sequence->video ? 0 : image_focal_length_35mm(sequence->frames.front().path);
  use_fov(sequence, kAssumedFov);
  sequence->camera_origin = mm > 0 ? CameraOrigin::exif : CameraOrigin::assumed;
  if (mm == 0) return;
  const double width = sequence->camera.width;
  const double f = mm / kDiagonal * std::hypot(width, static_cast<double>(sequence->camera.height));
  sequence->approximate_fov = std::atan(0.5 * width / f) * (360 / M_PI);
  sequence->camera = camera_from_fov(sequence->approximate_fov, sequence->camera.width, sequence->camera.height);
}

// The camera of --camera, of the calibration `own` of the sequence (empty: it has none), or of --fov. `expected` is
// where the calibration of the layout would be (empty: nowhere).
void choose_camera(Sequence* sequence, const SequenceOptions& options, const std::string& own,
                   const std::string& expected) {
  const std::string file = !options.camera.empty() ? options.camera : own;
  if (!file.empty()) {
    if (options.fov > 0) throw InputError(file, 0, "the camera is calibrated here: leave out --fov");
    sequence->camera = read_camera(file);
    sequence->camera_source = fs::path(file).filename().string() + " says";
  } else if (options.fov > 0) {
    use_fov(sequence, options.fov);
  } else if (options.needs_camera && options.assumes_camera) {
    assume_camera(sequence);
  } else if (options.needs_camera) {
    throw InputError(expected.empty() ? sequence->images_file : expected, 0,
                     std::string(expected.empty() ? "there is no calibration" : "No such file") +
                         ": give --camera FILE, or --fov DEGREES for an approximate camera");
  }
}

// The calibration in a folder, where it counts.
std::string own_camera(const std::string& folder, const SequenceOptions& options) {
  return options.camera.empty() ? find_camera(folder) : "";
}

void read_video(Sequence* sequence, const std::string& path, const SequenceOptions& options) {
  sequence->folder = fs::path(path).parent_path().string();
  sequence->images_file = path;
  sequence->video = open_video(path);
  for (const double time : sequence->video->times()) {
    char number[24];
    std::snprintf(number, sizeof number, "%06zu", sequence->frames.size());
    sequence->frames.push_back({time, path, number, 0});
  }
  choose_camera(sequence, options, "", "");
}

void read_listed(Sequence* sequence, const std::string& list, const SequenceOptions& options) {
  sequence->images_file = list;
  sequence->frames = read_frame_list(sequence->folder, list);
  choose_camera(sequence, options, own_camera(sequence->folder, options), inside(sequence->folder, "camera.yaml"));
  sequence->groundtruth = read_groundtruth(sequence->folder);
}

void read_euroc(Sequence* sequence, const EurocFiles& files, const SequenceOptions& options) {
  sequence->images_file = files.list;
  sequence->frames = read_euroc_frames(files.list, files.images);
  const std::string own = is_there(files.camera) ? files.camera : own_camera(sequence->folder, options);
  choose_camera(sequence, options, own, files.camera);
  sequence->groundtruth = read_groundtruth(sequence->folder);
}

void read_images(Sequence* sequence, const SequenceOptions& options) {
  const std::string& folder = sequence->folder;
  const std::vector<std::string> names = image_names(folder);
  sequence->images_file = folder;
  sequence->frames = number_frames(folder, names, kUsualFps);
  choose_camera(sequence, options, own_camera(folder, options), "");
  const double fps = options.fps > 0 ? options.fps : sequence->camera.fps > 0 ? sequence->camera.fps : kUsualFps;
  sequence->frames = number_frames(folder, names, fps);
  sequence->groundtruth = read_groundtruth(folder);
}

// Of the first image: those of one camera are turned alike.
void note_orientation(Sequence* sequence) {
  const int orientation = image_orientation(sequence->frames.front().path);
  if (orientation == 1) return;
  sequence->notes.push_back("by their EXIF data (orientation " + std::to_string(orientation) +
                            ") the images are to be turned or mirrored; they are taken as they are stored. If the text "
                            "in them is not upright, turn the files first, as exiftran -ai does");
}

void note_damage(Sequence* sequence) {
  const std::size_t damaged = sequence->video->damaged();
  if (damaged > 0)
    sequence->notes.push_back(sequence->images_file + ": " + std::to_string(damaged) +
                              (damaged == 1 ? " frame is" : " frames are") + " damaged and left out");
}

void refuse_fps(const std::string& path, const SequenceOptions& options) {
  if (options.fps > 0) throw InputError(path, 0, "its frames have times: leave out --fps");
}

}  // namespace

Sequence read_sequence(const std::string& path, const SequenceOptions& options) {
  if (!is_there(path)) throw InputError(path, 0, "no such folder or file");
  if (!options.detections.empty() && !is_folder(options.detections))
    throw InputError(options.detections, 0, "no such folder: detections are expected there");
  Sequence sequence;
  sequence.folder = path;
  sequence.detections = options.detections;
  EurocFiles euroc;
  if (!is_folder(path)) {
    refuse_fps(path, options);
    read_video(&sequence, path, options);
  } else if (const std::string list = find_list(path); !list.empty()) {
    refuse_fps(list, options);
    read_listed(&sequence, list, options);
  } else if (find_euroc(path, &euroc)) {
    refuse_fps(euroc.list, options);
    read_euroc(&sequence, euroc, options);
  } else {
    read_images(&sequence, options);
  }
  sequence.has_detections = has_detections(sequence);
  if (const std::string truth = inside(sequence.folder, "true_camera.yaml"); is_there(truth))
    sequence.true_camera = read_camera(truth);
  if (sequence.video)
    note_damage(&sequence);
  else
    note_orientation(&sequence);
  return sequence;
}

std::vector<StampedPose> read_groundtruth(const std::string& folder) {
  const std::string tum = inside(folder, "groundtruth.txt");
  if (is_there(tum)) return read_tum(tum);
  EurocFiles euroc;
  if (!find_euroc(folder, &euroc) || !is_there(euroc.truth) || !is_there(euroc.camera)) return {};
  return read_euroc_truth(euroc.truth, read_camera_file(euroc.camera).T_b_c);
}

std::string frame_name(const Sequence& sequence, std::size_t index) {
  const FrameRef& frame = sequence.frames.at(index);
  const fs::path path(frame.path);
  if (sequence.video) return path.filename().string() + "#" + frame.stem;
  return path.lexically_relative(sequence.folder).string();
}

Image<std::uint8_t> load_image(const Sequence& sequence, std::size_t index) {
  const FrameRef& frame = sequence.frames.at(index);
  if (sequence.video) return sequence.video->load(index);
  try {
    return load_grey(frame.path);
  } catch (const InputError& error) {
    if (frame.line == 0) throw;
    throw InputError(sequence.images_file, frame.line, error.what());
  }
}

Image<std::uint8_t> load_colour(const Sequence& sequence, std::size_t index) {
  return sequence.video ? sequence.video->load_colour(index) : Image<std::uint8_t>();
}

Image<std::uint8_t> load_frame(const Sequence& sequence, std::size_t index) {
  Image<std::uint8_t> image = load_image(sequence, index);
  const CameraModel& camera = sequence.camera;
  if (image.width() == camera.width && image.height() == camera.height) return image;
  const FrameRef& frame = sequence.frames[index];
  const std::string message = "the image is " + size_text(image.width(), image.height()) + " px, " +
                              sequence.camera_source + " " + size_text(camera.width, camera.height);
  if (frame.line == 0) throw InputError(frame.path, 0, message);
  throw InputError(sequence.images_file, frame.line, frame.path + ": " + message);
}

}  // namespace textslam
