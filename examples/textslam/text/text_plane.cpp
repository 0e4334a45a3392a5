#include "textslam/text/text_plane.hpp"

#include <utility>

#include "textplane/features/select.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/solver/plane.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/text_geometry.hpp"
#include "textslam/map/text_zncc.hpp"

namespace textslam {
textplane::TextPatch make_text_patch(const Map& map, const Parameters& parameters, int id, const Quad<double>& quad) {
  textplane::SelectOptions options;
  options.min_pixels = parameters.text_min_pixels;
  options.max_pixels = parameters.text_max_pixels;
  options.levels = parameters.text_levels;
  return textplane::make_patch(map.keyframe(id).frame.image->view(), map.camera, quad, options);
}

bool refine_plane(const Map& map, const Parameters& parameters, const std::vector<int>& keyframes, const Vec3& theta,
                  double min_zncc, TextObject& text) {
  std::vector<textplane::PlaneTarget> targets;
  TextObject guess;
  guess.host = text.host;
  guess.patch.quad = text.patch.quad;
  guess.theta = theta;
  for (const int id : keyframes) {
    const SE3d T_c_w = map.keyframe(id).T_w_c.inverse();
    Quad<double> quad;
    const int shift = project_text(map, guess, T_c_w, &quad) ? scale_shift(text, quad) : 0;
    targets.push_back({map.keyframe(id).frame.image->view(), map.T_c_h(T_c_w, text.host), shift});
  }
  std::vector<double> limits;
  for (std::size_t i = 0; i < targets.size(); ++i)
    limits.push_back(text_zncc_limit(parameters, min_zncc, text.patch, 0, theta, map.keyframe(text.host).frame,
                                     map.keyframe(keyframes[i]).frame, targets[i].T_t_h, map.camera));
  textplane::PlaneWorkspace workspace;
  workspace.reserve(text.patch, static_cast<int>(targets.size()));
  textplane::PlaneOptions options;
  const auto fit = textplane::refine_plane(text.patch, theta, targets.data(), static_cast<int>(targets.size()),
                                           map.camera, options, workspace);
  if (!textplane::is_ok(fit.status) || fit.zncc < median(std::move(limits)) ||
      !is_plausible_plane(map, parameters, text.patch.quad, fit.theta))
    return false;
  text.theta = fit.theta;
  text.covariance = fit.covariance;
  text.zncc = fit.zncc;
  return true;
}

textplane::PhotometricCost compare_text(const Map& map, const TextObject& text, int level, const Pyramid& image,
                                        const SE3d& T_c_w, int shift, textplane::PhotometricWorkspace& workspace) {
  const auto input = textplane::photometric_input(text.patch, level, image.view(), map.camera, shift);
  workspace.reserve(input.patch.n);
  return textplane::evaluate(textplane::ResidualRequest{input, text.theta, map.T_c_h(T_c_w, text.host)}, workspace);
}

bool transport_plane(const Map& map, int from, int to, Vec3* theta, Eigen::Matrix3d* covariance) {
  const SE3d T_to_from = map.T_c_h(map.keyframe(to).T_w_c.inverse(), from);
  Vec3 moved;
  textplane::Matrix3<double> J;
  if (!textplane::is_ok(textplane::reanchor_plane<double>(*theta, T_to_from, &moved, &J))) return false;
  *theta = moved;
  *covariance = J * *covariance * J.transpose();
  return true;
}

}  // namespace textslam
