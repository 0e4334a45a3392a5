// A run's part in a map that lasts: it begins in the map of earlier sessions, and saves what it made.
#ifndef TEXTSLAM_MAP_SESSION_HPP
#define TEXTSLAM_MAP_SESSION_HPP

#include <functional>
#include <optional>
#include <string>

#include "textslam/map_file/map_file.hpp"
#include "textslam/run.hpp"

namespace textslam {

/// Whether the numbers of two cameras are the same, but for what a text may round.
bool is_same_camera(const CameraModel& a, const CameraModel& b);

class MapSession {
 public:
  /// Loads the map that the options name, and gives the sequence its camera. Throws InputError where a file is no map,
  /// where the sequence's camera file is neither that camera nor the one that earlier sessions were given, and where
  /// the file to save cannot be one.
  MapSession(const RunOptions& options, Sequence* sequence);

  bool has_earlier() const { return earlier_.has_value(); }
  /// Gives the system the map of earlier sessions.
  void begin(System* system);
  /// The image of a key frame of an earlier session, by its frame's index.
  std::string image(int index) const;
  /// Saves what the options ask for, and localisation.csv into the output folder. `image`: of any frame, by its index.
  /// What cannot be saved where it should be is saved as map.db into the output folder before the error is thrown.
  /// Returns one line where no frame was found in the map of earlier sessions; what the run made is then in
  /// unjoined_map.db of the output folder.
  /// `metric`: the scale that this run gave the map; else that of earlier sessions stays.
  std::string save(const System& system, const CameraModel& camera, const std::optional<MetricScale>& metric,
                   const std::function<std::string(int)>& image) const;

 private:
  MapRecord record_of(const System& system, const CameraModel& camera, bool joined,
                      const std::function<std::string(int)>& image) const;

  const RunOptions& options_;
  std::string started_;
  std::optional<CameraModel> given_;  // of the sequence's camera file
  std::optional<LoadedMap> earlier_;
};

}  // namespace textslam

#endif  // TEXTSLAM_MAP_SESSION_HPP
