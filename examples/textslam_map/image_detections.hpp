// Text in images that belong to no sequence, by a detector of the command line.
#ifndef TEXTSLAM_MAP_IMAGE_DETECTIONS_HPP
#define TEXTSLAM_MAP_IMAGE_DETECTIONS_HPP

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/input_error.hpp"
#include "io/paths.hpp"
#include "textslam/detect/text_detector.hpp"

namespace textslam {

class ImageDetections {
 public:
  /// `folder`: of the files of --detector files; empty: `detections` beside each image. Throws as make_detector(), and
  /// InputError where there is no such folder.
  ImageDetections(const DetectorOptions& options, const CameraModel& camera, const std::string& folder) {
    if (!folder.empty() && !is_folder(folder))
      throw InputError(folder, 0, "no such folder: detections are expected there");
    sequence_.camera = camera;
    sequence_.detections = folder;
    detector_ = make_detector(options, sequence_);
  }
  ImageDetections(const ImageDetections&) = delete;
  ImageDetections& operator=(const ImageDetections&) = delete;

  /// Of the image file `path`, which holds `image`.
  std::vector<Detection> of(const std::string& path, ImageView8 image) {
    const std::filesystem::path file(path);
    sequence_.folder = file.has_parent_path() ? file.parent_path().string() : ".";
    FrameRef frame;
    frame.path = path;
    frame.stem = file.stem().string();
    const auto [first, is_new] = path_of_stem_.emplace(frame.stem, path);
    if (!sequence_.detections.empty() && !is_new && first->second != path)
      throw InputError(path, 0, "its boxes would be those of " + first->second + ", which has the same stem");
    sequence_.frames = {frame};
    return detector_->detect(frame, image);
  }

 private:
  Sequence sequence_;  // of one image at a time
  std::map<std::string, std::string> path_of_stem_;
  std::unique_ptr<TextDetector> detector_;
};

}  // namespace textslam

#endif  // TEXTSLAM_MAP_IMAGE_DETECTIONS_HPP
