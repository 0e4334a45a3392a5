// Text in images that belong to no sequence, by a detector of the command line.
#ifndef TEXTSLAM_MAP_IMAGE_DETECTIONS_HPP
#define TEXTSLAM_MAP_IMAGE_DETECTIONS_HPP

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "textslam/detect/text_detector.hpp"

namespace textslam {

class ImageDetections {
 public:
  /// `folder`: of the files of --detector files; empty: they are beside the images. Throws as make_detector().
  ImageDetections(const DetectorOptions& options, const CameraModel& camera, const std::string& folder) {
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
    sequence_.frames = {frame};
    return detector_->detect(frame, image);
  }

 private:
  Sequence sequence_;  // of one image at a time
  std::unique_ptr<TextDetector> detector_;
};

}  // namespace textslam

#endif  // TEXTSLAM_MAP_IMAGE_DETECTIONS_HPP
