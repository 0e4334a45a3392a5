#include <cmath>

#include "renderer/furniture.hpp"
#include "renderer/kinds.hpp"
#include "renderer/random.hpp"

namespace textslam {

namespace {

constexpr double kHalfTurn = 3.14159265358979323846;
constexpr double kReach = 1.8;   // m to either side of the middle of the room
constexpr double kTurned = 0.7;  // rad: how far a walker turns to where he goes
constexpr double kRound = 0.985;

/// To and fro along x at this distance from the camera's end of the room; `phase` 0: in the middle at first.
Motion walk(double y, double speed, double phase) {
  return [=](double t) {
    // A triangle wave with rounded turns.
    const double w = 0.5 * kHalfTurn * speed / kReach * t + phase, s = kRound * std::sin(w);
    const double yaw = kTurned * std::cos(w) / std::sqrt(1.0 - s * s);
    SE3d T_w_b;
    T_w_b.R << std::cos(yaw), -std::sin(yaw), 0.0, std::sin(yaw), std::cos(yaw), 0.0, 0.0, 0.0, 1.0;
    T_w_b.t = {kReach * std::asin(s) / std::asin(kRound), y, 0.02 * std::sin(2.0 * kHalfTurn * 1.8 * t + phase)};
    return T_w_b;
  };
}

}  // namespace

void add_crowd(Scene& scene, std::uint64_t seed) {
  constexpr double kRows[] = {0.8, 1.0, 1.2};  // m along y; the camera comes as near as y = -.25
  std::uint64_t k = 0;
  const auto draw = [&](double low, double high) { return low + (high - low) * unit(hash(seed, 600, ++k)); };
  const auto sides = [&](double w, double h) {
    const double shade = draw(70.0, 170.0);
    return later(plaster, w, h, shade, 1.6, hash(seed, 601, k));
  };
  const auto front = [&](double w, double h) {
    const int style = 1 + static_cast<int>(draw(0.0, 3.0));
    return later(picture, w, h, style, hash(seed, 602, k));
  };
  for (int i = 0; i < 3; ++i) {
    const std::size_t first = scene.surfaces().size();
    const double height = draw(1.65, 1.85), speed = draw(0.5, 1.5), shift = draw(-0.4, 0.4);
    add_box(scene, Vector3<double>::Zero(), {0.42, 0.22, height}, 0.0, front, sides);
    const double leftwards = draw(0.0, 1.0) < 0.5 ? kHalfTurn : 0.0;
    scene.carry(first, walk(kRows[i], speed, shift + leftwards + (i < 2 ? 0.0 : 0.5 * kHalfTurn)));
  }
}

}  // namespace textslam
