// Recovery trials: whether PlaneTracker finds a plane again that was covered or jumped, and what it says meanwhile.
#ifndef TEXTPLANE_EXAMPLES_RECOVERY_HPP
#define TEXTPLANE_EXAMPLES_RECOVERY_HPP

#include <cstdint>

#include "planar/plane_video.hpp"

namespace planar {

/// Of one kind of trials. A frame counts as found where the pose is said to be good and the corners are within 5 px.
struct Recovery {
  int trials = 0;
  int found = 0;         ///< Trials in which the plane was found within kRecoveryFrames, at an annotated frame.
  int judged = 0;        ///< Frames that were annotated, or in which all of the plane is covered.
  int good = 0;          ///< Those said to be good, and
  int wrong = 0;         ///< those of them that are not within 5 px or covered.
  double slowest = 0;    ///< ms of CPU time, the slowest frame.
  double searching = 0;  ///< ms, of all frames that were not good.
  int searches = 0;      ///< Their number.
};

constexpr int kRecoveryFrames = 5;  ///< In which a plane is to be found again.
constexpr double kFound = 5;        ///< px, mean over the corners: what the benchmark scores with.

/// `share` of the plane is covered for `covered` frames by a rectangle of print that moves with it, after five frames
/// that it was followed in from a random annotated frame. The video goes on meanwhile.
Recovery cover(const PlaneVideo& video, int trials, int covered, double share, std::uint64_t seed);

/// Frames are left out after the plane was followed for five, so that its corners move by `least` to `most` px on
/// average between two frames.
Recovery jump(const PlaneVideo& video, int trials, double least, double most, std::uint64_t seed);

}  // namespace planar

#endif  // TEXTPLANE_EXAMPLES_RECOVERY_HPP
