// Maps of signs by formula, without images: what two maps are compared by.
#ifndef TESTS_MAP_FILE_SIGNS_SUPPORT_HPP
#define TESTS_MAP_FILE_SIGNS_SUPPORT_HPP

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "io/evaluate.hpp"
#include "textplane/geometry/plane.hpp"
#include "textslam/map/map.hpp"
#include "textslam/relocalise/boards_support.hpp"

namespace textslam {
namespace signs_support {

struct Sign {
  std::string word;
  SE3d T_w_s;  // its x to the right, y down, z into the wall
  double width = 0.5, height = 0.2;
};

using boards_support::moved;

// A camera 1.5 to 2 units before each sign hosts it. With noise the boxes err by `px`, the planes by `plane`, as their
// covariances say.
class MapMaker {
 public:
  explicit MapMaker(unsigned seed) : random_(seed) {}
  double noise(double sigma) { return sigma > 0 ? std::normal_distribution<double>(0, sigma)(random_) : 0; }
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  /// The map in a world of its own: S maps the signs' world to it.
  Map map_of(const std::vector<Sign>& signs, const Similarity& S = {}, double px = 0, double plane = 0) {
    constexpr double kPlaneSigma = 0.01;
    Map map;
    map.camera = {{262, 262, 159.5, 119.5}, nullptr};
    for (const Sign& sign : signs) {
      const SE3d T_s_h = moved({uniform(-0.2, 0.2), uniform(-0.2, 0.2), -uniform(1.5, 2)}, {0, uniform(-0.2, 0.2), 0});
      const SE3d T_w_h = sign.T_w_s * T_s_h, T_h_s = T_s_h.inverse();
      TextObject text;
      text.id = static_cast<int>(map.texts.size());
      text.host = static_cast<int>(map.keyframes.size());
      text.state = TextState::mapped;
      text.votes[sign.word] = 2;
      text.patch.camera = map.camera.pinhole;
      const Vec3 normal = -T_h_s.R.col(2);
      text.theta = textplane::plane_from_normal<double>(normal, -normal.dot(T_h_s.t));
      const double signs_of[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
      for (std::size_t k = 0; k < 4; ++k)
        text.patch.quad.corner[k] =
            map.camera.project(T_h_s * Vec3(signs_of[k][0] * sign.width / 2, signs_of[k][1] * sign.height / 2, 0)) +
            Vec2(noise(px), noise(px));
      const double sigma = kPlaneSigma * text.theta.norm();
      text.covariance = sigma * sigma * Eigen::Matrix3d::Identity();
      for (int i = 0; i < 3; ++i) text.theta[i] += noise(plane * sigma);
      text.theta /= S.scale;
      text.covariance /= S.scale * S.scale;
      map.keyframes.push_back({});
      map.keyframes.back().T_w_c = S * T_w_h;
      map.texts.push_back(text);
    }
    return map;
  }

  /// Signs on the four walls of a room of 8 by 6.
  std::vector<Sign> room(const std::vector<std::string>& words) {
    std::vector<Sign> signs;
    for (const std::string& word : words) {
      const int wall = static_cast<int>(random_() % 4);
      const double along = uniform(-3, 3), high = uniform(-1, 0.5), turn = M_PI / 2 * wall;
      const SE3d T_wall = moved({0, 0, 0}, {0, turn, 0});
      signs.push_back({word, T_wall * moved({along, high, wall % 2 == 0 ? 3.0 : 4.0}, {0, 0, 0}), uniform(0.3, 0.8),
                       uniform(0.12, 0.25)});
    }
    return signs;
  }

 private:
  std::mt19937 random_;
};

}  // namespace signs_support
}  // namespace textslam

#endif  // TESTS_MAP_FILE_SIGNS_SUPPORT_HPP
