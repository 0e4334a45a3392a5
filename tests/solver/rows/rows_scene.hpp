// A wall with a pattern, and clouds of points, before cameras with rolling shutters.
#ifndef TEXTPLANE_TESTS_SOLVER_ROWS_SCENE_HPP
#define TEXTPLANE_TESTS_SOLVER_ROWS_SCENE_HPP

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/random.hpp"
#include "textplane/features/select.hpp"

namespace textplane_test {
namespace rows {

namespace tp = textplane;

const tp::CameraView kCamera(260, 262, 159.5, 119.5);
const tp::RollingShutter kShutter{0.03, 119.5, 240};
constexpr int kWidth = 320, kHeight = 240;

inline double distance(const tp::SE3d& a, const tp::SE3d& b) { return tp::se3_log<double>(a * b.inverse()).norm(); }

// The plane z = 2 of the world with a pattern on it.
inline double pattern(double x, double y) {
  return 128 + 40 * std::sin(31 * x + 4 * y) + 35 * std::cos(27 * y - 6 * x) + 25 * std::sin(13 * x + 17 * y + 1);
}

// What a camera at T_c_w sees of it while its rows are taken.
inline tp::Image<std::uint8_t> picture(const tp::SE3d& T_c_w, const tp::RowMotion& rows) {
  tp::Image<std::uint8_t> image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    const tp::SE3d T_w_c = (rows.at(y) * T_c_w).inverse();
    for (int x = 0; x < kWidth; ++x) {
      const tp::Vector3<double> d = T_w_c.R * kCamera.pinhole.unproject(tp::Vector2<double>(x, y));
      const tp::Vector3<double> p = T_w_c.t + (2 - T_w_c.t[2]) / d[2] * d;
      image(x, y) = static_cast<std::uint8_t>(std::lround(std::min(255.0, std::max(0.0, pattern(p[0], p[1])))));
    }
  }
  return image;
}

struct Views {
  tp::SE3d T_h_w, T_t_w;
  tp::RowMotion host, target;
  tp::Vector3<double> theta;  // in the host

  explicit Views(unsigned seed) {
    Random random(seed);
    T_h_w = tp::se3_exp<double>(random.twist(0.1, 0.05));
    T_t_w = tp::se3_exp<double>(random.twist(0.2, 0.08));
    host = {random.twist(0.6, 0.6), kShutter};
    target = {random.twist(0.6, 0.6), kShutter};
    theta = tp::reanchor_plane<double>({0, 0, 0.5}, T_h_w);
  }
  tp::SE3d T_t_h() const { return T_t_w * T_h_w.inverse(); }
};

const tp::Quad<double> kQuad{{tp::Vector2<double>(100, 70), tp::Vector2<double>(210, 75), tp::Vector2<double>(208, 120),
                              tp::Vector2<double>(98, 115)}};

inline std::vector<tp::Vector3<double>> cloud(Random& random, int n) {
  std::vector<tp::Vector3<double>> points;
  for (int i = 0; i < n; ++i) {
    const double z = random.uniform(1.5, 4);
    points.push_back({z * random.uniform(-0.4, 0.4), z * random.uniform(-0.3, 0.3), z});
  }
  return points;
}

}  // namespace rows
}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SOLVER_ROWS_SCENE_HPP
