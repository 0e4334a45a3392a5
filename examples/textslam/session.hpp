// Session: the system frame by frame for a host that has the images, with what it needs for its outputs. Python's
// textplane.slam.System and the page in the browser (examples/page) are such hosts.
#ifndef TEXTSLAM_SESSION_HPP
#define TEXTSLAM_SESSION_HPP

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "textslam/input/sequence_camera.hpp"
#include "textslam/map_session.hpp"
#include "textslam/report/summary.hpp"
#include "textslam/system/system.hpp"

namespace textslam {

struct SessionOptions {
  Parameters parameters;
  /// Images are kept for finish(), which gives poses to frames that had none, and for the pictures of the report.
  bool keep_images = true;
  /// Of those kept at most. Frames that come later are not filled in, and not shown.
  std::size_t most_image_bytes = std::numeric_limits<std::size_t>::max();
  std::optional<SelfCalibration> calibration;  ///< Of the camera, where it was estimated.
  std::string detector = "of the program";     ///< Its name, for the outputs.
  std::vector<std::string> command;            ///< What the report gives as the command line.
  std::string map;                             ///< The map file of earlier sessions that it begins in; empty: none.
  bool localise = false;                       ///< Frames are only localised in it, and it stays as it is.
};

/// The sequence of a host that has nothing but a camera.
Sequence sequence_of(const CameraModel& camera);

class Session {
 public:
  /// Of `sequence` the camera, the truth and the words for people count; its frames are those that come. A map of
  /// earlier sessions has its own camera: throws InputError where it is no map, or of another camera.
  Session(Sequence sequence, const SessionOptions& options);

  /// The next frame. Throws std::invalid_argument for an image of another size, a time that does not increase, or after
  /// finish().
  const FrameRecord& process(FrameRef frame, ImageView8 image, std::vector<Detection> detections, double detect_ms);
  /// The same of a frame that has nothing but a time.
  const FrameRecord& process(ImageView8 image, double timestamp, std::vector<Detection> detections, double detect_ms);
  /// Late detections of a frame that was processed, before finish(): see System::add_detections().
  void add_detections(int frame, std::vector<Detection> detections, double detect_ms);
  /// Ends the run; twice does nothing.
  void finish();
  bool finished() const { return finished_; }
  /// Ends the run and reads the mapped texts once more, as text/text_reading.hpp says.
  void read_texts(TextReader& reader);
  /// Ends the run and writes the files of report/outputs.hpp, the report too unless it would be empty, an estimated
  /// camera as camera.yaml, and of a run that only localises localisation.csv. Returns one line where that found no
  /// frame in its map. Throws std::runtime_error where it cannot write.
  std::string save(const std::string& folder);
  /// Ends the run and writes its map (map_file/map_file.hpp); without a path into the map that it began in. Returns one
  /// line where no frame was found in that map; what the run made is then in unjoined_map.db beside `path`. Throws
  /// std::invalid_argument where there is no path, no map, or the run only localises, and what save_map() throws.
  std::string save_map(const std::string& path);
  /// Ends the run; the page of report/report.hpp. Empty before the first frame, and without images.
  std::string report();
  /// Ends the run; its numbers. Throws InputError for a broken file of true signs.
  RunSummary summary();

  const System& system() const { return system_; }
  const CameraModel& camera() const { return sequence_.camera; }
  std::size_t frames() const { return sequence_.frames.size(); }

 private:
  Frame kept(int index) const;
  std::string image_name(int index) const;

  SessionOptions options_;
  Parameters at_size_;
  Sequence sequence_;  // its frames are those that came
  MapSession map_;
  SequenceCamera camera_;
  System system_;
  bool finished_ = false;
  std::vector<Image<std::uint8_t>> images_;  // of the first frames
  std::size_t image_bytes_ = 0;
  std::map<int, std::vector<Detection>> detections_;  // of the frames whose images are kept
  std::vector<TrueSign> signs_;
  std::size_t detected_ = 0;
};

}  // namespace textslam

#endif  // TEXTSLAM_SESSION_HPP
