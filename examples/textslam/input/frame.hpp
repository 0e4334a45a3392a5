// Frame: one image on its way through the system.
#ifndef TEXTSLAM_INPUT_FRAME_HPP
#define TEXTSLAM_INPUT_FRAME_HPP

#include <memory>
#include <vector>

#include "io/detections.hpp"
#include "textplane/photometry/pyramid.hpp"

namespace textslam {

using textplane::Pyramid;

struct Frame {
  int index = -1;
  double timestamp = 0;
  std::shared_ptr<const Pyramid> image;  ///< Undistorted.
  std::vector<Detection> detections;     ///< Undistorted px.
  double noise = 0;                      ///< Grey levels: standard deviation of a pixel of level 0.
  double smoothing = 0;                  ///< px^2: variance of the Gaussian that the image was smoothed with.
};

}  // namespace textslam

#endif  // TEXTSLAM_INPUT_FRAME_HPP
