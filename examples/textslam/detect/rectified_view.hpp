// RectifiedView: the middle of an image behind a lens as a pinhole would have taken it. Detectors and readers know
// straight lines of text; a fisheye bends them.
#ifndef TEXTSLAM_DETECT_RECTIFIED_VIEW_HPP
#define TEXTSLAM_DETECT_RECTIFIED_VIEW_HPP

#include <vector>

#include "textslam/common/rays.hpp"

namespace textslam {

/// How much the lens bends straight lines: of the lines in the world through the ends of each edge of the image, the
/// largest distance of one from the middle of its edge, as a share of the edge. 1 where an end has no ray.
double line_bend(const CameraView& camera, int width, int height);

constexpr double kMostBend = 0.1;  ///< line_bend() that a detector can do with. A word at the edge bends by less.

class RectifiedView {
 public:
  /// Of images of this size. The view has the same resolution in its middle, and takes in what the image shows along
  /// the axes of the camera, at most 50 degrees off the optical axis.
  RectifiedView(const CameraView& camera, int width, int height);

  int width() const { return width_; }    ///< px
  int height() const { return height_; }  ///< px

  /// The view of an image with so many interleaved bytes a pixel: bilinear; the image's border is repeated beyond it,
  /// and what the lens does not show is black.
  Image<std::uint8_t> operator()(ImageView8 image, int channels = 1) const;

  /// From px of the view to px of the image. False, and the quad as it was, where the lens shows no such corner.
  bool to_image(Quad<double>* quad) const;
  /// The way back. False, and the quad as it was, where a corner is not in the view.
  bool from_image(Quad<double>* quad) const;

 private:
  CameraView camera_;
  Pinhole<double> pinhole_;  // of the view
  int width_ = 0, height_ = 0;
  std::vector<Vec2f> places_;  // in the image, of each pixel of the view; NaN: the lens does not show it
};

}  // namespace textslam

#endif  // TEXTSLAM_DETECT_RECTIFIED_VIEW_HPP
