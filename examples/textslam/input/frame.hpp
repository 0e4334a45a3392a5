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
  std::shared_ptr<const Pyramid> image;  ///< Undistorted.
  std::vector<Detection> detections;     ///< Undistorted px.
};

}  // namespace textslam

#endif  // TEXTSLAM_INPUT_FRAME_HPP
