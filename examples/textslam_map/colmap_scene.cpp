#include "textslam_map/colmap_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "io/camera_formats/formats.hpp"
#include "io/input_error.hpp"
#include "io/text_file.hpp"

namespace textslam {
namespace {

std::string image_name(int id) {
  char name[32];
  std::snprintf(name, sizeof name, "keyframe_%06d.png", id);
  return name;
}

double error_of(const Map& map, const MapPoint& point) {
  double sum = 0;
  int count = 0;
  for (const PointObservation& o : point.observations) {
    Vec2 px;
    if (!show(map.view_of(o.keyframe), map.keyframe(o.keyframe).T_w_c.inverse() * point.p_w, &px)) continue;
    sum += (px - o.px).norm();
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

int grey_of(const Map& map, const MapPoint& point) {
  const PointObservation& host = point.observations.front();
  const ImageView8 image = map.keyframe(host.keyframe).frame.image->level(0);
  const int x = std::clamp(static_cast<int>(host.px.x() + 0.5), 0, image.width() - 1);
  const int y = std::clamp(static_cast<int>(host.px.y() + 0.5), 0, image.height() - 1);
  return image(x, y);
}

}  // namespace

int require_whole(double number, const std::string& path, int line, const char* what) {
  if (!(number >= 0 && number < std::numeric_limits<int>::max()) || number != std::floor(number))
    throw InputError(path, line, std::string(what) + " should be a whole number below 2^31");
  return static_cast<int>(number);
}

std::vector<TextLine> model_lines(const std::string& bytes) {
  std::vector<TextLine> lines;
  int number = 0;
  for (std::size_t at = 0; at < bytes.size(); ++number) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    if (bytes[at] != '#') lines.push_back({bytes.substr(at, end - at), number + 1});
    at = end + 1;
  }
  return lines;
}

ColmapScene::Camera camera_of_text(const std::string& text, const std::string& path) {
  ColmapScene::Camera camera;
  int cameras = 0;
  for (const auto& [row, line] : model_lines(text)) {
    const std::vector<std::string_view> words = split_blanks(row);
    if (words.empty() || words[0][0] == '#') continue;
    if (++cameras > 1) throw InputError(path, line, "a second camera: a map has one, for all images");
    if (words.size() < 5) throw InputError(path, line, "expected 'id model width height parameters'");
    const auto number = [&, line = line](std::size_t i) {
      return require_number(words[i], path, line, "a number of the camera");
    };
    camera.id = require_whole(number(0), path, line, "the id");
    camera.model = std::string(words[1]);
    camera.width = require_whole(number(2), path, line, "the width");
    camera.height = require_whole(number(3), path, line, "the height");
    for (std::size_t i = 4; i < words.size(); ++i) camera.parameters.push_back(number(i));
  }
  if (cameras == 0) throw InputError(path, 0, "no camera");
  return camera;
}

ColmapScene colmap_scene(const LoadedMap& loaded, const std::string& folder) {
  const Map& map = loaded.map;
  ColmapScene scene;
  scene.camera_text = format_camera(loaded.record.camera, CameraFormat::colmap);
  if (scene.camera_text.empty())
    throw InputError(folder, 0, std::string("COLMAP has no camera like the map's, ") + loaded.record.camera.raw.name());
  scene.camera = camera_of_text(scene.camera_text, folder);
  std::map<int, std::size_t> place;  // of a key frame's image
  for (const int id : map.keyframe_ids()) {
    place[id] = scene.images.size();
    scene.images.push_back({id + 1, id, map.keyframe(id).T_w_c.inverse(), image_name(id), {}});
  }
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const MapPoint& point = map.points[i];
    if (point.bad) continue;
    const int id = static_cast<int>(i) + 1;
    ColmapScene::Point out{id, point.p_w, grey_of(map, point), error_of(map, point), {}};
    std::vector<int> seen;
    for (const PointObservation& o : point.observations) {
      if (std::find(seen.begin(), seen.end(), o.keyframe) != seen.end()) continue;
      seen.push_back(o.keyframe);
      ColmapScene::Image& image = scene.images[place.at(o.keyframe)];
      out.track.emplace_back(image.id, image.pixels.size());
      image.pixels.push_back({o.px + Vec2(kColmapHalfPixel, kColmapHalfPixel), id});
    }
    std::sort(out.track.begin(), out.track.end());
    scene.points.push_back(std::move(out));
  }
  return scene;
}

}  // namespace textslam
