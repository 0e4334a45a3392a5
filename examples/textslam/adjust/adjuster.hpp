// Adjuster: the adjustment that follows a key frame, in step with the frames or on a thread of its own.
//
// It is local, around the newest key frame. Whenever the map has grown by whole_growth, it takes the whole map: a local
// adjustment keeps the errors of its fixed key frames, and live poses inherit them.
//
// In step, keyframe_added() does it all, and the same frames give the same bytes. In real time it runs beside the
// tracker, and collect() takes over the result between two frames. Key frames that come meanwhile share the next one.
// So it is after a loop or a join: map_corrected().
//
// Threads: all members are called from one thread, which alone touches the map.
#ifndef TEXTSLAM_ADJUST_ADJUSTER_HPP
#define TEXTSLAM_ADJUST_ADJUSTER_HPP

#include <future>

#include "textslam/adjust/adjustment.hpp"

namespace textslam {

class Adjuster {
 public:
  explicit Adjuster(const Parameters& parameters) : parameters_(parameters) {}
  ~Adjuster();
  Adjuster(const Adjuster&) = delete;
  Adjuster& operator=(const Adjuster&) = delete;

  /// After the newest key frame was inserted and its tracks triangulated.
  void keyframe_added(Map& map);

  /// After a loop or a join moved parts of the map: adjusts all of it. True where that is done, as it is in step; else
  /// it is under way, and Collected::corrected tells when it is done. Not while an adjustment is under way.
  bool map_corrected(Map& map);
  /// Whether such an adjustment is under way.
  bool is_correcting() const { return correcting_; }

  struct Collected {
    bool changed = false;    ///< The map was.
    bool corrected = false;  ///< What map_corrected() began is done.
    SE3d moved;              ///< Motion of the world at its newest key frame: poses of frames since then follow it.
    int frame = -1;          ///< Index of the key frame's frame,
    double ms = 0;           ///< and what its adjustment took.
  };
  /// Takes over the adjustment under way if it is finished, and begins the one that waits.
  Collected collect(Map& map);
  /// As collect(), but waits for all of it: before the map is left, joined or written.
  Collected settle(Map& map);

 private:
  void begin(const Map& map, std::unique_ptr<StagedAdjustment> adjustment);
  std::unique_ptr<StagedAdjustment> prepare(const Map& map);
  bool has_grown(const Map& map);

  const Parameters& parameters_;
  std::unique_ptr<StagedAdjustment> adjustment_;
  std::future<double> solved_;  // valid while one is under way; gives the ms it took
  int frame_ = -1;
  bool waiting_ = false;             // a key frame came meanwhile
  bool correcting_ = false;          // it is of map_corrected()
  int whole_map_ = -1;               // number of the map that was last adjusted as a whole,
  std::size_t whole_keyframes_ = 0;  // and how many key frames it had
};

}  // namespace textslam

#endif  // TEXTSLAM_ADJUST_ADJUSTER_HPP
