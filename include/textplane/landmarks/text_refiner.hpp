// TextRefiner: the plane of a text from many views, once the poses of the key frames are known.
//
// The text is compared between its views, from several hosts, with all its pixels, each pair at the same blur
// (photometry/blur.hpp). Each host samples narrow strokes differently, so the hosts' planes are averaged; their
// scatter, and the disagreement of the views (jackknife.hpp), go into the covariance. Last, the map points of the
// surface count, if there are any and the text lies on it (text_surface.hpp). What is bent (planarity.hpp) or uncertain
// is no text.
#ifndef TEXTPLANE_LANDMARKS_TEXT_REFINER_HPP
#define TEXTPLANE_LANDMARKS_TEXT_REFINER_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "textplane/landmarks/planarity.hpp"
#include "textplane/landmarks/text_life.hpp"
#include "textplane/landmarks/text_plane.hpp"
#include "textplane/landmarks/text_surface.hpp"
#include "textplane/photometry/blur.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {
// Moves the sides of a quad outwards by `margin` px.
TEXTPLANE_DEFERRED
inline Quad<Real> grown(const Quad<Real>& quad, double margin) noexcept {
  const auto& c = quad.corner;
  const Vector2<Real> right = (c[1] - c[0] + c[2] - c[3]).normalized(), down = (c[3] - c[0] + c[2] - c[1]).normalized();
  Quad<Real> out;
  out.corner = {c[0] - margin * (right + down), c[1] + margin * (right - down), c[2] + margin * (right + down),
                c[3] - margin * (right - down)};
  return out;
}

// d px / d m of a camera at the ray m.
TEXTPLANE_DEFERRED
inline Matrix2d pixel_jacobian(const CameraView& camera, const Vector2<double>& m) noexcept {
  FixedMatrix<Real, 2, 2> D = FixedMatrix<Real, 2, 2>::Identity();
  if (camera.lens) camera.lens->distort(m, &D);
  return Vector2<Real>(camera.pinhole.fx, camera.pinhole.fy).asDiagonal() * D;
}

// d target px / d host px of the plane, at a ray of the host.
TEXTPLANE_DEFERRED
inline bool affine_at(const CameraView& host, const CameraView& target, const Vector3<double>& theta, const SE3d& T_t_h,
                      const Vector3<double>& ray, Matrix2d* A) noexcept {
  const Matrix3<Real> H = plane_homography(theta, T_t_h);
  const Vector3<Real> q = H * ray;
  if (!(q.z() > 1e-6) || !host.in_domain(ray) || !target.in_domain(q)) return false;
  const Vector2<Real> m = q.hnormalized();
  const FixedMatrix<Real, 2, 2> by_ray =
      (H.template topLeftCorner<2, 2>() - m * H.template bottomLeftCorner<1, 2>()) / q.z();
  const FixedMatrix<Real, 2, 2> by_host_px = pixel_jacobian(host, Vector2<double>(ray[0], ray[1]));
  *A = pixel_jacobian(target, m) * by_ray * by_host_px.inverse();
  return true;
}
}  // namespace detail

/// What became of a text in TextRefiner::refine().
enum class Refinement : std::uint8_t {
  refined,    ///< Theta and covariance are new.
  uncertain,  ///< They are, but the normal is less certain than refine_max_sigma.
  bent,       ///< It is no plane, and certainly so; it is as it was.
  failed,     ///< No two whole views agree: its plane rests on parts, or on points alone. It is as it was.
};

/// Refines planes, one text after the other. Keeps memory from text to text; for one thread at a time.
TEXTPLANE_DEFERRED
class BasicTextRefiner {
 public:
  /// `options`, and what `keyframes` looks up, must outlive the refiner.
  BasicTextRefiner(const TextOptions& options, const KeyframeLookup& keyframes)
      : options_(options), keyframes_(keyframes) {}

  /// Theta and covariance of a text with a plane. `points`, if given: of the map, for the surface that it lies on.
  Refinement refine(TextObject& text, const PointLookup* points = nullptr);

 private:
  struct View {
    int id = -1;
    TextKeyframe keyframe;
    Quad<Real> quad;
    double area = 0;
  };
  struct Estimate {
    Vector3<Real> theta;  // in the text's host
    Matrix3<Real> covariance;
    double zncc = 0, variance_factor = 1;
    Bend bend;
  };

  std::vector<View> views_of(const TextObject& text) const {
    const TextKeyframe host = keyframes_(text.host);
    std::vector<int> ids = text.views;
    ids.push_back(text.host);
    std::vector<View> views;
    for (const int id : ids) {
      View view{id, keyframes_(id), {}, 0};
      const SE3d T_v_h = view.keyframe.from(host);
      if (view.keyframe.pyramid.levels < 1 || !project_text(text, T_v_h, view.keyframe.camera, &view.quad) ||
          is_too_slanted(options_, facing(text, T_v_h)) ||
          !inside_image(view.quad, view.keyframe.width(), view.keyframe.height(), options_.refine_margin + 1))
        continue;
      view.area = std::abs(area(view.quad));
      views.push_back(view);
    }
    std::sort(views.begin(), views.end(), [](const View& a, const View& b) { return a.id < b.id; });
    return views;
  }

