#include "textslam_map/map_signs.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/landmarks/text_view.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/common/geometry.hpp"
#include "textslam/map/text_views.hpp"
#include "textslam/text/text_centre.hpp"

namespace textslam {
namespace {

constexpr double kSteepest = 70;  // degrees: beyond this slant no text is mapped

MapSign sign_of(const Map& map, const TextObject& text) {
  MapSign sign;
  sign.text = text.id;
  sign.word = textplane::consensus(text.votes);
  sign.corners = world_corners(map, text);
  const auto& c = sign.corners;
  const TextCentre centre = text_centre(map, text);
  sign.centre = centre.at;
  sign.covariance = centre.covariance;
  const Vec3 right = c[1] + c[2] - c[0] - c[3], down = c[2] + c[3] - c[0] - c[1];
  sign.size = 0.5 * std::sqrt(right.norm() * down.norm());
  const Eigen::Matrix3d& R_w_h = map.keyframe(text.host).T_w_c.R;
  const Vec3 into = -(R_w_h * textplane::plane_normal(text.theta));
  sign.axes.col(2) = into;
  sign.axes.col(0) = (right - into * into.dot(right)).normalized();
  sign.axes.col(1) = into.cross(sign.axes.col(0));

  const auto& q = text.patch.quad.corner;
  const double wide = 0.5 * (q[1] + q[2] - q[0] - q[3]).norm(), high = 0.5 * (q[2] + q[3] - q[0] - q[1]).norm();
  const double corner = centre.corner_px;
  const double cosine =
      std::max(-textplane::plane_normal(text.theta).dot(centre.in_host.normalized()), std::cos(radians(kSteepest)));
  const double slant = std::sqrt(1 - std::min(1.0, cosine * cosine)) / cosine;
  sign.normal_sigma = normal_sigma(text);
  sign.turn_sigma = std::hypot(sign.normal_sigma, corner / std::max(wide, 1.0));
  // Two corners of four each side.
  const double box = 0.5 * std::hypot(corner / std::max(wide, 1.0), corner / std::max(high, 1.0));
  sign.size_sigma = std::hypot(distance_sigma(text), box, slant * sign.normal_sigma);
  return sign;
}

}  // namespace

std::vector<MapSign> map_signs(const Map& map, const textplane::TextOptions& options) {
  std::vector<MapSign> signs;
  for (const TextObject& text : map.texts) {
    if (text.state != TextState::mapped || !textplane::is_read(textplane::consensus(text.votes))) continue;
    MapSign sign = sign_of(map, text);
    if (sign.size > 0 && sign.centre.allFinite() && sign.axes.allFinite() && sign.covariance.allFinite())
      signs.push_back(std::move(sign));
  }
  for (MapSign& sign : signs)
    sign.unique = std::none_of(signs.begin(), signs.end(), [&](const MapSign& other) {
      return &other != &sign && textplane::words_agree(sign.word, other.word, options);
    });
  return signs;
}

double plane_uncertainty(const TextObject& text) { return std::hypot(normal_sigma(text), distance_sigma(text)); }

}  // namespace textslam
