// Boards that stand in a world made by formula, and a map of them.
#ifndef TESTS_TEXTSLAM_RELOCALISE_BOARDS_SUPPORT_HPP
#define TESTS_TEXTSLAM_RELOCALISE_BOARDS_SUPPORT_HPP

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "support/spots.hpp"
#include "textplane/features/select.hpp"
#include "textplane/geometry/plane.hpp"
#include "textslam/common/parameters.hpp"
#include "textslam/map/map.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/track/feature_tracks.hpp"

namespace textslam {
namespace boards_support {

constexpr double kDegree = M_PI / 180;

inline SE3d moved(const Vec3& t, const Vec3& w) { return {textplane::so3_exp<double>(w), t}; }
inline double turn_between(const SE3d& a, const SE3d& b) {
  return textplane::so3_log<double>(a.R * b.R.transpose()).norm();
}

// Three boards that stand in the world; the first key frame, at the origin, sees them all and hosts a text on each.
class TextRecoveryTest : public testing::Test {
 protected:
  struct Board {
    SE3d T_w_b;  // its x to the right, y down, z away from the reader
    unsigned print;
  };

  explicit TextRecoveryTest(const textplane::LensMap* lens = nullptr) {
    map.camera = {{262, 262, 159.5, 119.5}, lens};
    map.width = 320;
    map.height = 240;
    map.number = 0;
    boards = {{moved({-0.9, -0.2, 3}, {0, -0.5, 0}), 1},
              {moved({0.1, 0.5, 3.4}, {0.3, 0, 0}), 2},
              {moved({1.0, -0.4, 3.1}, {0, 0.4, 0.1}), 3}};
    map.keyframes.push_back({frame_at(SE3d{}), SE3d{}, {}});
    const char* const words[] = {"EXIT", "OPEN", "TAXI"};
    for (std::size_t i = 0; i < boards.size(); ++i) add_text(boards[i], 0, words[i]);
  }

  // A text on a board that key frame `host` sees.
  void add_text(const Board& board, int host, const std::string& word) {
    TextObject text;
    text.id = static_cast<int>(map.texts.size());
    text.state = TextState::mapped;
    text.host = host;
    const KeyFrame& keyframe = map.keyframes[static_cast<std::size_t>(host)];
    const SE3d T_h_w = keyframe.T_w_c.inverse(), T_h_b = T_h_w * board.T_w_b;
    const Vec3 normal = -T_h_b.R.col(2);
    text.theta = textplane::plane_from_normal<double>(normal, -normal.dot(T_h_b.t));
    textplane::SelectOptions options;
    options.levels = parameters.text.levels;
    text.patch = textplane::make_patch(keyframe.frame.image->view(), map.camera, quad_of(board, T_h_w), options);
    EXPECT_TRUE(textplane::is_ok(text.patch.status));
    text.votes[word] = 3;
    map.texts.push_back(std::move(text));
  }

  // Points on the boards, at the corners that a key frame sees.
  void add_points(int host) {
    std::vector<Track> corners;
    const KeyFrame& keyframe = map.keyframe(host);
    add_corners(keyframe.frame, map.camera, host, {}, parameters, corners);
    for (const Track& corner : corners)
      for (const Board& board : boards) {
        const SE3d T_b_c = board.T_w_b.inverse() * keyframe.T_w_c;
        const Vec3 ray = T_b_c.R * ray_of(map.camera, corner.px.cast<double>());
        const Vec3 p = T_b_c.t - T_b_c.t.z() / ray.z() * ray;
        if (!(std::abs(p.x()) <= kHalfWidth && std::abs(p.y()) <= kHalfHeight)) continue;
        map.points.push_back({board.T_w_b * p});
        add_observation(map, static_cast<int>(map.points.size()) - 1, host, corner.px.cast<double>());
        break;
      }
  }

  // Two boards more, without texts, and the points that the first key frame sees on all of them.
  void map_points_of_five_boards() {
    parameters = at_size(parameters, map.width, map.height);
    boards.push_back({moved({-0.3, -0.8, 3.3}, {0.1, 0.2, 0}), 4});
    boards.push_back({moved({-0.7, 0.7, 3.2}, {0.2, -0.1, 0}), 5});
    map.keyframes[0].frame = frame_at(SE3d{});
    add_points(0);
  }

  static constexpr double kHalfWidth = 0.35, kHalfHeight = 0.15;

  // Letters of a kind: random spots of 6 cm, other ones for each print.
  static double ink(double x, double y, unsigned print) {
    return textplane_test::between_spots(x / 0.06, y / 0.06, [print](int i, int j) {
      const auto column = static_cast<std::uint32_t>(i), row = static_cast<std::uint32_t>(j);
      return textplane_test::spot_number(column, row, print) % 2 == 0 ? 30.0 : 220.0;
    });
  }

  Quad<double> quad_of(const Board& board, const SE3d& T_c_w) const {
    Quad<double> quad;
    const double signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (std::size_t i = 0; i < 4; ++i)
      quad.corner[i] =
          map.camera.project(T_c_w * board.T_w_b * Vec3(signs[i][0] * kHalfWidth, signs[i][1] * kHalfHeight, 0));
    return quad;
  }

  // Boards before a plain wall.
  Frame frame_at(const SE3d& T_c_w) const {
    Image<std::uint8_t> image(map.width, map.height, 120);
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x)
        for (const Board& board : boards) {
          const SE3d T_b_c = (T_c_w * board.T_w_b).inverse();
          const Vec3 ray = T_b_c.R * ray_of(map.camera, Vec2(x, y));
          const Vec3 p = T_b_c.t - T_b_c.t.z() / ray.z() * ray;
          if (!(std::abs(p.x()) <= 1.1 * kHalfWidth && std::abs(p.y()) <= 1.1 * kHalfHeight)) continue;
          image(x, y) = static_cast<std::uint8_t>(ink(p.x(), p.y(), board.print));
        }
    Frame frame;
    frame.image = std::make_shared<const Pyramid>(image.view(), parameters.pyramid_levels);
    return frame;
  }

  // As a detector sees them: corners a pixel off.
  Detection detection(std::size_t board, const SE3d& T_c_w, const std::string& word) const {
    Detection d;
    d.quad = quad_of(boards[board], T_c_w);
    for (std::size_t i = 0; i < 4; ++i) d.quad.corner[i] += Vec2(i % 2 == 0 ? 1.0 : -0.6, i < 2 ? -0.8 : 0.7);
    d.text = word;
    return d;
  }

  void expect_pose(const SE3d& found, const SE3d& truth, double metres, double degrees) const {
    EXPECT_LT((found.inverse().t - truth.inverse().t).norm(), metres);
    EXPECT_LT(turn_between(found, truth) / kDegree, degrees);
  }

  Parameters parameters;
  Map map;
  std::vector<Board> boards;
};

}  // namespace boards_support
}  // namespace textslam

#endif  // TESTS_TEXTSLAM_RELOCALISE_BOARDS_SUPPORT_HPP
