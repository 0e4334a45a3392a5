// What refine_pose() takes: text objects and points, options, and memory.
#ifndef TEXTPLANE_SOLVER_POSE_TERMS_HPP
#define TEXTPLANE_SOLVER_POSE_TERMS_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/photometry/photometric_workspace.hpp"
#include "textplane/photometry/residual_request.hpp"
#include "textplane/photometry/template_patch.hpp"
#include "textplane/solver/gauss_newton.hpp"
#include "textplane/solver/pose_batch.hpp"
#include "textplane/solver/weighting.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A text object whose host pose and plane are held fixed.
struct PoseTextTerm {
  const TextPatch* patch = nullptr;                 ///< Its pixels in the host; not owned.
  Vector3<double> theta = Vector3<double>::Zero();  ///< Plane in the host frame.
  SE3d T_w_h;                                       ///< Host camera to world.
  double weight = 1;                                ///< Multiplies lambda_w.
  int scale_shift = 0;  ///< Of photometric_input(), for targets that see it at another size.
  /// One prepared form a level of the patch, for LinearisePolicy::template_jacobian and hybrid, or null.
  const TemplatePatch* prepared = nullptr;
  int camera = 0;  ///< Which camera of a rig sees it; 0 where there is one.
};

/// A known 3D point and its pixel.
struct PosePointTerm {
  Vector3<double> p_w = Vector3<double>::Zero();  ///< In the world.
  Vector2<double> px = Vector2<double>::Zero();   ///< Of the image as the camera of the solve sees it, level 0.
  double sigma = 1;  ///< Standard deviation of px as a multiple of PoseOptions::sigma_rep; see valid_sigma().
  int camera = 0;    ///< Which camera of a rig saw it; 0 where there is one.
};

/// Settings of refine_pose() and align_pose().
struct PoseOptions {
  PhotometricOptions photometric;  ///< Of every pixel of the texts.
  /// How lambda_w follows from sigma_rep and sigma_photo. sigma_photo is the standard deviation of a pixel's residual
  /// in units of 1/sqrt(N) for `variance` (0.3: ZNCC 0.955), and of an object's error (the paper's E_text) for `paper`.
  Weighting weighting = Weighting::variance;
  double sigma_photo = 0.3;  ///< Its unit depends on `weighting`.
  double sigma_rep = 1;      ///< px, of a point with sigma 1.
  /// On |e| / sigma: root of the 95 % bound of chi-square with 2 degrees of freedom.
  Robust point_robust{RobustKind::huber, 2.4477};
  /// Of the finest level. Coarser levels stop at a relative gain of 1e-3 or a step of 1e-5, or earlier.
  SolveOptions solve;
  int coarsest_level = 2;  ///< Lowered to the levels that target and patches have.
  int finest_level = 0;    ///< The last level; 0 is the image itself.
  /// Whose gradients linearise the texts (docs/policy.md, policy_at_level()). Patches without gradients take forward.
  /// The cost alone accepts or rejects a step.
  LinearisePolicy policy = LinearisePolicy::forward;
  /// A smaller ZNCC on the finest level is Status::diverged; -1 lets all pass. align_pose() only: refine_pose() tells
  /// the ZNCC of every text.
  double min_zncc = 0.5;
};

namespace detail {
// A text in the last linearisation.
struct PoseTextState {
  std::size_t offset = 0;  // Of its visible set.
  double weight = 0;       // lambda_w times the term's weight, for the visible set.
  double zncc = 0;
  int visible = 0;  // 0: not used.
};

template <class View>
class PoseProblem;
}  // namespace detail

/// Memory of refine_pose(), to be reused from frame to frame; for one thread at a time.
class PoseWorkspace {
 public:
  /// Makes room for these terms (every level of their patches). The only member that allocates; never shrinks.
  void reserve(const PoseTextTerm* texts, int text_count, int point_count) {
    std::size_t pixels = 0;
    int largest = 0;
    for (int i = 0; i < text_count; ++i) {
      const int n = pixel_count(texts[i]);
      pixels += static_cast<std::size_t>(n);
      largest = (std::max)(largest, n);
    }
    photometric_.reserve(largest);
    if (visible_.size() < pixels) visible_.resize(pixels);
    if (text_count > 0 && texts_.size() < static_cast<std::size_t>(text_count))
      texts_.resize(static_cast<std::size_t>(text_count));
    if (point_count > 0 && points_.size() < static_cast<std::size_t>(point_count))
      points_.resize(static_cast<std::size_t>(point_count));
    if (rows_.size() < points_.size()) rows_.resize(points_.size());
    if (text_count >= detail::kBatchFewest) batch_.reserve(text_count);
  }

  /// Whether it has room for these terms.
  bool fits(const PoseTextTerm* texts, int text_count, int point_count) const noexcept {
    std::size_t pixels = 0;
    for (int i = 0; i < text_count; ++i) {
      const int n = pixel_count(texts[i]);
      if (n > photometric_.capacity()) return false;
      pixels += static_cast<std::size_t>(n);
    }
    return pixels <= visible_.size() && static_cast<std::size_t>(text_count) <= texts_.size() &&
           static_cast<std::size_t>(point_count) <= points_.size();
  }

 private:
  template <class View>
  friend class detail::PoseProblem;

  static int pixel_count(const PoseTextTerm& term) noexcept { return term.patch ? term.patch->max_pixels() : 0; }

  PhotometricWorkspace photometric_;
  std::vector<std::uint8_t> visible_;  // Visible sets of the last linearisation, text after text.
  std::vector<detail::PoseTextState> texts_;
  std::vector<std::uint8_t> points_;  // 1: took part in the last linearisation.
  std::vector<SE3d> rows_;            // Of the points, behind a rolling shutter: increments of the pose.
  detail::PoseBatch batch_;           // Of the small texts.
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_POSE_TERMS_HPP
