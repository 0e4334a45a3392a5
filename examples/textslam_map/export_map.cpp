#include "textslam_map/export_map.hpp"

#include <algorithm>

#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "io/output_file.hpp"
#include "textslam/report/text_map.hpp"
#include "textslam_map/colmap_scene.hpp"

namespace textslam {

void export_colmap(const LoadedMap& loaded, const std::string& folder) {
  const ColmapScene scene = colmap_scene(loaded, folder);
  create_output_folder(folder + "/images");
  write_file(folder + "/cameras.txt", scene.camera_text);
  write_file(folder + "/images.txt", colmap_images_text(scene));
  write_file(folder + "/points3D.txt", colmap_points_text(scene));
  write_file(folder + "/cameras.bin", colmap_cameras_binary(scene));
  write_file(folder + "/images.bin", colmap_images_binary(scene));
  write_file(folder + "/points3D.bin", colmap_points_binary(scene));
  for (const ColmapScene::Image& image : scene.images)
    save_png(folder + "/images/" + image.name, loaded.map.keyframe(image.keyframe).frame.image->level(0));
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