  bool add_target(const TextPatch& patch, const Vector3<Real>& theta, const View& host, const View& view) {
    constexpr double kSampling = 1.0 / 6.0;  // px^2: mean variance of bilinear interpolation
    PlaneTarget target;
    target.T_t_h = view.keyframe.from(host.keyframe);
    target.camera = &view.keyframe.camera;
    FixedMatrix<Real, 2, 2> A;
    BlurMatch match;
    // The spread is for what is not known: the camera's blur, and not that of smoothing.
    const double camera_blur = options_.blur_variance, host_smoothing = host.keyframe.smoothing,
                 view_smoothing = view.keyframe.smoothing,
                 spread = 1 + (options_.blur_spread - 1) * camera_blur /
                                  (camera_blur + (std::max)(host_smoothing, view_smoothing));
    if (host.area > options_.refine_scale * options_.refine_scale * view.area ||
        !detail::affine_at(host.keyframe.camera, view.keyframe.camera, theta, target.T_t_h,
                           patch.camera.unproject(centroid(patch.quad)), &A) ||
        !is_ok(match_blur(A, camera_blur + host_smoothing, camera_blur + view_smoothing + kSampling, spread, &match)))
      return false;
    const std::size_t slot = targets_.size();
    const ImageView8 image = view.keyframe.pyramid.level[0];
    if (filtered_.size() <= slot) filtered_.emplace_back();
    if (filtered_[slot].width() != image.width() || filtered_[slot].height() != image.height())
      filtered_[slot] = Image<std::uint8_t>(image.width(), image.height());
    const Bounds<Real> box = bounds(view.quad);
    const int reach = options_.refine_reach;
    filter_(image, BlurKernel(match.target), static_cast<int>(box.min.x()) - reach,
            static_cast<int>(box.min.y()) - reach, static_cast<int>(box.max.x()) + reach,
            static_cast<int>(box.max.y()) + reach, filtered_[slot].view());
    target.image.levels = 1;
    target.image.level[0] = filtered_[slot].view();
    patches_.push_back(patch);
    filter_(host.keyframe.pyramid.level[0], BlurKernel(match.host), &patches_.back().levels[0]);
    targets_.push_back(target);
    return true;
  }

