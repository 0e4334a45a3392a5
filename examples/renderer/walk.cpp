#include "renderer/walk.hpp"

#include <cmath>

#include "renderer/random.hpp"

namespace textslam {
namespace {

constexpr std::uint64_t kWalkStream = 20;
constexpr double kAside = 0.3, kAbove = 0.15;                          // m
constexpr double kTurn = 7 * 3.14159265358979323846 / 180, kLate = 8;  // rad, s
constexpr double kDark = 0.6, kBright = 1.4, kBias = 12;

}  // namespace

std::uint64_t seed_of_walk(std::uint64_t seed, int walk) {
  return walk == 0 ? seed : hash(seed, kWalkStream, static_cast<std::uint64_t>(walk));
}

void take_walk(std::uint64_t seed, Shot* shot) {
  Random random(seed);
  const double late = random.uniform(0, kLate);
  const Vector3<double> aside(random.uniform(-kAside, kAside), random.uniform(-kAside, kAside),
                              random.uniform(-kAbove, kAbove));
  const Vector3<double> turn(random.uniform(-kTurn, kTurn), random.uniform(-kTurn, kTurn),
                             random.uniform(-kTurn, kTurn));
  const double gain = random.uniform(kDark, kBright), bias = random.uniform(-kBias, kBias);
  shot->motion = [=, motion = shot->motion](double t) {
    SE3d T_w_c = motion(t + late);
    T_w_c.t += aside;
    T_w_c.R = T_w_c.R * textplane::so3_exp<double>(turn);
    return T_w_c;
  };
  shot->sensor = [=, sensor = shot->sensor](double t) {
    SensorState state = sensor(t);
    state.gain *= gain;
    state.bias += bias;
    return state;
  };
}

}  // namespace textslam
