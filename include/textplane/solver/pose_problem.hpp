// The joint cost of one camera pose over text objects and points, as a problem for minimise().
//
//   C(T_t_w) = sum_points rho(|e|^2 / sigma^2) + sum_texts lambda_w c,    e = reprojection error in px
//
// c is the robust photometric cost of a text object (residual.hpp); weighting.hpp has lambda_w. This is the paper's
// E_point + lambda_w E_text. The pose is perturbed from the left, T_t_w <- Exp(xi) T_t_w, xi = (v, omega), and with it
// every T_t_h = T_t_w T_w_h. Of a rig, the pose is the rig's, and each term is one of its camera (pose_rig.hpp). Behind
// a rolling shutter (CameraView::rows) poses are those at the time stamp, and each point counts at the pose of the row
// that shows it. Small texts of one camera go through the batch kernel (pose_batch.hpp).
#ifndef TEXTPLANE_SOLVER_POSE_PROBLEM_HPP
#define TEXTPLANE_SOLVER_POSE_PROBLEM_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "textplane/photometry/residual_policy.hpp"
#include "textplane/solver/levels.hpp"
#include "textplane/solver/pose_points.hpp"
#include "textplane/solver/pose_rig.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
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
              const View& target, const CameraView& camera, const PoseOptions& options,
              PoseWorkspace& workspace) noexcept
      : texts_(texts),
        points_(points),
        text_count_(text_count),
        point_count_(point_count),
        one_{camera, SE3d(), target},
        options_(options),
        memory_(workspace) {
    set_rows();
  }
  /// Of a rig. The terms' cameras are in [0, camera_count).
  PoseProblem(const PoseTextTerm* texts, int text_count, const PosePointTerm* points, int point_count,
              const BasicPoseCamera<View>* rig, int camera_count, const PoseOptions& options,
              PoseWorkspace& workspace) noexcept
      : texts_(texts),
        points_(points),
        text_count_(text_count),
        point_count_(point_count),
        rig_(rig),
        camera_count_(camera_count),
        options_(options),
        memory_(workspace) {
    set_rows();
  }

  void set_level(int level) noexcept {
    level_ = level;
    memory_.batch_.clear();
    if constexpr (std::is_same<Pixel, std::uint8_t>::value) fill_batch();
  }

  PoseSystem linearise(const SE3d& T_t_w) noexcept {
    PoseSystem system;
    Status trouble = Status::too_few;
    visible_pixels_ = active_points_ = active_texts_ = 0;
    offset_ = 0;
    for (int c = 0; c < camera_count_; ++c) {
      if (!rig_) {
        add_terms(c, T_t_w, system, trouble);
      } else {
        const SE3d T_c_r = rig_[c].T_r_c.inverse();
        PoseSystem seen;
        add_terms(c, T_c_r * T_t_w, seen, trouble);
        mirror(seen);
        add_moved(seen, T_c_r, system);
      }
    }
    mirror(system);
    system.status = active_texts_ + active_points_ > 0 ? Status::ok : trouble;
    return system;
  }

  Evaluation evaluate(const SE3d& T_t_w) noexcept {
    Evaluation e;
    int lost_pixels = 0, lost_points = 0;
    for (int c = 0; c < camera_count_; ++c)
      e.cost += cost(c, rig_ ? rig_[c].T_r_c.inverse() * T_t_w : T_t_w, lost_pixels, lost_points);
    const double pixels = visible_pixels_ > 0 ? static_cast<double>(lost_pixels) / visible_pixels_ : 0.0;
    const double points = active_points_ > 0 ? static_cast<double>(lost_points) / active_points_ : 0.0;
    e.lost_fraction = (std::max)(pixels, points);
    return e;
  }

  /// Calls f(point index, its error in px) for the points that have a projection at this pose.
  template <class F>
  void for_each_error(const SE3d& T_t_w, const F& f) const noexcept {
    for (int c = 0; c < camera_count_; ++c) {
      const SE3d T_c_w = rig_ ? rig_[c].T_r_c.inverse() * T_t_w : T_t_w;
      Vector3<double> p;
      Vector2<double> e;
      for (int i = 0; i < point_count_; ++i)
        if (points_[i].camera == c && reproject(points_[i], T_c_w, camera(c).camera, row(i), &p, &e)) f(i, e);
    }
  }

  SE3d retract(const SE3d& T_t_w, const Vector6<double>& xi) const noexcept { return se3_exp(xi) * T_t_w; }

  /// Of the last linearisation.
  const PoseTextState& text_state(int i) const noexcept { return memory_.texts_[static_cast<std::size_t>(i)]; }
  int visible_pixels() const noexcept { return visible_pixels_; }
  int active_texts() const noexcept { return active_texts_; }
  Path path() const noexcept { return path_; }  ///< Of all evaluations so far.

 private:
  using Pixel = PixelOf<View>;

  const BasicPoseCamera<View>& camera(int c) const noexcept { return rig_ ? rig_[c] : one_; }

  void set_rows() noexcept {
    for (int i = 0; i < point_count_; ++i) {
      const CameraView& seen = camera(points_[i].camera).camera;
      if (seen.rows) memory_.rows_[static_cast<std::size_t>(i)] = row_increment(points_[i], seen);
    }
  }
  // Of a point, as reproject() takes it.
  const SE3d* row(int i) const noexcept {
    return camera(points_[i].camera).camera.rows ? memory_.rows_.data() + static_cast<std::size_t>(i) : nullptr;
  }

  // The terms of camera c with the pose T_c_w: to the lower triangle of H, to b and to the cost.
  void add_terms(int c, const SE3d& T_c_w, PoseSystem& system, Status& trouble) noexcept {
    run_batch(T_c_w);
    for (int i = 0; i < text_count_; ++i) {
      if (texts_[i].camera != c) continue;
      PoseTextState& state = text(i);
      state = PoseTextState{offset_, 0, 0, 0};
      const Status status = add_text(i, T_c_w, state, system);
      if (!is_ok(status)) {
        if (trouble == Status::too_few) trouble = status;
        continue;
      }
      offset_ += static_cast<std::size_t>(texts_[i].patch->max_pixels());
      visible_pixels_ += state.visible;
      ++active_texts_;
    }
    for (int i = 0; i < point_count_; ++i) {
      if (points_[i].camera != c) continue;
      const bool active = add_point(points_[i], T_c_w, camera(c).camera, row(i), options_.point_robust, system);
      memory_.points_[static_cast<std::size_t>(i)] = active;
      active_points_ += active;
    }
  }

  // Their cost on the residuals of the last linearisation.
  double cost(int c, const SE3d& T_c_w, int& lost_pixels, int& lost_points) noexcept {
    double sum = 0;
    run_batch(T_c_w);
    NormalEquations<6> together{Unset()};
    for (int i = 0; i < text_count_; ++i) {
      const PoseTextState& state = text(i);
      if (texts_[i].camera != c || state.visible == 0) continue;
      if (memory_.batch_.take(i, false, &together) && together.visible == state.visible) {
        sum += state.weight * together.cost;
        continue;
      }
      const PhotometricCost found =
          textplane::evaluate(request(texts_[i], T_c_w), memory_.photometric_, memory_.visible_.data() + state.offset);
      path_ = (std::max)(path_, found.path);
      // An object that fails as a whole costs as much as an uncorrelated patch.
      sum += state.weight * (is_ok(found.status) ? found.cost : options_.photometric.robust.rho(2.0));
      lost_pixels += is_ok(found.status) ? found.lost : state.visible;
    }
    const CameraView& view = camera(c).camera;
    for (int i = 0; i < point_count_; ++i) {
      if (points_[i].camera != c || !memory_.points_[static_cast<std::size_t>(i)]) continue;
      Vector3<double> p;
      Vector2<double> r;
      if (reproject(points_[i], T_c_w, view, row(i), &p, &r)) {
        sum += options_.point_robust.rho(r.squaredNorm() / (points_[i].sigma * points_[i].sigma));
      } else {
        // Behind the camera: the largest error in an image about as wide as the focal length.
        sum += options_.point_robust.rho(view.pinhole.fx * view.pinhole.fx / (points_[i].sigma * points_[i].sigma));
        ++lost_points;
      }
    }
    return sum;
  }

  void fill_batch() noexcept {
    if (rig_ || text_count_ < kBatchFewest || level_ >= one_.target.levels ||
        !PoseBatch::takes(one_.camera, one_.target.level[static_cast<std::size_t>(level_)], options_.photometric))
      return;
    for (int i = 0; i < text_count_; ++i) {
      const PoseTextTerm& term = texts_[i];
      if (!is_usable(term) || term.scale_shift > 0 || term.patch->rows.active()) continue;
      const PolicyRequest<Pixel> q = request(term, SE3d());
      if (q.policy == LinearisePolicy::forward || q.policy == LinearisePolicy::hybrid)
        memory_.batch_.add({i, q.input.patch, q.input.host_camera, term.theta, term.T_w_h});
    }
    memory_.batch_.pack();
  }

  void run_batch(const SE3d& T_c_w) noexcept {
    if constexpr (std::is_same<Pixel, std::uint8_t>::value)
      if (!memory_.batch_.empty())
        memory_.batch_.run(T_c_w, one_.target.level[static_cast<std::size_t>(level_)],
                           one_.camera.pinhole.at_level(level_), options_.photometric);
  }

  static bool is_usable(const PoseTextTerm& term) noexcept {
    return term.patch && term.weight > 0 && is_finite(term.weight);
  }

  PolicyRequest<Pixel> request(const PoseTextTerm& term, const SE3d& T_c_w) const noexcept {
    const int host_level = term.scale_shift < 0 ? level_ - term.scale_shift : level_;
    const BasicPoseCamera<View>& seen = camera(term.camera);
    PolicyRequest<Pixel> q{{level_input(*term.patch, level_, seen.target, seen.camera, term.scale_shift), term.theta,
                            T_c_w * term.T_w_h, options_.photometric},
                           policy_at_level(options_.policy, level_, options_.finest_level),
                           term.prepared ? term.prepared + host_level : nullptr};
    if (!q.input.patch.gx || !q.input.patch.gy) q.policy = LinearisePolicy::forward;
    return q;
  }

  PoseTextState& text(int i) noexcept { return memory_.texts_[static_cast<std::size_t>(i)]; }

  Status add_text(int index, const SE3d& T_c_w, PoseTextState& state, PoseSystem& system) noexcept {
    const PoseTextTerm& term = texts_[index];
    if (!is_usable(term)) return Status::invalid_argument;
    NormalEquations<6> n{Unset()};
    std::uint8_t* visible = memory_.visible_.data() + state.offset;
    if (memory_.batch_.take(index, true, &n)) {
      std::fill_n(visible, n.visible, std::uint8_t{1});
    } else {
      const Status status = linearise_text(term, T_c_w, visible, &n);
      if (!is_ok(status)) return status;
    }
    state.visible = n.visible;
    state.zncc = n.zncc;
    state.weight = term.weight * text_weight(options_.weighting, options_.sigma_rep, options_.sigma_photo, n.visible);
    for (int i = 0; i < 6; ++i) {
      system.b[i] += state.weight * n.b[i];
      for (int j = 0; j <= i; ++j) system.H(i, j) += state.weight * n.H(i, j);
    }
    system.cost += state.weight * n.cost;
    return Status::ok;
  }

  // By itself.
  Status linearise_text(const PoseTextTerm& term, const SE3d& T_c_w, std::uint8_t* visible,
                        NormalEquations<6>* n) noexcept {
    PhotometricWorkspace& workspace = memory_.photometric_;
    const PolicyRequest<Pixel> q = request(term, T_c_w);
    *n = textplane::linearise<Parameters::pose>(q, workspace);
    path_ = (std::max)(path_, n->path);
    if (!is_ok(n->status)) return n->status;
    // Trials are compared with this cost, so it must equal evaluate()'s to the last digit.
    if (q.prepared && q.policy != LinearisePolicy::forward && q.policy != LinearisePolicy::hybrid) {
      const PhotometricCost c = textplane::evaluate(q, workspace, workspace.visible());
      if (is_ok(c.status)) n->cost = c.cost;
    }
    std::copy_n(workspace.visible(), q.input.patch.n, visible);
    return Status::ok;
  }

  const PoseTextTerm* texts_;
  const PosePointTerm* points_;
  int text_count_, point_count_;
  BasicPoseCamera<View> one_;  // where there is no rig
  const BasicPoseCamera<View>* rig_ = nullptr;
  int camera_count_ = 1;
  const PoseOptions& options_;
  PoseWorkspace& memory_;
  int level_ = 0;
  std::size_t offset_ = 0;  // of the next text's visible set
  int visible_pixels_ = 0, active_points_ = 0, active_texts_ = 0;
  Path path_ = Path::kernel;
};
}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_POSE_PROBLEM_HPP
