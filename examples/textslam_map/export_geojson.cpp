#include "textslam_map/export_geojson.hpp"

#include <algorithm>
#include <cmath>

#include "io/input_error.hpp"
#include "io/output_file.hpp"
#include "io/text_file.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/landmarks/text_view.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/common/report_json.hpp"
#include "textslam/map/text_views.hpp"

namespace textslam {
namespace {

constexpr double kPerDegree = 1e10, kPerMetre = 1e5;  // a hundredth of a millimetre
constexpr double kLevel = 89.9;                       // degrees: a normal that is steeper has no azimuth to speak of

double rounded(double value, double steps) { return std::round(value * steps) / steps; }

Json position(const GeoReference& reference, const Vec3& p_w) {
  const GeoPosition p = geo_position(reference, p_w);
  return {rounded(p.longitude, kPerDegree), rounded(p.latitude, kPerDegree), rounded(p.altitude, kPerMetre)};
}

Json feature(const std::string& type, Json coordinates, Json properties) {
  return {{"type", "Feature"},
          {"geometry", {{"type", type}, {"coordinates", std::move(coordinates)}}},
          {"properties", std::move(properties)}};
}

Json sign(const LoadedMap& loaded, const GeoReference& reference, const TextObject& text) {
  const std::array<Vec3, 4> corners = world_corners(loaded.map, text);
  const Vec3 normal = loaded.map.keyframe(text.host).T_w_c.R * textplane::plane_normal(text.theta);
  const double height = elevation(reference, normal);
  Json outline = Json::array();
  for (const Vec3& corner : corners) outline.push_back(position(reference, corner));
  const bool level = std::abs(height) < kLevel;
  Json properties = {
      {"kind", "sign"},
      {"id", text.id},
      {"word", well_formed_utf8(textplane::consensus(text.votes))},
      {"width", 0.5 * ((corners[1] - corners[0]).norm() + (corners[2] - corners[3]).norm())},
      {"height", 0.5 * ((corners[3] - corners[0]).norm() + (corners[2] - corners[1]).norm())},
      {"azimuth", level ? Json(azimuth(reference, normal)) : Json(nullptr)},
      {"elevation", height},
      {"sigma_deg", normal_sigma(text) * 180 / M_PI},
      {"observations", text.views.size() + 1},
      {"session", loaded.record.sources.at(text.host).session},
      {"outline", std::move(outline)},
  };
  return feature("Point", position(reference, (corners[0] + corners[1] + corners[2] + corners[3]) / 4),
                 std::move(properties));
}

Json path_of(const LoadedMap& loaded, const GeoReference& reference, const SavedSession& session) {
  std::vector<std::pair<double, int>> order;
  for (const auto& [id, source] : loaded.record.sources)
    if (source.session == session.id) order.emplace_back(loaded.map.keyframe(id).frame.timestamp, id);
  if (order.empty()) return nullptr;
  std::sort(order.begin(), order.end());
  Json line = Json::array(), times = Json::array();
  for (const auto& [time, id] : order) {
    line.push_back(position(reference, loaded.map.keyframe(id).T_w_c.t));
    times.push_back(time);
  }
  Json properties = {{"kind", "path"},
                     {"session", session.id},
                     {"started", well_formed_utf8(session.started)},
                     {"sequence", well_formed_utf8(session.sequence)},
                     {"timestamps", std::move(times)}};
  const bool one = order.size() == 1;  // a line has two positions at least
  return feature(one ? "Point" : "LineString", one ? Json(line[0]) : std::move(line), std::move(properties));
}

}  // namespace

std::string map_geojson(const LoadedMap& loaded, const GeoReference& reference) {
  Json features = Json::array();
  for (const TextObject& text : loaded.map.texts)
    if (text.state == TextState::mapped) features.push_back(sign(loaded, reference, text));
  for (const SavedSession& session : loaded.record.sessions) {
    Json path = path_of(loaded, reference, session);
    if (!path.is_null()) features.push_back(std::move(path));
  }
  const GeoPosition& o = reference.origin;
  return Json{{"type", "FeatureCollection"},
              {"georeference",
               {{"latitude", o.latitude},
                {"longitude", o.longitude},
                {"altitude", o.altitude},
                {"north", reference.north},
                {"scale_sigma", loaded.record.scale_sigma ? Json(*loaded.record.scale_sigma) : Json(nullptr)}}},
              {"features", std::move(features)}}
             .dump(1) +
         "\n";
}

void export_geojson(const LoadedMap& loaded, const std::string& file, const GeoReference& reference,
                    const std::string& path) {
  if (!loaded.record.scale_sigma)
    throw InputError(file, 0, "its lengths are not metres: GeoJSON needs a map made with textslam --scale WORD=WIDTH");
  write_file(path, map_geojson(loaded, reference));
}

}  // namespace textslam
