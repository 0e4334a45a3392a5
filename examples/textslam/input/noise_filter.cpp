#include "textslam/input/noise_filter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "textplane/photometry/blur.hpp"
#include "textplane/photometry/noise.hpp"

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

double noise_on_level(const Frame& frame, int level) {
  // A Gaussian of variance v leaves 1 / (4 pi v) of the variance of white noise, the mean of n pixels 1 / n; one after
  // the other about the inverse of the sum.
  const double left = std::max(1.0, kFourPi * frame.smoothing);
  return frame.noise * std::sqrt(left / (left + std::ldexp(1.0, 2 * level) - 1));
}

bool is_noisy(const Parameters& parameters, const Frame& a, const Frame& b) {
  return std::max(a.noise, b.noise) > parameters.clear_noise;
}

double zncc_limit(const Parameters& parameters, double limit, int level, const Frame& a, double contrast_a,
                  const Frame& b, double contrast_b) {
  if (!is_noisy(parameters, a, b)) return limit;
  const auto excess = [&](const Frame& frame) {
    const double noise = noise_on_level(frame, level), clear = std::ldexp(parameters.clear_noise, -level);
    return std::sqrt(std::max(0.0, noise * noise - clear * clear));
  };
  const double expected = textplane::expected_zncc(contrast_a, excess(a), contrast_b, excess(b));
  return limit * std::max(parameters.least_expected_zncc, expected);
}

}  // namespace textslam
