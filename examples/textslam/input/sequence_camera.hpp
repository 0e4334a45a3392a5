// SequenceCamera: the camera of a sequence as the library takes it. It keeps the lens, so it outlives all views of it.
#ifndef TEXTSLAM_INPUT_SEQUENCE_CAMERA_HPP
#define TEXTSLAM_INPUT_SEQUENCE_CAMERA_HPP

#include <memory>

#include "io/camera_model.hpp"
#include "textslam/common/rays.hpp"

namespace textslam {

class SequenceCamera {
 public:
  explicit SequenceCamera(const CameraModel& model) : pinhole_(model.pinhole()) {
    if (model.is_pinhole()) return;
    lens_ = std::make_unique<const textplane::LensMap>(model.raw);
  }

  /// Without a lens where the model distorts nothing.
  CameraView view() const { return {pinhole_, lens_.get()}; }

 private:
  Pinhole<double> pinhole_;
  std::unique_ptr<const textplane::LensMap> lens_;
};

}  // namespace textslam

#endif  // TEXTSLAM_INPUT_SEQUENCE_CAMERA_HPP
