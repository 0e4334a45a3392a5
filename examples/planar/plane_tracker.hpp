// PlaneTracker: a planar object followed through a video from its quad in the first frame, by a camera that nobody calibrated.
//
// Every frame is aligned with the pixels of the first one, so nothing drifts. A frame's start is the best by ZNCC of a search round
// the last pose and round the pose that went on as before; then pose and plane are found together, coarse to fine. H = R + t theta^T
// with both free is any homography, so that a wrong focal length does no harm. Its scale, which H does not show, and the plane
// of the first frames, which without parallax cannot be seen, are held by a weak pull of theta to where it was.
#ifndef TEXTPLANE_EXAMPLES_PLANE_TRACKER_HPP
#define TEXTPLANE_EXAMPLES_PLANE_TRACKER_HPP

#include <algorithm>
#include <utility>
#include <vector>

#include "textplane/features/select.hpp"
#include "textplane/geometry/homography.hpp"
#include "textplane/solver/pose.hpp"
#include "textplane/solver/search.hpp"

namespace planar {

namespace tp = textplane;

/// Pose T_t_h and plane theta (host frame) of an object in one image.
struct PlaneState {
  tp::SE3d T_t_h;
  tp::Vector3<double> theta = tp::Vector3<double>::UnitZ();
};

/// The same for every video and every image pair.
struct PlaneTrackerOptions {
  tp::SelectOptions select;
  tp::PhotometricOptions photometric;
  tp::SolveOptions solve;
  tp::SearchOptions search;
  tp::PoseOptions pose;  ///< Of the pose alone.
  int plane_level = 2;   ///< From here on the plane is free, too.
  double focal = 1.2;    ///< Of the camera, as a multiple of the image's longer side: a common lens.
  double pull =
      1e-3;  ///< Of theta to its last value, in units of the photometric cost for a plane turned by 45 degrees.
  double lost = 0.5;  ///< A frame with a lower ZNCC than this is lost: the next one begins where this one did.

  PlaneTrackerOptions() {
    select.levels = 4;
    select.max_pixels = 500;
    solve.max_iterations = 30;
    search.level = 3;
    search.radius = 5;
    search.roll = 0.2;
    pose.coarsest_level = 3;
    pose.finest_level = 1;
  }
};

/// Pose and plane together as a problem for tp::minimise(): nine parameters (v, omega, theta).
class PosePlaneProblem {
 public:
  using State = PlaneState;
  static constexpr int kParameters = 9;

  PosePlaneProblem(const tp::PhotometricInput& input, const tp::Vector3<double>& theta,
                   const PlaneTrackerOptions& options, tp::PhotometricWorkspace& workspace)
      : input_(input), theta_(theta), options_(options), workspace_(workspace) {}

  tp::NormalEquations<9> linearise(const State& x) noexcept {
    auto sums = tp::linearise_pose_plane(input_, x.theta, x.T_t_h, options_.photometric, workspace_);
    for (int i = 6; i < 9; ++i) {
      sums.H(i, i) += options_.pull;
      sums.b[i] += options_.pull * (x.theta[i - 6] - theta_[i - 6]);
    }
    sums.cost += options_.pull * (x.theta - theta_).squaredNorm();
    return sums;
  }
  tp::Evaluation evaluate(const State& x) noexcept {
    const auto c = tp::evaluate(input_, x.theta, x.T_t_h, options_.photometric, workspace_, workspace_.visible());
    return {c.cost + options_.pull * (x.theta - theta_).squaredNorm(), static_cast<double>(c.lost) / input_.patch.n,
            c.status};
  }
  State retract(const State& x, const Eigen::Matrix<double, 9, 1>& step) const noexcept {
    return {tp::se3_exp<double>(step.head<6>()) * x.T_t_h, x.theta + step.tail<3>()};
  }

