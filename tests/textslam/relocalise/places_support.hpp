// The corner of a room made by formula, and a map of points in it.
#ifndef TESTS_TEXTSLAM_RELOCALISE_PLACES_SUPPORT_HPP
#define TESTS_TEXTSLAM_RELOCALISE_PLACES_SUPPORT_HPP

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "support/spots.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/relocalise/boards_support.hpp"
#include "textslam/relocalise/relocalisation.hpp"
#include "textslam/track/feature_tracks.hpp"

namespace textslam {
namespace places_support {

using boards_support::kDegree;
using boards_support::moved;
using boards_support::turn_between;

// The corner of a room, papered with spots of several sizes; two key frames, and points on what they see.
class PlacesTest : public testing::Test {
 protected:
  explicit PlacesTest(const textplane::LensMap* lens = nullptr) {
    parameters.mode = Mode::points;
    parameters = at_size(parameters, 640, 480);
    map.camera = {{525, 525, 319.5, 239.5}, lens};
    map.width = 640;
    map.height = 480;
    map.number = 0;
    for (const double x : {0.0, 0.15}) {
      const SE3d T_w_c = moved({x, 0, 0}, {0, 0, 0});
      map.keyframes.push_back({frame_at(T_w_c.inverse()), T_w_c, {}});
    }
    std::vector<Track> corners;
    add_corners(map.keyframe(0).frame, map.camera, 0, {}, parameters, corners);
    for (const Track& corner : corners) {
      const Vec3 p = hit(Vec3::Zero(), ray_of(map.camera, corner.px.cast<double>()), nullptr);
      const Vec2 other = map.camera.project(map.keyframe(1).T_w_c.inverse() * p);
      if (!(other.x() > 20 && other.x() < 620)) continue;
      map.points.push_back({p});
      const int id = static_cast<int>(map.points.size()) - 1;
      add_observation(map, id, 0, corner.px.cast<double>());
      add_observation(map, id, 1, other);
    }
  }

  static double smooth(double u, double v, unsigned print) {
    return textplane_test::between_spots(u, v, [print](int i, int j) {
      const auto column = static_cast<std::uint32_t>(i), row = static_cast<std::uint32_t>(j);
      return static_cast<double>(textplane_test::spot_number(column, row, print) % 256);
    });
  }

  // Two walls and the floor: the first that the ray meets.
  Vec3 hit(const Vec3& from, const Vec3& ray, double* grey) const {
    const Vec3 normals[] = {Vec3(0.6, 0, 0.8), Vec3(-0.7, 0, 0.714), Vec3(0, 1, 0)};
    const double offsets[] = {2.6, 2.4, 0.9};
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
      const double along = (offsets[i] - normals[i].dot(from)) / normals[i].dot(ray);
      if (!(along > 0) || along >= nearest) continue;
      nearest = along;
      if (!grey) continue;
      const Vec3 p = from + along * ray;
      const double u = i == 2 ? p.x() : p.cross(normals[i]).y(), v = i == 2 ? p.z() : p.y();
      const auto print = paper + 7 * static_cast<unsigned>(i);
      *grey = 0.5 * smooth(u / 0.04, v / 0.04, print) + 0.5 * smooth(u / 0.11, v / 0.11, print + 3);
    }
    return from + nearest * ray;
  }

  Frame frame_at(const SE3d& T_c_w) const {
    Image<std::uint8_t> image(map.width, map.height, 0);
    const SE3d T_w_c = T_c_w.inverse();
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) {
        double grey = 0;
        hit(T_w_c.t, T_w_c.R * ray_of(map.camera, Vec2(x, y)), &grey);
        image(x, y) = static_cast<std::uint8_t>(grey);
      }
    Frame frame;
    frame.image = std::make_shared<const Pyramid>(image.view(), parameters.pyramid_levels);
    return frame;
  }

  // A camera that has gone round the middle of the scene by `turn`, is `nearer` times as near, and is rolled.
  static SE3d around(double turn, double nearer, double roll) {
    const Vec3 middle(0.1, 0, 3);
    const Eigen::Matrix3d R =
        textplane::so3_exp<double>(Vec3(0, turn, 0)) * textplane::so3_exp<double>(Vec3(0, 0, roll));
    return SE3d{R, middle - R * middle / nearer}.inverse();
  }

  void expect_found(const SE3d& truth) {
    SCOPED_TRACE(testing::Message() << truth.inverse().t.transpose());
    const Relocalisation found = relocalise(map, parameters, frame_at(truth));
    ASSERT_TRUE(found.ok);
    EXPECT_LT((found.T_c_w.inverse().t - truth.inverse().t).norm(), 0.01);
    EXPECT_LT(turn_between(found.T_c_w, truth) / kDegree, 0.2);
  }

  Parameters parameters;
  Map map;
  unsigned paper = 1;
};

}  // namespace places_support
}  // namespace textslam

#endif  // TESTS_TEXTSLAM_RELOCALISE_PLACES_SUPPORT_HPP
