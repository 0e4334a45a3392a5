// PlaneTracker: follows a planar object through a video from its quad in the first frame, with an uncalibrated camera.
//
// Every frame is aligned with the pixels of the first one, so nothing drifts. Two searches by ZNCC give the starts of a
// frame: round the last pose, and round the pose of constant velocity. From both, pose and plane are refined coarse to
// fine; the better fit wins. Local contrast at one degree of blur is compared (appearance.hpp). A poor fit is tried
// again from a search on a finer level: the coarsest cannot tell repeated texture apart, and has few pixels of small
// text. H = R + t theta^T with both free is any homography, so the focal length affects conditioning alone. Weak priors
// hold what H does not determine: its scale, the plane without parallax, and the perspective of a small quad.
//
// A pose is good only where enough parts of the object agree with the image (parts.hpp). Where it is not, the object is
// searched round its last place, then in the whole image, by the views of it that were seen (view_search.hpp).
#ifndef TEXTPLANE_EXAMPLES_PLANE_TRACKER_HPP
#define TEXTPLANE_EXAMPLES_PLANE_TRACKER_HPP

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "planar/appearance.hpp"
#include "planar/parts.hpp"
#include "planar/plane_tracker_options.hpp"
#include "planar/pose_plane_problem.hpp"
#include "planar/view_search.hpp"
#include "textplane/features/select.hpp"
#include "textplane/geometry/homography.hpp"
#include "textplane/geometry/quad_projection.hpp"
#include "textplane/solver/gauss_newton.hpp"
#include "textplane/solver/search.hpp"

namespace planar {

namespace tp = textplane;

class PlaneTracker {
 public:
  /// `quad`: clockwise, px of `first`. status() says whether it can be tracked.
  PlaneTracker(tp::ImageView8 first, const tp::Quad<double>& quad, const PlaneTrackerOptions& options = {})
      : options_(options) {
    const tp::Vector2<double> centre = tp::centroid(quad);
    const double focal = options.focal * std::sqrt(std::abs(tp::area(quad)));
    camera_ = {focal, focal, centre[0], centre[1]};
    const tp::Pyramid pyramid(first, std::max(options.select.levels, options.views.levels));
    patch_ = tp::make_patch(pyramid.view(), camera_, quad, options.select);
    workspace_.reserve(patch_.max_pixels());
    appearance_ = Appearance(pyramid.view(), patch_, options.appearance);
    prepared_ = std::vector<tp::TemplatePatch>(patch_.levels.size());
    for (std::size_t l = 0; l < prepared_.size(); ++l) prepared_[l].prepare(patch_.levels[l].view());
    for (const tp::PatchLevel& level : patch_.levels) parts_.emplace_back(level);
    if (!tp::is_ok(patch_.status)) return;
    views_ = ViewSearch(pyramid.view(), camera_, quad, options.views, options.appearance.contrast);
    remembered_ = {state_};
  }

  tp::Status status() const noexcept { return patch_.status; }

  /// Tracks the object to the next image: an ok status where confidence() is good, else the reason of the failure.
  tp::Status track(tp::ImageView8 image) {
    image_.build(image, std::max(options_.select.levels, options_.views.levels));
    Fit best = follow();
    if (!good(best) && confidence_ != Confidence::lost) best = better(best, find(near(quad(state_)), {state_}, 0));
    if (!good(best)) {
      const Fit far = find_anywhere();
      if (good(far) || !guess(best)) best = better(best, far);
    }
    return conclude(best);
  }

  /// Aligns coarse to fine from `state`, in place: first with the known plane, then with a free one. A poor fit is
  /// tried again.
  tp::Status align(const tp::PyramidView& image, PlaneState& state) {
    const Fit fit = again(image, state, descend(image, kAllLevels, 0, state));
    state = fit.state;
    zncc_ = fit.zncc;
    return fit.status;
  }

  const tp::Pinhole<double>& camera() const noexcept { return camera_; }
  const tp::TextPatch& patch() const noexcept { return patch_; }
  /// Of the last frame.
  Confidence confidence() const noexcept { return confidence_; }
  const PlaneState& state() const noexcept { return shown_; }
  const Agreement& agreement() const noexcept { return agreement_; }
  double zncc() const noexcept { return zncc_; }
  /// The first frame's quad under the homography of `state`.
  tp::Quad<double> quad(const PlaneState& state) const noexcept {
    tp::Quad<double> out = patch_.quad;
    tp::transform(patch_.quad, tp::pixel_homography(tp::plane_homography(state.theta, state.T_t_h), camera_, camera_),
                  &out);
    return out;
  }
  tp::Quad<double> quad() const noexcept { return quad(shown_); }

