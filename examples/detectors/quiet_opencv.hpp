// QuietOpenCv: while one exists, OpenCV reports errors by exceptions alone, not on standard error too.
#ifndef TEXTSLAM_DETECTORS_QUIET_OPENCV_HPP
#define TEXTSLAM_DETECTORS_QUIET_OPENCV_HPP

#include <opencv2/core/utils/logger.hpp>

namespace textslam {

class QuietOpenCv {
 public:
  QuietOpenCv() : level_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {
    cv::redirectError([](int, const char*, const char*, const char*, int, void*) { return 0; });
  }
  ~QuietOpenCv() {
    cv::redirectError(nullptr);
    cv::utils::logging::setLogLevel(level_);
  }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  cv::utils::logging::LogLevel level_;
};

}  // namespace textslam

#endif  // TEXTSLAM_DETECTORS_QUIET_OPENCV_HPP
