// A model of COLMAP as a map: its images are key frames, its points are map points, and texts are looked for in its
// images as a tracker that hands its key frames to a TextMap would.
#ifndef TEXTSLAM_MAP_IMPORT_COLMAP_HPP
#define TEXTSLAM_MAP_IMPORT_COLMAP_HPP

#include <string>

#include "textslam_map/colmap_scene.hpp"
#include "textslam_map/image_detections.hpp"

namespace textslam {

/// Throws InputError where the image does not have the camera's size; `whose` begins the message: "the map's images
/// are".
void check_size(const std::string& path, ImageView8 image, const CameraModel& camera, const std::string& whose);

/// Key frames are in the order of the images' names. Points that fewer than two images see are left out. Throws
/// InputError for an image of the model that is missing or of another size. The model has two images or more.
LoadedMap import_colmap(const ColmapScene& scene, const CameraModel& camera, const std::string& images,
                        ImageDetections& detections);

/// How much of what, in one line.
std::string imported_text(const LoadedMap& map);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_IMPORT_COLMAP_HPP
