# Sets TEXTPLANE_HAS_ECC_MULTISCALE: whether the OpenCV that was found has cv::findTransformECCMultiScale. No version of
# its headers says so.
include(CheckCXXSourceCompiles)
set(CMAKE_REQUIRED_INCLUDES ${OpenCV_INCLUDE_DIRS})
set(CMAKE_REQUIRED_LIBRARIES opencv_core opencv_imgproc opencv_video)
check_cxx_source_compiles("
#include <opencv2/video/tracking.hpp>
int main() {
  cv::Mat reference, sample, warp;
  return cv::findTransformECCMultiScale(reference, sample, warp, cv::ECCParameters()) > 0;
}" TEXTPLANE_HAS_ECC_MULTISCALE)
unset(CMAKE_REQUIRED_INCLUDES)
unset(CMAKE_REQUIRED_LIBRARIES)
