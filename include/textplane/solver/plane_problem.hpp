// The cost of theta over targets with known poses, as a problem for minimise(); its targets, options and memory.
//
//   C(theta) = sum_targets N c,    c: robust photometric cost (residual.hpp), N: its visible pixels
//
// This is the paper's text object refinement. N scales a pixel's cost to a patch of unit variance.
#ifndef TEXTPLANE_SOLVER_PLANE_PROBLEM_HPP
#define TEXTPLANE_SOLVER_PLANE_PROBLEM_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/photometry/residual.hpp"
#include "textplane/solver/gauss_newton.hpp"
#include "textplane/solver/levels.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A target image and its pose relative to the host. View: PyramidView, or PyramidViewF for float images.
template <class View>
struct BasicPlaneTarget {
  View image;           ///< Pyramid of the image, which the camera says how to see.
  SE3d T_t_h;           ///< Host to target.
  int scale_shift = 0;  ///< Of photometric_input(), for targets that see the object at another size.
  /// The host's patch for this target alone (blur.hpp), or null for the patch of refine_plane(). A target whose patch
  /// differs from that one in levels or numbers of pixels is not used.
  const TextPatch* patch = nullptr;
  const CameraView* camera = nullptr;  ///< Of level 0, or null for the camera of refine_plane().
};
using PlaneTarget = BasicPlaneTarget<PyramidView>;    ///< Of 8-bit images.
using PlaneTargetF = BasicPlaneTarget<PyramidViewF>;  ///< Of float images.

/// Settings of refine_plane() and align_plane().
struct PlaneOptions {
  PhotometricOptions photometric;  ///< Of every pixel.
  /// Of the finest level. Coarser levels stop at a relative gain of 1e-3 or a step of 1e-5, or earlier.
  SolveOptions solve;
  int coarsest_level = 2;  ///< Lowered to the levels that images and patch have.
  int finest_level = 0;    ///< The last level; 0 is the image itself.
};

namespace detail {
struct PlaneSystem {
  Matrix3<double> H = Matrix3<double>::Zero();
  Vector3<double> b = Vector3<double>::Zero();
  double cost = 0;
  Status status = Status::too_few;
};

template <class View>
class PlaneProblem;
}  // namespace detail

/// Memory of refine_plane(), for one thread at a time.
class PlaneWorkspace {
 public:
  /// Makes room for a patch (every level) seen in `targets` images. The only member that allocates; never shrinks.
  void reserve(const TextPatch& patch, int targets) {
    const int n = patch.max_pixels();
    photometric_.reserve(n);
    const std::size_t count = targets > 0 ? static_cast<std::size_t>(targets) : 0;
    if (visible_.size() < count * static_cast<std::size_t>(n)) visible_.resize(count * static_cast<std::size_t>(n));
    if (counts_.size() < count) counts_.resize(count);
  }

  /// Whether it has room for this patch and number of targets.
  bool fits(const TextPatch& patch, int targets) const noexcept {
    const int n = patch.max_pixels();
    const auto count = static_cast<std::size_t>(targets);
    return n <= photometric_.capacity() && count <= counts_.size() &&
           count * static_cast<std::size_t>(n) <= visible_.size();
  }

 private:
  template <class View>
  friend class detail::PlaneProblem;

  PhotometricWorkspace photometric_;
  std::vector<std::uint8_t> visible_;  // Visible sets of the last linearisation, target after target.
  std::vector<int> counts_;            // Visible pixels of each target; 0: not used.
};

namespace detail {
template <class View>
class PlaneProblem {
 public:
  using State = Vector3<double>;
  static constexpr int kParameters = 3;

  PlaneProblem(const TextPatch& patch, const BasicPlaneTarget<View>* targets, int count, const CameraView& camera,
               const PlaneOptions& options, PlaneWorkspace& workspace) noexcept
      : patch_(patch), targets_(targets), count_(count), camera_(camera), options_(options), memory_(workspace) {}

  void set_level(int level) noexcept { level_ = level; }

