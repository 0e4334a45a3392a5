// The peers of PlaneTracker: OpenCV's ECC, pyramidal KLT with a RANSAC homography, and plain SSD, each as a careful
// user would set it up.
//
// All of them find the homography H, pixels of the first image to pixels of another, from a start.
#ifndef TEXTPLANE_EXAMPLES_PEERS_HPP
#define TEXTPLANE_EXAMPLES_PEERS_HPP

#include <opencv2/core.hpp>
#include <vector>

#include "textplane/features/select.hpp"

namespace planar {

namespace tp = textplane;

/// cv::findTransformECC, coarse to fine over the levels of both pyramids: the quad's bounding box of the first image
/// against the surroundings of the quad in the other. False where OpenCV fails; *H is then unchanged.
bool align_ecc(const tp::PyramidView& first, const tp::Quad<double>& quad, const tp::PyramidView& image,
               tp::Matrix3<double>* H);

/// The same over whole images, on the finest level alone: refines a published homography. False where it fails.
bool refine_whole(tp::ImageView8 first, tp::ImageView8 image, tp::Matrix3<double>* H);

/// Least squares of the grey levels at the patch's pixels by the eight entries of H, damped, coarse to fine. False
/// where too few pixels are in view.
bool align_ssd(const tp::TextPatch& patch, const tp::PyramidView& image, tp::Matrix3<double>* H);

/// Tracks corners of the quad from frame to frame by cv::calcOpticalFlowPyrLK; H by cv::findHomography with RANSAC at 3
/// px.
class KltHomography {
 public:
  KltHomography(const cv::Mat& first, const tp::Quad<double>& quad);
  bool track(const cv::Mat& image, tp::Matrix3<double>* H);

 private:
  cv::Mat last_;
  std::vector<cv::Point2f> first_points_, points_;
};

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_PEERS_HPP
