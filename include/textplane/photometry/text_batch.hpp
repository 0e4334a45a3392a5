// TextBatch: many text objects of a few pixels each (the paper's 15, up to some hundred), judged against one image at
// once: verification of all signs of a map in one frame, or normal equations of all of them.
//
// One object fills one lane of the vectors, so 15 pixels cost no more a pixel than thousands do; objects that lie
// wholly behind a camera or outside the image cost a few dozen cycles. Objects of very different size waste lanes.
#ifndef TEXTPLANE_PHOTOMETRY_TEXT_BATCH_HPP
#define TEXTPLANE_PHOTOMETRY_TEXT_BATCH_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/core/cache_line.hpp"
#include "textplane/core/cameras/camera_view.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/geometry/row_warp.hpp"
#include "textplane/photometry/batch/text_batch_pack.hpp"
#include "textplane/photometry/photometric_workspace.hpp"
#include "textplane/photometry/residual_request.hpp"
#include "textplane/photometry/residual_result.hpp"
#include "textplane/simd/batch.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// One object of a batch: host pixels of one level, the host's camera of that level, and the plane in the host frame.
struct TextBatchItem {
  PatchView patch;                                  ///< Host pixels of one level.
  Pinhole<double> host_camera;                      ///< Of the level that `patch` is of.
  Vector3<double> theta = Vector3<double>::Zero();  ///< Plane in the host frame.
  PatchRows rows = {};                              ///< As TextPatch::rows, where the host's shutter rolls.
};

/// The host side of many objects, packed once. Thread-safe to read.
class TextBatch {
 public:
  TextBatch() = default;
  TextBatch(const TextBatchItem* items, int count) { build(items, count); }  ///< As build().

  /// Packs the items anew; pixels that are masked or not finite are left out. Allocates. An item with null pointers, a
  /// negative n or a camera that is not valid() keeps its place, and has Status::invalid_argument in every result.
  /// invalid_argument for null items or a negative count: the batch is then empty.
  Status build(const TextBatchItem* items, int count) {
    groups_.clear();
    valid_ = std::vector<std::uint8_t>();
    rows_ = std::vector<PatchRows>();
    pixels_ = cache_lines<float>(0);
    most_ = 0;
    if (count < 0 || (count > 0 && !items)) return Status::invalid_argument;
    // Vectors of numbers do not grow, they are made: growing ones would share weak symbols with files built for other
    // CPUs.
    valid_ = std::vector<std::uint8_t>(static_cast<std::size_t>(count));
    std::size_t total = 0;
    for (int first = 0; first < count; first += simd::kBatchLanes)
      total += count_group(items + first, first, (std::min)(count - first, simd::kBatchLanes));
    pixels_ = cache_lines<float>(total);
    total = 0;
    for (int first = 0; first < count; first += simd::kBatchLanes)
      total = add_group(items + first, first, (std::min)(count - first, simd::kBatchLanes), total);
    const bool rolling = std::any_of(items, items + count, [](const TextBatchItem& i) { return i.rows.active(); });
    if (rolling) rows_ = std::vector<PatchRows>(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i] = items[i].rows;
    return Status::ok;
  }

  int size() const noexcept { return static_cast<int>(valid_.size()); }  ///< Objects that it was built of.
  int max_pixels() const noexcept { return most_; }                      ///< Pixels of the largest object.
  /// A new plane for object i, 0 <= i < size().
  void set_plane(int i, const Vector3<double>& theta) noexcept {
    simd::BatchGroup& group = groups_[static_cast<std::size_t>(i / simd::kBatchLanes)];
    for (int k = 0; k < 3; ++k) group.theta[k][i % simd::kBatchLanes] = theta[k];
  }

  bool valid(int i) const noexcept { return valid_[static_cast<std::size_t>(i)] != 0; }  ///< For the kernels.
  /// The host's rows of object i; null where no object has any. For the kernels.
  const PatchRows* rows(int i) const noexcept { return rows_.empty() ? nullptr : &rows_[static_cast<std::size_t>(i)]; }
  /// Sets the kernels' pointers to what was built.
  void fill(simd::BatchArgs* args) const noexcept {
    args->groups = groups_.data();
    args->count = size();
    args->pixels = numbers(pixels_);
  }

