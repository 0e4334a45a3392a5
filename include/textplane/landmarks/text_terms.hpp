// What the texts of a map say to an adjustment that the host system runs itself, by any solver.
//
// Each mapped text adds to the host's cost, which has points as rho(|e|^2 / sigma_rep^2):
//
//   sum_views (sigma_rep / sigma_photo)^2 N c(T_v_w T_w_h, theta)  +  |theta - theta_0|^2 by TextPrior::information
//
// c is the robust photometric cost (residual.hpp), N its visible pixels, sigma_photo what the text differs by in that
// view. Views that do not move tell of the plane alone: they are in the prior, in place of terms of their own. Where
// the text's host moves, the views that do not move hold it, so they have terms, and there is no prior.
//
// adapters/ceres_text_map.hpp makes blocks of Ceres of them, text_window.hpp texts of a Window.
// linearise<Parameters::pose_plane>(term.request()) gives the normal equations for a solver of your own.
#ifndef TEXTPLANE_LANDMARKS_TEXT_TERMS_HPP
#define TEXTPLANE_LANDMARKS_TEXT_TERMS_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/landmarks/text_map.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A text as a key frame sees it. Valid until the next change of the map.
struct TextTerm {
  const TextObject* text = nullptr;  ///< Its host is text->host.
  int target = -1;                   ///< Id of the key frame.
  PhotometricInput input;            ///< Level 0 of the patch, and what shows it in the target.
  SE3d T_t_h;                        ///< Host to target, as the map has the poses.
  int scale_shift = 0;               ///< Of photometric_input().
  int visible = 0;                   ///< Pixels.
  double zncc = 0;                   ///< At T_t_h.
  double sigma_photo = 1;            ///< Of a pixel's residual, in units of 1/sqrt(N): see text_weight().

  /// For the kernels: the term at the poses and the plane of now.
  ResidualRequest<std::uint8_t> request() const { return {input, text->theta, T_t_h}; }
  /// lambda_w where a point of one px has unit variance.
  double weight() const noexcept { return text_weight(Weighting::variance, 1, sigma_photo, visible); }
};

/// What the views that do not move say of a text's plane.
struct TextPrior {
  const TextObject* text = nullptr;                       ///< theta_0 is text->theta.
  Matrix3<double> information = Matrix3<double>::Zero();  ///< Of theta: zero where all its views move.
};

/// How views that do not move take part where the text's host does not move either.
enum class StillViews {
  as_prior,  ///< By TextPrior.
  as_terms,  ///< By terms of their own, TextOptions::views of them; no text has a prior. For solvers without priors.
};

/// Of an adjustment.
struct TextTerms {
  std::vector<TextTerm> terms;    ///< By text, then by target.
  std::vector<TextPrior> priors;  ///< Of the texts that have terms, in their order.
};

namespace detail {

// One text's share of text_terms().
template <class Moves>
void add_text_terms(const BasicTextMap<>& map, const TextObject& text, Moves moves, StillViews how,
                    PhotometricWorkspace& workspace, TextTerms* out) {
  const bool host_moves = moves(text.host), with_prior = !host_moves && how == StillViews::as_prior;
  std::vector<int> moving, still;
  for (const int id : text.views)
    if (map.keyframes().has_image(id)) (moves(id) ? moving : still).push_back(id);
  if (!host_moves && moving.empty()) return;
  std::vector<int> targets = moving;
  if (!with_prior) {
    const std::vector<int> some = evenly_spaced(still, static_cast<std::size_t>(map.options().text.views));
    targets.insert(targets.end(), some.begin(), some.end());
    std::sort(targets.begin(), targets.end());
  }
  const TextKeyframe host = map.keyframes().text_keyframe(text.host);
  const std::size_t before = out->terms.size();
  for (const int id : targets) {
    const TextKeyframe target = map.keyframes().text_keyframe(id);
    TextTerm term;
    term.text = &text;
    term.target = id;
    term.T_t_h = target.from(host);
    Quad<double> quad;
    if (!project_text(text, term.T_t_h, target.camera, &quad)) continue;
    term.scale_shift = scale_shift(text, quad);
    term.input = photometric_input(text.patch, 0, target.pyramid, target.camera, term.scale_shift);
    workspace.reserve(term.input.patch.n);
    const PhotometricCost now = evaluate(term.request(), workspace);
    if (!is_ok(now.status) || now.zncc < map.options().min_zncc) continue;
    term.visible = now.visible;
    term.zncc = now.zncc;
    term.sigma_photo = text_sigma(text, now.zncc);
    out->terms.push_back(term);
  }
  if (out->terms.size() == before) return;
  TextPrior prior;
  prior.text = &text;
  const Ldlt<double, 3> covariance(text.covariance, 1e-12);
  const double moving_share = static_cast<double>(moving.size()) / static_cast<double>(text.views.size());
  if (with_prior && covariance.ok()) prior.information = scaled(1 - moving_share, covariance.inverse());
  out->priors.push_back(prior);
}

}  // namespace detail

/// What the mapped texts say of the key frames with moves(id). Texts that no such key frame sees or hosts say nothing.
template <class Moves>
TextTerms text_terms(const BasicTextMap<>& map, Moves moves, StillViews how = StillViews::as_prior) {
  TextTerms out;
  PhotometricWorkspace workspace;
  for (const TextObject& text : map.objects())
    if (text.state == TextState::mapped) detail::add_text_terms(map, text, moves, how, workspace, &out);
  return out;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_TERMS_HPP
