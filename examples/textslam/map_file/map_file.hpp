// A map in a file: an SQLite database with everything that a later session needs to go on in it.
//
// A save is one transaction: whatever ends it, the file holds the old map or the new one. Ids are those of the map in
// memory and stay the same from session to session. Only mapped texts are kept.
#ifndef TEXTSLAM_MAP_FILE_MAP_FILE_HPP
#define TEXTSLAM_MAP_FILE_MAP_FILE_HPP

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/camera_model.hpp"
#include "textslam/input/sequence_camera.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// A run that made or changed the map.
struct SavedSession {
  int id = 1;
  std::string started;   ///< UTC, "2026-01-31 12:00:00".
  std::string sequence;  ///< As it was given.
  std::string command;   ///< The command line.
  std::string mode;      ///< text, points or loose.
  std::string version;   ///< Of textplane.
  int frames = 0, tracked = 0;
};

/// Where a key frame comes from.
struct KeyFrameSource {
  int session = 1;
  std::string image;  ///< The image's file in the sequence's folder.
};

/// What a file says beside the map itself.
struct MapRecord {
  CameraModel camera;
  std::optional<CameraModel> given_camera;  ///< That of the camera file, where `camera` is a better one of its images.
  std::vector<SavedSession> sessions;
  std::map<int, KeyFrameSource> sources;  ///< Of the key frames, by their ids.
  std::optional<double> scale_sigma;      ///< Lengths are metres, with this standard deviation as a share of them.
  std::int64_t revision = 0;              ///< Saves so far; 0: it comes from no file.
  bool same_ids = true;                   ///< Key frames have the ids that they have in that revision.
};

struct LoadedMap {
  MapRecord record;
  std::shared_ptr<const SequenceCamera> camera;  ///< Keeps the lens that `map` points to.
  Map map;
};

/// The index of a key frame's frame of an earlier session. These are negative, and increase with the ids up to -2.
inline int earlier_frame_index(int id, std::size_t keyframes) { return id - static_cast<int>(keyframes) - 1; }

/// Its inverse.
inline int earlier_keyframe_id(int index, std::size_t keyframes) { return index + static_cast<int>(keyframes) + 1; }

/// Throws InputError where the file is no map, is damaged or is newer than this program.
LoadedMap load_map(const std::string& path, const Parameters& parameters);
/// Its camera alone; throws likewise.
CameraModel load_map_camera(const std::string& path);

/// Writes the map. `record.revision` says which one it replaces: with 0 whatever map is there. Points and texts that
/// are not finite are left out. Throws InputError where the file is no map, or has another revision by now, as another
/// session was saved in between; std::runtime_error where it cannot be written. Then the file is as before.
void save_map(const std::string& path, const Map& map, const MapRecord& record);

/// Throws as save_map() would at once: where there is a file that is no map, or one that cannot be written.
void check_can_save(const std::string& path);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_FILE_MAP_FILE_HPP
