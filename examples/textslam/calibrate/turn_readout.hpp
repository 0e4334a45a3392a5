// The readout of a rolling shutter by the turns of the camera alone: no map, no scale, nothing to begin with.
//
// A camera that turns faster and faster shears what it sees, and one that turns back shears it the other way. Between
// two neighbouring frames a point far away at row a in the first and b in the second turns by
//
//   r + readout (s_b omega_2 - s_a omega_1),  s: its row, as a share of the rows, from the middle one,
//
// r: the turn from middle row to middle row; omega_1 and omega_2 (rad/s), the camera's at the two frames, are means of
// neighbouring r. The way of the camera between the frames is of any length, as it moves points along epipolar lines
// only: errors count across these. Noise of the turns makes speeds differ that do not, so that the readout comes out
// too short, the more the steadier the camera turns; the map (Parameters::estimate_readout) goes on from there.
#ifndef TEXTSLAM_CALIBRATE_TURN_READOUT_HPP
#define TEXTSLAM_CALIBRATE_TURN_READOUT_HPP

#include <vector>

#include "textslam/common/geometry.hpp"

namespace textslam {

/// A corner that two frames show: its unit rays, and its rows, -1/2 at the first one and 1/2 at the last.
struct RayPair {
  Vec3 ray_a, ray_b;
  double row_a = 0, row_b = 0;
};

/// Two neighbouring frames, `seconds` apart. A pair's second frame is the first frame of the next pair.
struct FramePair {
  double seconds = 0;
  std::vector<RayPair> rays;
};

struct TurnReadout {
  bool determined = false;  ///< Longer than its sigma and errors of stamps and lens explain.
  double readout = 0;       ///< s, from the first row to the last: negative where the last comes first.
  double sigma = 0;         ///< s, by leaving out each tenth of the pairs in turn (jackknife).
  double turn = 0;          ///< Radians, from frame to frame, rms.
  double shear = 0;         ///< Radians, by which the readout moves what frames show, rms over their rows.
};

/// By Gauss-Newton over the readout, the turns, and the directions of the ways, robustly. Not determined with fewer
/// than 30 pairs of 30 corners that have such neighbours on both sides; a pair with numbers that are not finite is
/// passed over.
TurnReadout readout_of_turns(const std::vector<FramePair>& pairs);

}  // namespace textslam

#endif  // TEXTSLAM_CALIBRATE_TURN_READOUT_HPP
