// Patch and plane of a text: making, solving for, refining, moving to another key frame, and comparing with an image.
#ifndef TEXTPLANE_LANDMARKS_TEXT_PLANE_HPP
#define TEXTPLANE_LANDMARKS_TEXT_PLANE_HPP

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "textplane/core/order.hpp"
#include "textplane/features/select.hpp"
#include "textplane/geometry/plane_fit.hpp"
#include "textplane/landmarks/text_noise.hpp"
#include "textplane/landmarks/text_view.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/solver/plane.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// The pixels of a text with this quad.
TEXTPLANE_DEFERRED
TextPatch make_text_patch(const TextOptions& options, const TextImage& image, const Quad<double>& quad) {
  SelectOptions select;
  select.min_pixels = options.min_pixels;
  select.max_pixels = options.max_pixels;
  select.levels = options.levels;
  return make_patch(image.pyramid, image.camera, quad, select);
}

/// The linear system of section IV-B of the paper from matched rays (m~ in the host and in the target, third entry 1),
/// with outliers removed by transfer error. False with fewer than min_corners or too little parallax (min_parallax), or
/// where the plane is not in front of the host at `centre` (m~); *theta may then hold anything.
TEXTPLANE_DEFERRED
bool plane_from_text_matches(const TextOptions& options, std::vector<Vector3<Real>> host,
                             std::vector<Vector3<Real>> target, const SE3d& T_t_h, double fx,
                             const Vector3<double>& centre, Vector3<double>* theta) {
  const auto too_few = [&](const auto& rays) { return static_cast<int>(rays.size()) < options.min_corners; };
  std::vector<double> parallax;
  for (std::size_t i = 0; i < host.size(); ++i) {
    const Vector3<Real> turned = T_t_h.R * host[i];
    parallax.push_back(detail::degrees_between(turned, target[i]));
  }
  *theta = Vector3<double>::Zero();
  if (too_few(host) || median(parallax) < options.min_parallax) return false;
  for (int round = 0; round < options.plane_rounds; ++round) {
    const auto fit = plane_from_matches(host.data(), target.data(), static_cast<int>(host.size()), T_t_h);
    if (!is_ok(fit.status)) return false;
    *theta = fit.value;
    const Matrix3<Real> H = plane_homography(*theta, T_t_h);
    std::vector<double> errors;
    for (std::size_t i = 0; i < host.size(); ++i) {
      const Vector3<Real> q = H * host[i];
      const bool ahead = q.z() > 1e-6;
      errors.push_back(ahead ? fx * (q.hnormalized() - target[i].hnormalized()).norm() : 1e9);
    }
    const double limit = (std::max)(options.plane_min_error, options.plane_outlier * median(errors));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < host.size(); ++i) {
      if (errors[i] > limit) continue;
      host[kept] = host[i];
      target[kept++] = target[i];
    }
    if (kept == host.size()) break;
    host.resize(kept);
    target.resize(kept);
    if (too_few(host)) return false;
  }
  return all_finite(*theta) && inverse_depth<double>(*theta, centre) > 0;
}

/// Refines theta, covariance and ZNCC photometrically against these key frames, from `theta`. False, and the text as it
/// was, where the images agree by less than text_zncc_limit() of `min_zncc` or the plane is implausible.
TEXTPLANE_DEFERRED
bool refine_text_plane(const TextOptions& options, const KeyframeLookup& keyframes, const std::vector<int>& ids,
                       const Vector3<double>& theta, double min_zncc, TextObject& text) {
  const TextKeyframe host = keyframes(text.host);
  const TextObject guess = outline_of(text.patch, theta);
  std::vector<PlaneTarget> targets;
  std::vector<CameraView> cameras(ids.size());
  std::vector<double> limits;
  for (const int id : ids) {
    const TextKeyframe keyframe = keyframes(id);
    const SE3d T_t_h = keyframe.from(host);
    Quad<Real> quad;
    const int shift = project_text(guess, T_t_h, keyframe.camera, &quad) ? scale_shift(text, quad) : 0;
    CameraView& camera = cameras[targets.size()];
    camera = keyframe.camera;
    targets.push_back({keyframe.pyramid, T_t_h, shift, nullptr, &camera});
    limits.push_back(text_zncc_limit(options, min_zncc, text.patch, 0, theta, host, keyframe, T_t_h));
  }
  PlaneWorkspace workspace;
  workspace.reserve(text.patch, static_cast<int>(targets.size()));
  const auto fit = refine_plane(text.patch, theta, targets.data(), static_cast<int>(targets.size()), host.camera,
                                PlaneOptions{}, workspace);
  if (!is_ok(fit.status) || fit.zncc < median(std::move(limits)) ||
      !is_plausible_plane(options, text.patch.camera, text.patch.quad, fit.theta))
    return false;
  text.theta = fit.theta;
  text.covariance = fit.covariance;
  text.zncc = fit.zncc;
  return true;
}

/// One level of the text's patch against an image; `shift` as scale_shift() says.
TEXTPLANE_DEFERRED
inline PhotometricCost compare_text(const TextObject& text, int level, const TextImage& image, const SE3d& T_t_h,
                                    int shift, PhotometricWorkspace& workspace) {
  const auto input = photometric_input(text.patch, level, image.pyramid, image.camera, shift);
  workspace.reserve(input.patch.n);
  return evaluate(ResidualRequest{input, text.theta, T_t_h}, workspace);
}

/// Moves a plane with its covariance to another frame. False, and both as they were, where that sees its back.
TEXTPLANE_DEFERRED
inline bool transport_plane(const SE3d& T_to_from, Vector3<double>* theta, Matrix3<double>* covariance) noexcept {
  Vector3<Real> moved;
  Matrix3<Real> J;
  if (!is_ok(reanchor_plane<double>(*theta, T_to_from, &moved, &J))) return false;
  *theta = moved;
  *covariance = J * *covariance * J.transpose();
  return true;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_PLANE_HPP
