// A sequence: a folder with images.txt (or TUM's rgb.txt), camera.yaml and, optionally, groundtruth.txt and detections.
//
//   images.txt        `timestamp path` a line, times strictly increasing, `#` comments; the path is relative to the
//                     folder and runs to the end of the line
//   camera.yaml       `Camera.key: value` a line with the keys width height fps fx fy cx cy k1 k2 p1 p2 [k3]; other
//                     keys of an ORB-SLAM settings file are ignored
//   groundtruth.txt   TUM, see io/trajectory.hpp
//   detections/       see io/detections.hpp
#ifndef TEXTSLAM_IO_SEQUENCE_HPP
#define TEXTSLAM_IO_SEQUENCE_HPP

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/names.hpp"
#include "io/trajectory.hpp"

namespace textslam {

/// The camera that took the images: raw pixel = pinhole.pixel(lens.distort(m)).
struct CameraModel {
  Pinhole<double> pinhole;
  RadialTangential<double> lens;
  int width = 0, height = 0;  ///< px
  double fps = 0;
};

struct FrameRef {
  double timestamp = 0;  ///< s
  std::string path;      ///< the image, resolved against the sequence's folder
  std::string stem;      ///< file name without its last extension: the name of its detections
  int line = 0;          ///< in Sequence::images_file
};

struct Sequence {
  std::string folder;
  CameraModel camera;
  std::vector<FrameRef> frames;          ///< at least one, times strictly increasing
  std::string images_file;               ///< the list that the frames come from
  std::vector<StampedPose> groundtruth;  ///< empty where the folder has none
  bool has_detections = false;           ///< the folder has a folder of detections
};

/// Reads everything but images and detections. Throws InputError, with file and line where there is one, for whatever
/// is missing, malformed, unsorted or not finite. Whether the images exist is seen when they are loaded, so that a
/// broken frame in the middle does not cost the ones before it.
Sequence read_sequence(const std::string& folder);

/// Throws InputError for a missing or repeated key, a bad number, a focal length or size that is not positive, or a
/// lens model other than the pinhole.
CameraModel read_camera(const std::string& path);
/// The text that read_camera() reads; the numbers survive the round trip exactly.
std::string format_camera(const CameraModel& camera);

/// Decodes frame `index` (below frames.size()). Throws InputError that names images_file and the frame's line when the
/// image is missing, will not decode, or is not camera.width x camera.height.
Image<std::uint8_t> load_frame(const Sequence& sequence, std::size_t index);

}  // namespace textslam

#endif  // TEXTSLAM_IO_SEQUENCE_HPP
