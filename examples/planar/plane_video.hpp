// Videos of a planar object with its corners annotated in some of the frames.
#ifndef TEXTPLANE_EXAMPLES_PLANE_VIDEO_HPP
#define TEXTPLANE_EXAMPLES_PLANE_VIDEO_HPP

#include <cstdint>
#include <map>
#include <string>

#include "textplane/geometry/quad.hpp"
#include "textplane/photometry/pyramid.hpp"

namespace planar {

namespace tp = textplane;

/// A folder of frames 00000001.jpg on, and the usable annotations.
struct PlaneVideo {
  std::string images;
  std::map<int, tp::Quad<double>> truth;  ///< By frame, px; clockwise.

  tp::Image<std::uint8_t> load(int frame) const;
  /// The corners of any frame between the first and the last annotated one, interpolated where it is not annotated.
  tp::Quad<double> corners(int frame) const;
};

/// `sequence` of a folder: its images, and its file SEQUENCE_gt_corners.csv with lines `frame,flag,x1,y1,...,x4,y4`;
/// flag 0 is usable. Throws InputError.
PlaneVideo read_plane_video(const std::string& folder, const std::string& sequence);

/// Mean distance of the corners, px.
double corner_error(const tp::Quad<double>& a, const tp::Quad<double>& b);

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_PLANE_VIDEO_HPP
