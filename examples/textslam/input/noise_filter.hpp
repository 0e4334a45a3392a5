// Noise of the images: what is too noisy is smoothed before anything looks at it. Limits of the ZNCC are lowered to
// what the noise that is left allows: textplane/landmarks/text_noise.hpp.
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

}  // namespace textslam

#endif  // TEXTSLAM_INPUT_NOISE_FILTER_HPP
