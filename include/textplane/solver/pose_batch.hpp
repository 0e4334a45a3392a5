// PoseBatch: the small texts of one image, linearised together by the batch kernel, one a lane (simd/batch.hpp).
//
// One text of 15 pixels takes as long as one of 60: its results wait for each other. In lanes beside others it takes a
// third; of larger ones little is gained. Normal equations and cost come from one run of the kernel, so that an
// accepted trial is linearised already.
#ifndef TEXTPLANE_SOLVER_POSE_BATCH_HPP
#define TEXTPLANE_SOLVER_POSE_BATCH_HPP

#include <algorithm>
#include <cstddef>
#include <vector>

#include "textplane/core/cache_line.hpp"
#include "textplane/core/cameras/camera_view.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/photometry/batch/text_batch_pack.hpp"
#include "textplane/photometry/residual_request.hpp"
#include "textplane/photometry/residual_result.hpp"
#include "textplane/simd/batch.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
constexpr int kBatchFewest = 4;       // texts: fewer go one by one
constexpr int kBatchMostPixels = 32;  // of a text: larger ones do

/// One text of a batch, on one level.
struct PoseBatchItem {
  int text = -1;  // its place among the terms
  PatchView patch;
  Pinhole<double> host_camera;
  Vector3<double> theta = Vector3<double>::Zero();
  SE3d T_w_h;
};

/// For one thread at a time. Only reserve() allocates.
class PoseBatch {
 public:
  /// Room for all of `texts` terms.
  void reserve(int texts) {
    const auto count = static_cast<std::size_t>(texts > 0 ? texts : 0);
    if (slots_.size() >= count) return;
    const std::size_t groups = (count + simd::kBatchLanes - 1) / simd::kBatchLanes;
    slots_ = std::vector<int>(count);  // made, not grown: see TextBatch::build()
    items_.resize(count);
    poses_.resize(count);
    status_.resize(count);
    groups_.resize(groups);
    pixels_ = cache_lines<float>(groups * kGroupFloats);
    out_ = cache_lines<float>(simd::batch_floats(texts, 6));
    scratch_ = cache_lines<float>(simd::batch_scratch(kBatchMostPixels));
  }

  /// No text is in the batch.
  void clear() noexcept {
    count_ = 0;
    has_run_ = false;
    std::fill(slots_.begin(), slots_.end(), -1);
  }

  /// Whether the batch kernel computes against this image what the kernels of one text would.
  static bool takes(const CameraView& camera, const ImageView8& target, const PhotometricOptions& options) noexcept {
    return !camera.lens && !camera.rows && camera.valid() && !options.precise && options.valid() && target.valid() &&
           simd::readable(batch_image(target));
  }

  /// Adds a text, or leaves it to the kernels of one text.
  void add(const PoseBatchItem& item) noexcept {
    const PatchView& p = item.patch;
    if (p.x && p.y && p.intensity && p.n > 0 && p.n <= kBatchMostPixels && usable_pixels(p) == p.n &&
        item.host_camera.valid())
      items_[static_cast<std::size_t>(count_++)] = item;
  }

  /// Packs what was added, texts of one size beside each other. Too few of them leave the batch empty.
  void pack() noexcept {
    if (count_ < kBatchFewest) return clear();
    std::sort(items_.begin(), items_.begin() + count_, [](const PoseBatchItem& a, const PoseBatchItem& b) {
      return a.patch.n != b.patch.n ? a.patch.n < b.patch.n : a.text < b.text;
    });
    for (int i = 0; i < count_; ++i) {
      const auto group = static_cast<std::size_t>(i / simd::kBatchLanes);
      const int lane = i % simd::kBatchLanes;
      const std::size_t start = group * kGroupFloats;
      if (lane == 0) {
        groups_[group] = simd::BatchGroup();
        groups_[group].start = static_cast<std::ptrdiff_t>(start);
      }
      const PoseBatchItem& item = items_[static_cast<std::size_t>(i)];
      pack_lane(item.patch, item.host_camera, item.theta, lane, &groups_[group], numbers(pixels_) + start);
      slots_[static_cast<std::size_t>(item.text)] = i;
    }
  }

  bool empty() const noexcept { return count_ == 0; }

  /// Linearises all by the pose T_c_w, unless the last call did.
  void run(const SE3d& T_c_w, const ImageView8& target, const Pinhole<double>& camera,
           const PhotometricOptions& options) noexcept {
    if (has_run_ && T_c_w.R == at_.R && T_c_w.t == at_.t) return;
    has_run_ = true;
    at_ = T_c_w;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) poses_[i] = T_c_w * items_[i].T_w_h;
    simd::BatchArgs args;
    args.groups = groups_.data();
    args.count = count_;
    args.pixels = numbers(pixels_);
    set_batch_args(target, camera, poses_.data(), options, &args);
    args.scratch = numbers(scratch_);
    args.out = numbers(out_);
    args.status = status_.data();
    simd::batch_linearise_pose(args);
  }

  /// What run() found for a text, where it is in the batch and all of its pixels are visible; false elsewhere. With
  /// `whole` also H and b.
  bool take(int text, bool whole, NormalEquations<6>* out) const noexcept {
    if (count_ == 0) return false;
    const int slot = slots_[static_cast<std::size_t>(text)];
    if (slot < 0 || !is_ok(status_[static_cast<std::size_t>(slot)])) return false;
    const auto result = [&](simd::BatchEntry which) {
      return static_cast<double>(numbers(out_)[batch_place(6, slot, which)]);
    };
    out->visible = static_cast<int>(result(simd::BatchEntry::visible));
    if (out->visible != items_[static_cast<std::size_t>(slot)].patch.n) return false;
    out->status = Status::ok;
    out->cost = result(simd::BatchEntry::cost);
    if (!whole) return true;
    out->error = range_error(result(simd::BatchEntry::error));
    const float* entry = numbers(out_) + batch_place(6, slot, 0);
    out->zncc = 1 - 0.5 * out->error;
    for (int r = 0; r < 6; ++r)
      for (int c = r; c < 6; ++c, entry += simd::kBatchLanes) out->H(c, r) = static_cast<double>(*entry);
    for (int r = 0; r < 6; ++r, entry += simd::kBatchLanes) out->b[r] = static_cast<double>(*entry);
    return true;
  }

 private:
  static constexpr std::size_t kGroupFloats = static_cast<std::size_t>(kBatchMostPixels) * 3 * simd::kBatchLanes;

  std::vector<int> slots_;            // of each term; -1: not in the batch
  std::vector<PoseBatchItem> items_;  // of each slot
  std::vector<SE3d> poses_;
  std::vector<Status> status_;
  std::vector<simd::BatchGroup> groups_;
  std::vector<CacheLine<float>> pixels_, out_, scratch_;
  SE3d at_;
  int count_ = 0;
  bool has_run_ = false;
};
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_POSE_BATCH_HPP
