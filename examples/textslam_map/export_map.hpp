// A map file as other programs read it.
#ifndef TEXTSLAM_MAP_EXPORT_MAP_HPP
#define TEXTSLAM_MAP_EXPORT_MAP_HPP

#include <string>

#include "textslam/map_file/map_file.hpp"

namespace textslam {

/// COLMAP's model in `folder`, as text and as binary: cameras, images and points3D as .txt and .bin, and the key frames
/// in images/. Its ids are ours and one. The images are as they were taken, and so are the pixels; COLMAP's pixel
/// (0.5, 0.5) is our (0, 0). Throws InputError where COLMAP has no word for the camera, std::runtime_error where a file
/// cannot be written.
void export_colmap(const LoadedMap& map, const std::string& folder);

/// Text quads as faces, points and key frames as coloured vertices.
void export_ply(const LoadedMap& map, const std::string& path);

/// Poses of the key frames of a session (0: the last), camera to world, in TUM's format.
void export_tum(const LoadedMap& map, int session, const std::string& path);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_EXPORT_MAP_HPP
