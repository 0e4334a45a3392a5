#include "textslam/text/text_hosting.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/geometry/quad.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/text_geometry.hpp"
#include "textslam/text/text_plane.hpp"

namespace textslam {
namespace {

// Its whole quad in a key frame that shows clearly more of it than the host; false where that does not.
bool shown_better(const Map& map, const Parameters& parameters, const TextObject& text, int id, Quad<double>* quad) {
  const SE3d T_c_w = map.keyframe(id).T_w_c.inverse();
  if (!project_text(map, text, T_c_w, quad) || !textplane::is_convex(*quad) ||
      !textplane::inside_image(*quad, map.width, map.height, parameters.text_border))
    return false;
  if (!(textplane::area(*quad) >= parameters.rehost_area * textplane::area(text.patch.quad))) return false;
  const auto slant = [&](const SE3d& T) { return std::acos(std::clamp(facing(map, text, T), -1.0, 1.0)); };
  return slant(T_c_w) <= slant(map.keyframe(text.host).T_w_c.inverse()) + radians(parameters.rehost_slant);
}

// Mean of 1 - ZNCC between the text's patch and these key frames, on the finest level.
double dissimilarity(const Map& map, const TextObject& text, const std::vector<int>& keyframes) {
  textplane::PhotometricWorkspace workspace;
  double sum = 0;
  for (const int id : keyframes) {
    const SE3d T_c_w = map.keyframe(id).T_w_c.inverse();
    Quad<double> quad;
    if (!project_text(map, text, T_c_w, &quad)) return 2;
    const auto cost =
        compare_text(map, text, 0, *map.keyframe(id).frame.image, T_c_w, scale_shift(text, quad), workspace);
    sum += textplane::is_ok(cost.status) ? 1 - cost.zncc : 2;
  }
  return sum / static_cast<double>(keyframes.size());
}

}  // namespace

bool rehost(const Map& map, const Parameters& parameters, int id, TextObject& text) {
  const auto at = std::find(text.views.begin(), text.views.end(), id);
  Quad<double> quad;
  if (text.state != TextState::mapped || at == text.views.end() || map.keyframe(id).culled ||
      !shown_better(map, parameters, text, id, &quad))
    return false;
  std::vector<int> others = text.views;
  others.erase(others.begin() + (at - text.views.begin()));
  if (others.empty()) return false;

  TextObject moved = text;
  moved.host = id;
  moved.patch = make_text_patch(map, parameters, id, quad);
  if (!textplane::is_ok(moved.patch.status) || !transport_plane(map, text.host, id, &moved.theta, &moved.covariance))
    return false;
  moved.views = others;
  moved.views.insert(std::upper_bound(moved.views.begin(), moved.views.end(), text.host), text.host);
  const auto most = static_cast<std::size_t>(parameters.text_views);
  if (!refine_plane(map, parameters, evenly_spaced(moved.views, most), moved.theta, parameters.text_min_zncc, moved))
    return false;
  // The same key frames speak for either host.
  const std::vector<int> both = evenly_spaced(others, most);
  if (dissimilarity(map, moved, both) > parameters.rehost_max_dissimilarity * dissimilarity(map, text, both))
    return false;
  text = std::move(moved);
  return true;
}

}  // namespace textslam
