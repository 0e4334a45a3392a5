// The joint cost of one camera pose over text objects and points, as a problem for minimise().
//
//   C(T_t_w) = sum_points rho(|e|^2 / sigma^2) + sum_texts lambda_w c,    e = reprojection error in px
//
// c is the robust photometric cost of a text object (residual.hpp); weighting.hpp has lambda_w. This is the paper's
// E_point + lambda_w E_text. The pose is perturbed from the left, T_t_w <- Exp(xi) T_t_w, xi = (v, omega), and with it
// every T_t_h = T_t_w T_w_h.
#ifndef TEXTPLANE_SOLVER_POSE_PROBLEM_HPP
#define TEXTPLANE_SOLVER_POSE_PROBLEM_HPP

#include <algorithm>
#include <cstddef>

#include "textplane/photometry/residual_policy.hpp"
#include "textplane/solver/levels.hpp"
#include "textplane/solver/pose_terms.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
struct PoseSystem {
  FixedMatrix<double, 6, 6> H = FixedMatrix<double, 6, 6>::Zero();
  Vector6<double> b = Vector6<double>::Zero();
  double cost = 0;
  Status status = Status::too_few;
};

/// Reprojection error e (px) of p_w. False for a point that is not finite or over 89.9 degrees off the optical axis.
template <class S>
bool reproject(const PosePointTerm& term, const SE3<S>& T_t_w, const Pinhole<S>& camera, Vector3<S>* p,
               Vector2<S>* e) noexcept {
  *p = T_t_w * term.p_w;
  const double z = (*p)[2];
  if (!(z > 0) || !(z * z > 1e-6 * p->squaredNorm())) return false;
  *e = camera.project(*p) - term.px;
  return is_finite((*e)[0]) && is_finite((*e)[1]) && valid_sigma(term.sigma);
}

/// Adds a point's part to the lower triangle of H, to b and to the cost. False where reproject() is.
inline bool add_point(const PosePointTerm& term, const SE3d& T_t_w, const Pinhole<double>& camera, const Robust& robust,
                      PoseSystem& system) noexcept {
  Vector3<double> p;
  Vector2<double> e;
  if (!reproject(term, T_t_w, camera, &p, &e)) return false;
  const double information = 1.0 / (term.sigma * term.sigma), r2 = e.squaredNorm() * information;
  const double weight = robust.weight(r2) * information;
  const double iz = 1.0 / p[2], u = p[0] * iz, v = p[1] * iz, fx = camera.fx, fy = camera.fy;
  // d e / d xi from dp = v + omega x p.
  const double jx[6] = {fx * iz, 0, -fx * u * iz, -fx * u * v, fx * (1 + u * u), -fx * v};
  const double jy[6] = {0, fy * iz, -fy * v * iz, -fy * (1 + v * v), fy * u * v, fy * u};
  for (int i = 0; i < 6; ++i) {
    const double wx = weight * jx[i], wy = weight * jy[i];
    system.b[i] += wx * e[0] + wy * e[1];
    for (int j = 0; j <= i; ++j) system.H(i, j) += wx * jx[j] + wy * jy[j];
  }
  system.cost += robust.rho(r2);
  return true;
}

/// H's upper triangle becomes its lower one.
inline void mirror(PoseSystem& system) noexcept {
  for (int i = 0; i < 6; ++i)
    for (int j = i + 1; j < 6; ++j) system.H(i, j) = system.H(j, i);
}

template <class View>
class PoseProblem {
 public:
  using State = SE3d;
  static constexpr int kParameters = 6;

  PoseProblem(const PoseTextTerm* texts, int text_count, const PosePointTerm* points, int point_count,
              const View& target, const Pinhole<double>& camera, const PoseOptions& options,
              PoseWorkspace& workspace) noexcept
      : texts_(texts),
        points_(points),
        text_count_(text_count),
        point_count_(point_count),
        target_(target),
        camera_(camera),
        options_(options),
        memory_(workspace) {}

  void set_level(int level) noexcept { level_ = level; }

  PoseSystem linearise(const SE3d& T_t_w) noexcept {
    PoseSystem system;
    Status trouble = Status::too_few;
    visible_pixels_ = active_points_ = active_texts_ = 0;
    std::size_t offset = 0;
    for (int i = 0; i < text_count_; ++i) {
      PoseTextState& state = text(i);
      state = PoseTextState{offset, 0, 0, 0};
      const Status status = add_text(texts_[i], T_t_w, state, system);
      if (!is_ok(status)) {
        if (trouble == Status::too_few) trouble = status;
        continue;
      }
      offset += static_cast<std::size_t>(texts_[i].patch->max_pixels());
      visible_pixels_ += state.visible;
      ++active_texts_;
    }
    for (int i = 0; i < point_count_; ++i) {
      const bool active = add_point(points_[i], T_t_w, camera_, options_.point_robust, system);
      memory_.points_[static_cast<std::size_t>(i)] = active;
      active_points_ += active;
    }
    mirror(system);
    system.status = active_texts_ + active_points_ > 0 ? Status::ok : trouble;
    return system;
  }

