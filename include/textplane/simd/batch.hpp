// Batch kernels: many text objects of a few pixels each against one image, one object a lane. photometry/text_batch.hpp
// is the typed form; what r, E, H and b are is said in photometry/residual.hpp.
//
// Objects lie in groups of kBatchLanes. A group holds, pixel by pixel, the lanes' host coordinates u and v relative to
// each object's centre and its host intensities; objects of fewer pixels end earlier. Geometry (H, recentred on patch
// and projected centre) is in double, everything else in float: rows of the parameters, pixel by pixel, in each lane,
// projected through mean and s before they are multiplied, so that no sum cancels. No sum crosses lanes, so an object's
// result does not depend on its neighbours. Error against the double reference, samples 1e-4 px clear of pixel lines:
// coordinates 1e-5 px for patches of 128 px, and N 6e-8 of sums of N terms of one sign: H, b and costs as in
// simd/residual.hpp for objects of up to 256 pixels.
#ifndef TEXTPLANE_SIMD_BATCH_HPP
#define TEXTPLANE_SIMD_BATCH_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/simd/robust.hpp"
#include "textplane/simd/sample.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace simd {

/// Lanes of a group, on every target.
constexpr int kBatchLanes = 16;

/// What is known of a group's objects before the pose, one object a lane. Lanes without an object have n = 0 and finite
/// numbers.
struct BatchGroup {
  double theta[3][kBatchLanes];               ///< Planes in the host frames.
  double ifx[kBatchLanes], ify[kBatchLanes];  ///< 1 / focal lengths of the hosts.
  double mu[kBatchLanes], mv[kBatchLanes];    ///< Normalised host coordinates of the patch's centre, where u = v = 0.
  double ru[kBatchLanes], rv[kBatchLanes];    ///< All |u| <= ru, |v| <= rv.
  int n[kBatchLanes];                         ///< Pixels.
  std::ptrdiff_t start;                       ///< Of the group's pixels in BatchArgs::pixels.
};

/// Entries of a result: H's upper triangle row by row (45, or 21), b (9, or 6), then these.
enum class BatchEntry : int { cost, error, mean, s, visible, count };
/// Floats of one result with 9 or 6 parameters.
constexpr int batch_entries(int parameters) noexcept {
  return parameters * (parameters + 1) / 2 + parameters + static_cast<int>(BatchEntry::count);
}

struct BatchArgs {
  const BatchGroup* groups = nullptr;
  int count = 0;                  ///< Objects, kBatchLanes a group.
  const float* pixels = nullptr;  ///< Of a group from its start on: [pixel][u, v, intensity][lane].
  /// Pose of object i: R at pose + i * pose_step, column by column, t three numbers from there + t_offset on.
  const double* pose = nullptr;
  std::ptrdiff_t pose_step = 12, t_offset = 9;
  double camera[4] = {1, 1, 0, 0};  ///< fx, fy, cx, cy of the target.
  Image8 target;                    ///< readable(); pairs are not used.
  bool exact = true;
  RobustKind robust = RobustKind::huber;
  double delta = 0.5;
  double min_contrast = 0;
  int min_visible = 1;
  float* scratch = nullptr;  ///< batch_scratch(largest n) floats.
  float* out =
      nullptr;  ///< [group][entry][lane], batch_entries(P) entries; zero unless the status is ok, but `visible`.
  Status* status = nullptr;  ///< One an object.
};

/// Floats of BatchArgs::out for `count` objects.
constexpr std::size_t batch_floats(int count, int parameters) noexcept {
  const int groups = (count + kBatchLanes - 1) / kBatchLanes;
  return static_cast<std::size_t>(groups) * kBatchLanes * static_cast<std::size_t>(batch_entries(parameters));
}
/// Floats of scratch memory for objects of at most n pixels.
constexpr std::size_t batch_scratch(int n) noexcept {
  return static_cast<std::size_t>(n > 0 ? n : 0) * 12 * kBatchLanes;
}

}  // namespace simd

namespace detail {
// A vector's worth of objects: constants of the warp, of rows and of the image's border, one a lane. `scale` is in rho
// and t.
struct BatchFrame {
  float g[9][simd::kBatchLanes], rho[3][simd::kBatchLanes], t[3][simd::kBatchLanes];
  float u0[simd::kBatchLanes], v0[simd::kBatchLanes];        // normalised target coordinates of the origin
  float hu[2][simd::kBatchLanes], hv[2][simd::kBatchLanes];  // host: mu = hu0 u + hu1
  float x_low[simd::kBatchLanes], x_high[simd::kBatchLanes], y_low[simd::kBatchLanes], y_high[simd::kBatchLanes];
  std::int32_t n[simd::kBatchLanes];
  bool whole[simd::kBatchLanes];  // all of the object is certainly visible
};
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/batch_sample.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/batch_sums.inl"
#include "textplane/simd/foreach_target.inl"
#define TEXTPLANE_SIMD_KERNEL "textplane/simd/kernels/residual/batch.inl"
#include "textplane/simd/foreach_target.inl"

TEXTPLANE_BEGIN_NAMESPACE

namespace simd {

/// The costs of all objects.
TEXTPLANE_KERNEL void batch_evaluate(const BatchArgs& args) noexcept TEXTPLANE_SIMD_BODY(batch_evaluate(args));
/// Their normal equations by the pose.
TEXTPLANE_KERNEL void batch_linearise_pose(const BatchArgs& args) noexcept
    TEXTPLANE_SIMD_BODY(batch_linearise_pose(args));
/// Their normal equations by pose and plane.
TEXTPLANE_KERNEL void batch_linearise_pose_plane(const BatchArgs& args) noexcept
    TEXTPLANE_SIMD_BODY(batch_linearise_pose_plane(args));

}  // namespace simd

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SIMD_BATCH_HPP