  // Views that are blurred by motion or half hidden are less similar to the host than the others.
  bool drop_dissimilar(const Vector3<Real>& theta) {
    std::vector<double> dissimilarity;
    for (const PlaneTarget& target : targets_) {
      const auto input = photometric_input(*target.patch, 0, target.image, *target.camera);
      const auto cost = evaluate(ResidualRequest{input, theta, target.T_t_h}, photometric_);
      dissimilarity.push_back(is_ok(cost.status) ? 1 - cost.zncc : 2);
    }
    const double limit = options_.refine_max_dissimilarity * median(dissimilarity);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < targets_.size(); ++i)
      if (dissimilarity[i] <= limit) targets_[kept++] = targets_[i];
    const bool dropped = kept < targets_.size();
    targets_.resize(kept);
    return dropped;
  }

  // How far the views disagree: by errors of their poses, by highlights, by neighbouring pixels that err together.
  Matrix3<Real> disagreement(const Vector3<Real>& theta) {
    std::vector<GroupEquations<3>> views;
    for (const PlaneTarget& target : targets_) {
      const auto input = photometric_input(*target.patch, 0, target.image, *target.camera);
      const auto view = linearise<Parameters::plane>(ResidualRequest{input, theta, target.T_t_h}, photometric_);
      if (is_ok(view.status)) views.push_back({view.visible * view.H, view.visible * view.b});
    }
    return jackknife_covariance(views);
  }

  bool estimate(const TextObject& text, const View& host, const std::vector<View>& views, Estimate* out) {
    const SE3d T_h_o = host.keyframe.from(keyframes_(text.host));
    const Vector3<Real> theta = reanchor_plane<double>(text.theta, T_h_o);
    SelectOptions select;
    select.min_pixels = options_.min_pixels;
    select.max_pixels = options_.refine_pixels;
    select.levels = 1;
    const TextPatch patch = make_patch(host.keyframe.pyramid, host.keyframe.camera,
                                       detail::grown(host.quad, options_.refine_margin), select);
    if (!is_ok(patch.status) || !(theta.norm() > 0)) return false;

    targets_.clear();
    patches_.clear();
    std::vector<int> others;
    std::vector<double> limits;
    for (std::size_t i = 0; i < views.size(); ++i)
      if (views[i].id != host.id) others.push_back(static_cast<int>(i));
    for (const int i : evenly_spaced(others, static_cast<std::size_t>(options_.refine_views))) {
      const View& view = views[static_cast<std::size_t>(i)];
      if (add_target(patch, theta, host, view))
        limits.push_back(text_zncc_limit(options_, options_.min_zncc, patch, 0, theta, host.keyframe, view.keyframe,
                                         targets_.back().T_t_h));
    }
    if (targets_.empty()) return false;
    for (std::size_t i = 0; i < targets_.size(); ++i) targets_[i].patch = &patches_[i];

    workspace_.reserve(patch, static_cast<int>(targets_.size()));
    photometric_.reserve(patch.max_pixels());
    PlaneOptions plane;
    plane.coarsest_level = 0;
    const auto fit_to_targets = [&](const Vector3<Real>& start) {
      return refine_plane(patch, start, targets_.data(), static_cast<int>(targets_.size()), host.keyframe.camera, plane,
                          workspace_);
    };
    auto fit = fit_to_targets(theta);
    if (!is_ok(fit.status)) return false;
    if (drop_dissimilar(fit.theta)) fit = fit_to_targets(fit.theta);
    if (!is_ok(fit.status) || fit.zncc < median(std::move(limits))) return false;
    Matrix3<Real> J;
    out->theta = reanchor_plane<double>(fit.theta, T_h_o.inverse(), &J);
    if (!bend_of(patch, fit.theta, targets_, patch.camera, options_.refine_bend_sigmas, photometric_, &out->bend))
      out->bend = {};
    // The disagreement shows noise, too; but few views may agree by chance.
    const Matrix3<Real> scatter = disagreement(fit.theta);
    const Matrix3<Real> known = scatter.trace() > fit.covariance.trace() ? scatter : fit.covariance;
    out->covariance = J * (known + out->bend.doubt) * J.transpose();
    out->variance_factor = fit.covariance.trace() > 0 ? known.trace() / fit.covariance.trace() : 1;
    out->zncc = fit.zncc;
    return out->theta.norm() > 0;
  }

  // Not planar: a bend, the mean over the hosts less `sigmas` standard deviations, is large, and explains much of why
  // the views disagree.
  bool is_bent(const std::vector<Estimate>& estimates, double sigmas) const {
    const double n = static_cast<double>(estimates.size());
    Vector2<Real> bend = Vector2<Real>::Zero(), sigma = Vector2<Real>::Zero();
    double explained = 0;
    for (const Estimate& e : estimates) {
      bend += e.bend.value / n;
      sigma += e.bend.sigma / n;
      explained += e.bend.explained / n;
    }
    return explained >= options_.refine_bend_share &&
           (bend.cwiseAbs() - sigmas * sigma).maxCoeff() >= options_.refine_most_bend;
  }

  const TextOptions& options_;
  KeyframeLookup keyframes_;
  BlurFilter filter_;
  PlaneWorkspace workspace_;
  PhotometricWorkspace photometric_;
  std::vector<PlaneTarget> targets_;
  std::vector<TextPatch> patches_;             // as each target's blur shows the host
  std::vector<Image<std::uint8_t>> filtered_;  // the targets, where the text is
};
using TextRefiner = BasicTextRefiner<>;  ///< It is compiled only where it is used.

template <class Real>
Refinement BasicTextRefiner<Real>::refine(TextObject& text, const PointLookup* points) {
  const std::vector<View> views = views_of(text);
  double largest = 0;
  for (const View& view : views) largest = (std::max)(largest, view.area);
  std::vector<int> hosts;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (views[i].area >= options_.refine_area * largest) hosts.push_back(static_cast<int>(i));
  std::vector<Estimate> estimates;
  for (const int i : evenly_spaced(hosts, static_cast<std::size_t>(options_.refine_hosts))) {
    Estimate e;
    if (estimate(text, views[static_cast<std::size_t>(i)], views, &e)) estimates.push_back(e);
  }
  if (estimates.empty()) return Refinement::failed;
  // A host that is blurred itself is similar to none of its targets.
  double most = 0;
  for (const Estimate& e : estimates) most = (std::max)(most, e.zncc);
  const double limit = options_.refine_max_dissimilarity * (1 - most);
  estimates.erase(
      std::remove_if(estimates.begin(), estimates.end(), [&](const Estimate& e) { return 1 - e.zncc > limit; }),
      estimates.end());
  const double n = static_cast<double>(estimates.size());
  Vector3<Real> mean = Vector3<Real>::Zero();
  Matrix3<Real> covariance = Matrix3<Real>::Zero();
  for (const Estimate& e : estimates) mean += e.theta / n;
  for (const Estimate& e : estimates)
    covariance += (e.covariance + (e.theta - mean) * (e.theta - mean).transpose()) / n;
  TextObject refined = outline_of(text.patch, mean);
  refined.covariance = covariance;
  if (points) fit_to_surface(options_, *points, keyframes_(text.host).T_w_c, refined);
  const bool uncertain = is_uncertain(refined, options_);
  // A bend makes the plane uncertain, which is no reason to doubt the bend.
  if (is_bent(estimates, uncertain ? options_.refine_bend_sigmas : 0)) return Refinement::bent;
  text.theta = refined.theta;
  text.covariance = refined.covariance;
  text.variance_factor = 0;
  for (const Estimate& e : estimates) text.variance_factor += e.variance_factor / n;
  return uncertain ? Refinement::uncertain : Refinement::refined;
}

TEXTPLANE_INSTANCE(class BasicTextRefiner<double>);

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_REFINER_HPP
