#include "textslam/feature_tracks.hpp"

#include <algorithm>

#include "textplane/features/fast.hpp"
#include "textplane/features/klt.hpp"
#include "textplane/features/select.hpp"

namespace textslam {
namespace {

constexpr int kTextCell = 6;  // px between the corners of a text

textplane::KltOptions klt_options(const Parameters& parameters) {
  textplane::KltOptions options;
  options.half_window = parameters.klt_half_window;
  options.levels = parameters.pyramid_levels;
  options.max_forward_backward = parameters.max_forward_backward;
  options.min_zncc = parameters.min_track_zncc;
  return options;
}

}  // namespace

void advance_tracks(const Frame& from, const Frame& to, const std::vector<Vec2f>& guesses, const Parameters& parameters,
                    std::vector<Track>& tracks) {
  if (tracks.empty()) return;
  std::vector<Vec2f> start(tracks.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) start[i] = tracks[i].px;
  std::vector<textplane::KltResult> results(tracks.size());
  textplane::track_klt(from.image->view(), to.image->view(), start.data(), guesses.empty() ? nullptr : guesses.data(),
                       static_cast<int>(tracks.size()), klt_options(parameters), results.data());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!textplane::is_ok(results[i].status)) continue;
    if (kept != i) tracks[kept] = std::move(tracks[i]);
    tracks[kept].px = results[i].px;
    ++kept;
  }
  tracks.resize(kept);
}

void add_corners(const Frame& frame, int keyframe, const std::vector<Quad<double>>& quads, const Parameters& parameters,
                 std::vector<Track>& tracks) {
  const textplane::ImageView8 image = frame.image->level(0);
  const int border = parameters.klt_half_window + 2;
  std::vector<textplane::Corner> corners;
  for (int threshold = parameters.fast_threshold;; threshold /= 2) {
    threshold = std::max(threshold, parameters.min_fast_threshold);
    textplane::detect_fast(image, threshold, true, corners);
    if (static_cast<int>(corners.size()) >= 4 * parameters.max_tracks || threshold == parameters.min_fast_threshold)
      break;
  }
  const auto inside = [&](const Vec2f& px) {
    return px.x() >= static_cast<float>(border) && px.y() >= static_cast<float>(border) &&
           px.x() < static_cast<float>(image.width() - border) && px.y() < static_cast<float>(image.height() - border);
  };
  const auto add = [&](const Vec2f& px) {
    Track track;
    track.px = px;
    track.observations.push_back({keyframe, px.cast<double>()});
    tracks.push_back(std::move(track));
  };

  // Text first, and more densely: its plane is solved for from these corners.
  for (const Quad<double>& quad : quads) {
    std::vector<Vec2f> occupied;
    for (const Track& track : tracks) occupied.push_back(track.px);
    std::vector<textplane::Corner> in_quad;
    for (const textplane::Corner& corner : corners)
      if (inside({corner.x, corner.y}) && textplane::contains(quad, Vec2(corner.x, corner.y)))
        in_quad.push_back(corner);
    textplane::select_spread(in_quad, image.width(), image.height(), kTextCell, parameters.text_corners, occupied,
                             in_quad);
    for (const textplane::Corner& corner : in_quad) add({corner.x, corner.y});
  }

  std::vector<Vec2f> occupied;
  for (const Track& track : tracks) occupied.push_back(track.px);
  corners.erase(std::remove_if(corners.begin(), corners.end(),
                               [&](const textplane::Corner& c) {
                                 return !inside({c.x, c.y});
                               }),
                corners.end());
  textplane::select_spread(corners, image.width(), image.height(), parameters.corner_cell,
                           parameters.max_tracks - static_cast<int>(tracks.size()), occupied, corners);
  for (const textplane::Corner& corner : corners) add({corner.x, corner.y});
}

}  // namespace textslam