 private:
  // Floats that a group needs.
  std::size_t count_group(const TextBatchItem* items, int first, int members) {
    int most = 0;
    for (int l = 0; l < members; ++l) {
      const PatchView& p = items[l].patch;
      const bool valid = p.x && p.y && p.intensity && p.n >= 0 && items[l].host_camera.valid();
      valid_[static_cast<std::size_t>(first + l)] = valid;
      if (valid) most = (std::max)(most, detail::usable_pixels(p));
    }
    most_ = (std::max)(most_, most);
    return static_cast<std::size_t>(most) * 3 * simd::kBatchLanes;
  }

  // Packs a group from float `start` on; returns where the next one starts.
  std::size_t add_group(const TextBatchItem* items, int first, int members, std::size_t start) {
    simd::BatchGroup group = {};
    group.start = static_cast<std::ptrdiff_t>(start);
    int most = 0;
    for (int l = 0; l < members; ++l) {
      if (!valid_[static_cast<std::size_t>(first + l)]) continue;
      detail::pack_lane(items[l].patch, items[l].host_camera, items[l].theta, l, &group, numbers(pixels_) + start);
      most = (std::max)(most, group.n[l]);
    }
    groups_.push_back(group);
    return start + static_cast<std::size_t>(most) * 3 * simd::kBatchLanes;
  }

  std::vector<simd::BatchGroup> groups_;
  std::vector<std::uint8_t> valid_;
  std::vector<PatchRows> rows_;  // of each object, or none
  std::vector<CacheLine<float>> pixels_;
  int most_ = 0;
};

/// Results of the last call on a batch, and the memory that it needs. One a thread.
class TextBatchResult {
 public:
  TextBatchResult() = default;
  explicit TextBatchResult(const TextBatch& batch) { reserve(batch); }  ///< With room for the results of `batch`.

  /// Makes room for the batch and nine parameters. The only member that allocates; never shrinks.
  void reserve(const TextBatch& batch) {
    const auto objects = static_cast<std::size_t>(batch.size());
    if (number_count(out_) < floats(batch)) out_ = cache_lines<float>(floats(batch));
    if (status_.size() < objects) status_.resize(objects);
    workspace_.reserve(batch.max_pixels());
    const std::size_t scratch = simd::batch_scratch(batch.max_pixels());
    if (number_count(scratch_) < scratch) scratch_ = cache_lines<float>(scratch);
  }
  /// Whether reserve() was called for a batch of this size.
  bool fits(const TextBatch& batch) const noexcept {
    return number_count(out_) >= floats(batch) && status_.size() >= static_cast<std::size_t>(batch.size()) &&
           number_count(scratch_) >= simd::batch_scratch(batch.max_pixels()) &&
           workspace_.capacity() >= batch.max_pixels();
  }

  /// Of object i, as reference::linearise() would say it; all zero, `visible` excepted, unless is_ok(status).
  Status status(int i) const noexcept { return status_[static_cast<std::size_t>(i)]; }
  double cost(int i) const noexcept { return tail(i, simd::BatchEntry::cost); }  ///< Robust cost of object i.
  /// E of object i: sum of r^2 over its visible pixels, in [0, 4].
  double error(int i) const noexcept { return detail::range_error(tail(i, simd::BatchEntry::error)); }
  /// ZNCC of object i, 0 unless its status is ok.
  double zncc(int i) const noexcept { return is_ok(status(i)) ? 1.0 - 0.5 * error(i) : 0.0; }
  /// Visible pixels of object i.
  int visible(int i) const noexcept { return static_cast<int>(tail(i, simd::BatchEntry::visible)); }

  /// Of object i, after linearise_batch() of the same unknowns; otherwise zeros.
  template <Parameters Unknowns>
  NormalEquations<dof(Unknowns)> normal_equations(int i) const noexcept {
    constexpr int P = dof(Unknowns);
    NormalEquations<P> n;
    n.status = status(i);
    if (parameters_ != P || !is_ok(n.status)) return n;
    int entry = 0;
    for (int r = 0; r < P; ++r)
      for (int c = r; c < P; ++c, ++entry) n.H(r, c) = n.H(c, r) = at(i, entry);
    for (int r = 0; r < P; ++r, ++entry) n.b[r] = at(i, entry);
    n.cost = cost(i);
    n.error = error(i);
    n.zncc = zncc(i);
    n.visible = visible(i);
    n.mean = tail(i, simd::BatchEntry::mean);
    n.s = tail(i, simd::BatchEntry::s);
    return n;
  }

  PhotometricWorkspace& workspace() noexcept { return workspace_; }  ///< For the kernels of one object.
  /// For the kernels.
  void fill(int parameters, simd::BatchArgs* args) noexcept {
    parameters_ = parameters;
    args->out = numbers(out_);
    args->status = status_.data();
    args->scratch = numbers(scratch_);
  }

