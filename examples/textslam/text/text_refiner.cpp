#include "textslam/text/text_refiner.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/features/select.hpp"
#include "textplane/geometry/homography.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/photometry/residual.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/culling.hpp"
#include "textslam/map/text_geometry.hpp"
#include "textslam/map/text_zncc.hpp"
#include "textslam/text/jackknife.hpp"
#include "textslam/text/text_surface.hpp"

namespace textslam {
namespace {

constexpr double kSampling = 1.0 / 6.0;  // px^2: mean variance of bilinear interpolation

// Moves the sides of a quad outwards by `margin` px.
Quad<double> grown(const Quad<double>& quad, double margin) {
  const auto& c = quad.corner;
  const Vec2 right = (c[1] - c[0] + c[2] - c[3]).normalized(), down = (c[3] - c[0] + c[2] - c[1]).normalized();
  Quad<double> out;
  out.corner = {c[0] - margin * (right + down), c[1] + margin * (right - down), c[2] + margin * (right + down),
                c[3] - margin * (right - down)};
  return out;
}

// d target px / d host px of the plane, at the text's centre.
bool affine_at(const Pinhole<double>& camera, const Vec3& theta, const SE3d& T_t_h, const Vec2& px,
               textplane::Matrix2d* A) {
  const Eigen::Matrix3d H =
      textplane::pixel_homography<double>(textplane::plane_homography(theta, T_t_h), camera, camera);
  const Vec3 q = H * px.homogeneous();
  if (!(q.z() > 1e-6)) return false;
  const Vec2 p = q.hnormalized();
  *A = (H.topLeftCorner<2, 2>() - p * H.bottomLeftCorner<1, 2>()) / q.z();
  return true;
}

}  // namespace

std::vector<TextRefiner::View> TextRefiner::views_of(const TextObject& text) const {
  std::vector<int> keyframes = text.views;
  keyframes.push_back(text.host);
  std::vector<View> views;
  for (const int id : keyframes) {
    View view{id, map_.keyframe(id).T_w_c.inverse(), {}, 0};
    if (!project_text(map_, text, view.T_c_w, &view.quad) ||
        is_too_slanted(parameters_, facing(map_, text, view.T_c_w)) ||
        !textplane::inside_image(view.quad, map_.width, map_.height, parameters_.refine_margin + 1))
      continue;
    view.area = std::abs(textplane::area(view.quad));
    views.push_back(view);
  }
  std::sort(views.begin(), views.end(), [](const View& a, const View& b) { return a.keyframe < b.keyframe; });
  return views;
}

bool TextRefiner::add_target(const textplane::TextPatch& patch, const Vec3& theta, const View& host, const View& view) {
  textplane::PlaneTarget target;
  target.T_t_h = view.T_c_w * map_.keyframe(host.keyframe).T_w_c;
  textplane::Matrix2d A;
  textplane::BlurMatch match;
  // The spread is for what is not known: the camera's blur, and not that of smoothing.
  const double camera_blur = parameters_.blur_variance, host_smoothing = map_.keyframe(host.keyframe).frame.smoothing,
               view_smoothing = map_.keyframe(view.keyframe).frame.smoothing,
               spread = 1 + (parameters_.blur_spread - 1) * camera_blur /
                                (camera_blur + std::max(host_smoothing, view_smoothing));
  if (host.area > parameters_.refine_scale * parameters_.refine_scale * view.area ||
      !affine_at(map_.camera, theta, target.T_t_h, textplane::centroid(patch.quad), &A) ||
      !textplane::is_ok(textplane::match_blur(A, camera_blur + host_smoothing, camera_blur + view_smoothing + kSampling,
                                              spread, &match)))
    return false;
  const std::size_t slot = targets_.size();
  if (filtered_.size() <= slot) filtered_.emplace_back(map_.width, map_.height);
  const textplane::Bounds<double> box = textplane::bounds(view.quad);
  const int reach = parameters_.refine_reach;
  filter_(map_.keyframe(view.keyframe).frame.image->level(0), textplane::BlurKernel(match.target),
          static_cast<int>(box.min.x()) - reach, static_cast<int>(box.min.y()) - reach,
          static_cast<int>(box.max.x()) + reach, static_cast<int>(box.max.y()) + reach, filtered_[slot].view());
  target.image.levels = 1;
  target.image.level[0] = filtered_[slot].view();
  patches_.push_back(patch);
  filter_(map_.keyframe(host.keyframe).frame.image->level(0), textplane::BlurKernel(match.host),
          &patches_.back().levels[0]);
  targets_.push_back(target);
  return true;
}

// Views that are blurred by motion or half hidden are less similar to the host than the others.
bool TextRefiner::drop_dissimilar(const Vec3& theta) {
  std::vector<double> dissimilarity;
  for (const textplane::PlaneTarget& target : targets_) {
    const auto input = textplane::photometric_input(*target.patch, 0, target.image, map_.camera);
    const auto cost = textplane::evaluate(textplane::ResidualRequest{input, theta, target.T_t_h}, photometric_);
    dissimilarity.push_back(textplane::is_ok(cost.status) ? 1 - cost.zncc : 2);
  }
  const double limit = parameters_.refine_max_dissimilarity * median(dissimilarity);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < targets_.size(); ++i)
    if (dissimilarity[i] <= limit) targets_[kept++] = targets_[i];
  const bool dropped = kept < targets_.size();
  targets_.resize(kept);
  return dropped;
}

