#include "textslam/report/text_map.hpp"

#include <cmath>
#include <sstream>

#include "io/data_uri.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/landmarks/text_view.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/map/text_views.hpp"
#include "textslam/report/report_frames.hpp"

namespace textslam {
namespace {

Fields describe(const Map& map, const TextObject& text) {
  const KeyFrame& host = map.keyframe(text.host);
  const std::array<Vec3, 4> corners = world_corners(map, text);
  const double sigma = normal_sigma(text) * 180 / M_PI;
  Fields fields;
  fields.add("id", "id", text.id);
  fields.add("text", "word", textplane::consensus(text.votes));
  fields.add("corners", "corners", corners);
  fields.add(nullptr, "centre", Vec3((corners[0] + corners[1] + corners[2] + corners[3]) / 4));
  fields.add("normal", "normal", Vec3(host.T_w_c.R * textplane::plane_normal(text.theta)));
  fields.add("theta", nullptr, text.theta);
  fields.add("host", nullptr, host.frame.timestamp);
  fields.add(nullptr, "sigma_deg", sigma);
  fields.add("observations", "observations", text.views.size() + 1);
  fields.add("zncc", "zncc", text.zncc);
  fields.add("normal_sigma_deg", nullptr, sigma);
  fields.add(nullptr, "host", host.frame.index);
  return fields;
}

void add_match(Json& text, const SignMatch& match) {
  text["sign"] = match.sign;
  if (match.sign < 0) return;
  text["angle_deg"] = short_number(match.angle);
  text["centre_error"] = short_number(match.centre);
  text["word_right"] = match.word;
}

}  // namespace

std::string text_map_json(const Map& map) {
  Json texts = Json::array();
  for (const TextObject& text : map.texts)
    if (text.state == TextState::mapped) texts.push_back(describe(map, text).file);
  return Json{{"texts", texts}}.dump(1) + "\n";
}

Json page_texts(const Map& map, const std::vector<SignMatch>& matches) {
  Json texts = Json::array();
  std::size_t bytes = 0;
  for (const TextObject& text : map.texts) {
    if (text.state != TextState::mapped) continue;
    Json entry = describe(map, text).page, readings = Json::array();
    for (const auto& [reading, votes] : text.votes) readings.push_back(reading);
    entry["readings"] = readings;
    const std::string picture = text_jpeg(map, text);
    bytes += picture.size();
    entry["image"] = bytes <= kTextureBytes ? Json(jpeg_uri(picture)) : Json(nullptr);
    for (const SignMatch& match : matches)
      if (match.text == text.id) add_match(entry, match);
    texts.push_back(std::move(entry));
  }
  return texts;
}

std::string text_map_ply(const Map& map) {
  std::vector<std::array<Vec3, 4>> quads;
  for (const TextObject& text : map.texts)
    if (text.state == TextState::mapped) quads.push_back(world_corners(map, text));
  const std::vector<int> keyframes = map.keyframe_ids();
  std::vector<Vec3> points;
  for (const MapPoint& point : map.points)
    if (!point.bad) points.push_back(point.p_w);

  std::ostringstream out;
  out << "ply\nformat ascii 1.0\ncomment textplane: text objects (faces, blue), points (grey), key frames (orange)\n"
      << "element vertex " << 4 * quads.size() + points.size() + keyframes.size()
      << "\nproperty float x\nproperty float y\nproperty float z\n"
      << "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      << "element face " << quads.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto vertex = [&](const Vec3& p, const char* colour) {
    char line[96];
    std::snprintf(line, sizeof line, "%.7g %.7g %.7g %s\n", p.x(), p.y(), p.z(), colour);
    out << line;
  };
  for (const auto& quad : quads)
    for (const Vec3& corner : quad) vertex(corner, "30 90 220");
  for (const Vec3& point : points) vertex(point, "150 150 150");
  for (const int id : keyframes) vertex(map.keyframe(id).T_w_c.t, "240 140 20");
  for (std::size_t i = 0; i < quads.size(); ++i)
    out << "4 " << 4 * i << ' ' << 4 * i + 1 << ' ' << 4 * i + 2 << ' ' << 4 * i + 3 << '\n';
  return out.str();
}

}  // namespace textslam
