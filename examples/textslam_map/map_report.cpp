#include "textslam_map/map_report.hpp"

#include <algorithm>
#include <tuple>

#include "textplane/config.hpp"
#include "textplane/simd/dispatch.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/report/report.hpp"
#include "textslam/report/report_data.hpp"
#include "textslam/report/text_map.hpp"
#include "textslam_map/map_queries.hpp"

namespace textslam {
namespace {

constexpr double kBetweenSessions = 1;  // s, on the axis of time

// Key frames in the order of the page. From here on that is their index.
std::vector<int> number_keyframes(LoadedMap& loaded) {
  std::vector<int> ids = loaded.map.keyframe_ids();
  const auto key = [&](int id) {
    return std::tuple(loaded.record.sources.at(id).session, loaded.map.keyframe(id).frame.timestamp, id);
  };
  std::sort(ids.begin(), ids.end(), [&](int a, int b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < ids.size(); ++i) loaded.map.keyframe(ids[i]).frame.index = static_cast<int>(i);
  return ids;
}

std::vector<const TextObject*> mapped_texts(const Map& map) {
  std::vector<const TextObject*> texts;
  for (const TextObject& text : map.texts)
    if (text.state == TextState::mapped) texts.push_back(&text);
  return texts;
}

Json sessions_json(const LoadedMap& loaded) {
  const auto session_of = [&](int id) { return loaded.record.sources.at(id).session; };
  const std::vector<const TextObject*> texts = mapped_texts(loaded.map);
  const std::vector<int> ids = loaded.map.keyframe_ids();
  Json sessions = Json::array();
  for (const SavedSession& session : loaded.record.sessions) {
    const auto is_of = [&](int id) { return session_of(id) == session.id; };
    sessions.push_back(session_json(
        session, std::count_if(ids.begin(), ids.end(), is_of),
        std::count_if(texts.begin(), texts.end(), [&](const TextObject* text) { return is_of(text->host); })));
    sessions.back()["command"] = session.command;
  }
  return sessions;
}

Json keyframe_series(const LoadedMap& loaded, const std::vector<int>& ids) {
  const Map& map = loaded.map;
  const std::vector<const TextObject*> mapped = mapped_texts(map);
  Json times = Json::array(), sessions = Json::array(), points = Json::array(), texts = Json::array(),
       costs = Json::array();
  double now = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const int id = ids[i], session = loaded.record.sources.at(id).session;
    const KeyFrame& keyframe = map.keyframe(id);
    if (i > 0 && loaded.record.sources.at(ids[i - 1]).session == session)
      now += keyframe.frame.timestamp - map.keyframe(ids[i - 1]).frame.timestamp;
    else if (i > 0)
      now += kBetweenSessions;
    const std::vector<SeenPoint> seen = points_of_keyframe(map, id);
    times.push_back(short_number(now));
    sessions.push_back(session);
    points.push_back(seen.size());
    texts.push_back(std::count_if(mapped.begin(), mapped.end(), [&](const TextObject* text) {
      return text->host == id || std::find(text->views.begin(), text->views.end(), id) != text->views.end();
    }));
    costs.push_back(short_number(seen_error(map, seen, keyframe.T_w_c.inverse())));
  }
  return {{"time", times},       {"state", std::string(ids.size(), 't')},
          {"session", sessions}, {"points", points},
          {"texts", texts},      {"cost", costs}};
}

Json keyframe_pictures(const Map& map, const Parameters& parameters, const std::vector<int>& ids) {
  Json frames = Json::array();
  for (const int id : evenly_spaced(ids, kReportFrames)) {
    const KeyFrame& keyframe = map.keyframe(id);
    frames.push_back(frame_json(map, parameters, keyframe.frame.index, *keyframe.frame.image, keyframe.frame.detections,
                                points_of_keyframe(map, id), keyframe.T_w_c.inverse()));
  }
  return frames;
}

Json summary_json(const LoadedMap& loaded) {
  const auto is_good = [](const MapPoint& point) { return !point.bad; };
  const auto& points = loaded.map.points;
  Json summary{{"keyframes", loaded.map.keyframe_ids().size()},
               {"points", std::count_if(points.begin(), points.end(), is_good)},
               {"reprojection_px", short_number(reprojection_error(loaded.map))},
               {"texts", mapped_texts(loaded.map).size()}};
  if (loaded.record.scale_sigma) summary["metric"] = {{"sigma_share", *loaded.record.scale_sigma}};
  return summary;
}

}  // namespace

std::string map_report_html(LoadedMap loaded, const std::string& file, const Parameters& parameters,
                            const std::vector<std::string>& command) {
  const std::vector<int> ids = number_keyframes(loaded);
  const Map& map = loaded.map;
  Json world = map_json(map), path = Json::array();
  for (const int id : ids) path.push_back(short_pose(map.keyframe(id).T_w_c));
  world.update({{"trajectory", path}, {"truth", Json::array()}, {"signs", Json::array()}});
  const Json data{{"version", TEXTPLANE_VERSION_STRING},
                  {"summary", summary_json(loaded)},
                  {"camera", camera_json(loaded.record.camera, 0)},
                  {"min_zncc", parameters.text.min_zncc},
                  {"cull_zncc", parameters.text.cull_zncc},
                  {"same_word", parameters.text.same_word},
                  {"sessions", sessions_json(loaded)},
                  {"texts", page_texts(map, {})},
                  {"world", world},
                  {"series", keyframe_series(loaded, ids)},
                  {"frames", keyframe_pictures(map, parameters, ids)}};
  const Json run{{"command", command},
                 {"sequence", file},
                 {"target", textplane::simd::to_string(textplane::simd::active_target())}};
  return report_page(data, run);
}

}  // namespace textslam