// How far the views disagree: by errors of their poses, by highlights, by neighbouring pixels that err together.
Eigen::Matrix3d TextRefiner::disagreement(const Vec3& theta) {
  std::vector<GroupEquations<>> views;
  for (const textplane::PlaneTarget& target : targets_) {
    const auto input = textplane::photometric_input(*target.patch, 0, target.image, map_.camera);
    const auto view = textplane::linearise<textplane::Parameters::plane>(
        textplane::ResidualRequest{input, theta, target.T_t_h}, photometric_);
    if (textplane::is_ok(view.status)) views.push_back({view.visible * view.H, view.visible * view.b});
  }
  return jackknife_covariance(views);
}

bool TextRefiner::estimate(const TextObject& text, const View& host, const std::vector<View>& views, Estimate* out) {
  const SE3d T_h_o = host.T_c_w * map_.keyframe(text.host).T_w_c;
  const Vec3 theta = textplane::reanchor_plane<double>(text.theta, T_h_o);
  textplane::SelectOptions options;
  options.min_pixels = parameters_.text_min_pixels;
  options.max_pixels = parameters_.refine_pixels;
  options.levels = 1;
  const textplane::TextPatch patch =
      textplane::make_patch(map_.keyframe(host.keyframe).frame.image->view(), map_.camera,
                            grown(host.quad, parameters_.refine_margin), options);
  if (!textplane::is_ok(patch.status) || !(theta.norm() > 0)) return false;

  targets_.clear();
  patches_.clear();
  std::vector<int> others;
  std::vector<double> limits;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (views[i].keyframe != host.keyframe) others.push_back(static_cast<int>(i));
  for (const int i : evenly_spaced(others, static_cast<std::size_t>(parameters_.refine_views)))
    if (add_target(patch, theta, host, views[static_cast<std::size_t>(i)]))
      limits.push_back(text_zncc_limit(
          parameters_, parameters_.text_min_zncc, patch, 0, theta, map_.keyframe(host.keyframe).frame,
          map_.keyframe(views[static_cast<std::size_t>(i)].keyframe).frame, targets_.back().T_t_h, map_.camera));
  if (targets_.empty()) return false;
  for (std::size_t i = 0; i < targets_.size(); ++i) targets_[i].patch = &patches_[i];

  workspace_.reserve(patch, static_cast<int>(targets_.size()));
  photometric_.reserve(patch.max_pixels());
  textplane::PlaneOptions plane;
  plane.coarsest_level = 0;
  const auto fit_to_targets = [&](const Vec3& start) {
    return textplane::refine_plane(patch, start, targets_.data(), static_cast<int>(targets_.size()), map_.camera, plane,
                                   workspace_);
  };
  auto fit = fit_to_targets(theta);
  if (!textplane::is_ok(fit.status)) return false;
  if (drop_dissimilar(fit.theta)) fit = fit_to_targets(fit.theta);
  if (!textplane::is_ok(fit.status) || fit.zncc < median(std::move(limits))) return false;
  textplane::Matrix3<double> J;
  out->theta = textplane::reanchor_plane<double>(fit.theta, T_h_o.inverse(), &J);
  if (!bend_of(patch, fit.theta, targets_, map_.camera, parameters_.refine_bend_sigmas, photometric_, &out->bend))
    out->bend = {};
  // The disagreement shows noise, too; but few views may agree by chance.
  const Eigen::Matrix3d scatter = disagreement(fit.theta);
  const Eigen::Matrix3d known = scatter.trace() > fit.covariance.trace() ? scatter : fit.covariance;
  out->covariance = J * (known + out->bend.doubt) * J.transpose();
  out->zncc = fit.zncc;
  return out->theta.norm() > 0;
}

// Not planar: a bend, the mean over the hosts, explains much of why the views disagree.
bool TextRefiner::is_bent(const std::vector<Estimate>& estimates) const {
  const double n = static_cast<double>(estimates.size());
  Vec2 bend = Vec2::Zero();
  double explained = 0;
  for (const Estimate& e : estimates) {
    bend += e.bend.value / n;
    explained += e.bend.explained / n;
  }
  return explained >= parameters_.refine_bend_share && bend.cwiseAbs().maxCoeff() >= parameters_.refine_most_bend;
}

void TextRefiner::refine(TextObject& text) {
  if (!is_detected(text, parameters_)) return drop(text);
  const std::vector<View> views = views_of(text);
  double largest = 0;
  for (const View& view : views) largest = std::max(largest, view.area);
  std::vector<int> hosts;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (views[i].area >= parameters_.refine_area * largest) hosts.push_back(static_cast<int>(i));
  std::vector<Estimate> estimates;
  for (const int i : evenly_spaced(hosts, static_cast<std::size_t>(parameters_.refine_hosts))) {
    Estimate e;
    if (estimate(text, views[static_cast<std::size_t>(i)], views, &e)) estimates.push_back(e);
  }
  if (estimates.empty()) return drop(text);
  // A host that is blurred itself is similar to none of its targets.
  double most = 0;
  for (const Estimate& e : estimates) most = std::max(most, e.zncc);
  const double limit = parameters_.refine_max_dissimilarity * (1 - most);
  erase_if(estimates, [&](const Estimate& e) { return 1 - e.zncc > limit; });
  const double n = static_cast<double>(estimates.size());
  Vec3 mean = Vec3::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Estimate& e : estimates) mean += e.theta / n;
  for (const Estimate& e : estimates)
    covariance += (e.covariance + (e.theta - mean) * (e.theta - mean).transpose()) / n;
  text.theta = mean;
  text.covariance = covariance;
  fit_to_surface(map_, parameters_, text);
  if (is_uncertain(text, parameters_) || is_bent(estimates)) drop(text);
}

void TextRefiner::refine() {
  for (TextObject& text : map_.texts)
    if (text.state == TextState::mapped) refine(text);
}

}  // namespace textslam