 private:
  // Of the results of nine parameters, the most.
  static std::size_t floats(const TextBatch& batch) noexcept { return simd::batch_floats(batch.size(), 9); }

  double at(int i, int entry) const noexcept {
    return static_cast<double>(numbers(out_)[detail::batch_place(parameters_, i, entry)]);
  }
  double tail(int i, simd::BatchEntry entry) const noexcept {
    return static_cast<double>(numbers(out_)[detail::batch_place(parameters_, i, entry)]);
  }

  std::vector<CacheLine<float>> out_, scratch_;
  std::vector<Status> status_;
  PhotometricWorkspace workspace_;
  int parameters_ = 0;
};

namespace detail {
// The image that a batch is judged against.
struct BatchTarget {
  ImageView8 image;
  CameraView camera;  // of the image's level
  int level;
};

// text_batch_lens.hpp
template <int P>
void run_batch_behind(const TextBatch& batch, const simd::BatchArgs& args, const BatchTarget& target, const SE3d* T_t_h,
                      const PhotometricOptions& options, PhotometricWorkspace& workspace) noexcept;

// Costs alone (P = 0), or with normal equations of P parameters.
template <int P>
Status run_batch(const TextBatch& batch, const BatchTarget& target, const SE3d* T_t_h,
                 const PhotometricOptions& options, TextBatchResult& result) noexcept {
  const CameraView& camera = target.camera;
  if (!result.fits(batch)) return Status::invalid_argument;
  simd::BatchArgs args;
  batch.fill(&args);
  result.fill(P, &args);
  if (!target.image.valid() || !simd::readable(batch_image(target.image)) || !camera.valid() || !options.valid() ||
      (!T_t_h && batch.size() > 0)) {
    for (int i = 0; i < batch.size(); ++i) args.status[i] = Status::invalid_argument;
    std::fill_n(args.out, simd::batch_floats(batch.size(), P), 0.0F);
    return Status::invalid_argument;
  }
  if (batch.size() == 0) return Status::ok;
  detail::set_batch_args(target.image, camera.pinhole, T_t_h, options, &args);
  if (camera.lens || (camera.rows && camera.rows->active()) || batch.rows(0)) {
    run_batch_behind<P>(batch, args, target, T_t_h, options, result.workspace());
  } else {
    if constexpr (P == 0) simd::batch_evaluate(args);
    if constexpr (P == 6) simd::batch_linearise_pose(args);
    if constexpr (P == 9) simd::batch_linearise_pose_plane(args);
  }
  for (int i = 0; i < batch.size(); ++i)
    if (!batch.valid(i)) args.status[i] = Status::invalid_argument;
  return Status::ok;
}
}  // namespace detail

/// The cost of every object of the batch against one image. `T_t_h`: one pose an object. `camera`: the target's, of the
/// target's level, which `level` says where the camera has rows.
///
/// Results agree with reference::evaluate() within the bounds of simd/batch.hpp. An object whose geometry overflows
/// float (a number beyond 1e30) is non_finite. Returns ok, or invalid_argument for null poses, a target below 2 x 2, a
/// camera that is not valid(), bad options, or a result without room; all objects then have that status. The kernels
/// compute all of it; behind a lens or a rolling shutter objects go one by one. No allocation; thread-safe for distinct
/// results.
TEXTPLANE_DEFERRED
Status evaluate_batch(const TextBatch& batch, const ImageView8& target, const CameraView& camera, const SE3d* T_t_h,
                      const PhotometricOptions& options, TextBatchResult& result, int level = 0) noexcept {
  return detail::run_batch<0>(batch, {target, camera, level}, T_t_h, options, result);
}

/// As evaluate_batch(), with the normal equations of every object: by Parameters::pose or Parameters::pose_plane.
template <Parameters Unknowns>
Status linearise_batch(const TextBatch& batch, const ImageView8& target, const CameraView& camera, const SE3d* T_t_h,
                       const PhotometricOptions& options, TextBatchResult& result, int level = 0) noexcept {
  static_assert(Unknowns == Parameters::pose || Unknowns == Parameters::pose_plane,
                "textplane: linearise_batch() is by pose or pose_plane");
  return detail::run_batch<dof(Unknowns)>(batch, {target, camera, level}, T_t_h, options, result);
}

TEXTPLANE_END_NAMESPACE

#include "textplane/photometry/lens/text_batch_lens.hpp"

#endif  // TEXTPLANE_PHOTOMETRY_TEXT_BATCH_HPP
