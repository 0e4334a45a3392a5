// Motions: smooth camera paths as functions of time, camera to world.
#ifndef TEXTSLAM_RENDERER_MOTION_HPP
#define TEXTSLAM_RENDERER_MOTION_HPP

#include <cstdint>
#include <functional>
#include <vector>

#include "io/names.hpp"

namespace textslam {

/// T_w_c at a time in seconds.
using Motion = std::function<SE3d(double)>;

/// A camera in the head of a walker: yaw turns right from +y, pitch up, roll clockwise (radians).
struct Look {
  Vector3<double> position = Vector3<double>::Zero();
  double yaw = 0.0, pitch = 0.0, roll = 0.0;
};
SE3d pose_of(const Look& look);

/// The tremor of a hand: sums of sines of 0.9 to 2.9 Hz, about 3 mm and 0.15 degrees (rms of each axis), from the seed.
class Tremor {
 public:
  explicit Tremor(std::uint64_t seed, double strength = 1.0);
  void apply(double t, Look& look) const;

 private:
  struct Wave {
    double amplitude, frequency, phase;
  };
  std::vector<Wave> waves_;  // kWaves for each of six axes
};

/// 0 before `start`, 1 after start + duration; between them the quintic with zero speed and acceleration at both ends.
double smooth_step(double t, double start, double duration);

/// The loop of the room: an ellipse of 2.2 m by 1 m in eight seconds, looking at the far wall and the walls beside it.
Motion room_motion(std::uint64_t seed);
/// The same with `pause` seconds of standing still at its start.
Motion still_then_room_motion(std::uint64_t seed, double pause);
/// The loop of the room, slower, with quick turns of the camera.
Motion rapid_motion(std::uint64_t seed);
/// Once round the middle of the room in eleven seconds, looking across it at one wall after the other until the first
/// one is seen again.
Motion loop_motion(std::uint64_t seed);
/// A walk along +y and, after more than eight seconds, back again.
Motion corridor_motion(std::uint64_t seed);

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_MOTION_HPP
