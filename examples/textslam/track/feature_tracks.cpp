#include "textslam/track/feature_tracks.hpp"

#include <algorithm>

#include "textplane/features/fast.hpp"
#include "textplane/features/klt.hpp"
#include "textplane/features/select.hpp"
#include "textplane/landmarks/text_noise.hpp"
#include "textslam/common/algorithms.hpp"

namespace textslam {
namespace {

textplane::KltOptions klt_options(const Parameters& parameters, const Frame& from, const Frame& to) {
  textplane::KltOptions options;
  options.radius = parameters.klt_radius;
  options.levels = std::min({parameters.pyramid_levels, from.image->levels(), to.image->levels()});
  options.max_forward_backward = parameters.max_forward_backward;
  options.min_zncc = parameters.min_track_zncc;
  return options;
}

// Of the corner's patch, where it is wholly in the image.
double contrast_at(const Frame& frame, const Vec2f& px, int radius) {
  textplane::PointPatch patch;
  const auto status =
      textplane::extract_point_patch(frame.image->level(0), px, Eigen::Matrix2f::Identity(), radius, &patch);
  return textplane::is_ok(status) ? static_cast<double>(patch.contrast()) : 0;
}

// With a limit of the ZNCC for each corner where the frames are noisy. The contrast of the second frame is not known
// yet: it is taken to be that of the first.
void track_klt(const Frame& from, const Frame& to, const Vec2f* start, const Vec2f* guesses, int n,
               textplane::KltOptions options, const Parameters& parameters, textplane::KltResult* results) {
  const textplane::PyramidView from_view = from.image->view(), to_view = to.image->view();
  if (!is_noisy(parameters.text, from, to)) {
    textplane::track_klt(from_view, to_view, start, guesses, n, options, results);
    return;
  }
  for (int i = 0; i < n; ++i) {
    const double contrast = contrast_at(from, start[i], options.radius);
    options.min_zncc = static_cast<float>(
        zncc_limit(parameters.text, static_cast<double>(parameters.min_track_zncc), 0, from, contrast, to, contrast));
    textplane::track_klt(from_view, to_view, start + i, guesses ? guesses + i : nullptr, 1, options, results + i);
  }
}

// Good guesses need the fine levels alone; what fails there is searched for from the coarsest on.
std::vector<textplane::KltResult> follow(const Frame& from, const Frame& to, const std::vector<Vec2f>& start,
                                         const std::vector<Vec2f>& guesses, const Parameters& parameters) {
  const textplane::KltOptions options = klt_options(parameters, from, to);
  const auto n = static_cast<int>(start.size());
  std::vector<textplane::KltResult> results(start.size());
  if (guesses.empty()) {
    track_klt(from, to, start.data(), nullptr, n, options, parameters, results.data());
    return results;
  }
  textplane::KltOptions fine = options;
  fine.levels = std::min(parameters.klt_fine_levels, options.levels);
  track_klt(from, to, start.data(), guesses.data(), n, fine, parameters, results.data());
  for (std::size_t i = 0; i < start.size(); ++i)
    if (!textplane::is_ok(results[i].status))
      track_klt(from, to, &start[i], &guesses[i], 1, options, parameters, &results[i]);
  return results;
}

}  // namespace

void advance_tracks(const Frame& from, const Frame& to, const CameraView& camera, const std::vector<Vec2f>& guesses,
                    const Parameters& parameters, std::vector<Track>& tracks) {
  if (tracks.empty()) return;
  std::vector<Vec2f> start;
  for (const Track& track : tracks) start.push_back(track.px);
  const std::vector<textplane::KltResult> results = follow(from, to, start, guesses, parameters);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!textplane::is_ok(results[i].status) || !has_ray(camera, results[i].px.cast<double>())) continue;
    if (kept != i) tracks[kept] = std::move(tracks[i]);
    tracks[kept].px = results[i].px;
    ++kept;
  }
  tracks.resize(kept);
}

void add_corners(const Frame& frame, const CameraView& camera, int keyframe, const std::vector<Quad<double>>& quads,
                 const Parameters& parameters, std::vector<Track>& tracks) {
  const textplane::ImageView8 image = frame.image->level(0);
  const int border = parameters.klt_radius + 2;
  std::vector<textplane::Corner> corners;
  const int lowest = parameters.min_fast_threshold;
  textplane::detect_fast(image, std::min(parameters.fast_threshold, lowest), true, corners);
  textplane::keep_enough(&corners, std::max(parameters.fast_threshold, lowest), lowest,
                         parameters.corner_choice * parameters.max_tracks, [](int threshold) { return threshold / 2; });
  const auto outside = [&](const textplane::Corner& c) {
    return c.x < static_cast<float>(border) || c.y < static_cast<float>(border) ||
           c.x >= static_cast<float>(image.width() - border) || c.y >= static_cast<float>(image.height() - border) ||
           !has_ray(camera, Vec2(c.x, c.y));
  };
  erase_if(corners, outside);
  const auto add = [&](std::vector<textplane::Corner>& candidates, int cell, int most) {
    std::vector<Vec2f> occupied;
    for (const Track& track : tracks) occupied.push_back(track.px);
    textplane::select_spread(candidates, image.width(), image.height(), cell, most, occupied, candidates);
    for (const textplane::Corner& c : candidates) tracks.push_back({{c.x, c.y}, -1, {{keyframe, Vec2(c.x, c.y)}}});
  };

  // Text first, and more densely: its plane is solved for from these corners.
  for (const Quad<double>& quad : quads) {
    std::vector<textplane::Corner> in_quad;
    for (const textplane::Corner& corner : corners)
      if (textplane::contains(quad, Vec2(corner.x, corner.y))) in_quad.push_back(corner);
    add(in_quad, parameters.text_corner_cell, parameters.text_corners);
  }
  add(corners, parameters.corner_cell, parameters.max_tracks - static_cast<int>(tracks.size()));
}

}  // namespace textslam
