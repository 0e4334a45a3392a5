// Frame: one image on its way through the system.
#ifndef TEXTSLAM_INPUT_FRAME_HPP
#define TEXTSLAM_INPUT_FRAME_HPP

#include <memory>
#include <vector>

#include "io/detections.hpp"
#include "textplane/landmarks/keyframe.hpp"
#include "textplane/photometry/pyramid.hpp"

namespace textslam {

using textplane::Pyramid;

struct Frame : textplane::ImageNoise {
  int index = -1;
  double timestamp = 0;
  std::shared_ptr<const Pyramid> image;  ///< As it was taken, behind the lens.
  std::vector<Detection> detections;     ///< px of it.
  /// How the camera moved while a rolling shutter took the rows; null: it took all at once, or the motion is not known.
  /// Replaced, never changed: views of the camera point to it.
  std::shared_ptr<const textplane::RowMotion> rows = {};
};

}  // namespace textslam

#endif  // TEXTSLAM_INPUT_FRAME_HPP
