// Session: the example system frame by frame, with what it needs for its outputs.
#ifndef TEXTPLANE_PYTHON_SESSION_HPP
#define TEXTPLANE_PYTHON_SESSION_HPP

#include <map>
#include <string>
#include <vector>

#include "textslam/input/sequence_camera.hpp"
#include "textslam/report/summary.hpp"
#include "textslam/system/system.hpp"

namespace textslam {

class Session {
 public:
  /// `keep_images`: for finish(), which gives poses to frames that had none, and for the pictures of the report.
  Session(const CameraModel& camera, const Parameters& parameters, bool keep_images);

  /// Throws std::invalid_argument for an image of another size, a time that does not increase, or after finish().
  const FrameRecord& process(ImageView8 image, double timestamp, std::vector<Detection> detections, double detect_ms);
  /// Ends the run; twice does nothing.
  void finish();
  bool finished() const { return finished_; }
  /// Ends the run and writes the files of report/outputs.hpp. Throws std::runtime_error where it cannot.
  void save(const std::string& folder);
  /// Ends the run; the page of report/report.hpp. Empty before the first frame, and without images.
  std::string report();

  const System& system() const { return system_; }
  const CameraModel& camera() const { return sequence_.camera; }
  std::size_t frames() const { return sequence_.frames.size(); }

 private:
  RunSummary summary() const;

  Parameters parameters_;
  Sequence sequence_;  // what the outputs ask of one
  SequenceCamera camera_;
  System system_;
  bool keep_images_, finished_ = false;
  std::vector<Frame> kept_;
  std::map<int, std::vector<Detection>> detections_;
  std::size_t detected_ = 0;
};

}  // namespace textslam

#endif  // TEXTPLANE_PYTHON_SESSION_HPP
