// Noise of the images: what is too noisy is smoothed before anything looks at it, and limits of the ZNCC are lowered to
// what the noise that is left allows.
#ifndef TEXTSLAM_INPUT_NOISE_FILTER_HPP
#define TEXTSLAM_INPUT_NOISE_FILTER_HPP

#include "io/names.hpp"
#include "textslam/common/parameters.hpp"
#include "textslam/input/frame.hpp"

namespace textslam {

/// Smooths the image in place by a Gaussian where its noise, of standard deviation `noise`, is more than most_noise,
/// and says in `frame` what noise is left and how much it was smoothed. The variance is that of the Gaussian that
/// leaves most_noise, (noise / most_noise)^2 / (4 pi), but at most most_smoothing.
void smooth_noise(double noise, const Parameters& parameters, Image<std::uint8_t>* image, Frame* frame);

/// The standard deviation of a pixel's noise on a pyramid level of the frame: halving takes half of white noise, and
/// less of what is left by smoothing, where neighbours err alike.
double noise_on_level(const Frame& frame, int level);

/// What a ZNCC has to reach in place of `limit`, which is made for images of clear_noise: `limit` times
/// textplane::expected_zncc() of these contrasts (with noise included) and the noise beyond that, on this level of the
/// frames. Equal to `limit` where neither frame has more; never below least_expected_zncc times it.
double zncc_limit(const Parameters& parameters, double limit, int level, const Frame& a, double contrast_a,
                  const Frame& b, double contrast_b);
/// Whether zncc_limit() may differ from the limit.
bool is_noisy(const Parameters& parameters, const Frame& a, const Frame& b);

}  // namespace textslam

#endif  // TEXTSLAM_INPUT_NOISE_FILTER_HPP
