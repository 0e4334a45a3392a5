// PageRun: a run of the page. The browser brings the small files of a sequence (camera, truth, list of images) as a
// folder of the module's memory, then the frames one by one; the outputs lie in a folder, too.
#ifndef TEXTSLAM_PAGE_PAGE_RUN_HPP
#define TEXTSLAM_PAGE_PAGE_RUN_HPP

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "live_map.hpp"
#include "textslam/session.hpp"

namespace textslam {

class KeptFrames;

class PageRun {
 public:
  /// What the folder says. `video`: the name of a video whose frames will come, or of a camera; empty: the folder's
  /// images, which lie there as empty files. Throws InputError for broken files.
  PageRun(const std::string& folder, const std::string& video);

  /// {"frames": [{"path", "time"}], "camera": {"width", "height"} or null, "truth"}: those of a folder of images, in
  /// order; whether the camera is known; how many true poses there are.
  Json sequence() const;

  /// The size of the frames is known now. Without a camera file the camera is a pinhole of `fov` degrees. Throws
  /// InputError where the camera file has another size.
  void begin(int width, int height, double fov, const std::string& detector);
  /// A frame that calibrate() is to see, before begin().
  void keep(double time, ImageView8 image);
  /// Estimates the camera from the frames kept, and forgets them; begin() then takes it, where they tell it. It starts
  /// from `fov` degrees.
  Json calibrate(double fov, const std::function<void(std::size_t, std::size_t)>& progress);
  /// The next frame; returns live_frame().
  Json frame(double time, ImageView8 image);
  void add_detections(int frame, std::vector<Detection> detections, double ms);
  Json map();
  /// Ends the run and writes its outputs into `folder`. Returns {"metrics", "table", "warnings"}.
  Json finish(const std::string& folder);

 private:
  void assume_camera(int width, int height, double fov);

  Sequence sequence_;
  std::shared_ptr<KeptFrames> kept_;
  std::optional<SelfCalibration> calibration_;
  std::unique_ptr<Session> session_;
  TextPictures pictures_;
};

}  // namespace textslam

#endif  // TEXTSLAM_PAGE_PAGE_RUN_HPP