 private:
  const tp::PhotometricInput& input_;
  const tp::Vector3<double> theta_;  ///< Where it is pulled to.
  const PlaneTrackerOptions& options_;
  tp::PhotometricWorkspace& workspace_;
};

class PlaneTracker {
 public:
  /// `quad`: clockwise, px of `first`. status() tells whether it can be tracked.
  PlaneTracker(tp::ImageView8 first, const tp::Quad<double>& quad, const PlaneTrackerOptions& options = {})
      : options_(options) {
    const double focal = options.focal * std::max(first.width(), first.height());
    camera_ = {focal, focal, 0.5 * (first.width() - 1), 0.5 * (first.height() - 1)};
    patch_ = tp::make_patch(first, camera_, quad, options.select);
    workspace_.reserve(patch_.max_pixels());
    prepared_ = std::vector<tp::TemplatePatch>(patch_.levels.size());
    for (std::size_t l = 0; l < prepared_.size(); ++l) prepared_[l].prepare(patch_.levels[l].view());
  }

  tp::Status status() const noexcept { return patch_.status; }

  /// Where the object is in the next image: an ok status, or why it is not known; the state is then that of the frame before.
  tp::Status track(tp::ImageView8 image) {
    image_.build(image, options_.select.levels);
    PlaneState found;
    tp::Status status = tp::Status::too_few;
    double zncc = -1.0;
    for (const tp::SE3d& guess : {state_.T_t_h, step_ * state_.T_t_h}) {
      PlaneState tried = state_;
      tried.T_t_h =
          tp::search_pose(patch_, state_.theta, guess, image_, camera_, options_.search, workspace_, prepared_.data());
      const tp::Status s = align(image_, tried);
      if (tp::is_ok(s) && zncc_ > zncc) {
        zncc = zncc_;
        found = tried;
        status = s;
      }
    }
    zncc_ = zncc;
    if (tp::is_ok(status) && zncc < options_.lost) status = tp::Status::diverged;
    if (!tp::is_ok(status)) {
      step_ = {};
      return status;
    }
    step_ = found.T_t_h * state_.T_t_h.inverse();
    state_ = found;
    return status;
  }

  /// Coarse to fine from `state`, in place: first the pose alone, with the plane that is known, then both.
  tp::Status align(const tp::PyramidView& image, PlaneState& state) {
    tp::Status status = tp::Status::too_few;
    tp::PoseTextTerm term{&patch_, state.theta, tp::SE3d(), 1, scale_shift(state)};
    pose_workspace_.reserve(&term, 1, 0);
    state.T_t_h =
        tp::refine_pose(&term, 1, nullptr, 0, image, camera_, state.T_t_h, options_.pose, pose_workspace_).T_t_w;
    for (int level = std::min({patch_.level_count() - 1, image.levels - 1, options_.plane_level}); level >= 0;
         --level) {
      tp::NormalEquations<9> system;
      const tp::PhotometricInput input = tp::photometric_input(patch_, level, image, camera_, scale_shift(state));
      PosePlaneProblem problem(input, PlaneState().theta, options_, workspace_);
      status = tp::minimise(problem, state, options_.solve, &system).status;
      zncc_ = system.zncc;
    }
    return status;
  }

  const PlaneState& state() const noexcept { return state_; }
  double zncc() const noexcept { return zncc_; }
  /// The first frame's quad under the homography of `state`.
  tp::Quad<double> quad(const PlaneState& state) const noexcept {
    tp::Quad<double> out = patch_.quad;
    tp::transform(patch_.quad, tp::pixel_homography(tp::plane_homography(state.theta, state.T_t_h), camera_, camera_),
                  &out);
    return out;
  }
  tp::Quad<double> quad() const noexcept { return quad(state_); }

 private:
  int scale_shift(const PlaneState& state) const noexcept {
    return tp::scale_shift(tp::area(patch_.quad), tp::area(quad(state)));
  }

  PlaneTrackerOptions options_;
  tp::Pinhole<double> camera_;
  tp::TextPatch patch_;
  std::vector<tp::TemplatePatch> prepared_;
  tp::Pyramid image_;
  tp::PhotometricWorkspace workspace_;
  tp::PoseWorkspace pose_workspace_;
  PlaneState state_;
  tp::SE3d step_;
  double zncc_ = 0;
};

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_PLANE_TRACKER_HPP
