#include "renderer/motion.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/random.hpp"

namespace textslam {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kWaves = 3;

Look room_look(double t, double phase) {
  const double w = 2.0 * kPi / 8.0 * t;
  Look look;
  look.position = {1.1 * std::sin(w), -0.75 - 0.5 * std::cos(w), 1.45 + 0.12 * std::sin(1.3 * w + phase)};
  look.yaw = -0.68 * std::sin(w - 0.3) + 0.06 * std::sin(2.0 * w + 0.4 * phase);
  look.pitch = -0.04 + 0.07 * std::sin(1.7 * w + phase);
  look.roll = 0.03 * std::sin(0.9 * w + phase);
  return look;
}

/// A quick turn and, later, back.
double flick(double t, double there, double back, double duration) {
  return smooth_step(t, there, duration) - smooth_step(t, back, duration);
}

}  // namespace

SE3d pose_of(const Look& look) {
  const double cp = std::cos(look.pitch);
  const Vector3<double> forward(std::sin(look.yaw) * cp, std::cos(look.yaw) * cp, std::sin(look.pitch));
  const Vector3<double> level = forward.cross(Vector3<double>::UnitZ()).normalized();
  const Vector3<double> plumb = forward.cross(level);
  SE3d T_w_c;
  T_w_c.R.col(0) = std::cos(look.roll) * level + std::sin(look.roll) * plumb;
  T_w_c.R.col(1) = forward.cross(T_w_c.R.col(0));
  T_w_c.R.col(2) = forward;
  T_w_c.t = look.position;
  return T_w_c;
}

Tremor::Tremor(std::uint64_t seed, double strength) {
  Random random(seed);
  for (int axis = 0; axis < 6; ++axis) {
    const double amplitude = strength * (axis < 3 ? 0.0025 : 0.0022);
    for (int k = 0; k < kWaves; ++k) {
      waves_.push_back(
          {amplitude * random.uniform(0.6, 1.2), random.uniform(0.9, 2.9), random.uniform(0.0, 2.0 * kPi)});
    }
  }
}

void Tremor::apply(double t, Look& look) const {
  double axis[6];
  for (int i = 0; i < 6; ++i) {
    axis[i] = 0.0;
    for (int k = 0; k < kWaves; ++k) {
      const Wave& w = waves_[static_cast<std::size_t>(i * kWaves + k)];
      axis[i] += w.amplitude * std::sin(2.0 * kPi * w.frequency * t + w.phase);
    }
  }
  look.position += Vector3<double>(axis[0], axis[1], axis[2]);
  look.yaw += axis[3];
  look.pitch += axis[4];
  look.roll += axis[5];
}

double smooth_step(double t, double start, double duration) {
  const double a = std::clamp((t - start) / duration, 0.0, 1.0);
  return a * a * a * (10.0 + a * (6.0 * a - 15.0));
}

Motion room_motion(std::uint64_t seed) { return still_then_room_motion(seed, 0.0); }

Motion still_then_room_motion(std::uint64_t seed, double pause) {
  const Tremor tremor(seed);
  const double phase = 2.0 * kPi * unit(hash(seed, 1));
  return [=](double t) {
    // After the pause the clock of the path starts with a run-up of half a second: integral of a smooth step.
    double clock = t;
    if (pause > 0.0) {
      const double run = 0.5, a = std::clamp((t - pause) / run, 0.0, 1.0);
      clock = run * a * a * a * a * (2.5 - 3.0 * a + a * a) + std::max(0.0, t - pause - run);
    }
    Look look = room_look(clock, phase);
    tremor.apply(clock, look);
    return pose_of(look);
  };
}

Motion rapid_motion(std::uint64_t seed) {
  const Tremor tremor(seed);
  const double phase = 2.0 * kPi * unit(hash(seed, 1));
  return [=](double t) {
    Look look = room_look(0.75 * t, phase);
    // Every eight seconds: three turns there and back, one of them with a nod.
    const double s = std::fmod(t, 8.0);
    look.yaw += 0.42 * flick(s, 2.1, 3.2, 0.55) - 0.34 * flick(s, 4.2, 5.1, 0.5) + 0.26 * flick(s, 6.2, 7.2, 0.45);
    look.pitch += 0.14 * flick(s, 4.2, 5.1, 0.5) - 0.18 * flick(s, 6.2, 7.2, 0.45);
    tremor.apply(t, look);
    return pose_of(look);
  };
}

Motion loop_motion(std::uint64_t seed) {
  const Tremor tremor(seed);
  const double phase = 2.0 * kPi * unit(hash(seed, 1));
  return [=](double t) {
    const double w = 2.0 * kPi / 11.0 * t;
    Look look;
    look.position = {-0.95 * std::sin(w), -0.8 * std::cos(w), 1.45 + 0.1 * std::sin(1.4 * t + phase)};
    look.yaw = w + 0.1 * std::sin(1.1 * t + phase);
    look.pitch = -0.04 + 0.05 * std::sin(1.3 * t + phase);
    look.roll = 0.03 * std::sin(0.7 * t + phase);
    tremor.apply(t, look);
    return pose_of(look);
  };
}

Motion corridor_motion(std::uint64_t seed) {
  const Tremor tremor(seed, 1.3);
  const double phase = 0.6 * (unit(hash(seed, 1)) - 0.5);
  return [=](double t) {
    // A triangle wave with rounded turns: 1.2 m/s between y = 0.8 m and 10.6 m.
    const double period = 17.2, w = 2.0 * kPi * t / period - 1.42;
    const double walk = std::asin(0.985 * std::sin(w)) / std::asin(0.985);
    Look look;
    look.position = {0.28 * std::sin(0.9 * t + 0.5 + phase), 5.8 + 5.0 * walk,
                     1.5 + 0.025 * std::sin(2.0 * kPi * 1.7 * t)};
    look.yaw = 0.4 * std::sin(1.35 * t + phase);
    look.pitch = -0.03 + 0.04 * std::sin(0.8 * t + 1.0);
    look.roll = 0.02 * std::sin(1.1 * t);
    tremor.apply(t, look);
    return pose_of(look);
  };
}

}  // namespace textslam
