// The photometric residual of a planar text object and its normal equations, in float vectors: raw pointers in, sums
// out. photometry/residual.hpp is the typed form and says what r, E, H and b are; docs/equations.md holds the formulas
// used here.
//
//   frame    H in double, recentred on patch and projected centre (simd/sample.hpp); are the patch's corners visible?
//   collect  strips of 256 pixels: warp | taps | interpolation. Where a corner is not visible, or a mask is given,
//            the visible pixels are moved together first
//   sums     of products of rows, in float over at most 256 terms a lane, then in double
//   finish   projection through mean and s, and change of parameters, in double
//
// Few pixels (kRowPixels) take rows of the parameters themselves, projected and weighted pixel by pixel. More take one
// pass of unweighted sums. For Huber's cost the weighted sums of the outliers correct them, as other pixels have weight
// 1; Cauchy's and Tukey's costs sum all pixels again with their weights. All 9 parameters then go through the 8 of the
// pixel homography.
//
// Error against the double reference, for samples 1e-4 px clear of pixel lines (where the gradient jumps) and patches
// of at most 128 px: coordinates 1e-5 px; r sqrt(N) 1e-5 (1 + |g| / sigma), sigma being the standard deviation of the
// target's intensities. What that makes of the sums depends on the image. Whatever it is, white noise included: entries
// of H and b 5e-4 of sqrt(F_ii F_jj) and sqrt(F_ii), F being H with the normalisation frozen (for Cauchy and Tukey: and
// without weights); cost and E 1e-4 of themselves and 1e-5. On the textures of the tests (some 5 % of change a px):
// 3e-5, and 1e-5 and 1e-6. For delta < 0.1 the bound of H and b grows as 1 / delta, since weights are ratios to delta.
#ifndef TEXTPLANE_SIMD_RESIDUAL_HPP
#define TEXTPLANE_SIMD_RESIDUAL_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/simd/lens.hpp"
#include "textplane/simd/robust.hpp"
#include "textplane/simd/sample.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace simd {

/// One host patch, one 8-bit target, one pose and plane. All arrays are the caller's.
struct ResidualArgs {
  const float* x = nullptr;  ///< n host pixels: positions, intensities.
  const float* y = nullptr;
  const float* intensity = nullptr;
  int n = 0;
  const std::uint8_t* mask = nullptr;         ///< If not null: pixels with 0 here do not exist.
  const std::uint8_t* on_set = nullptr;       ///< Another such mask.
  PointBounds bounds;                         ///< Of all n pixels, or none.
  Image8 target;                              ///< readable().
  double R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< Host to target, row-major.
  double t[3] = {};
  double theta[3] = {};        ///< Plane in the host frame, theta^T p = 1.
  double host_camera[4] = {};  ///< fx, fy, cx, cy.
  double target_camera[4] = {};
  const LensFit* lens = nullptr;  ///< Of the target camera, near this patch; null where it has none.
  bool exact = true;              ///< Derivatives through mean and s; else both are held.
  RobustKind robust = RobustKind::huber;
  double delta = 0.5;             ///< Of the robust cost, on r sqrt(N).
  double min_contrast = 0;        ///< Least standard deviation of either side, in intensity units.
  int min_visible = 1;            ///< Sums are taken from this many visible pixels on.
  std::uint8_t* flags = nullptr;  ///< If not null: n bytes, 1 for visible pixels, 0 for others.
  float* scratch = nullptr;       ///< residual_scratch(n) floats.
};

/// Floats of scratch memory for n pixels: ten arrays with room for whole vectors, whose starts differ modulo 4 KiB.
constexpr std::size_t residual_scratch(int n) noexcept {
  return 10 * ((static_cast<std::size_t>(n > 0 ? n : 0) + 159) / 256 * 256 + 112);
}

/// What is known about the residuals. Only the counts mean anything unless the status is ok.
struct ResidualInfo {
  int candidates = 0;  ///< Pixels that the masks let through.
  int behind = 0;      ///< Of these, behind one of the cameras.
  int visible = 0;     ///< N.
  double cost = 0;     ///< Sum of rho(N r^2) / N.
  double error = 0;    ///< E = sum of r^2.
  double mean = 0;     ///< Of the target intensities.
  double s = 0;        ///< ||I - mean|| of the same.
  /// ok; too_few below min_visible; no_contrast; unsupported where float or the homography's inverse do not carry
  /// the case, and the double reference must take it.
  Status status = Status::invalid_argument;
};

}  // namespace simd

namespace detail {
enum : int {
  kRowPixels = 256,  // up to here rows of the parameters, from here on sums that are corrected
  kFoldTerms = 256,  // terms of a lane before a sum goes to double
  kMostSums = 56,    // 27 + 3 * 8, and a multiple of eight
  kMostLanes = 16,
};

// The geometry of one call. (c, d) is the target's principal point relative to the origin.
struct ResidualFrame {
  simd::Warp8 warp;    // to the image, or behind a lens to its pinhole image; its origin is that of both
  SampleFrame sample;  // around (ox, oy)
  ImageTiles tiles;    // used where its guess is likely
  LensFrame lens;
  float rho[3];                   // rho = theta^T m~ of a host pixel: rho0 u + rho1 v + rho2
  double inverse[9];              // H^-1, row-major
  double q[3];                    // theta^T H^-1
  double c, d, fx, fy, ifx, ify;  // focal lengths of the target or of its pinhole image, and their inverses
  bool inside;                    // if true, every pixel of the patch is visible
};

// The caller's scratch: one array of each.
struct ResidualArrays {
  float *x, *y;        // target coordinates relative to the origin
  float *a, *b;        // gradient there
  float* i;            // target intensity, less an offset
  float* d;            // host intensity, less an offset; later kappa times that, less i
  float *hx, *hy, *h;  // visible host pixels, closed up
  std::int32_t* list;
};
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/frame.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/collect.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/sums.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/moments.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/rows.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/strip_sums.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/centre.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/weights.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/finish.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/large.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/small.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/entry.inl"
#include "textplane/simd/foreach_target.inl"

TEXTPLANE_BEGIN_NAMESPACE

namespace simd {

/// Normal equations for theta: H (3 x 3, symmetric) and b (3), of which nothing may be used unless the status is ok.
TEXTPLANE_KERNEL void linearise_plane(const ResidualArgs& args, ResidualInfo* out, double* H, double* b) noexcept
    TEXTPLANE_SIMD_BODY(linearise_plane(args, out, H, b));

/// The same for the pose, (v, omega): 6 x 6 and 6.
TEXTPLANE_KERNEL void linearise_pose(const ResidualArgs& args, ResidualInfo* out, double* H, double* b) noexcept
    TEXTPLANE_SIMD_BODY(linearise_pose(args, out, H, b));

/// The same for both, (v, omega, theta): 9 x 9 and 9.
TEXTPLANE_KERNEL void linearise_pose_plane(const ResidualArgs& args, ResidualInfo* out, double* H, double* b) noexcept
    TEXTPLANE_SIMD_BODY(linearise_pose_plane(args, out, H, b));

/// Cost, E and counts alone.
TEXTPLANE_KERNEL void evaluate(const ResidualArgs& args, ResidualInfo* out) noexcept
    TEXTPLANE_SIMD_BODY(evaluate(args, out));

}  // namespace simd

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_RESIDUAL_HPP
