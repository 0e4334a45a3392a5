#include "textslam_map/join_branches.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "io/input_error.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/map_session.hpp"
#include "textslam_map/merge_maps.hpp"

namespace textslam {
namespace {

using IdPairs = std::vector<std::pair<int, int>>;  // ids in a and in b of what is one

// Sessions of b that are in a: by b's number, a's.
std::map<int, int> common_sessions(const MapRecord& a, const MapRecord& b) {
  std::map<int, int> common;
  for (const SavedSession& of_a : a.sessions)
    for (const SavedSession& of_b : b.sessions)
      if (is_same_session(of_a, of_b)) common[of_b.id] = of_a.id;
  return common;
}

// By b's id, a's.
std::map<int, int> common_keyframes(const LoadedMap& a, const LoadedMap& b, const std::map<int, int>& sessions) {
  std::map<std::tuple<int, std::string, double>, int> of_a;
  for (const auto& [id, source] : a.record.sources)
    of_a[{source.session, source.image, a.map.keyframe(id).frame.timestamp}] = id;
  std::map<int, int> common;
  for (const auto& [id, source] : b.record.sources) {
    const auto session = sessions.find(source.session);
    if (session == sessions.end()) continue;
    const auto same = of_a.find({session->second, source.image, b.map.keyframe(id).frame.timestamp});
    if (same != of_a.end()) common[id] = same->second;
  }
  return common;
}

// The first key frame is what both worlds hang on.
Similarity between_worlds(const Map& a, const Map& b, const std::map<int, int>& keyframes) {
  const SE3d &first_a = a.keyframe(keyframes.begin()->second).T_w_c,
             &first_b = b.keyframe(keyframes.begin()->first).T_w_c;
  double spread_a = 0, spread_b = 0;
  for (const auto& [of_b, of_a] : keyframes) {
    spread_a += (a.keyframe(of_a).T_w_c.t - first_a.t).squaredNorm();
    spread_b += (b.keyframe(of_b).T_w_c.t - first_b.t).squaredNorm();
  }
  Similarity S;
  S.scale = spread_a > 0 && spread_b > 0 ? std::sqrt(spread_a / spread_b) : 1;
  S.R = first_a.R * first_b.R.transpose();
  S.t = first_a.t - S.scale * (S.R * first_b.t);
  return S;
}

IdPairs common_points(const Map& a, const Map& b, const std::map<int, int>& keyframes) {
  std::map<std::tuple<int, double, double>, int> of_a;
  for (std::size_t i = 0; i < a.points.size(); ++i)
    for (const PointObservation& o : a.points[i].observations)
      of_a[{o.keyframe, o.px.x(), o.px.y()}] = static_cast<int>(i);
  IdPairs pairs;
  std::set<int> taken;
  for (std::size_t i = 0; i < b.points.size(); ++i)
    for (const PointObservation& o : b.points[i].observations) {
      const auto keyframe = keyframes.find(o.keyframe);
      if (keyframe == keyframes.end()) continue;
      const auto same = of_a.find({keyframe->second, o.px.x(), o.px.y()});
      if (same == of_a.end() || !taken.insert(same->second).second) continue;
      pairs.emplace_back(same->second, static_cast<int>(i));
      break;
    }
  return pairs;
}

std::set<int> seen_by(const TextObject& text) {
  std::set<int> keyframes(text.views.begin(), text.views.end());
  keyframes.insert(text.host);
  return keyframes;
}

// Whether a key frame of both sees both: then it was a text of the map that both grew from.
bool is_inherited(const TextObject& of_a, const TextObject& of_b, const std::map<int, int>& keyframes) {
  const std::set<int> in_a = seen_by(of_a), in_b = seen_by(of_b);
  return std::any_of(in_b.begin(), in_b.end(), [&](int id) {
    const auto same = keyframes.find(id);
    return same != keyframes.end() && in_a.count(same->second) > 0;
  });
}

IdPairs common_texts(const LoadedMap& a, const LoadedMap& b, const std::map<int, int>& keyframes,
                     const Parameters& parameters) {
  IdPairs pairs;
  std::set<int> taken_a, taken_b;
  const auto add = [&](int of_a, int of_b) {
    if (taken_a.count(of_a) + taken_b.count(of_b) > 0) return;
    taken_a.insert(of_a);
    taken_b.insert(of_b);
    pairs.emplace_back(of_a, of_b);
  };
  for (const TextObject& of_b : b.map.texts) {
    if (of_b.state != TextState::mapped || of_b.id >= static_cast<int>(a.map.texts.size())) continue;
    const TextObject& of_a = a.map.text(of_b.id);
    if (of_a.state == TextState::mapped && is_inherited(of_a, of_b, keyframes) &&
        textplane::words_agree(textplane::consensus(of_a.votes), textplane::consensus(of_b.votes), parameters.text))
      add(of_a.id, of_b.id);
  }
  if (const auto place = common_place(a, b, parameters))
    for (const auto& [of_a, of_b] : place->texts) add(of_a, of_b);
  return pairs;
}

// Joining added what a map inherited to itself.
void count_once(const LoadedMap& a, const LoadedMap& b, const CommonPlace& place, const std::map<int, int>& keyframes,
                Map* joined) {
  for (const auto& [of_a, of_b] : place.points) {
    const MapPoint &in_a = a.map.point(of_a), &in_b = b.map.point(of_b);
    joined->point(of_a).visible = std::max(in_a.visible, in_b.visible);
    joined->point(of_a).found = std::max(in_a.found, in_b.found);
  }
  for (const auto& [of_a, of_b] : place.texts) {
    const TextObject &in_a = a.map.text(of_a), &in_b = b.map.text(of_b);
    if (!is_inherited(in_a, in_b, keyframes)) continue;
    TextObject& text = joined->text(of_a);
    text.votes = in_a.votes;
    for (const auto& [word, score] : in_b.votes) {
      double& most = text.votes[word];
      most = std::max(most, score);
    }
    text.detections = std::max(in_a.detections, in_b.detections);
    text.shown = std::max(in_a.shown, in_b.shown);
  }
}

// New ids of key frames; those that get the same one are one, and the first of them stays.
void renumber_keyframes(const std::vector<int>& to, int count, LoadedMap* loaded) {
  Map& map = loaded->map;
  std::vector<KeyFrame> kept(static_cast<std::size_t>(count));
  std::map<int, KeyFrameSource> sources;
  for (std::size_t old = 0; old < to.size(); ++old) {
    if (to[old] < 0 || sources.count(to[old]) > 0) continue;
    KeyFrame& keyframe = kept[static_cast<std::size_t>(to[old])] = map.keyframes[old];
    keyframe.points.clear();
    const auto source = loaded->record.sources.find(static_cast<int>(old));
    if (source != loaded->record.sources.end()) sources[to[old]] = source->second;
  }
  map.keyframes = std::move(kept);
  loaded->record.sources = std::move(sources);
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    std::vector<PointObservation> observations = std::move(map.points[i].observations);
    map.points[i].observations.clear();
    for (const PointObservation& o : observations) {
      const int keyframe = to[static_cast<std::size_t>(o.keyframe)];
      if (!observed_in(map.points[i].observations, keyframe)) add_observation(map, static_cast<int>(i), keyframe, o.px);
    }
  }
  for (TextObject& text : map.texts) {
    if (text.state != TextState::mapped) continue;
    std::set<int> views;
    for (const int view : text.views) views.insert(to[static_cast<std::size_t>(view)]);
    text.host = to[static_cast<std::size_t>(text.host)];
    views.erase(text.host);
    text.views.assign(views.begin(), views.end());
  }
}

// b's copies of key frames of both become a's; the others follow those of a.
void unite_keyframes(std::size_t first, const std::map<int, int>& keyframes, LoadedMap* joined) {
  std::vector<int> to(joined->map.keyframes.size(), -1);
  int count = static_cast<int>(first);
  for (std::size_t id = 0; id < to.size(); ++id) {
    const auto same = id < first ? keyframes.end() : keyframes.find(static_cast<int>(id - first));
    if (id < first)
      to[id] = static_cast<int>(id);
    else if (same != keyframes.end())
      to[id] = same->second;
    else if (!joined->map.keyframes[id].culled)
      to[id] = count++;
  }
  renumber_keyframes(to, count, joined);
}

// The record as joined has b's sessions after a's `last`.
void unite_sessions(int last, const std::map<int, int>& common, MapRecord* record) {
  std::map<int, int> to;
  std::vector<SavedSession> kept;
  int next = last;
  for (SavedSession session : record->sessions) {
    const auto same = common.find(session.id - last);
    const bool is_of_b = session.id > last;
    to[session.id] = !is_of_b ? session.id : same != common.end() ? same->second : ++next;
    if (is_of_b && same != common.end()) continue;
    session.id = to[session.id];
    kept.push_back(session);
  }
  record->sessions = std::move(kept);
  for (auto& [id, source] : record->sources) source.session = to.at(source.session);
}

}  // namespace

