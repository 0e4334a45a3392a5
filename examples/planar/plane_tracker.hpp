// PlaneTracker: follows a planar object through a video from its quad in the first frame, with an uncalibrated camera.
//
// Every frame is aligned with the pixels of the first one, so nothing drifts. Two searches by ZNCC give the starts of a
// frame: round the last pose, and round the pose of constant velocity. From both, pose and plane are refined coarse to
// fine; the better fit wins. Local contrast at one degree of blur is compared (appearance.hpp). A poor fit is tried
// again from a search on a finer level: the coarsest cannot tell repeated texture apart, and has few pixels of small
// text. H = R + t theta^T with both free is any homography, so the focal length affects conditioning alone. Weak priors
// hold what H does not determine: its scale, the plane without parallax, and the perspective of a small quad.
#ifndef TEXTPLANE_EXAMPLES_PLANE_TRACKER_HPP
#define TEXTPLANE_EXAMPLES_PLANE_TRACKER_HPP

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "planar/appearance.hpp"
#include "textplane/features/select.hpp"
#include "textplane/geometry/homography.hpp"
#include "textplane/geometry/quad_projection.hpp"
#include "textplane/solver/gauss_newton.hpp"
#include "textplane/solver/search.hpp"

namespace planar {

namespace tp = textplane;

/// Pose T_t_h and plane theta (host frame) of an object in one image.
struct PlaneState {
  tp::SE3d T_t_h;
  tp::Vector3<double> theta = tp::Vector3<double>::UnitZ();
};

/// One set of parameters for every video and every image pair.
struct PlaneTrackerOptions {
  tp::SelectOptions select;
  tp::PhotometricOptions photometric;
  tp::SolveOptions solve;
  tp::SearchOptions search;  ///< For the start of a video frame, on grey levels.
  AppearanceOptions appearance;
  double sure = 0.9;        ///< A fit with a lower ZNCC is tried again.
  tp::SearchOptions again;  ///< For the second try, on local contrast.
  int plane_level = 2;      ///< From this level on the plane is free, too.
  double focal = 8;         ///< Of the camera whose axis meets the quad's centre, in units of sqrt(the quad's area).
  double plane = 1e-3;      ///< Weight of the prior that the plane faces the first camera, relative to the data.
  double turn = 0.1;        ///< Weight of the prior on tilt (rad^2): a small quad hardly shows perspective.
  double lost = 0.5;        ///< A frame with a lower ZNCC is lost: the next one starts where this one did.

  PlaneTrackerOptions() {
    select.levels = 4;
    select.max_pixels = 500;
    solve.max_iterations = 30;
    search.level = 3;
    search.radius = 5;
    search.roll = 0.2;
    again.level = 1;
  }
};

/// Pose and plane as a problem for tp::minimise(): nine parameters (v, omega, theta), some with a prior at the start.
class PosePlaneProblem {
 public:
  using State = PlaneState;
  static constexpr int kParameters = 9;

  /// `from`: the mean of the priors on rotation and theta, with these weights.
  PosePlaneProblem(const tp::PhotometricInput& input, const State& from, double turn, double plane,
                   const tp::PhotometricOptions& options, tp::PhotometricWorkspace& workspace)
      : input_(input), from_(from), options_(options), workspace_(workspace) {
    weight_ << 0, 0, 0, turn, turn, 0, plane, plane, plane;
  }

  tp::NormalEquations<9> linearise(const State& x) noexcept {
    auto sums =
        tp::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{input_, x.theta, x.T_t_h, options_}, workspace_);
    const Eigen::Matrix<double, 9, 1> off = distance(x);
    sums.H.diagonal() += weight_;
    sums.b += weight_.cwiseProduct(off);
    sums.cost += off.dot(weight_.cwiseProduct(off));
    return sums;
  }
  tp::Evaluation evaluate(const State& x) noexcept {
    const auto c =
        tp::evaluate(tp::ResidualRequest{input_, x.theta, x.T_t_h, options_}, workspace_, workspace_.visible());
    const Eigen::Matrix<double, 9, 1> off = distance(x);
    return {c.cost + off.dot(weight_.cwiseProduct(off)), static_cast<double>(c.lost) / input_.patch.n, c.status};
  }
  State retract(const State& x, const Eigen::Matrix<double, 9, 1>& step) const noexcept {
    return {tp::se3_exp<double>(step.head<6>()) * x.T_t_h, x.theta + step.tail<3>()};
  }

 private:
  Eigen::Matrix<double, 9, 1> distance(const State& x) const noexcept {
    Eigen::Matrix<double, 9, 1> off;
    off << tp::Vector3<double>::Zero(), tp::so3_log<double>(x.T_t_h.R * from_.T_t_h.R.transpose()),
        x.theta - from_.theta;
    return off;
  }

  const tp::PhotometricInput& input_;
  const State from_;
  const tp::PhotometricOptions& options_;
  tp::PhotometricWorkspace& workspace_;
  Eigen::Matrix<double, 9, 1> weight_;
};

class PlaneTracker {
 public:
  /// `quad`: clockwise, px of `first`. status() says whether it can be tracked.
  PlaneTracker(tp::ImageView8 first, const tp::Quad<double>& quad, const PlaneTrackerOptions& options = {})
      : options_(options) {
    const tp::Vector2<double> centre = tp::centroid(quad);
    const double focal = options.focal * std::sqrt(std::abs(tp::area(quad)));
    camera_ = {focal, focal, centre[0], centre[1]};
    patch_ = tp::make_patch(first, camera_, quad, options.select);
    workspace_.reserve(patch_.max_pixels());
    appearance_ = Appearance(tp::Pyramid(first, patch_.level_count()).view(), patch_, options.appearance);
    prepared_ = std::vector<tp::TemplatePatch>(patch_.levels.size());
    for (std::size_t l = 0; l < prepared_.size(); ++l) prepared_[l].prepare(patch_.levels[l].view());
  }

