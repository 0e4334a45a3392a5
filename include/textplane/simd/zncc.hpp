// Correlation of one prepared host patch with one image under many candidate poses: raw pointers in, one number a
// candidate out.
//
// Per candidate: the homography in double, then warp, value-only sampling in fixed point and three exact integer sums
// (simd/template.hpp), pixels in lanes. For patches below some 64 pixels the batch kernel (simd/batch.hpp), with
// candidates in lanes, is the faster one.
#ifndef TEXTPLANE_SIMD_ZNCC_HPP
#define TEXTPLANE_SIMD_ZNCC_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/simd/template.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace simd {

/// What ZnccArgs::zncc receives where a candidate does not see the whole patch, or the kernel declines: less than any
/// ZNCC.
constexpr float kZnccUnknown = -2.0F;

struct ZnccArgs {
  const TemplateModel* model = nullptr;
  ResidualArgs base;  ///< As of linearise_template(); R and t are not read.
  /// Pose of candidate i: R at pose + i * pose_step, column by column, t three numbers from there + t_offset on.
  const double* pose = nullptr;
  std::ptrdiff_t pose_step = 12, t_offset = 9;
  int count = 0;
  std::int16_t* values = nullptr;  ///< Room for model.n, rounded up to blocks.
  float* zncc = nullptr;  ///< `count` results: ZNCC, -1 without contrast or with too few pixels, or kZnccUnknown.
};

}  // namespace simd

TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/zncc.inl"
#include "textplane/simd/foreach_target.inl"

TEXTPLANE_BEGIN_NAMESPACE

namespace simd {

/// ZNCC of every candidate. Within 0.05 / sigma of the double reference's, sigma the lesser standard deviation of the
/// two sides in intensity units, and the same on every target where the float positions are.
TEXTPLANE_KERNEL void zncc_candidates(const ZnccArgs& args) noexcept TEXTPLANE_SIMD_BODY(zncc_candidates(args));

}  // namespace simd

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_ZNCC_HPP
