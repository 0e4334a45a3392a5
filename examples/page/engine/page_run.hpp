// PageRun: a run of the page. The browser brings the small files of a sequence (camera, truth, list of images) as a
// folder of the module's memory, then the frames one by one; the outputs lie in a folder, too.
#ifndef TEXTSLAM_PAGE_PAGE_RUN_HPP
#define TEXTSLAM_PAGE_PAGE_RUN_HPP

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "live_map.hpp"
#include "textslam/session.hpp"

namespace textslam {

class KeptFrames;

/// A text in a picture, px.
struct TextPicture {
  Image<std::uint8_t> image;
  Quad<double> quad;
};

class PageRun {
 public:
  /// What the folder says. `video`: the name of a video whose frames will come, or of a camera; empty: the folder's
  /// images, which lie there as empty files. `map`: a map's file to begin in; empty: none. Throws InputError for broken
  /// files.
  PageRun(const std::string& folder, const std::string& video, const std::string& map);

  /// {"frames": [{"path", "time"}], "known_camera", "most_side", "truth"}: those of a folder of images, in order;
  /// whether the camera is known; px to which larger frames are to be made smaller, 0: none; how many true poses.
  Json sequence() const;

  /// The size of the frames is known now. Without a map and a camera file the camera is a pinhole of `fov` degrees.
  /// `localise`: the map stays as it is. Throws InputError where the map or the camera file has another size or camera.
  void begin(int width, int height, double fov, const std::string& detector, bool localise);
  /// A frame that calibrate() is to see, before begin().
  void keep(double time, ImageView8 image);
  /// Estimates the camera from the frames kept, and forgets them; begin() then takes it, where they tell it. It starts
  /// from `fov` degrees.
  Json calibrate(double fov, const std::function<void(std::size_t, std::size_t)>& progress);
  /// The next frame; returns live_frame().
  Json frame(double time, ImageView8 image);
  void add_detections(int frame, std::vector<Detection> detections, double ms);
  Json map();
  /// Ends the run; how many pictures a reader of the mapped texts is to see.
  std::size_t unread();
  const TextPicture& picture(std::size_t index) const { return unread_.at(index); }
  /// Takes what it read in them, in their order.
  void take_readings(const std::vector<TextReader::Reading>& readings);
  /// Ends the run and writes its outputs into `folder`. Returns {"metrics", "table", "warnings", "map"}: the path of
  /// the map to save, null where there is none.
  Json finish(const std::string& folder);

 private:
  void assume_camera(int width, int height, double fov);
  std::string write_map(const std::string& folder, std::vector<std::string>* lines);

  std::string map_;
  bool localise_ = false;
  Sequence sequence_;
  bool has_camera_file_ = false;
  std::shared_ptr<KeptFrames> kept_;
  std::optional<SelfCalibration> calibration_;
  std::unique_ptr<Session> session_;
  std::vector<TextPicture> unread_;
  TextPictures pictures_;
};

}  // namespace textslam

#endif  // TEXTSLAM_PAGE_PAGE_RUN_HPP
