// Loop closure: the camera is back at a place whose key frames are no longer in the local map.
//
// A key frame is looked for in the old part of the map: by the signs that its detector found, and where the map expects it,
// which serves while the drift is small. Several key frames must agree on the similarity between the two parts. The drift is
// then spread over the way between them, and what is in both becomes one.
#ifndef TEXTSLAM_LOOP_LOOP_CLOSURE_HPP
#define TEXTSLAM_LOOP_LOOP_CLOSURE_HPP

#include <string>
#include <vector>

#include "textslam/loop/map_join.hpp"
#include "textslam/map/local_map.hpp"

namespace textslam {

/// The map in two, with the ids of the whole: what is not in the one part is flagged bad or dropped there.
Map old_part(const Map& map, const LocalMap& local);     ///< Points and texts outside the local map.
Map recent_part(const Map& map, const LocalMap& local);  ///< Those of the local map.

/// The recent part lies `link.S_a_b` away from where the old part says it is.
struct Loop {
  bool ok = false;
  int keyframe = -1;  ///< The newest: it met the old part
  int met = -1;       ///< in the view of this key frame, which shows most of what both know.
  MapLink link;       ///< From the recent part (b) to the old one (a).
  Recovery seen;      ///< The newest key frame, as recognised in the old part.
};

/// Does the newest key frame, around which `local` is, show the old part of the map?
Loop find_loop(const Map& map, const LocalMap& local, const Parameters& parameters);

/// How far a part of the map is out of place.
struct Drift {
  double translation = 0;  ///< As a share of the way since.
  double rotation = 0;     ///< Degrees.
  double scale = 1;        ///< Ratio.
};

/// What a loop changed.
struct LoopCorrection {
  bool spread = false;         ///< The drift was large enough to be spread over the map.
  Drift found;                 ///< Of the newest key frame against the one that it met, as the whole graph has it.
  std::vector<double> scales;  ///< Of each key frame: what lengths in its frame were multiplied by.
  std::vector<int> points;     ///< What each point became: its own id, or that of the one it was merged into.
};

/// Closes the loop: spreads the drift over the pose graph where it shifts what the newest key frame sees by more than
/// loop_max_shift px in the image; merges texts, and points that are the same to a part of a pixel; and makes the old points
/// that recent key frames showed observations of them. Nothing is adjusted. Observations and ids that others hold are to be
/// moved by the result.
LoopCorrection close_loop(Map& map, const Parameters& parameters, const Loop& loop);

/// What the camera travelled from key frame a to b, by the key frames between.
double way_between(const Map& map, int a, int b);

/// The drift that is left: between the newest key frame's pose in the map and the one that the old points which it
/// showed give it by themselves. Zeros where too few of them are left.
Drift drift_left(const Map& map, const Parameters& parameters, const Loop& loop);

}  // namespace textslam

#endif  // TEXTSLAM_LOOP_LOOP_CLOSURE_HPP
