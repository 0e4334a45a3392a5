// A wall three units away with a sign about its origin, as a camera beside it sees it.
#ifndef TESTS_LANDMARKS_WALL_SUPPORT_HPP
#define TESTS_LANDMARKS_WALL_SUPPORT_HPP

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "support/spots.hpp"
#include "textplane/core/cameras/pinhole.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/photometry/pyramid.hpp"

namespace landmarks_test {

constexpr int kWallWidth = 320, kWallHeight = 240;
constexpr double kHalfWidth = 0.3, kHalfHeight = 0.12;

// Random spots of 3 cm, linear between them.
inline double ink(double x, double y) {
  const auto index = [](int i) { return static_cast<std::uint32_t>(i + 1000); };
  return textplane_test::between_spots(x / 0.03, y / 0.03, [&](int i, int j) {
    return textplane_test::spot_number(index(i), index(j)) % 2 == 0 ? 30.0 : 220.0;
  });
}

class Wall {
 public:
  const textplane::Pinhole<double> camera{262, 262, 159.5, 119.5};
  std::function<double(double)> relief;  // at x, away from the camera

  // Beside the axis by x, walked up to the wall by z, and turned to the sign's middle.
  static textplane::SE3d at(double x, double z, double y = 0.05) {
    const Eigen::Vector3d forward = (Eigen::Vector3d(0, 0, 3) - Eigen::Vector3d(x, y, z)).normalized(),
                          right = Eigen::Vector3d(0, 1, 0).cross(forward).normalized();
    textplane::SE3d T_w_c;
    T_w_c.R << right, forward.cross(right), forward;
    T_w_c.t = {x, y, z};
    return T_w_c;
  }

  textplane::Quad<double> quad_in(const textplane::SE3d& T_w_c) const {
    const Eigen::Vector2d signs[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    textplane::Quad<double> quad;
    for (std::size_t i = 0; i < 4; ++i)
      quad.corner[i] =
          camera.project(T_w_c.inverse() * Eigen::Vector3d(signs[i].x() * kHalfWidth, signs[i].y() * kHalfHeight, 3));
    return quad;
  }

  // A pixel is the mean over it, then over so many pixels to its right and left, for blur, with a sensor's noise.
  std::shared_ptr<const textplane::Pyramid> render(const textplane::SE3d& T_w_c, int blur, int levels) {
    constexpr int kSamples = 3, kNoise = 8;  // grey levels, at most
    textplane::Image<std::uint8_t> image(kWallWidth, kWallHeight);
    std::vector<double> row(static_cast<std::size_t>(kWallWidth + 2 * blur));
    for (int y = 0; y < kWallHeight; ++y) {
      for (int x = -blur; x < kWallWidth + blur; ++x) {
        double sum = 0;
        for (int k = 0; k < kSamples * kSamples; ++k) {
          const Eigen::Vector2d px(x + (k % kSamples - 1) / 3.0, y + (k / kSamples - 1) / 3.0);
          const Eigen::Vector3d ray = T_w_c.R * camera.unproject(px);
          Eigen::Vector3d p = T_w_c.t + (3 - T_w_c.t.z()) / ray.z() * ray;
          for (int i = 0; relief && i < 20; ++i) {
            const Eigen::Vector3d next = T_w_c.t + (3 + relief(p.x()) - T_w_c.t.z()) / ray.z() * ray;
            if (next == p) break;  // so it stays
            p = next;
          }
          const bool meets = ray.z() > 0 && p.norm() < 1e6;  // not so where a ray runs along a bent wall
          sum += meets ? ink(p.x(), p.y()) : 0;
        }
        row[static_cast<std::size_t>(x + blur)] = sum / (kSamples * kSamples);
      }
      for (int x = 0; x < kWallWidth; ++x) {
        double sum = 0;
        for (int k = 0; k <= 2 * blur; ++k) sum += row[static_cast<std::size_t>(x + k)];
        image.view().row(y)[x] = static_cast<std::uint8_t>(std::lround(sum / (2 * blur + 1)) - kNoise +
                                                           static_cast<int>(random_() % (2 * kNoise + 1)));
      }
    }
    return std::make_shared<const textplane::Pyramid>(image.view(), levels);
  }

 private:
  std::mt19937 random_{1};
};

}  // namespace landmarks_test

#endif  // TESTS_LANDMARKS_WALL_SUPPORT_HPP