  tp::Status status() const noexcept { return patch_.status; }

  /// Tracks the object to the next image: an ok status, or the reason of the failure; the state is then that of the
  /// previous frame.
  tp::Status track(tp::ImageView8 image) {
    image_.build(image, options_.select.levels);
    PlaneState found, best;
    tp::Status status = tp::Status::too_few;
    double zncc = -1.0;
    for (const tp::SE3d& guess : {state_.T_t_h, step_ * state_.T_t_h}) {
      PlaneState tried = state_;
      tried.T_t_h =
          tp::search_pose(patch_, state_.theta, guess, image_, camera_, options_.search, workspace_, prepared_.data());
      const PlaneState start = tried;
      const tp::Status s = descend(image_, kAllLevels, tried);
      if (tp::is_ok(s) && zncc_ > zncc) {
        zncc = zncc_;
        found = tried;
        best = start;
        status = s;
      }
    }
    zncc_ = zncc;
    if (tp::is_ok(status)) status = again(image_, best, status, found);
    if (tp::is_ok(status) && zncc_ < options_.lost) status = tp::Status::diverged;
    if (!tp::is_ok(status)) {
      step_ = {};
      return status;
    }
    step_ = found.T_t_h * state_.T_t_h.inverse();
    state_ = found;
    return status;
  }

  /// Aligns coarse to fine from `state`, in place: first with the known plane, then with a free one. A poor fit is
  /// tried again.
  tp::Status align(const tp::PyramidView& image, PlaneState& state) {
    const PlaneState start = state;
    const tp::Status status = descend(image, kAllLevels, state);
    return again(image, start, status, state);
  }

  const tp::Pinhole<double>& camera() const noexcept { return camera_; }
  const tp::TextPatch& patch() const noexcept { return patch_; }
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
  static constexpr int kAllLevels = tp::kMaxPyramidLevels, kRounds = 3;

  tp::Status descend(const tp::PyramidView& image, int coarsest, PlaneState& state) {
    tp::Status status = tp::Status::too_few;
    PlaneState from = state;
    for (int level = std::min({coarsest, patch_.level_count() - 1, image.levels - 1}); level >= 0; --level) {
      const bool known = level > options_.plane_level;
      if (!known) from.theta = PlaneState().theta;
      const int shift = scale_shift(state), host = level - std::min(shift, 0), target = level + std::max(shift, 0);
      tp::PhotometricInput input = tp::photometric_input(appearance_.sharp(), level, image, camera_, shift);
      if (!input.target.valid()) return tp::Status::invalid_argument;
      const Window window = appearance_.window(input.target, tp::quad_to_level(quad(state), target));
      if (!window.image.valid()) return tp::Status::out_of_view;
      input.target = window.image;
      input.target_camera = window.of(input.target_camera);
      std::size_t look = appearance_.count();
      for (int round = 0; round < kRounds; ++round) {
        const std::size_t best =
            appearance_.best(input, host, state.theta, state.T_t_h, options_.photometric, workspace_);
        if (best == look) break;
        look = best;
        input.patch = appearance_.look(look, host);
        PosePlaneProblem problem(input, from, options_.turn, known ? 1.0 : options_.plane, options_.photometric,
                                 workspace_);
        tp::NormalEquations<9> system;
        status = tp::minimise(problem, state, options_.solve, &system).status;
        // No step lowers the cost: the fit is converged, and ZNCC rates it.
        if (status == tp::Status::diverged) status = tp::Status::converged;
        zncc_ = system.zncc;
      }
    }
    return status;
  }

  // The fit from `start` with zncc_; where it is poor, that of a search round it if it is better.
  tp::Status again(const tp::PyramidView& image, const PlaneState& start, tp::Status status, PlaneState& state) {
    const double zncc = tp::is_ok(status) ? zncc_ : -1.0;
    if (zncc >= options_.sure) return status;
    const int level = tp::search_level(patch_, image.levels, options_.again);
    const Window window =
        appearance_.window(image.level[static_cast<std::size_t>(level)], tp::quad_to_level(quad(start), level));
    if (window.image.valid()) {
      tp::PyramidView view;  // this level alone, for the search
      view.levels = level + 1;
      view.level[static_cast<std::size_t>(level)] = window.image;
      tp::Pinhole<double> camera = camera_;
      camera.cx -= std::ldexp(window.x, level);
      camera.cy -= std::ldexp(window.y, level);
      tp::SearchOptions search = options_.again;
      search.level = level;
      PlaneState tried = start;
      tried.T_t_h = tp::search_pose(appearance_.sharp(), start.theta, start.T_t_h, view, camera, search, workspace_,
                                    appearance_.prepared());
      const tp::Status second = descend(image, level, tried);
      if (tp::is_ok(second) && zncc_ > zncc) {
        state = tried;
        return second;
      }
    }
    zncc_ = zncc;
    return status;
  }

  int scale_shift(const PlaneState& state) const noexcept {
    return tp::scale_shift(tp::area(patch_.quad), tp::area(quad(state)));
  }

  PlaneTrackerOptions options_;
  tp::Pinhole<double> camera_;
  tp::TextPatch patch_;
  std::vector<tp::TemplatePatch> prepared_;  // of patch_
  Appearance appearance_;
  tp::Pyramid image_;
  tp::PhotometricWorkspace workspace_;
  PlaneState state_;
  tp::SE3d step_;
  double zncc_ = 0;
};

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_PLANE_TRACKER_HPP