  Evaluation evaluate(const SE3d& T_t_w) noexcept {
    Evaluation e;
    int lost_pixels = 0, lost_points = 0;
    for (int i = 0; i < text_count_; ++i) {
      const PoseTextState& state = text(i);
      if (state.visible == 0) continue;
      const PhotometricCost c =
          textplane::evaluate(request(texts_[i], T_t_w), memory_.photometric_, memory_.visible_.data() + state.offset);
      path_ = (std::max)(path_, c.path);
      // An object that fails as a whole costs as much as an uncorrelated patch.
      e.cost += state.weight * (is_ok(c.status) ? c.cost : options_.photometric.robust.rho(2.0));
      lost_pixels += is_ok(c.status) ? c.lost : state.visible;
    }
    for (int i = 0; i < point_count_; ++i) {
      if (!memory_.points_[static_cast<std::size_t>(i)]) continue;
      Vector3<double> p;
      Vector2<double> r;
      if (reproject(points_[i], T_t_w, camera_, &p, &r)) {
        e.cost += options_.point_robust.rho(r.squaredNorm() / (points_[i].sigma * points_[i].sigma));
      } else {
        // Behind the camera: the largest error in an image about as wide as the focal length.
        e.cost += options_.point_robust.rho(camera_.fx * camera_.fx / (points_[i].sigma * points_[i].sigma));
        ++lost_points;
      }
    }
    const double pixels = visible_pixels_ > 0 ? static_cast<double>(lost_pixels) / visible_pixels_ : 0.0;
    const double points = active_points_ > 0 ? static_cast<double>(lost_points) / active_points_ : 0.0;
    e.lost_fraction = (std::max)(pixels, points);
    return e;
  }

  SE3d retract(const SE3d& T_t_w, const Vector6<double>& xi) const noexcept { return se3_exp(xi) * T_t_w; }

  /// Of the last linearisation.
  const PoseTextState& text_state(int i) const noexcept { return memory_.texts_[static_cast<std::size_t>(i)]; }
  int visible_pixels() const noexcept { return visible_pixels_; }
  int active_texts() const noexcept { return active_texts_; }
  Path path() const noexcept { return path_; }  ///< Of all evaluations so far.

 private:
  using Pixel = PixelOf<View>;

  PolicyRequest<Pixel> request(const PoseTextTerm& term, const SE3d& T_t_w) const noexcept {
    const int host_level = term.scale_shift < 0 ? level_ - term.scale_shift : level_;
    PolicyRequest<Pixel> q{{level_input(*term.patch, level_, target_, camera_, term.scale_shift), term.theta,
                            T_t_w * term.T_w_h, options_.photometric},
                           policy_at_level(options_.policy, level_, options_.finest_level),
                           term.prepared ? term.prepared + host_level : nullptr};
    if (!q.input.patch.gx || !q.input.patch.gy) q.policy = LinearisePolicy::forward;
    return q;
  }

  PoseTextState& text(int i) noexcept { return memory_.texts_[static_cast<std::size_t>(i)]; }

  Status add_text(const PoseTextTerm& term, const SE3d& T_t_w, PoseTextState& state, PoseSystem& system) noexcept {
    if (!term.patch || !(term.weight > 0) || !is_finite(term.weight)) return Status::invalid_argument;
    PhotometricWorkspace& workspace = memory_.photometric_;
    const PolicyRequest<Pixel> q = request(term, T_t_w);
    NormalEquations<6> n = textplane::linearise<Parameters::pose>(q, workspace);
    path_ = (std::max)(path_, n.path);
    if (!is_ok(n.status)) return n.status;
    // Trials are compared with this cost, so it must equal evaluate()'s to the last digit.
    if (q.prepared && q.policy != LinearisePolicy::forward) {
      const PhotometricCost c = textplane::evaluate(q, workspace, workspace.visible());
      if (is_ok(c.status)) n.cost = c.cost;
    }
    state.visible = n.visible;
    state.zncc = n.zncc;
    state.weight = term.weight * text_weight(options_.weighting, options_.sigma_rep, options_.sigma_photo, n.visible);
    std::copy_n(workspace.visible(), q.input.patch.n, memory_.visible_.data() + state.offset);
    for (int i = 0; i < 6; ++i) {
      system.b[i] += state.weight * n.b[i];
      for (int j = 0; j <= i; ++j) system.H(i, j) += state.weight * n.H(i, j);
    }
    system.cost += state.weight * n.cost;
    return Status::ok;
  }

  const PoseTextTerm* texts_;
  const PosePointTerm* points_;
  int text_count_, point_count_;
  const View& target_;
  const Pinhole<double>& camera_;
  const PoseOptions& options_;
  PoseWorkspace& memory_;
  int level_ = 0;
  int visible_pixels_ = 0, active_points_ = 0, active_texts_ = 0;
  Path path_ = Path::kernel;
};
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_POSE_PROBLEM_HPP
