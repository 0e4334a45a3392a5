// What the page shows while a run goes on: the map so far, and what was found in a frame. In the form that the viewer
// of the report takes (report_data.hpp, text_map.hpp), so that one view draws both.
#ifndef TEXTSLAM_PAGE_LIVE_MAP_HPP
#define TEXTSLAM_PAGE_LIVE_MAP_HPP

#include <map>
#include <string>

#include "textslam/common/report_json.hpp"
#include "textslam/system/system.hpp"

namespace textslam {

/// The pictures of the texts on their quads. A text keeps its picture while its host stays: encoding all again and
/// again would take longer than tracking.
class TextPictures {
 public:
  /// Data URI of the text seen from the front.
  const std::string& of(const Map& map, const TextObject& text);

 private:
  struct Picture {
    int map = -1, host = -1;
    std::string uri;
  };
  std::map<int, Picture> pictures_;
};

/// {"camera", "texts", "world"}: see report.hpp; truth and signs are empty.
Json live_map(const System& system, const Sequence& sequence, TextPictures& pictures);

/// Of the newest frame: frame_json() with {"seen": [x, y, ...], "quads": [[x1, y1, ...], ...]}, px.
Json live_frame(const System& system);

}  // namespace textslam

#endif  // TEXTSLAM_PAGE_LIVE_MAP_HPP
