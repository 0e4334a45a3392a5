// A TextBatch against an image behind a lens, or between rolling shutters: its objects one after the other, by the
// kernels of one object. From some 60 pixels an object on, that is as fast as lanes are.
#ifndef TEXTPLANE_PHOTOMETRY_LENS_TEXT_BATCH_LENS_HPP
#define TEXTPLANE_PHOTOMETRY_LENS_TEXT_BATCH_LENS_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "textplane/photometry/residual.hpp"
#include "textplane/photometry/text_batch.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {

/// One lane of a batch as a patch of its own: pixels relative to their centre, and the host camera that belongs to
/// them.
struct BatchLane {
  PatchView patch;
  Pinhole<double> host_camera;
  Vector3<double> theta;
};
/// `memory` has room for 3 n floats.
inline BatchLane batch_lane(const simd::BatchArgs& args, int i, float* memory) noexcept {
  const simd::BatchGroup& group = args.groups[i / simd::kBatchLanes];
  const int l = i % simd::kBatchLanes, n = group.n[l];
  float *x = memory, *y = memory + n, *intensity = memory + 2 * n;
  const float* from = args.pixels + group.start + l;
  for (int k = 0; k < n; ++k, from += 3 * simd::kBatchLanes) {
    x[k] = from[0];
    y[k] = from[simd::kBatchLanes];
    intensity[k] = from[2 * simd::kBatchLanes];
  }
  BatchLane out;
  out.patch = {x, y, intensity, nullptr, n};
  const double fx = 1 / group.ifx[l], fy = 1 / group.ify[l];
  out.host_camera = {fx, fy, -group.mu[l] * fx, -group.mv[l] * fy};
  out.theta = {group.theta[0][l], group.theta[1][l], group.theta[2][l]};
  return out;
}

template <int P>
void run_batch_behind(const TextBatch& batch, const simd::BatchArgs& args, const BatchTarget& target, const SE3d* T_t_h,
                      const PhotometricOptions& options, PhotometricWorkspace& workspace) noexcept {
  constexpr int kEntries = simd::batch_entries(P), kTail = kEntries - static_cast<int>(simd::BatchEntry::count);
  std::fill_n(args.out, simd::batch_floats(batch.size(), P), 0.0F);
  for (int i = 0; i < batch.size(); ++i) {
    if (!batch.valid(i)) continue;
    const BatchLane lane = batch_lane(args, i, args.scratch);
    PhotometricInput input;
    input.patch = lane.patch;
    input.host_camera = lane.host_camera;
    input.target_camera = target.camera.pinhole;
    input.target = target.image;
    input.lens = target.camera.lens;
    input.host_rows = batch.rows(i);
    input.rows = target.camera.rows;
    input.level = target.level;
    const ResidualRequest<std::uint8_t> request{input, lane.theta, T_t_h[i], options};
    float* out = args.out + static_cast<std::ptrdiff_t>(i / simd::kBatchLanes) * kEntries * simd::kBatchLanes +
                 i % simd::kBatchLanes;
    const auto put = [out](int entry, double value) { out[entry * simd::kBatchLanes] = static_cast<float>(value); };
    const auto put_tail = [&](simd::BatchEntry entry, double value) { put(kTail + static_cast<int>(entry), value); };
    if constexpr (P == 0) {
      const PhotometricCost cost = evaluate(request, workspace);
      args.status[i] = cost.status;
      put_tail(simd::BatchEntry::visible, cost.visible);
      if (!is_ok(cost.status)) continue;
      put_tail(simd::BatchEntry::cost, cost.cost);
      put_tail(simd::BatchEntry::error, cost.error);
    } else {
      const auto sums = linearise < P == 6 ? Parameters::pose : Parameters::pose_plane > (request, workspace);
      args.status[i] = sums.status;
      if (!is_ok(sums.status)) continue;
      int entry = 0;
      for (int r = 0; r < P; ++r)
        for (int c = r; c < P; ++c, ++entry) put(entry, sums.H(r, c));
      for (int r = 0; r < P; ++r, ++entry) put(entry, sums.b[r]);
      put_tail(simd::BatchEntry::visible, sums.visible);
      put_tail(simd::BatchEntry::cost, sums.cost);
      put_tail(simd::BatchEntry::error, sums.error);
      put_tail(simd::BatchEntry::mean, sums.mean);
      put_tail(simd::BatchEntry::s, sums.s);
    }
  }
}

}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_LENS_TEXT_BATCH_LENS_HPP
