// A sequence: frames with times, their camera and, optionally, true poses and text detections. It is one of
//
//   a folder with images.txt or TUM's rgb.txt (io/frame_list.hpp), camera.yaml or another camera file
//     (io/camera_model.hpp) and, optionally, groundtruth.txt (TUM, io/trajectory.hpp)
//   a folder of the EuRoC layout (io/euroc.hpp)
//   a folder of images, in the order of their names (io/frame_list.hpp), with a camera file or without
//   a video file (io/video_file.hpp)
//
// Detections: io/detections.hpp.
#ifndef TEXTSLAM_IO_SEQUENCE_HPP
#define TEXTSLAM_IO_SEQUENCE_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/camera_model.hpp"
#include "io/frame_list.hpp"
#include "io/names.hpp"
#include "io/trajectory.hpp"
#include "io/video_file.hpp"

namespace textslam {

/// Overrides of the input, and what it lacks.
struct SequenceOptions {
  std::string camera;  ///< a camera file (io/camera_model.hpp) in place of the sequence's own
  double fov = 0;  ///< degrees, above 0 and below 180: camera_from_fov() where there is no calibration; 0: not given
  double fps = 0;  ///< of a folder of images; 0: what its camera file says, or 30
  std::string detections;    ///< folder of the detections, in place of the sequence's own
  bool needs_camera = true;  ///< false: without calibration the camera stays empty
  /// Without calibration and fov the camera has the focal length of the first image's EXIF data, or kAssumedFov; else
  /// that is an error.
  bool assumes_camera = false;
};

/// Degrees, horizontal: about what phones and webcams see.
constexpr double kAssumedFov = 60;

/// Where the camera of a sequence comes from.
enum class CameraOrigin { file, fov, exif, assumed };

struct Sequence {
  std::string folder;  ///< of a video, the folder that holds it
  CameraModel camera;
  std::string camera_source;  ///< where the size of the images comes from, for messages
  CameraOrigin camera_origin = CameraOrigin::file;
  double approximate_fov = 0;              ///< degrees, where the camera is guessed from it; 0: calibrated
  std::vector<FrameRef> frames;            ///< at least one, times strictly increasing
  std::string images_file;                 ///< the list of the frames, the folder of images, or the video
  std::optional<CameraModel> true_camera;  ///< true_camera.yaml of the folder: where self-calibration is to be judged
  std::vector<StampedPose> groundtruth;    ///< camera to world; empty where the sequence has none
  std::string detections;                  ///< SequenceOptions::detections
  bool has_detections = false;             ///< a folder of detections exists, or a file beside the first image
  std::shared_ptr<VideoFile> video;        ///< null for images
  std::vector<std::string> notes;          ///< what the user should know of it: lines without their ends
};

/// Reads everything but images and detections. Throws InputError, with file and line where there is one, for input that
/// is missing, malformed, unsorted or not finite, and for an option that the input makes meaningless. Images are
/// checked when they are loaded, so that the frames before a broken one can be used.
Sequence read_sequence(const std::string& path, const SequenceOptions& options = {});

/// The true poses of a folder of any layout; none where it has none, and for EuRoC without a sensor.yaml, which places
/// the camera on the body. Throws InputError for a broken file.
std::vector<StampedPose> read_groundtruth(const std::string& folder);

/// The frame's name for users: its image's path from the folder, or `video.mp4#000123`.
std::string frame_name(const Sequence& sequence, std::size_t index);

/// Decodes frame `index` (below frames.size()). Throws InputError that names images_file and the frame's line when the
/// image is missing, does not decode, or is not camera.width x camera.height.
Image<std::uint8_t> load_frame(const Sequence& sequence, std::size_t index);
/// The same for an image of any size.
Image<std::uint8_t> load_image(const Sequence& sequence, std::size_t index);
/// A frame of a video in colour: blue, green and red of each pixel in turn, so three times as wide. Quick after
/// load_image() of the same frame. Empty for images, whose files have their colours.
Image<std::uint8_t> load_colour(const Sequence& sequence, std::size_t index);

}  // namespace textslam

#endif  // TEXTSLAM_IO_SEQUENCE_HPP
