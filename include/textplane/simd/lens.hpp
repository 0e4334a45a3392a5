// LensFit: how a lens moves and turns the pixels of one patch, for the kernels. photometry/lens/lens_fit.hpp makes it.
//
// A lens takes normalised coordinates m = (x/z, y/z) to m_d = s(r^2) m + tangential part, r = |m|, and the pixel is the
// pinhole's of m_d. Whatever the model, near one patch s is a polynomial in r^2: exactly for a radial-tangential lens,
// and within 1e-6 px for others. So one kernel serves all models, and none evaluates an arc tangent or a root a pixel.
//
// Between warp and taps the kernels then add the lens step: positions relative to that of m0, so that their error grows
// with the patch and not with the image, and the 2 x 2 derivative. Its transpose takes the image's gradient to the
// pinhole image, where all that follows is as without a lens. Error of positions: 2e-5 px for patches of 128 px, twice
// that without a lens; what residual.hpp and batch.hpp state of sums doubles with it.
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
// A fit for one image. Behind a lens the kernels' target is the plane z = 1: the positions of rows are m - m0, and
// gradients are by m. Image positions are relative to (ox, oy). Factors of fx are in s, c, p.
struct LensFrame {
  float mx, my, r0;                                    // m0, |m0|^2
  float sx, sy, aspect;                                // fx and fy times the factor of m at m0; fy / fx
  float ax, ay;                                        // image position of m0
  float c[simd::kLensTerms], slope[simd::kLensTerms];  // of s less that at m0, by t, and of twice its derivative
  float p1, p2, tx, ty;                                // 2 fx p; what the tangential part adds a unit of t
  float t_low, t_high;
  int terms;
  bool tangential;
  int ox, oy;
  float box[4];  // of the patch's image positions: x_low, y_low, x_high, y_high; empty where not all are in front
  bool on;       // false: there is no lens, and nothing else is set
};

// Between the loops over a strip: the factor of m in m_d, and the part of its gradient that is along m, a unit of m.
struct LensStrip {
  float s[kStrip], slope[kStrip];
};
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/lens.inl"
#include "textplane/simd/foreach_target.inl"

#endif  // TEXTPLANE_SIMD_LENS_HPP
