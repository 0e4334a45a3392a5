// A map as COLMAP's model, and its files as text and binary.
#ifndef TEXTSLAM_MAP_COLMAP_SCENE_HPP
#define TEXTSLAM_MAP_COLMAP_SCENE_HPP

#include <string>
#include <utility>
#include <vector>

#include "textslam/map_file/map_file.hpp"

namespace textslam {

/// Ids are ours and one. Pixels are COLMAP's: the centre of the top-left one is (0.5, 0.5).
struct ColmapScene {
  struct Camera {
    int id = 1;
    std::string model;
    int width = 0, height = 0;
    std::vector<double> parameters;
  };
  struct Pixel {
    Vec2 px;
    int point;
  };
  struct Image {
    int id, keyframe;
    SE3d T_c_w;
    std::string name;
    std::vector<Pixel> pixels;
  };
  struct Point {
    int id;
    Vec3 p;
    int grey = 0;
    double error = 0;                                ///< Mean distance of its images from its pixels, px.
    std::vector<std::pair<int, std::size_t>> track;  ///< Image, and the place in its pixels.
  };
  Camera camera;
  std::string camera_text;  ///< cameras.txt
  std::vector<Image> images;
  std::vector<Point> points;
};

/// Throws InputError that names `folder` where COLMAP has no word for the camera.
ColmapScene colmap_scene(const LoadedMap& map, const std::string& folder);

/// images.txt and points3D.txt; cameras.txt is ColmapScene::camera_text.
std::string colmap_images_text(const ColmapScene& scene);
std::string colmap_points_text(const ColmapScene& scene);

/// cameras.bin, images.bin and points3D.bin: the same numbers, little-endian, none of them rounded.
std::string colmap_cameras_binary(const ColmapScene& scene);
std::string colmap_images_binary(const ColmapScene& scene);
std::string colmap_points_binary(const ColmapScene& scene);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_COLMAP_SCENE_HPP
