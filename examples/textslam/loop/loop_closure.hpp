// Loop closure: the camera is back at a place whose key frames are no longer in the local map.
//
// A key frame is searched for in the old part of the map: by its signs; while the drift is small, where the map expects
// it; and by the looks of its points. Several key frames must agree on the similarity between the two parts. Then the
// drift is distributed over the path between them, and what is in both is merged.
#ifndef TEXTSLAM_LOOP_LOOP_CLOSURE_HPP
#define TEXTSLAM_LOOP_LOOP_CLOSURE_HPP

#include <vector>

#include "textslam/loop/map_join.hpp"
#include "textslam/map/local_map.hpp"

namespace textslam {

/// The two parts of the map, with the ids of the whole: what is in the other part is flagged bad or dropped.
Map old_part(const Map& map, const LocalMap& local);     ///< Points and texts outside the local map.
Map recent_part(const Map& map, const LocalMap& local);  ///< Those of the local map.

/// The recent part lies `link.S_a_b` away from where the old part says it is.
struct Loop {
  bool ok = false;
  int keyframe = -1;    ///< The newest, which shows the old part again.
  int met = -1;         ///< The key frame of the old part that shares most points with it.
  MapLink link;         ///< From the recent part (b) to the old one (a).
  Relocalisation seen;  ///< The newest key frame, as recognised in the old part.
};

/// Does the newest key frame, around which `local` is, show the old part of the map?
Loop find_loop(const Map& map, const LocalMap& local, const Parameters& parameters);

/// How far a part of the map is out of place.
struct Drift {
  double translation = 0;  ///< As a share of the path since.
  double rotation = 0;     ///< Degrees.
  double scale = 1;        ///< Ratio.
};

/// What a loop changed.
struct LoopCorrection {
  bool corrected = false;      ///< The drift was large enough to be corrected.
  Drift found;                 ///< Of the newest key frame against the one that it met, by the pose graph.
  std::vector<double> scales;  ///< Of each key frame: the factor on lengths in its frame.
  std::vector<int> points;     ///< New id of each point: its own, or that of the point it was merged into.
};

/// Closes the loop: distributes the drift over the pose graph where it shifts the old points by more than
/// loop_max_shift; merges texts, and points within loop_same_point; and adds the recent observations of old points.
/// Nothing is adjusted. Ids and lengths that others hold must be updated by the result.
LoopCorrection close_loop(Map& map, const Parameters& parameters, const Loop& loop);

/// Length of the camera's path from key frame a to b, by the key frames between.
double path_length_between(const Map& map, int a, int b);

/// The newest key frame's pose against its pose by the old points alone. Zeros where too few are left.
Drift drift_left(const Map& map, const Parameters& parameters, const Loop& loop);

}  // namespace textslam

#endif  // TEXTSLAM_LOOP_LOOP_CLOSURE_HPP
