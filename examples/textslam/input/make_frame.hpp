// From an image to a frame: noise, smoothing, pyramid.
#ifndef TEXTSLAM_INPUT_MAKE_FRAME_HPP
#define TEXTSLAM_INPUT_MAKE_FRAME_HPP

#include <utility>

#include "textplane/photometry/noise.hpp"
#include "textslam/input/noise_filter.hpp"

namespace textslam {

/// Without detections.
inline Frame make_frame(int index, double timestamp, Image<std::uint8_t> image, const Parameters& parameters) {
  Frame frame;
  frame.index = index;
  frame.timestamp = timestamp;
  smooth_noise(textplane::estimate_noise(image.view()).sigma, parameters, &image, &frame);
  frame.image = std::make_shared<const Pyramid>(image.view(), parameters.pyramid_levels);
  return frame;
}

}  // namespace textslam

#endif  // TEXTSLAM_INPUT_MAKE_FRAME_HPP
