// Compiled into both libraries, with different flags.
#include "unit.hpp"

#include <textplane/core/se3.hpp>
#include <textplane/photometry/pyramid.hpp>

#define TO_TEXT_(word) #word
#define TO_TEXT(word) TO_TEXT_(word)

namespace UNIT {

// A sum over an image that a kernel halved twice, and a little geometry in Eigen's types.
double number() {
  textplane::Image<std::uint8_t> image(157, 122);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) image(x, y) = static_cast<std::uint8_t>(7 * x + 13 * y + x * y / 5);
  const textplane::Pyramid pyramid(image.view(), 3);
  const auto top = pyramid.view().level[2];
  double sum = 0;
  for (int y = 0; y < top.height(); ++y)
    for (int x = 0; x < top.width(); ++x) sum += top(x, y);
  textplane::Vector6<double> xi;
  xi << 0.1, -0.2, 0.3, 0.4, -0.5, 0.6;
  const textplane::SE3<double> T = textplane::se3_exp(xi) * textplane::se3_exp<double>(-xi);
  return sum + T.R.trace() - 3 + T.t.norm();
}

const char* target() { return textplane::simd::to_string(textplane::simd::active_target()); }
bool set_target_scalar() { return textplane::is_ok(textplane::simd::set_target(textplane::simd::Target::scalar)); }
const char* baseline() { return TO_TEXT(TEXTPLANE_ABI_ISA); }

}  // namespace UNIT
