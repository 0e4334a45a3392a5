#include "textslam/report/report_frames.hpp"

#include <algorithm>
#include <cmath>

#include "io/data_uri.hpp"
#include "io/image_file.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/landmarks/text_plane.hpp"
#include "textplane/photometry/sample.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/text_views.hpp"

namespace textslam {
namespace {

std::uint8_t sample(const ImageView8& image, double x, double y) {
  float value = 0;
  const float px = std::clamp(static_cast<float>(x), 0.0F, static_cast<float>(image.width() - 1));
  const float py = std::clamp(static_cast<float>(y), 0.0F, static_cast<float>(image.height() - 1));
  textplane::sample_bilinear(image, px, py, &value);
  return static_cast<std::uint8_t>(value + 0.5F);
}

// The coarsest level on which `length` px of level 0 are still `wanted` px or more.
int level_for(const Pyramid& image, double length, double wanted) {
  int level = 0;
  while (level + 1 < image.levels() && std::ldexp(length, -level - 1) >= wanted) ++level;
  return level;
}

// The ZNCC of a text under a frame's pose, if it is in view there.
bool see_text(const Map& map, const Parameters& parameters, const TextObject& text, const Pyramid& pyramid,
              const SE3d& T_c_w, Quad<double>* quad, double* zncc) {
  const textplane::TextImage image{{}, pyramid.view(), map.camera};
  const SE3d T_c_h = map.T_c_h(T_c_w, text.host);
  if (!text_in_view(parameters.text, text, T_c_h, image, quad)) return false;
  const int level = text.patch.level_count() > 1 ? 1 : 0;
  textplane::PhotometricWorkspace workspace;
  const auto cost = compare_text(text, level, image, T_c_h, scale_shift(text, *quad), workspace);
  *zncc = cost.zncc;
  return textplane::is_ok(cost.status);
}

constexpr int kPointsAnEdge = 8;  // of an outline that a lens bends

// A detection whose sides are straight in the world, as the camera sees them. Where a corner has no ray: its corners.
std::vector<Vec2> outline(const CameraView& camera, const Quad<double>& quad) {
  std::array<Vec3, 4> rays;
  std::vector<Vec2> corners(quad.corner.begin(), quad.corner.end()), points;
  if (!camera.lens || !rays_of(camera, quad, &rays)) return corners;
  for (std::size_t i = 0; i < 4; ++i)
    for (int k = 0; k < kPointsAnEdge; ++k) {
      const double share = k / static_cast<double>(kPointsAnEdge);
      const Vec3 p = (1 - share) * rays[i].normalized() + share * rays[(i + 1) % 4].normalized();
      if (!camera.in_domain(p)) return corners;
      points.push_back(camera.project(p));
    }
  return points;
}

// The text's outline as the camera sees it, whose lens bends its edges. Nothing is left out that a lens can show.
std::vector<Vec2> outline(const Map& map, const TextObject& text, const SE3d& T_c_w, const Quad<double>& seen) {
  if (!map.camera.lens) return {seen.corner.begin(), seen.corner.end()};
  const SE3d T_c_h = map.T_c_h(T_c_w, text.host);
  const auto& c = text.patch.quad.corner;
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < 4; ++i)
    for (int k = 0; k < kPointsAnEdge; ++k) {
      const Vec2 px = c[i] + k / static_cast<double>(kPointsAnEdge) * (c[(i + 1) % 4] - c[i]);
      const Vec3 p = T_c_h * textplane::plane_point<double>(text.theta, text.patch.camera.unproject(px));
      if (map.camera.in_domain(p)) points.push_back(map.camera.project(p));
    }
  return points;
}

}  // namespace

