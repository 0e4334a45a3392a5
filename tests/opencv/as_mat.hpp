// Our images and matrices as OpenCV's.
#ifndef TEXTPLANE_TESTS_OPENCV_AS_MAT_HPP
#define TEXTPLANE_TESTS_OPENCV_AS_MAT_HPP

#include <opencv2/core.hpp>

#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"

namespace textplane_test {

/// A view of the same pixels.
template <class T>
cv::Mat as_mat(const textplane::Image<T>& image) {
  return cv::Mat(image.height(), image.width(), cv::DataType<T>::type, const_cast<T*>(image.data()));
}

/// A copy.
inline cv::Mat as_mat(const textplane::Matrix3<double>& H) {
  cv::Mat out(3, 3, CV_64F);
  for (int i = 0; i < 9; ++i) out.at<double>(i / 3, i % 3) = H(i / 3, i % 3);
  return out;
}

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_OPENCV_AS_MAT_HPP
