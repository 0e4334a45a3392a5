// LensFit: how a lens moves and turns the pixels of one patch, for the kernels. photometry/lens/lens_fit.hpp makes it.
//
// A lens takes normalised coordinates m = (x/z, y/z) to m_d = s(r^2) m + tangential part, r = |m|, and the pixel is the
// pinhole's of m_d. Whatever the model, near one patch s is a polynomial in r^2: exactly for a radial-tangential lens,
// and within 1e-6 px for others. So one kernel serves all models, and none evaluates an arc tangent or a root a pixel.
//
// Between warp and taps the kernels then add the lens step: what the lens changes of a pinhole image that agrees with
// it at m0, so that the error grows with the patch and not with the image, and the 2 x 2 derivative. Its transpose
// takes the image's gradient to the pinhole image, where all that follows is as without a lens. Error of positions:
// 2e-5 px for patches of 128 px, twice that without a lens; what residual.hpp and batch.hpp state of sums doubles with
// it.
#ifndef TEXTPLANE_SIMD_LENS_HPP
#define TEXTPLANE_SIMD_LENS_HPP

#include "textplane/simd/sample.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace simd {

/// Most terms of LensFit.
constexpr int kLensTerms = 14;

/// A lens near one patch. Rays with r^2 outside [low, high] have no pixel. Not set until it is made: a call without a
/// lens has no time for it.
struct LensFit {
  double m0[2];              ///< A ray near the middle of the patch, normalised.
  double r0;                 ///< |m0|^2.
  double c[kLensTerms + 1];  ///< s(r0 + t) = c[0] + t (c[1] + t (c[2] + ...)).
  int terms;                 ///< 3, 6 or kLensTerms; coefficients beyond c[terms] are 0.
  double p[2];               ///< Tangential: p1, p2.
  double low, high;
};

}  // namespace simd

namespace detail {
// A fit for one image. Behind a lens the kernels' target is a pinhole image: it has the scale of the lens at m0, and
// shows m0 where the lens does. Positions of rows are its pixels e, relative to (ox, oy), and gradients are by e.
struct LensFrame {
  float x_scale, x_shift, y_scale, y_shift;  // m = scale e + shift
  float r0, aspect;                          // |m0|^2; fy / fx
  float c[simd::kLensTerms];                 // fx (s - s(m0)) = t (c[0] + t (c[1] + ...)), t = |m|^2 - |m0|^2
  float slope[simd::kLensTerms];             // 2 x_scale times the derivative of that by t
  float p1, p2, p0;                          // 2 fx (w - w(m0)) of the tangential part = p2 e_x + p1 e_y + p0
  float tx, ty;                              // fx p2, fy p1: what it moves a unit of t
  float t_low, t_high;                       // t beyond these has no pixel
  float box[4];      // of the patch's image positions: x_low, y_low, x_high, y_high; empty where not all are in front
  double camera[4];  // fx, fy, cx, cy of that pinhole image
  int terms;
  int ox, oy;
  bool tangential;
  bool on;  // false: there is no lens, and nothing else is set
};

// Between the loops over a strip: the factor of m in m_d, as a share of that at m0, and how it rises.
struct LensStrip {
  float s[kStrip], slope[kStrip];
};
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/lens.inl"
#include "textplane/simd/foreach_target.inl"

#endif  // TEXTPLANE_SIMD_LENS_HPP
