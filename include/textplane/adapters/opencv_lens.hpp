// OpenCV's lenses as undistorted() takes them: the matrices K and D of a calibration.
//
//   quads = tp::undistorted(quads, tp::adapters::CvLens{K, D}, pinhole);
//
// Needs OpenCV's module calib3d.
#ifndef TEXTPLANE_ADAPTERS_OPENCV_LENS_HPP
#define TEXTPLANE_ADAPTERS_OPENCV_LENS_HPP

#include <cmath>
#include <cstddef>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <vector>

#ifndef TEXTPLANE_SINGLE_HEADER
#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"
#endif

TEXTPLANE_BEGIN_NAMESPACE

namespace adapters {

/// A calibrated lens: of cv::calibrateCamera, or of cv::fisheye::calibrate.
struct CvLens {
  cv::Mat K;             ///< 3 x 3 intrinsics, CV_64F or CV_32F.
  cv::Mat D;             ///< Coefficients, CV_64F or CV_32F: 4, 5, 8, 12 or 14, or none; 4 of a fisheye.
  bool fisheye = false;  ///< Which of the two.

  /// Whether K and D have such shapes and finite numbers.
  bool valid() const {
    const auto real = [](const cv::Mat& m) { return m.dims == 2 && (m.type() == CV_64FC1 || m.type() == CV_32FC1); };
    const std::size_t n = D.total();
    const bool count = fisheye ? n == 4 : n == 0 || n == 4 || n == 5 || n == 8 || n == 12 || n == 14;
    return real(K) && K.rows == 3 && K.cols == 3 && cv::checkRange(K) && count &&
           (n == 0 || (real(D) && (D.rows == 1 || D.cols == 1) && cv::checkRange(D)));
  }

  /// Ray m~ = (m, 1) of a raw pixel, by cv::undistortPoints. invalid_argument where the lens is not valid(), non_finite
  /// for NaN, degenerate where the ray does not lead back to within 0.1 px of the pixel: OpenCV does not say that it
  /// found none. *ray is then untouched.
  Status unproject(const Vector2<double>& px, Vector3<double>* ray) const {
    if (!valid()) return Status::invalid_argument;
    if (!all_finite(px)) return Status::non_finite;
    const cv::TermCriteria stop(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-10);
    const std::vector<cv::Point2d> raw = {{px[0], px[1]}};
    std::vector<cv::Point2d> m, back;
    if (fisheye) {
#if CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR >= 406
      cv::fisheye::undistortPoints(raw, m, K, D, cv::noArray(), cv::noArray(), stop);
#else  // it cannot be told when to stop
      cv::fisheye::undistortPoints(raw, m, K, D);
#endif
      cv::fisheye::distortPoints(m, back, K, D);
    } else {
      cv::undistortPoints(raw, m, K, D, cv::noArray(), cv::noArray(), stop);
      const std::vector<cv::Point3d> at = {{m[0].x, m[0].y, 1}};
      cv::projectPoints(at, cv::Vec3d(), cv::Vec3d(), K, D, back);
    }
    if (!(std::hypot(back[0].x - px[0], back[0].y - px[1]) < 0.1)) return Status::degenerate;
    *ray = {m[0].x, m[0].y, 1};
    return Status::ok;
  }
};

}  // namespace adapters

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_ADAPTERS_OPENCV_LENS_HPP
