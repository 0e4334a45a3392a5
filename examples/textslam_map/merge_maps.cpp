#include "textslam_map/merge_maps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "io/input_error.hpp"
#include "textslam/loop/map_join.hpp"
#include "textslam/map/scale_map.hpp"
#include "textslam/map_session.hpp"

namespace textslam {
namespace {

// The text of both has b's plane from here on: what belongs to it moves along.
void take_plane(const TextObject& of_b, int first_keyframe, TextObject* text) {
  text->views.push_back(text->host);
  text->host = first_keyframe + of_b.host;
  text->patch = of_b.patch;
  text->theta = of_b.theta;
  text->covariance = of_b.covariance;
  text->zncc = of_b.zncc;
  text->variance_factor = of_b.variance_factor;
}

// Each key frame once, in their order, without the host.
void tidy_views(TextObject* text) {
  auto& views = text->views;
  std::sort(views.begin(), views.end());
  views.erase(std::unique(views.begin(), views.end()), views.end());
  views.erase(std::remove(views.begin(), views.end(), text->host), views.end());
  text->failures = 0;
}

void add_record(const MapRecord& b, int first_keyframe, MapRecord* a) {
  const int first_session = a->sessions.back().id;
  for (SavedSession session : b.sessions) {
    session.id += first_session;
    a->sessions.push_back(session);
  }
  for (const auto& [id, source] : b.sources)
    a->sources[first_keyframe + id] = {first_session + source.session, source.image};
}

// The camera that the sessions came with.
const CameraModel& given_camera(const MapRecord& record) {
  return record.given_camera ? *record.given_camera : record.camera;
}

void check_mergeable(const LoadedMap& a, const std::string& file_a, const LoadedMap& b, const std::string& file_b) {
  if (!is_same_camera(a.record.camera, b.record.camera)) {
    const bool same_file = is_same_camera(given_camera(a.record), given_camera(b.record));
    throw InputError(file_b, 0,
                     "its camera is not that of " + file_a + ": " +
                         (same_file ? "each map mended that of the camera file by itself; make one of them with the "
                                      "camera.yaml of the other's run, or as a session of the other"
                                    : "a map has one camera, with the same numbers in all sessions"));
  }
  for (const SavedSession& of_a : a.record.sessions)
    for (const SavedSession& of_b : b.record.sessions)
      if (is_same_session(of_a, of_b))
        throw InputError(file_b, 0,
                         "it holds the session of " + of_b.started + " (" + of_b.sequence + "), as " + file_a +
                             " does: merged, it would count twice");
}

bool is_one_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return std::filesystem::equivalent(a, b, ignored);
}

}  // namespace

bool is_same_session(const SavedSession& a, const SavedSession& b) {
  return a.started == b.started && a.sequence == b.sequence && a.command == b.command;
}

std::optional<CommonPlace> common_place(const LoadedMap& a, const LoadedMap& b, const Parameters& parameters) {
  KnownScale scale_sigma;
  if (a.record.scale_sigma && b.record.scale_sigma)
    scale_sigma = std::hypot(*a.record.scale_sigma, *b.record.scale_sigma);
  return find_common_place(map_signs(a.map, parameters.text), map_signs(b.map, parameters.text), parameters.text,
                           scale_sigma);
}

LoadedMap merge_maps(LoadedMap a, LoadedMap b, const CommonPlace& place, const Parameters& parameters) {
  MapLink link;
  link.S_a_b = place.S_a_b;
  link.texts = place.texts;
  link.points = place.points;
  // Velocities of rows, planes and lengths of one map take the unit of the other; what is left is a motion.
  if (!a.record.scale_sigma && b.record.scale_sigma) {
    scale_map(1 / place.S_a_b.scale, &a.map);
    link.S_a_b.t /= place.S_a_b.scale;
    a.record.scale_sigma = std::hypot(*b.record.scale_sigma, place.scale_sigma);
  } else {
    scale_map(place.S_a_b.scale, &b.map);
  }
  link.S_a_b.scale = 1;
  const JoinedIds ids = join_maps(a.map, b.map, link, parameters);
  for (const auto& [of_a, of_b] : place.texts) {
    TextObject& text = a.map.text(of_a);
    const TextObject& other = b.map.text(of_b);
    if (plane_uncertainty(other) < plane_uncertainty(text)) take_plane(other, ids.first_keyframe, &text);
    tidy_views(&text);
  }
  add_record(b.record, ids.first_keyframe, &a.record);
  return a;
}

std::string merge_map_files(const std::string& file_a, const std::string& file_b, const std::string& output) {
  const Parameters parameters;
  LoadedMap a = load_map(file_a, parameters), b = load_map(file_b, parameters);
  check_mergeable(a, file_a, b, file_b);
  const auto place = common_place(a, b, parameters);
  if (!place) return "";
  // The output may be one of the two: then it is replaced as it was read. The ids are those of the first.
  const bool in_a = is_one_file(output, file_a), in_b = !in_a && is_one_file(output, file_b);
  const std::int64_t revision = in_a ? a.record.revision : in_b ? b.record.revision : 0;
  LoadedMap merged = merge_maps(std::move(a), std::move(b), *place, parameters);
  merged.record.revision = revision;
  merged.record.same_ids = !in_b;
  save_map(output, merged.map, merged.record);
  std::size_t texts = 0;
  for (const TextObject& text : merged.map.texts) texts += text.state == TextState::mapped ? 1u : 0u;
  char line[200];
  std::snprintf(line, sizeof line,
                "%zu signs in common, lengths of the second times %.5f; %zu sessions, %zu key frames, %zu texts\n",
                place->texts.size(), place->S_a_b.scale, merged.record.sessions.size(),
                merged.map.keyframe_ids().size(), texts);
  return line;
}

}  // namespace textslam
