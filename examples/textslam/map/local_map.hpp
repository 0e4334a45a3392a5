// Local map: the key frames around the newest one, and what they observe. The tracker uses nothing else.
//
// The rest of the map may have drifted against it; loop closure connects the two (loop_closure.hpp).
#ifndef TEXTSLAM_MAP_LOCAL_MAP_HPP
#define TEXTSLAM_MAP_LOCAL_MAP_HPP

#include <vector>

#include "textslam/common/parameters.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

struct LocalMap {
  std::vector<char> keyframe_in, point_in, text_in;  ///< By id.

  /// What the map got since is in. In an empty local map everything is.
  bool has_keyframe(int id) const { return in(keyframe_in, id); }
  bool has_point(int id) const { return in(point_in, id); }
  bool has_text(int id) const { return in(text_in, id); }

 private:
  static bool in(const std::vector<char>& flags, int id) {
    return static_cast<std::size_t>(id) >= flags.size() || flags[static_cast<std::size_t>(id)] != 0;
  }
};

/// Around a key frame: the key frames that share local_min_shared points or a mapped text with it, those that share as
/// much with one of these (local_hops), their points, and the texts that any of them hosts or observes.
LocalMap local_map(const Map& map, const Parameters& parameters, int keyframe);

/// The same around a frame that is no key frame, by the map points that it sees.
LocalMap local_map(const Map& map, const Parameters& parameters, const std::vector<int>& points);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_LOCAL_MAP_HPP
