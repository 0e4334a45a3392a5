#include "renderer/exposure.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace textslam {

namespace {

constexpr double kFootprint = 0.5;  // px: the distance of the grid's samples
constexpr int kMostInstants = 32;
constexpr double kStill = 0.2;  // px: blur that does not show

/// How far the images of scene points move in `duration` seconds about `middle` (px).
std::vector<Vector2<double>> displacements(const Scene& scene, const CameraModel& camera, const Motion& motion,
                                           double middle, double duration) {
  const SE3d T_w_c = motion(middle);
  const SE3d before = motion(middle - 0.5 * duration).inverse(), after = motion(middle + 0.5 * duration).inverse();
  std::vector<Vector2<double>> moves;
  constexpr int kColumns = 8, kRows = 6;
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const Vector2<double> px((i + 0.5) / kColumns * camera.width - 0.5, (j + 0.5) / kRows * camera.height - 0.5);
      Vector3<double> m;
      if (!ray_of(camera, px, &m)) continue;
      const Vector3<double> direction = T_w_c.R * m;
      const Hit hit = scene.first_hit(T_w_c.t, direction, middle);
      if (hit.surface < 0) continue;
      const Vector3<double> p = T_w_c.t + hit.distance * direction;
      const Surface& surface = scene.surfaces()[static_cast<std::size_t>(hit.surface)];
      const Vector3<double> p_before = surface.carried(p, middle, middle - 0.5 * duration);
      const Vector3<double> p_after = surface.carried(p, middle, middle + 0.5 * duration);
      Vector2<double> a, b;
      if (project(camera, before, p_before, &a) && project(camera, after, p_after, &b)) moves.push_back(b - a);
    }
  }
  return moves;
}

}  // namespace

std::vector<Vector2<double>> pixel_grid() { return {{-0.25, -0.25}, {0.25, -0.25}, {-0.25, 0.25}, {0.25, 0.25}}; }

std::vector<double> exposure_times(double middle, double exposure, int n) {
  std::vector<double> times;
  for (int i = 0; i < n; ++i) times.push_back(middle + exposure * (2 * i + 1 - n) / (2.0 * n));
  return times;
}

Blur blur_of(const Scene& scene, const CameraModel& camera, const Motion& motion, double middle, double exposure) {
  std::vector<double> lengths;
  for (const Vector2<double>& move : displacements(scene, camera, motion, middle, exposure))
    lengths.push_back(move.norm());
  if (lengths.empty()) return {};
  std::sort(lengths.begin(), lengths.end());
  return {lengths[lengths.size() / 2], lengths.back()};
}

Vector2<double> image_direction(const Scene& scene, const CameraModel& camera, const Motion& motion, double time) {
  constexpr double kMoment = 1e-3;  // s
  Vector2<double> sum = Vector2<double>::Zero();
  for (const Vector2<double>& move : displacements(scene, camera, motion, time, kMoment)) sum += move;
  return sum.norm() > 1e-9 ? sum.normalized() : Vector2<double>::UnitX();
}

int instants_for(double blur) {
  const int wanted = static_cast<int>(std::ceil(1.2 * blur / 8.0)) * 8;
  return blur < kStill ? 4 : std::clamp(wanted, 8, kMostInstants);
}

int sample_at(int instant) { return instant % 8 < 4 ? instant % 4 : 3 - instant % 4; }

Image<double> expose(const Scene& scene, const RayCaster& caster, const Motion& motion, double middle, double exposure,
                     int instants) {
  if (caster.offsets() != 4 || instants < 4 || instants % 4 != 0) {
    throw std::invalid_argument("an exposure takes a multiple of four instants and the four samples of pixel_grid()");
  }
  Image<double> sum(caster.camera().width, caster.camera().height);
  const std::vector<double> times = exposure_times(middle, exposure, instants);
  const textplane::RollingShutter& shutter = caster.camera().shutter;
  for (int i = 0; i < instants; ++i) {
    const double time = times[static_cast<std::size_t>(i)];
    const int at_once = shutter.active() ? 1 : caster.camera().height;
    for (int row = 0; row < caster.camera().height; row += at_once) {
      const double then = time + shutter.time(row);
      caster.add_rows(scene, motion(then), sample_at(i), kFootprint, 1.0 / instants, row, row + at_once, sum, then);
    }
  }
  return sum;
}

}  // namespace textslam
