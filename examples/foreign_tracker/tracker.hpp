// A monocular tracker as other people write them, in the manner of ORB-SLAM: ORB key points, a pose-only optimisation
// of every frame, key frames, triangulation, local bundle adjustment, relocalisation. What makes text features of it is
// text.hpp and the lines that end in `// text` in the other files: fewer than 60, counted by
// tests/programs/foreign_tracker.cmake.
#ifndef FOREIGN_TRACKER_TRACKER_HPP
#define FOREIGN_TRACKER_TRACKER_HPP

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "foreign_tracker/map.hpp"
#include "foreign_tracker/matcher.hpp"
#include "foreign_tracker/text.hpp"  // text

namespace foreign {

class Tracker {
 public:
  explicit Tracker(const Camera& camera) : camera_(camera) {}

  /// The next frame: image, time and quads are read.
  void grab(Frame frame);

  /// Of the frames that have one, by what is known in the end: times and poses, camera to world.
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
  Map map_;
  Frame first_, last_;  // of the initialisation; the one before
  Se3 velocity_;        // T_last_now
  bool lost_ = false;
  int since_key_frame_ = 0;
  Frame* reference_ = nullptr;
  std::vector<Pose> trajectory_;
};

}  // namespace foreign

#endif  // FOREIGN_TRACKER_TRACKER_HPP
