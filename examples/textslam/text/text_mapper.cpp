#include "textslam/text/text_mapper.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/geometry/plane.hpp"
#include "textplane/landmarks/text_hosting.hpp"
#include "textplane/landmarks/text_life.hpp"
#include "textplane/landmarks/text_plane.hpp"
#include "textplane/landmarks/text_surface.hpp"
#include "textplane/landmarks/words.hpp"
#include "textplane/photometry/residual.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/map/text_views.hpp"
#include "textslam/text/loose_planes.hpp"

namespace textslam {
namespace {

using textplane::KeyframeLookup;

}  // namespace

bool TextMapper::meets(const std::vector<Detection>& detections, const Quad<double>& quad) const {
  return std::any_of(detections.begin(), detections.end(), [&](const Detection& detection) {
    return textplane::iou(quad, detection.quad) >= parameters_.text.confirm_iou;
  });
}

// A text with a plane is where the plane says; a candidate is carried along by the median motion of its corners.
bool TextMapper::locate(const TextObject& text, const SE3d& T_c_w, const std::vector<Track>& tracks,
                        Quad<double>* quad) const {
  if (text.has_plane()) return facing(map_, text, T_c_w) > 0 && project_text(map_, text, T_c_w, quad);
  const Quad<double> in_host = host_quad(map_, text);
  std::vector<double> dx, dy;
  for (const Track& track : tracks) {
    const Vec2* host_px = observed_in(observations_of(map_, track), text.host);
    if (!host_px || !textplane::contains(in_host, *host_px)) continue;
    dx.push_back(track.px.x() - host_px->x());
    dy.push_back(track.px.y() - host_px->y());
  }
  if (static_cast<int>(dx.size()) < parameters_.text_carried_corners) return false;
  const Vec2 shift(median(dx), median(dy));
  for (std::size_t i = 0; i < 4; ++i) quad->corner[i] = in_host.corner[i] + shift;
  return true;
}

// Could a detector find it where locate() says that it is?
bool TextMapper::is_whole(const TextObject& text, const Quad<double>& quad, const SE3d& T_c_w) const {
  return textplane::inside_image(quad, map_.width, map_.height, parameters_.text.border) &&
         std::abs(textplane::area(quad)) >= parameters_.text.min_area &&
         !(text.has_plane() && is_too_slanted(parameters_.text, facing(map_, text, T_c_w)));
}

bool TextMapper::has_parallax(const SE3d& T_c_w, const std::vector<Track>& tracks, int last) const {
  const SE3d T_w_l = map_.keyframe(last).T_w_c;
  return std::any_of(map_.texts.begin(), map_.texts.end(), [&](const TextObject& text) {
    const bool waits = text.state == TextState::candidate || text.state == TextState::tentative;
    Quad<double> quad;
    if (!waits || text.detections < 2 || text.detections < parameters_.text.detected_share * text.shown ||
        !local_.has_text(text.id) || !locate(text, T_c_w, tracks, &quad) || !is_whole(text, quad, T_c_w))
      return false;
    const Quad<double> in_host = host_quad(map_, text);
    std::vector<double> parallax;
    for (const Track& track : tracks) {
      const auto& observations = observations_of(map_, track);
      const Vec2 *host_px = observed_in(observations, text.host), *then = observed_in(observations, last);
      if (!host_px || !then || !textplane::contains(in_host, *host_px)) continue;
      const Vec3 ray = ray_of(map_.camera, track.px.cast<double>());
      parallax.push_back(degrees_between(T_c_w.R.transpose() * ray, T_w_l.R * ray_of(map_.camera, *then)));
    }
    if (text.has_plane()) {
      const Vec3 centre =
          map_.keyframe(text.host).T_w_c *
          textplane::plane_point(text.theta, text.patch.camera.unproject(textplane::centroid(text.patch.quad)));
      parallax.assign(1, degrees_between(centre - T_c_w.inverse().t, centre - T_w_l.t));
    }
    return !parallax.empty() && median(std::move(parallax)) >= parameters_.text_keyframe_parallax;
  });
}

void TextMapper::associate(const Frame& frame, const SE3d& T_c_w, const std::vector<Track>& tracks) {
  if (frame.detections.empty()) return;
  for (TextObject& text : map_.texts) {
    Quad<double> quad;
    if (text.state == TextState::dropped || !local_.has_text(text.id) || !locate(text, T_c_w, tracks, &quad)) continue;
    bool shown = is_whole(text, quad, T_c_w);
    for (const Detection& detection : frame.detections) {
      if (textplane::iou(quad, detection.quad) < parameters_.text.confirm_iou) continue;
      ++text.detections;
      shown = true;
      if (is_read(detection.text)) vote(&text.votes, detection.text, detection.score, parameters_.text);
      break;
    }
    text.shown += shown ? 1 : 0;
  }
  pending_.add(map_, frame, T_c_w, unknown(frame.detections, T_c_w, tracks));
}

std::vector<Detection> TextMapper::new_detections(const Frame& frame, const SE3d& T_c_w,
                                                  const std::vector<Track>& tracks) const {
  std::vector<Detection> detections = frame.detections;
  for (Detection& carried : pending_.carried_to(map_, T_c_w)) detections.push_back(std::move(carried));
  return unknown(detections, T_c_w, tracks);
}

// Of detections on one another, the first counts.
std::vector<Detection> TextMapper::unknown(const std::vector<Detection>& detections, const SE3d& T_c_w,
                                           const std::vector<Track>& tracks) const {
  if (detections.empty()) return {};
  std::vector<Quad<double>> known;
  for (const TextObject& text : map_.texts) {
    Quad<double> quad;
    if (text.state != TextState::dropped && local_.has_text(text.id) && locate(text, T_c_w, tracks, &quad))
      known.push_back(quad);
  }
  std::vector<Detection> accepted;
  for (const Detection& detection : detections) {
    if (!may_begin(parameters_.text, detection.quad, map_.width, map_.height, known)) continue;
    accepted.push_back(detection);
    known.push_back(detection.quad);
  }
  return accepted;
}

void TextMapper::add_candidates(int id, const std::vector<Detection>& detections) {
  for (const Detection& detection : detections) {
    TextObject text;
    text.id = static_cast<int>(map_.texts.size());
    text.host = id;
    text.patch = make_text_patch(parameters_.text, map_.text_keyframe(id), detection.quad);
    if (!textplane::is_ok(text.patch.status)) continue;
    const PendingTexts::Count count = pending_.take(map_, map_.keyframe(id).T_w_c.inverse(), detection.quad);
    text.detections = std::max(1, count.detections);
    text.shown = std::max(1, count.shown);
    if (is_read(detection.text)) vote(&text.votes, detection.text, detection.score, parameters_.text);
    map_.texts.push_back(std::move(text));
  }
}

// Rays of the corners tracked from the host to `keyframe`.
TextMapper::Corners TextMapper::corners(const TextObject& text, int keyframe, const std::vector<Track>& tracks) const {
  Corners out;
  const Quad<double> in_host = host_quad(map_, text);
  for (const Track& track : tracks) {
    const auto& observations = observations_of(map_, track);
    const Vec2 *host_px = observed_in(observations, text.host), *px = observed_in(observations, keyframe);
    if (!host_px || !px || !textplane::contains(in_host, *host_px)) continue;
    out.host.push_back(ray_of(map_.camera, *host_px));
    out.target.push_back(ray_of(map_.camera, *px));
  }
  return out;
}

// The motion of key frame `id` from its time stamp to the row in the middle of these rays.
SE3d TextMapper::middle_row(int id, const std::vector<Vec3>& rays) const {
  const auto& rows = map_.keyframe(id).frame.rows;
  if (!rows || rays.empty()) return {};
  Vec3 mean = Vec3::Zero();
  for (const Vec3& ray : rays) mean += ray / static_cast<double>(rays.size());
  return map_.camera.in_domain(mean) ? rows->at(map_.camera.project(mean).y()) : SE3d{};
}

// The plane by the corners of key frame `id` and the images, and the views that agree with it. It replaces an earlier
// plane where more views agree: the first was solved with little parallax.
bool TextMapper::find_plane(TextObject& text, int id, const std::vector<Track>& tracks) {
  TextObject found = text;
  Vec3 theta;
  const auto [host, target] = corners(text, id, tracks);
  const Vec3 centre = text.patch.camera.unproject(textplane::centroid(text.patch.quad));
  SE3d T_t_h = map_.T_c_h(map_.keyframe(id).T_w_c.inverse(), text.host);
  // Behind a rolling shutter between the rows in the middle of the corners.
  const SE3d in_host = middle_row(text.host, host), in_target = middle_row(id, target);
  if (map_.shutter.active()) T_t_h = in_target * T_t_h * in_host.inverse();
  if (!plane_from_text_matches(parameters_.text, host, target, T_t_h, map_.camera.pinhole.fx, centre, &theta) ||
      (map_.shutter.active() &&
       !textplane::is_ok(textplane::reanchor_plane<double>(theta, in_host.inverse(), &theta))) ||
      !refine_text_plane(parameters_.text, KeyframeLookup(map_), {id}, theta, parameters_.text.min_zncc, found))
    return false;
  observe_until(found, id);
  if (text.has_plane() && found.views.size() <= text.views.size()) return false;
  text = std::move(found);
  return true;
}

// By the map points about it, which its host sees.
bool TextMapper::plane_by_points(TextObject& text) const {
  const SE3d T_w_h = map_.keyframe(text.host).T_w_c, T_h_w = T_w_h.inverse();
  std::vector<Vec3> seen;
  for (const int id : map_.keyframe(text.host).points)
    if (!map_.point(id).bad) seen.push_back(T_h_w * map_.point(id).p_w);
  const SurfacePoints points{map_, parameters_.point_sigma};
  return plane_from_surface(parameters_.text, textplane::PointLookup(points), T_w_h, seen, text);
}

// The key frames about the host, up to `id`, that agree with a text's new plane: those before it too, where the
// detector may have missed it. Failures of the old plane are forgotten.
void TextMapper::observe_until(TextObject& text, int id) {
  text.views.clear();
  for (int other = std::max(0, text.host - parameters_.text.patience); other <= id; ++other)
    if (other != text.host && !map_.keyframe(other).culled) observe(text, other, 1);
  text.failures = 0;
}

// Does key frame `keyframe` show the text where its plane says? A rough plane asks for all of it (`min_share` 1): on a
// part it may agree with the image by chance.
void TextMapper::observe(TextObject& text, int keyframe, double min_share) {
  const textplane::TextKeyframe host = map_.text_keyframe(text.host), target = map_.text_keyframe(keyframe);
  const SE3d T_t_h = target.from(host);
  Quad<double> quad;
  if (!is_in_view(parameters_.text, text, T_t_h, target, parameters_.text.seen_area * parameters_.text.min_area,
                  min_share, &quad))
    return;
  const int level = text.patch.level_count() > 1 ? 1 : 0;
  const auto input =
      textplane::photometric_input(text.patch, level, target.pyramid, target.camera, scale_shift(text, quad));
  textplane::PhotometricWorkspace workspace(input.patch.n);
  const auto cost = textplane::reference::evaluate(textplane::ResidualRequest{input, text.theta, T_t_h}, workspace);
  if (!textplane::is_ok(cost.status)) return;
  const double least =
      text_zncc_limit(parameters_.text, parameters_.text.min_zncc, text.patch, level, text.theta, host, target, T_t_h);
  count_view(parameters_.text, keyframe, cost.zncc, least, text,
             [&] { return meets(map_.keyframe(keyframe).frame.detections, quad); });
}

void TextMapper::observe_again() {
  for (TextObject& text : map_.texts) {
    if (text.state != TextState::mapped) continue;
    // Where loops are to stay open, a text met again far away must not close them.
    const LocalMap near = parameters_.loop_closure ? LocalMap() : local_map(map_, parameters_, text.host);
    std::vector<int> before = std::exchange(text.views, {});
    for (const int id : map_.keyframe_ids())
      if (id != text.host && near.has_keyframe(id)) observe(text, id, parameters_.text.min_share);
    if (static_cast<int>(text.views.size()) + 1 < parameters_.text.min_observations) text.views = std::move(before);
  }
}

void TextMapper::update(int id, const std::vector<Track>& tracks) {
  if (parameters_.mode == Mode::loose) return update_loose_planes(map_, parameters_, id);
  for (TextObject& text : map_.texts) {
    if (text.host == id || text.state == TextState::dropped) continue;
    const bool near = local_.has_text(text.id);
    const std::size_t before = text.views.size();
    if (text.state == TextState::candidate) {
      if (near && find_plane(text, id, tracks)) {
        text.state = TextState::tentative;
      } else if (is_overdue(text, parameters_.text, id - text.host) ||
                 static_cast<int>(corners(text, id, tracks).host.size()) < parameters_.text.min_corners) {
        if (near && plane_by_points(text)) {
          observe_until(text, id);  // no view need agree yet
          text.state = TextState::tentative;
        } else {
          drop(text);  // if it is seen again, another candidate starts with new corners
        }
      }
    } else if (near) {
      observe(text, id, 1);
      if (text.state == TextState::tentative && text.views.size() == before) find_plane(text, id, tracks);
    }
    if (!text.has_plane()) continue;
    if (text.views.size() > before && text.state == TextState::tentative) {
      refine_text_plane(parameters_.text, KeyframeLookup(map_),
                        evenly_spaced(text.views, static_cast<std::size_t>(parameters_.text.views)), text.theta,
                        parameters_.text.cull_zncc, text);
    }
    if (text.state == TextState::tentative && is_proven(text, parameters_.text)) text.state = TextState::mapped;
    if (is_contradicted(text, parameters_.text) || is_overdue(text, parameters_.text, id - text.host)) drop(text);
    if (text.views.size() > before) rehost(parameters_.text, KeyframeLookup(map_), id, text);
  }
}

}  // namespace textslam
