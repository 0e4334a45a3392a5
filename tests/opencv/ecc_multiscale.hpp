// OpenCV's ECC through a pyramid: its own findTransformECCMultiScale where the OpenCV that was found has it (define
// TEXTPLANE_HAS_ECC_MULTISCALE), otherwise what its documentation describes, around cv::findTransformECC.
#ifndef TEXTPLANE_TESTS_OPENCV_ECC_MULTISCALE_HPP
#define TEXTPLANE_TESTS_OPENCV_ECC_MULTISCALE_HPP

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <vector>

namespace textplane_test {

constexpr int kEccBlur = 5;  ///< px, of the pre-filter of each level: the default of cv::ECCParameters.

#if defined(TEXTPLANE_HAS_ECC_MULTISCALE)

constexpr const char* kEccMultiscale = "ecc_multiscale";

/// From *warp (float, 3 x 3: a homography, 2 x 3: affine), reference px to sample px. Throws where it fails.
inline void ecc_multiscale(const cv::Mat& reference, const cv::Mat& sample, const cv::TermCriteria& criteria,
                           int levels, cv::Mat* warp) {
  cv::ECCParameters parameters;
  parameters.motionType = warp->rows == 3 ? cv::MOTION_HOMOGRAPHY : cv::MOTION_AFFINE;
  parameters.criteria = criteria;
  parameters.gaussFiltSize = kEccBlur;
  parameters.nlevels = levels;
  cv::findTransformECCMultiScale(reference, sample, *warp, parameters);
}

#else

constexpr const char* kEccMultiscale = "ecc_multiscale_described";

/// From *warp (float, 3 x 3: a homography, 2 x 3: affine), reference px to sample px: each level is half of the one
/// before and takes all of the criteria's iterations. A coarse level that fails leaves the warp as it was; the finest
/// one throws.
inline void ecc_multiscale(const cv::Mat& reference, const cv::Mat& sample, const cv::TermCriteria& criteria,
                           int levels, cv::Mat* warp) {
  const int motion = warp->rows == 3 ? cv::MOTION_HOMOGRAPHY : cv::MOTION_AFFINE;
  std::vector<cv::Mat> references, samples;
  cv::buildPyramid(reference, references, levels - 1);
  cv::buildPyramid(sample, samples, levels - 1);
  for (int level = levels - 1; level >= 0; --level) {
    // Pixel x of a level lies at 2^level x of the image.
    const float scale = static_cast<float>(1 << level);
    const auto rescale = [motion](cv::Mat* w, float k) {
      w->at<float>(0, 2) *= k;
      w->at<float>(1, 2) *= k;
      if (motion == cv::MOTION_HOMOGRAPHY) {
        w->at<float>(2, 0) /= k;
        w->at<float>(2, 1) /= k;
      }
    };
    cv::Mat of_level = warp->clone();
    rescale(&of_level, 1 / scale);
    const auto l = static_cast<std::size_t>(level);
    try {
      cv::findTransformECC(references[l], samples[l], of_level, motion, criteria, cv::noArray(), kEccBlur);
    } catch (const cv::Exception&) {
      if (level == 0) throw;
      continue;
    }
    rescale(&of_level, scale);
    *warp = of_level;
  }
}

#endif

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_OPENCV_ECC_MULTISCALE_HPP
