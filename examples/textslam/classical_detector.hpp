// ClassicalDetector: text quads without a model, from the image alone.
#ifndef TEXTSLAM_CLASSICAL_DETECTOR_HPP
#define TEXTSLAM_CLASSICAL_DETECTOR_HPP

#include "textslam/text_detector.hpp"

namespace textslam {

class ClassicalDetector final : public TextDetector {
 public:
  std::vector<Detection> detect(const FrameRef& frame, ImageView8 raw_image) override;
};

}  // namespace textslam

#endif  // TEXTSLAM_CLASSICAL_DETECTOR_HPP
