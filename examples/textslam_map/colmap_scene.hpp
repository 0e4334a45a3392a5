// COLMAP's model: of a map, and its files as text and binary, written and read.
#ifndef TEXTSLAM_MAP_COLMAP_SCENE_HPP
#define TEXTSLAM_MAP_COLMAP_SCENE_HPP

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "io/text_file.hpp"
#include "textslam/map_file/map_file.hpp"

namespace textslam {

/// COLMAP's models: its numbers of them are their places.
struct ColmapCameraModel {
  const char* name;
  int parameters;
};
inline constexpr std::array<ColmapCameraModel, 11> kColmapModels = {{{"SIMPLE_PINHOLE", 3},
                                                                     {"PINHOLE", 4},
                                                                     {"SIMPLE_RADIAL", 4},
                                                                     {"RADIAL", 5},
                                                                     {"OPENCV", 8},
                                                                     {"OPENCV_FISHEYE", 8},
                                                                     {"FULL_OPENCV", 12},
                                                                     {"FOV", 5},
                                                                     {"SIMPLE_RADIAL_FISHEYE", 4},
                                                                     {"RADIAL_FISHEYE", 5},
                                                                     {"THIN_PRISM_FISHEYE", 12}}};

/// Of a map, ids are the map's and one; of a model that was read, they are as they are there. Pixels are COLMAP's: the
/// centre of the top-left one is (0.5, 0.5).
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
    int id;
    int keyframe = -1;  ///< Of a map.
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

/// The lines of a model's file, without comments, and with those that are blank: an image without points has one.
std::vector<TextLine> model_lines(const std::string& bytes);

/// A number of a model as the integer that it should be, 0 to 2^31 - 2. Throws InputError that says so of `what`.
int require_whole(double number, const std::string& path, int line, const char* what);

/// The one camera of cameras.txt. Throws InputError where it is not one.
ColmapScene::Camera camera_of_text(const std::string& text, const std::string& path);

/// The model in a folder, its ids as they are there: binary where there is a cameras.bin, else text. Pixels without a
/// point have -1. Throws InputError for what is missing or broken, and for several cameras.
ColmapScene read_colmap_scene(const std::string& folder);
/// Its camera. Throws InputError that names `folder` for a model that the library does not have.
CameraModel camera_of(const ColmapScene& scene, const std::string& folder);

/// images.txt and points3D.txt; cameras.txt is ColmapScene::camera_text.
std::string colmap_images_text(const ColmapScene& scene);
std::string colmap_points_text(const ColmapScene& scene);

/// cameras.bin, images.bin and points3D.bin: the same numbers, little-endian, none of them rounded.
std::string colmap_cameras_binary(const ColmapScene& scene);
std::string colmap_images_binary(const ColmapScene& scene);
std::string colmap_points_binary(const ColmapScene& scene);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_COLMAP_SCENE_HPP
