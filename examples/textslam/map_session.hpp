// A run's part in a map that lasts: it begins in the map of earlier sessions, and saves what it made.
#ifndef TEXTSLAM_MAP_SESSION_HPP
#define TEXTSLAM_MAP_SESSION_HPP

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "textslam/map_file/map_file.hpp"
#include "textslam/report/summary.hpp"
#include "textslam/system/system.hpp"

namespace textslam {

/// Whether the numbers of two cameras are the same, but for what a text may round.
bool is_same_camera(const CameraModel& a, const CameraModel& b);

/// Whether there is a map to save: one of two key frames at least.
bool has_map(const System& system);

struct MapSessionOptions {
  std::string map;                   ///< The map file of earlier sessions; empty: none.
  bool localise = false;             ///< Frames are only localised in it, and it stays as it is.
  std::string sequence;              ///< What the saved session is called.
  std::vector<std::string> command;  ///< Its command line.
  Parameters parameters;
};

/// What MapSession::save() writes, and where.
struct MapSaving {
  std::string path;                       ///< Empty: the map of earlier sessions, if there is one.
  std::string folder;                     ///< Of what cannot be saved there, and of localisation.csv.
  std::optional<MetricScale> metric;      ///< That this run gave the map; else earlier sessions' scale stays.
  std::function<std::string(int)> image;  ///< Of this run's frames, by their index.
};

class MapSession {
 public:
  /// Loads the map that the options name, and gives the sequence its camera. Throws InputError where the file is no
  /// map, and where the sequence's camera file is neither that camera nor the one that earlier sessions were given.
  MapSession(MapSessionOptions options, Sequence* sequence);

  bool has_earlier() const { return earlier_.has_value(); }
  /// Gives the system the map of earlier sessions.
  void begin(System* system);
  /// The image of a key frame of an earlier session, by its frame's index.
  std::string image(int index) const;
  /// Writes the map; of a run that only localises, localisation.csv. What cannot be saved where it should be is saved
  /// as map.db into the folder before the error is thrown. Returns one line where no frame was found in the map of
  /// earlier sessions; what the run made is then in unjoined_map.db of the folder.
  std::string save(const System& system, const CameraModel& camera, const MapSaving& saving) const;

 private:
  MapRecord record_of(const System& system, const CameraModel& camera, bool in_earlier,
                      const std::function<std::string(int)>& image) const;

  MapSessionOptions options_;
  std::string started_;
  std::optional<CameraModel> given_;  // of the sequence's camera file
  std::optional<LoadedMap> earlier_;
};

}  // namespace textslam

#endif  // TEXTSLAM_MAP_SESSION_HPP