  PlaneSystem linearise(const Vector3<double>& theta) noexcept {
    PlaneSystem system;
    Status trouble = Status::too_few;
    visible_ = used_ = 0;
    zncc_ = 0;
    for (int i = 0; i < count_; ++i) {
      int& visible = memory_.counts_[static_cast<std::size_t>(i)];
      visible = 0;
      if (!fits(i)) continue;
      const auto q = request(i, theta);
      const NormalEquations<3> n = textplane::linearise<Parameters::plane>(q, memory_.photometric_);
      path_ = (std::max)(path_, n.path);
      visible = is_ok(n.status) ? n.visible : 0;
      if (visible == 0) {
        if (trouble == Status::too_few) trouble = n.status;
        continue;
      }
      std::copy_n(memory_.photometric_.visible(), q.input.patch.n, visible_set(i));
      for (int c = 0; c < 3; ++c) {
        system.b[c] += visible * n.b[c];
        for (int r = 0; r < 3; ++r) system.H(r, c) += visible * n.H(r, c);
      }
      system.cost += visible * n.cost;
      visible_ += visible;
      zncc_ += n.zncc;
      ++used_;
    }
    system.status = used_ > 0 ? Status::ok : trouble;
    return system;
  }

  Evaluation evaluate(const Vector3<double>& theta) noexcept {
    Evaluation e;
    int lost = 0;
    for (int i = 0; i < count_; ++i) {
      const int visible = memory_.counts_[static_cast<std::size_t>(i)];
      if (visible == 0) continue;
      const PhotometricCost c = textplane::evaluate(request(i, theta), memory_.photometric_, visible_set(i));
      path_ = (std::max)(path_, c.path);
      // A target that fails as a whole costs as much as an uncorrelated patch.
      e.cost += visible * (is_ok(c.status) ? c.cost : options_.photometric.robust.rho(2.0));
      lost += is_ok(c.status) ? c.lost : visible;
    }
    e.lost_fraction = visible_ > 0 ? static_cast<double>(lost) / visible_ : 0.0;
    return e;
  }

  Vector3<double> retract(const Vector3<double>& theta, const Vector3<double>& step) const noexcept {
    return {theta[0] + step[0], theta[1] + step[1], theta[2] + step[2]};
  }

  int visible_pixels() const noexcept { return visible_; }                       ///< Of the last linearisation.
  int targets_used() const noexcept { return used_; }                            ///< Likewise.
  double mean_zncc() const noexcept { return used_ > 0 ? zncc_ / used_ : 0.0; }  ///< Likewise.
  Path path() const noexcept { return path_; }                                   ///< Of all evaluations so far.

 private:
  ResidualRequest<PixelOf<View>> request(int i, const Vector3<double>& theta) const noexcept {
    const BasicPlaneTarget<View>& target = targets_[i];
    return {
        level_input(patch_of(i), level_, target.image, target.camera ? *target.camera : camera_, target.scale_shift),
        theta, target.T_t_h, options_.photometric};
  }

  const TextPatch& patch_of(int i) const noexcept { return targets_[i].patch ? *targets_[i].patch : patch_; }

  bool fits(int i) const noexcept {
    const TextPatch* own = targets_[i].patch;
    if (!own) return true;
    if (own->level_count() != patch_.level_count()) return false;
    for (std::size_t l = 0; l < patch_.levels.size(); ++l)
      if (own->levels[l].x.size() != patch_.levels[l].x.size()) return false;
    return true;
  }

  std::uint8_t* visible_set(int i) noexcept {
    return memory_.visible_.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(patch_.max_pixels());
  }

  const TextPatch& patch_;
  const BasicPlaneTarget<View>* targets_;
  int count_;
  CameraView camera_;  // may have been made of a pinhole for this call
  const PlaneOptions& options_;
  PlaneWorkspace& memory_;
  int level_ = 0;
  int visible_ = 0, used_ = 0;
  double zncc_ = 0;
  Path path_ = Path::kernel;
};
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_PLANE_PROBLEM_HPP
