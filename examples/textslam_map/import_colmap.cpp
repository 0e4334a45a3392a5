#include "textslam_map/import_colmap.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "io/camera_formats/formats.hpp"
#include "io/clock.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "textplane/landmarks/text_map.hpp"
#include "textslam/input/make_frame.hpp"
#include "textslam/map/observations.hpp"

namespace textslam {
namespace {

std::vector<const ColmapScene::Image*> by_name(const ColmapScene& scene) {
  std::vector<const ColmapScene::Image*> images;
  for (const ColmapScene::Image& image : scene.images) images.push_back(&image);
  std::sort(images.begin(), images.end(), [](const auto* a, const auto* b) { return a->name < b->name; });
  return images;
}

void add_points(const ColmapScene& scene, const std::vector<const ColmapScene::Image*>& images, Map* map) {
  std::map<int, std::vector<PointObservation>> seen;
  for (std::size_t k = 0; k < images.size(); ++k) {
    for (const ColmapScene::Pixel& pixel : images[k]->pixels) {
      const int keyframe = static_cast<int>(k);
      std::vector<PointObservation>& of_point = seen[pixel.point];
      if (pixel.point >= 0 && (of_point.empty() || of_point.back().keyframe != keyframe))  // one of several pixels
        of_point.push_back({keyframe, pixel.px - Vec2(kColmapHalfPixel, kColmapHalfPixel)});
    }
  }
  for (const ColmapScene::Point& point : scene.points) {
    const std::vector<PointObservation>& of_point = seen[point.id];
    if (of_point.size() < 2) continue;
    const int id = static_cast<int>(map->points.size());
    map->points.push_back({point.p});
    map->points.back().visible = map->points.back().found = static_cast<int>(of_point.size());
    for (const PointObservation& o : of_point) add_observation(*map, id, o.keyframe, o.px);
  }
}

std::vector<textplane::TextPoint> points_of(const Map& map, int keyframe) {
  std::vector<textplane::TextPoint> points;
  for (const int id : map.keyframe(keyframe).points) {
    const MapPoint& point = map.point(id);
    points.push_back(textplane::TextPoint::at(*observed_in(point.observations, keyframe), point.p_w, id));
  }
  return points;
}

void find_texts(const Parameters& parameters, Map* map) {
  textplane::TextMapOptions options;
  options.text = parameters.text;
  options.max_images = static_cast<int>(map->keyframes.size());
  textplane::TextMap texts(map->camera, options);
  for (const int id : map->keyframe_ids()) {
    const Frame& frame = map->keyframe(id).frame;
    std::vector<textplane::TextDetection> quads;
    for (const Detection& seen : frame.detections) quads.emplace_back(seen.quad, seen.text, seen.score);
    texts.add_keyframe(id, map->text_image(frame), map->keyframe(id).T_w_c.inverse(), quads, points_of(*map, id));
  }
  for (const TextObject& text : texts.objects()) {
    if (text.state != TextState::mapped) continue;
    map->texts.push_back(text);
    map->texts.back().id = static_cast<int>(map->texts.size()) - 1;  // ids of a map are indices
  }
}

}  // namespace

void check_size(const std::string& path, ImageView8 image, const CameraModel& camera, const std::string& whose) {
  if (image.width() == camera.width && image.height() == camera.height) return;
  const auto size = [](int width, int height) { return std::to_string(width) + " x " + std::to_string(height); };
  throw InputError(
      path, 0,
      whose + " " + size(camera.width, camera.height) + ", this one is " + size(image.width(), image.height()));
}

LoadedMap import_colmap(const ColmapScene& scene, const CameraModel& camera, const std::string& images,
                        ImageDetections& detections) {
  LoadedMap loaded;
  loaded.record.camera = camera;
  loaded.record.camera.shutter = all_at_once(camera.height);
  loaded.camera = std::make_shared<const SequenceCamera>(camera);
  Map& map = loaded.map;
  map.camera = loaded.camera->view();
  map.width = camera.width;
  map.height = camera.height;
  map.shutter = loaded.record.camera.shutter;
  const Parameters parameters = at_size(Parameters{}, map.width, map.height);
  const std::vector<const ColmapScene::Image*> named = by_name(scene);
  for (const ColmapScene::Image* image : named) {
    const std::string path = images + "/" + image->name;
    Image<std::uint8_t> pixels = load_grey(path);
    check_size(path, pixels.view(), camera, "the model's images are");
    const int id = static_cast<int>(map.keyframes.size());
    std::vector<Detection> seen = detections.of(path, pixels.view());
    KeyFrame keyframe;
    keyframe.frame = make_frame(id, id, std::move(pixels), parameters);
    keyframe.frame.detections = std::move(seen);
    keyframe.T_w_c = image->T_c_w.inverse();
    map.keyframes.push_back(std::move(keyframe));
    loaded.record.sources[id] = {1, image->name};
  }
  add_points(scene, named, &map);
  find_texts(parameters, &map);
  SavedSession session;
  session.started = utc_now();
  session.sequence = images;
  session.command = "textslam-map import";
  session.mode = "text";
  session.version = TEXTPLANE_VERSION_STRING;
  session.frames = session.tracked = static_cast<int>(named.size());
  loaded.record.sessions = {session};
  return loaded;
}

std::string imported_text(const LoadedMap& map) {
  return std::to_string(map.map.keyframes.size()) + " key frames, " + std::to_string(map.map.points.size()) +
         " points, " + std::to_string(map.map.texts.size()) + " texts\n";
}

}  // namespace textslam
