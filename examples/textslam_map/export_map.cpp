#include "textslam_map/export_map.hpp"

#include <algorithm>
#include <cstdio>
#include <map>

#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "io/output_file.hpp"
#include "io/text_file.hpp"
#include "textslam/report/text_map.hpp"

namespace textslam {
namespace {

constexpr double kHalfPixel = 0.5;

std::string joined(const std::vector<double>& numbers) {
  std::string out;
  for (const double number : numbers) out += (out.empty() ? "" : " ") + shortest(number);
  return out;
}

std::string image_name(int id) {
  char name[32];
  std::snprintf(name, sizeof name, "keyframe_%06d.png", id);
  return name;
}

// Where each point is in the list of a key frame's pixels.
using Places = std::map<std::pair<int, int>, std::size_t>;  // (key frame, point) -> place

std::string images_text(const Map& map, Places* places) {
  std::string out = "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME\n# X Y POINT3D_ID ...\n";
  std::vector<std::string> pixels(map.keyframes.size());
  std::vector<std::size_t> counts(map.keyframes.size(), 0);
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    if (map.points[i].bad) continue;
    const int id = static_cast<int>(i);
    for (const PointObservation& o : map.points[i].observations) {
      const auto k = static_cast<std::size_t>(o.keyframe);
      if (!places->emplace(std::make_pair(o.keyframe, id), counts[k]).second) continue;
      ++counts[k];
      pixels[k] += (pixels[k].empty() ? "" : " ") + joined({o.px.x() + kHalfPixel, o.px.y() + kHalfPixel}) + " " +
                   std::to_string(id + 1);
    }
  }
  for (const int id : map.keyframe_ids()) {
    const SE3d T_c_w = map.keyframe(id).T_w_c.inverse();
    const Eigen::Quaterniond q(T_c_w.R);
    out += std::to_string(id + 1) + " " + joined({q.w(), q.x(), q.y(), q.z(), T_c_w.t.x(), T_c_w.t.y(), T_c_w.t.z()}) +
           " 1 " + image_name(id) + "\n" + pixels[static_cast<std::size_t>(id)] + "\n";
  }
  return out;
}

// Mean distance of the point's images from where they were seen, px.
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

std::string points_text(const Map& map, const Places& places) {
  std::string out = "# POINT3D_ID X Y Z R G B ERROR (IMAGE_ID POINT2D_IDX) ...\n";
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const MapPoint& point = map.points[i];
    if (point.bad) continue;
    const std::string grey = " " + std::to_string(grey_of(map, point));
    out += std::to_string(i + 1) + " " + joined({point.p_w.x(), point.p_w.y(), point.p_w.z()}) + grey + grey + grey +
           " " + shortest(error_of(map, point));
    std::vector<int> seen;
    for (const PointObservation& o : point.observations) seen.push_back(o.keyframe);
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    for (const int keyframe : seen)
      out += " " + std::to_string(keyframe + 1) + " " + std::to_string(places.at({keyframe, static_cast<int>(i)}));
    out += "\n";
  }
  return out;
}

}  // namespace

void export_colmap(const LoadedMap& loaded, const std::string& folder) {
  const std::string camera = format_camera(loaded.record.camera, CameraFormat::colmap);
  if (camera.empty())
    throw InputError(folder, 0, std::string("COLMAP has no camera like the map's, ") + loaded.record.camera.raw.name());
  create_output_folder(folder + "/images");
  Places places;
  write_file(folder + "/cameras.txt", camera);
  write_file(folder + "/images.txt", images_text(loaded.map, &places));
  write_file(folder + "/points3D.txt", points_text(loaded.map, places));
  for (const int id : loaded.map.keyframe_ids())
    save_png(folder + "/images/" + image_name(id), loaded.map.keyframe(id).frame.image->level(0));
}

void export_ply(const LoadedMap& loaded, const std::string& path) { write_file(path, text_map_ply(loaded.map)); }

void export_tum(const LoadedMap& loaded, int session, const std::string& path) {
  const int wanted = session > 0 ? session : loaded.record.sessions.back().id;
  std::vector<StampedPose> poses;
  for (const auto& [id, source] : loaded.record.sources)
    if (source.session == wanted)
      poses.push_back({loaded.map.keyframe(id).frame.timestamp, loaded.map.keyframe(id).T_w_c});
  if (poses.empty()) throw InputError("--session", 0, "the map has no key frame of session " + std::to_string(wanted));
  std::sort(poses.begin(), poses.end(),
            [](const StampedPose& a, const StampedPose& b) { return a.timestamp < b.timestamp; });
  write_tum(path, poses);
}

}  // namespace textslam
