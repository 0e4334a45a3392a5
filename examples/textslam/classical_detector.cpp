#include "textslam/classical_detector.hpp"

namespace textslam {

std::vector<Detection> ClassicalDetector::detect(const FrameRef&, ImageView8) { return {}; }

}  // namespace textslam
