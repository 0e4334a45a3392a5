#include "textslam/input/noise_filter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "textplane/photometry/blur.hpp"

namespace textslam {
namespace {

constexpr double kFourPi = 12.566370614359172;

// Noise behind a filter, as a factor.
double noise_gain(const textplane::BlurKernel& kernel) {
  double squares = 0;
  for (int y = -kernel.radius(); y <= kernel.radius(); ++y)
    for (int x = -kernel.radius(); x <= kernel.radius(); ++x)
      squares += static_cast<double>(kernel.at(x, y)) * static_cast<double>(kernel.at(x, y));
  return std::sqrt(squares);
}

}  // namespace

void smooth_noise(double noise, const Parameters& parameters, Image<std::uint8_t>* image, Frame* frame) {
  frame->noise = noise;
  frame->smoothing = 0;
  if (!(noise > parameters.most_noise)) return;
  const double share = noise / parameters.most_noise;
  frame->smoothing = std::min(share * share / kFourPi, parameters.most_smoothing);
  textplane::Matrix2d covariance = textplane::Matrix2d::Zero();
  covariance(0, 0) = covariance(1, 1) = frame->smoothing;
  const textplane::BlurKernel kernel(covariance);
  frame->noise = noise * noise_gain(kernel);
  Image<std::uint8_t> smooth(image->width(), image->height());
  textplane::BlurFilter filter;
  filter(image->view(), kernel, 0, 0, image->width(), image->height(), smooth.view());
  *image = std::move(smooth);
}

}  // namespace textslam