 private:
  static constexpr int kAllLevels = tp::kMaxPyramidLevels, kRounds = 3;

  bool good(const Fit& fit) const noexcept { return tp::is_ok(fit.status) && trust(fit) >= options_.good; }
  bool guess(const Fit& fit) const noexcept { return tp::is_ok(fit.status) && trust(fit) >= options_.unsure; }
  bool sure(const Fit& fit) const noexcept { return good(fit) && fit.zncc >= options_.sure; }
  // From the last pose and the one of constant velocity.
  Fit follow() {
    Fit best;
    PlaneState from = state_;
    for (const tp::SE3d& guess : {state_.T_t_h, step_ * state_.T_t_h}) {
      PlaneState start = state_;
      start.T_t_h =
          tp::search_pose(patch_, state_.theta, guess, image_, camera_, options_.search, workspace_, prepared_.data());
      const Fit fit = plausible(start, descend(image_, kAllLevels, 0, start));
      if (&better(best, fit) == &fit) {
        best = fit;
        from = start;
      }
      if (sure(best)) break;
    }
    return again(image_, from, best);
  }

  // The best fit from the places that a search finds.
  Fit find(const Region& region, const std::vector<PlaneState>& views, double turn) {
    std::vector<Fit> fits;
    const int coarse = std::min({options_.coarse, patch_.level_count() - 1, image_.levels() - 1});
    for (const Place& place : views_(image_, views, region, turn)) {
      fits.push_back(plausible(place.state, descend(image_, kAllLevels, coarse, place.state)));
      if (!guess(fits.back())) fits.pop_back();
    }
    std::stable_sort(fits.begin(), fits.end(),
                     [](const Fit& a, const Fit& b) { return a.agreement.score > b.agreement.score; });
    Fit best;
    PlaneState from = state_;
    for (std::size_t i = 0; i < fits.size() && i < options_.finalists && !sure(best); ++i) {
      const Fit fit = plausible(fits[i].state, descend(image_, coarse - 1, 0, fits[i].state));
      if (&better(best, fit) == &fit) {
        best = fit;
        from = fits[i].state;
      }
    }
    return again(image_, from, best);
  }

  // In the whole image, by all views; each time in another sector of turns, too.
  Fit find_anywhere() {
    const Region whole{0, 0, image_.level(0).width() - 1.0, image_.level(0).height() - 1.0};
    std::vector<PlaneState> views{state_};
    for (const PlaneState& view : remembered_)
      if (!alike(quad(view), quad(state_), options_.views)) views.push_back(view);
    const Fit fit = find(whole, views, 0);
    if (good(fit)) return fit;
    const double sector = 2 * options_.views.turn;
    const int sectors = static_cast<int>(std::ceil(6.283185307179586 / sector)) - 1;
    return better(fit, find(whole, {state_}, sector * (1 + searches_++ % std::max(sectors, 1))));
  }

  tp::Status conclude(const Fit& fit) {
    zncc_ = fit.zncc;
    agreement_ = fit.agreement;
    if (!good(fit)) {
      confidence_ = guess(fit) ? Confidence::unsure : Confidence::lost;
      shown_ = guess(fit) ? fit.state : state_;
      step_ = {};
      return tp::is_ok(fit.status) ? tp::Status::diverged : fit.status;
    }
    confidence_ = Confidence::good;
    step_ = fit.state.T_t_h * state_.T_t_h.inverse();
    state_ = shown_ = fit.state;
    remember();
    return fit.status;
  }

  // The first view stays, and of the others the latest.
  void remember() {
    const tp::Quad<double> now = quad(state_);
    for (const PlaneState& view : remembered_)
      if (alike(quad(view), now, options_.views)) return;
    if (remembered_.size() >= options_.remembered) remembered_.erase(remembered_.begin() + 1);
    remembered_.push_back(state_);
  }

  // A fit that bent the object far from its start holds on to something else.
  Fit plausible(const PlaneState& start, Fit fit) const {
    if (tp::is_ok(fit.status) && !alike(quad(start), quad(fit.state), options_.views))
      fit.status = tp::Status::diverged;
    return fit;
  }

  Fit descend(const tp::PyramidView& image, int coarsest, int finest, const PlaneState& start) {
    Fit fit;
    fit.state = start;
    PlaneState from = start;
    for (int level = std::min({coarsest, patch_.level_count() - 1, image.levels - 1}); level >= finest; --level) {
      const bool known = level > options_.plane_level;
      if (!known) from.theta = PlaneState().theta;
      fit_level(image, level, from, known ? 1.0 : options_.plane, &fit);
      if (fit.status == tp::Status::out_of_view || fit.status == tp::Status::invalid_argument) break;
    }
    return fit;
  }

