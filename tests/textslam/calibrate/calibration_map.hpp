// A map of known points, seen by known cameras, that calibration is tested with.
#ifndef TESTS_TEXTSLAM_CALIBRATE_CALIBRATION_MAP_HPP
#define TESTS_TEXTSLAM_CALIBRATE_CALIBRATION_MAP_HPP

#include <cmath>
#include <random>
#include <vector>

#include "io/camera_model.hpp"
#include "textslam/scene_support.hpp"

namespace textslam {
namespace calibration_map {

inline CameraModel model_of(const textplane::AnyCamera<double>& raw) {
  CameraModel out;
  out.raw = raw;
  out.width = 640;
  out.height = 480;
  return out;
}
inline CameraModel lens(double f, double k1, double k2, double cx = 319.5) {
  return model_of(textplane::RadialTangential<double>{{f, f, cx, 239.5}, k1, k2, 0, 0, 0});
}

/// Key frames about 300 points. Each is seen by a camera of its own, with an even error of up to .2 px. The path is as
/// long for any number of them.
struct CalibrationMap {
  Map map;

  explicit CalibrationMap(const std::vector<CameraModel>& cameras, bool turning = true) {
    std::mt19937 random(5);
    map.width = cameras.front().width;
    map.height = cameras.front().height;
    const int count = static_cast<int>(cameras.size());
    for (int i = 0; i < count; ++i) {
      KeyFrame keyframe;
      const double s = 12.0 * i / count, a = turning ? 0.05 * s : 0;
      const SE3d T_c_w =
          scene_support::moved({-0.15 * s, 0.1 * std::sin(1.7 * s), 0.05 * s}, {0.3 * a, a, 0.5 * std::sin(9 * a)});
      keyframe.frame.index = i;
      keyframe.T_w_c = T_c_w.inverse();
      map.keyframes.push_back(keyframe);
    }
    const auto error = [&random] { return scene_support::uniform(random, -0.2, 0.2); };
    for (const Vec3& p : scene_support::scene(300, false, random)) {
      MapPoint point{p};
      for (int i = 0; i < count; ++i) {
        const CameraModel& camera = cameras[static_cast<std::size_t>(i)];
        const Vec3 p_c = map.keyframe(i).T_w_c.inverse() * p;
        if (p_c.z() < 0.5 || !camera.raw.in_domain(p_c)) continue;
        const double x = error(), y = error();
        const Vec2 px = camera.project(p_c) + Vec2(x, y);
        if (px.x() < 0 || px.y() < 0 || px.x() > 639 || px.y() > 479) continue;
        point.observations.push_back({i, px});
        map.keyframe(i).points.push_back(static_cast<int>(map.points.size()));
      }
      map.points.push_back(point);
    }
  }
};

}  // namespace calibration_map
}  // namespace textslam

#endif  // TESTS_TEXTSLAM_CALIBRATE_CALIBRATION_MAP_HPP