std::optional<LoadedMap> join_branches(LoadedMap a, LoadedMap b, const std::string& file_b,
                                       const Parameters& parameters) {
  if (!is_same_camera(a.record.camera, b.record.camera))
    throw InputError(file_b, 0, "its camera is not that of the server's map, and a map has one camera");
  const std::map<int, int> sessions = common_sessions(a.record, b.record);
  const std::map<int, int> keyframes = common_keyframes(a, b, sessions);
  if (keyframes.empty()) {
    const auto place = common_place(a, b, parameters);
    if (!place) return std::nullopt;
    const int last = a.record.sessions.back().id;
    LoadedMap joined = merge_maps(std::move(a), std::move(b), *place, parameters);
    unite_sessions(last, sessions, &joined.record);
    return joined;
  }
  CommonPlace place;
  place.S_a_b = between_worlds(a.map, b.map, keyframes);
  place.points = common_points(a.map, b.map, keyframes);
  place.texts = common_texts(a, b, keyframes, parameters);
  LoadedMap joined = merge_maps(a, b, place, parameters);
  count_once(a, b, place, keyframes, &joined.map);
  unite_keyframes(a.map.keyframes.size(), keyframes, &joined);
  unite_sessions(a.record.sessions.back().id, sessions, &joined.record);
  return joined;
}

}  // namespace textslam