std::string frame_jpeg(const Pyramid& image) {
  const ImageView8& whole = image.level(0);
  const double scale = std::min(1.0, static_cast<double>(kFrameSide) / std::max(whole.width(), whole.height()));
  const int width = std::max(1, static_cast<int>(std::lround(scale * whole.width())));
  const int height = std::max(1, static_cast<int>(std::lround(scale * whole.height())));
  const int level = level_for(image, whole.width(), width);
  const ImageView8& from = image.level(level);
  const double step_x = static_cast<double>(from.width()) / width, step_y = static_cast<double>(from.height()) / height;
  Image<std::uint8_t> picture(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      picture.view()(x, y) = sample(from, (x + 0.5) * step_x - 0.5, (y + 0.5) * step_y - 0.5);
  std::string jpeg;
  for (const int quality : {75, 60, 45, 30, 15, 5}) {
    jpeg = encode_jpeg(picture.view(), quality);
    if (jpeg.size() <= kFrameBytes) break;
  }
  return jpeg;
}

std::string text_jpeg(const Map& map, const TextObject& text) {
  const Quad<double> in_host = host_quad(map, text);
  const auto& c = in_host.corner;
  const double wide = std::max((c[1] - c[0]).norm(), (c[2] - c[3]).norm());
  const double high = std::max((c[3] - c[0]).norm(), (c[2] - c[1]).norm());
  const Pyramid& image = *map.keyframe(text.host).frame.image;
  const double scale = std::min(1.0, kTextureSide / std::max(wide, high));
  const int width = std::max(2, static_cast<int>(std::lround(scale * wide)));
  const int height = std::max(2, static_cast<int>(std::lround(scale * high)));
  const int level = level_for(image, std::max(wide, high), std::max(width, height));
  const CameraView camera = map.camera.at_level(level);
  std::array<Vec3, 4> corner;
  for (std::size_t i = 0; i < 4; ++i)
    corner[i] = textplane::plane_point<double>(text.theta, text.patch.camera.unproject(text.patch.quad.corner[i]));
  Image<std::uint8_t> picture(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = (x + 0.5) / width, v = (y + 0.5) / height;
      const Vec3 p = (1 - v) * ((1 - u) * corner[0] + u * corner[1]) + v * ((1 - u) * corner[3] + u * corner[2]);
      if (!camera.in_domain(p)) continue;
      const Vec2 px = camera.project(p);
      picture.view()(x, y) = sample(image.level(level), px.x(), px.y());
    }
  return encode_jpeg(picture.view(), 80);
}

std::vector<SeenPoint> points_of_keyframe(const Map& map, int id) {
  const std::vector<Track> tracks = tracks_of_keyframe(map, id);
  return seen_points(tracks, tracks.size());
}

std::vector<SeenPoint> points_of(const System& system, std::size_t index) {
  const FrameRecord& record = system.records()[index];
  if (record.state != FrameState::tracked) return {};
  const Map& map = system.map();
  const bool is_keyframe = map.keyframe(record.keyframe).frame.index == static_cast<int>(index);
  return is_keyframe ? points_of_keyframe(map, record.keyframe) : record.seen;
}

Json frame_json(const Map& map, const Parameters& parameters, int index, const Pyramid& image,
                const std::vector<Detection>& detections, const std::vector<SeenPoint>& points,
                const std::optional<SE3d>& T_c_w) {
  Json found = Json::array(), at = Json::array(), texts = Json::array();
  for (const Detection& detection : detections)
    found.push_back({{"quad", short_polygon(outline(map.camera, detection.quad))}, {"text", detection.text}});
  for (const SeenPoint& seen : points)
    for (const float value : {seen.px.x(), seen.px.y()}) at.push_back(std::lround(value));
  if (T_c_w)
    for (const TextObject& text : map.texts) {
      Quad<double> quad;
      double zncc = 0;
      if (text.state == TextState::mapped && see_text(map, parameters, text, image, *T_c_w, &quad, &zncc))
        texts.push_back(
            {{"id", text.id}, {"quad", short_polygon(outline(map, text, *T_c_w, quad))}, {"zncc", short_number(zncc)}});
    }
  return {{"frame", index},
          {"image", jpeg_uri(frame_jpeg(image))},
          {"detections", found},
          {"points", at},
          {"texts", texts}};
}

Json frames_json(const System& system, const Parameters& parameters,
                 const std::map<int, std::vector<Detection>>& detections, const ImageSource& image) {
  std::vector<int> processed;
  for (const auto& entry : detections)
    if (entry.first < static_cast<int>(system.records().size())) processed.push_back(entry.first);
  Json frames = Json::array();
  for (const int index : evenly_spaced(processed, kReportFrames)) {
    const auto i = static_cast<std::size_t>(index);
    const FrameRecord& record = system.records()[i];
    std::optional<SE3d> T_c_w;
    if (record.state == FrameState::tracked) T_c_w = system.final_pose(record).inverse();
    frames.push_back(
        frame_json(system.map(), parameters, index, *image(index), detections.at(index), points_of(system, i), T_c_w));
  }
  return frames;
}

}  // namespace textslam