  // On one level; where only some parts agree, once more with those alone.
  void fit_level(const tp::PyramidView& image, int level, const PlaneState& from, double plane, Fit* fit) {
    const int shift = scale_shift(fit->state), host = level - std::min(shift, 0), target = level + std::max(shift, 0);
    tp::PhotometricInput input = tp::photometric_input(appearance_.sharp(), level, image, camera_, shift);
    fit->status = tp::Status::invalid_argument;
    if (!input.target.valid()) return;
    const Window window = appearance_.window(input.target, tp::quad_to_level(quad(fit->state), target));
    fit->status = tp::Status::out_of_view;
    if (!window.image.valid()) return;
    input.target = window.image;
    input.target_camera = window.of(input.target_camera);
    const Parts& parts = parts_[static_cast<std::size_t>(host)];
    std::size_t look = appearance_.count();
    double zncc = 0;
    for (int round = 0; round < kRounds; ++round) {
      const std::size_t best =
          appearance_.best(input, host, fit->state.theta, fit->state.T_t_h, options_.photometric, workspace_, &zncc);
      if (best == look) break;
      look = best;
      input.patch = appearance_.look(look, host);
      minimise(input, from, plane, zncc, fit);
    }
    const auto compare = [&] {
      fit->agreement =
          parts.compare(input, tp::plane_homography(fit->state.theta, fit->state.T_t_h), options_.agree, &mask_);
    };
    input.patch = appearance_.look(look, host);
    compare();
    for (int round = 0; round < kRounds && level <= options_.parts_level; ++round) {
      const Agreement before = fit->agreement;
      if (!tp::is_ok(fit->status) || before.share < options_.least_share || before.share > options_.whole) return;
      const Fit all = *fit;
      input.patch.mask = mask_.data();
      minimise(input, from, plane, fit->zncc, fit);
      input.patch.mask = nullptr;
      compare();
      // Hidden parts agree by chance, more or less: how much is no reason.
      if (fit->agreement.share >= before.share) continue;
      *fit = all;
      return;
    }
  }

  void minimise(const tp::PhotometricInput& input, const PlaneState& from, double plane, double zncc, Fit* fit) {
    // What the pixels say weighs the less, the more they differ.
    const double noise = std::min(std::max((1 - zncc) / (1 - options_.typical), 1.0), options_.most_noise);
    PosePlaneProblem problem(input, from, noise * options_.turn, noise * plane, options_.photometric, workspace_);
    tp::NormalEquations<9> system;
    fit->status = tp::minimise(problem, fit->state, options_.solve, &system).status;
    // No step lowers the cost: the fit is converged, and ZNCC rates it.
    if (fit->status == tp::Status::diverged) fit->status = tp::Status::converged;
    fit->zncc = system.zncc;
  }

  // The fit from `start`; where it is poor, that of a search round it if it is better.
  Fit again(const tp::PyramidView& image, const PlaneState& start, const Fit& fit) {
    if (tp::is_ok(fit.status) && fit.zncc >= options_.sure) return fit;
    const int level = tp::search_level(patch_, image.levels, options_.again);
    const Window window =
        appearance_.window(image.level[static_cast<std::size_t>(level)], tp::quad_to_level(quad(start), level));
    if (!window.image.valid()) return fit;
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
    return better(fit, plausible(tried, descend(image, level, 0, tried)));
  }

  int scale_shift(const PlaneState& state) const noexcept {
    return tp::scale_shift(tp::area(patch_.quad), tp::area(quad(state)));
  }

  PlaneTrackerOptions options_;
  tp::Pinhole<double> camera_;
  tp::TextPatch patch_;
  std::vector<tp::TemplatePatch> prepared_;  // of patch_
  Appearance appearance_;
  std::vector<Parts> parts_;  // of its levels
  ViewSearch views_;
  std::vector<PlaneState> remembered_;
  std::vector<std::uint8_t> mask_;
  tp::Pyramid image_;
  tp::PhotometricWorkspace workspace_;
  PlaneState state_;  // of the last good frame
  PlaneState shown_;
  tp::SE3d step_;
  Agreement agreement_;
  Confidence confidence_ = Confidence::good;
  double zncc_ = 0;
  int searches_ = 0;
};

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_PLANE_TRACKER_HPP
