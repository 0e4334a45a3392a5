#include "live_map.hpp"

#include <cmath>

#include "io/data_uri.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/map/text_views.hpp"
#include "textslam/report/frame_line.hpp"
#include "textslam/report/report.hpp"
#include "textslam/report/report_data.hpp"

namespace textslam {
namespace {

Json text_json(const Map& map, const TextObject& text, const std::string& picture) {
  const std::array<Vec3, 4> corners = world_corners(map, text);
  const Vec3 normal = map.keyframe(text.host).T_w_c.R * textplane::plane_normal(text.theta);
  return {{"id", text.id},
          {"word", textplane::consensus(text.votes)},
          {"corners", short_corners(corners)},
          {"centre", short_vector((corners[0] + corners[1] + corners[2] + corners[3]) / 4)},
          {"normal", short_vector(normal)},
          {"image", picture}};
}

// The mapped texts that lie before the camera whole.
Json quads_in(const Map& map, const SE3d& T_c_w) {
  Json quads = Json::array();
  for (const TextObject& text : map.texts) {
    if (text.state != TextState::mapped) continue;
    std::vector<Vec2> px;
    for (const Vec3& corner : world_corners(map, text)) {
      const Vec3 p = T_c_w * corner;
      if (map.camera.in_domain(p)) px.push_back(map.camera.project(p));
    }
    if (px.size() == 4) quads.push_back(short_polygon(px));
  }
  return quads;
}

}  // namespace

const std::string& TextPictures::of(const Map& map, const TextObject& text) {
  Picture& picture = pictures_[text.id];
  if (picture.map == map.number && picture.host == text.host) return picture.uri;
  picture = {map.number, text.host, jpeg_uri(text_jpeg(map, text))};
  return picture.uri;
}

Json live_map(const System& system, const Sequence& sequence, TextPictures& pictures) {
  const Map& map = system.map();
  Json texts = Json::array();
  for (const TextObject& text : map.texts)
    if (text.state == TextState::mapped) texts.push_back(text_json(map, text, pictures.of(map, text)));
  return {{"camera", camera_json(sequence.camera, sequence.approximate_fov)},
          {"texts", texts},
          {"world", world_json(system, sequence, {}, {})}};
}

Json live_frame(const System& system) {
  const std::size_t index = system.records().size() - 1;
  const FrameRecord& record = system.records()[index];
  const Map& map = system.map();
  Json seen = Json::array(), quads = Json::array();
  if (record.state == FrameState::tracked) {
    for (const SeenPoint& point : points_of(system, index))
      for (const float value : {point.px.x(), point.px.y()}) seen.push_back(std::lround(value));
    quads = quads_in(map, system.final_pose(record).inverse());
  }
  Json frame = frame_json(static_cast<int>(index), record, map);
  frame["seen"] = seen;
  frame["quads"] = quads;
  return frame;
}

}  // namespace textslam
