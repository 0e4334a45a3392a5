// A monocular tracker like ORB-SLAM, written without textplane: ORB key points, a pose-only optimisation of every
// frame, key frames, triangulation, local bundle adjustment, relocalisation. The lines that are marked `// text` add
// text features: at most 30, counted by tests/programs/foreign_tracker.cmake. It shows that text features fit into a
// system that is not built on this library. Without quads no text is found, and nothing changes.
#ifndef FOREIGN_TRACKER_TRACKER_HPP
#define FOREIGN_TRACKER_TRACKER_HPP

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "foreign_tracker/map.hpp"
#include "foreign_tracker/matcher.hpp"

namespace foreign {

class Tracker {
 public:
  explicit Tracker(const Camera& camera) : camera_(camera) {}

  /// Processes the next frame; its image, time and quads must be set.
  void grab(Frame frame);

  /// Times and final poses (camera to world) of the frames that have one.
  std::vector<std::pair<double, Se3>> trajectory() const;

  const Map& map() const { return map_; }

 private:
  // tracker.cpp
  void initialise(Frame frame);
  bool track(Frame& frame);
  bool track_local_map(Frame& frame);
  bool relocalise(Frame& frame);
  bool match_reference(const Frame& reference, Frame& frame) const;
  std::vector<MapPoint*> local_points(const Frame& frame) const;

  // mapper.cpp
  void make_key_frame(Frame frame);
  void cull(std::size_t since);
  int triangulate(Frame& a, Frame& b, const Matches& matches);
  void fuse(const std::vector<Frame*>& frames, std::size_t first_new);

  struct Pose {
    double time;
    const Frame* reference;
    Se3 T_r_c;
  };

  Camera camera_;
  textplane::TextMap texts_{{camera_.fx, camera_.fy, camera_.cx, camera_.cy}};  // text
  Map map_;
  Frame first_, last_;  // the first of the initialisation; the previous
  Se3 velocity_;        // T_last_now
  bool lost_ = false;
  int since_key_frame_ = 0;
  Frame* reference_ = nullptr;
  std::vector<Pose> trajectory_;
};

}  // namespace foreign

#endif  // FOREIGN_TRACKER_TRACKER_HPP
