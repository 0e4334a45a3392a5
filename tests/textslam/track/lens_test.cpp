// Corners and points in images behind a lens.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "support/spots.hpp"
#include "textslam/lens_support.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/scene_support.hpp"
#include "textslam/track/feature_tracks.hpp"
#include "textslam/track/observe_points.hpp"
#include "textslam/track/point_mapper.hpp"
#include "textslam/track/point_search.hpp"

namespace textslam {
namespace track_lens_test {

using namespace scene_support;

// Spots all over the image.
Frame spots(int width, int height, int shift) {
  Image<std::uint8_t> image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image(x, y) =
          static_cast<std::uint8_t>(textplane_test::between_spots((x - shift) / 9.0, y / 9.0, [](int i, int j) {
            return textplane_test::spot_number(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)) % 2 == 0
                       ? 40.0
                       : 210.0;
          }));
  Frame frame;
  frame.image = std::make_shared<const Pyramid>(image.view(), Parameters().pyramid_levels);
  return frame;
}

// A fisheye's image has corners where it has no rays: those are not taken, and tracks that come there end.
TEST(FeatureTracks, StayWhereTheLensHasRays) {
  const CameraView fisheye({190, 190, 319.5, 239.5}, &lens_support::fisheye());
  const Parameters parameters;
  const Frame frame = spots(640, 480, 0), next = spots(640, 480, 4);
  std::vector<Track> seen, all;
  add_corners(frame, fisheye, 0, {}, parameters, seen);
  add_corners(frame, fisheye.pinhole, 0, {}, parameters, all);
  const auto has_none = [&](const Track& track) { return !has_ray(fisheye, track.px.cast<double>()); };
  EXPECT_GT(seen.size(), 100u);
  EXPECT_TRUE(std::none_of(seen.begin(), seen.end(), has_none));
  ASSERT_GT(std::count_if(all.begin(), all.end(), has_none), 10);
  std::vector<Track> followed = all;
  advance_tracks(frame, next, fisheye.pinhole, {}, parameters, followed);
  const auto lost = std::count_if(followed.begin(), followed.end(), has_none);
  ASSERT_GT(lost, 5);
  std::vector<Track> kept = all;
  advance_tracks(frame, next, fisheye, {}, parameters, kept);
  EXPECT_EQ(kept.size() + static_cast<std::size_t>(lost), followed.size());
  EXPECT_TRUE(std::none_of(kept.begin(), kept.end(), has_none));
}

// One point, seen by two key frames.
struct Seen {
  Map map;
  SE3d T_c_w;

  explicit Seen(const textplane::LensMap* lens) {
    map.camera = {{300, 310, 319.5, 239.5}, lens};
    map.width = 640;
    map.height = 480;
    map.keyframes.push_back({Frame(), SE3d{}, {}});
    map.keyframes.push_back({Frame(), moved({0.1, 0, 0}, {0, 0, 0}), {}});
    map.points.push_back({Vec3(1.3, -0.9, 2.5)});
    for (int id = 0; id < 2; ++id)
      add_observation(map, 0, id, map.camera.project(map.keyframe(id).T_w_c.inverse() * map.point(0).p_w));
    T_c_w = moved({-0.3, 0.2, 0.4}, {0.1, 0.3, 0.4});
  }
  // Pixel of the host for a pixel of the frame: through the plane that faces the host at the point's depth.
  Vec2 host_px(const PointPrediction& prediction, const Vec2& px) const {
    const SE3d T_c_h = T_c_w * map.keyframe(prediction.host->keyframe).T_w_c, T_h_c = T_c_h.inverse();
    const double depth = (T_h_c * (T_c_w * map.point(0).p_w)).z();
    const Vec3 ray = T_h_c.R * ray_of(map.camera, px);
    return map.camera.project(T_h_c.t + (depth - T_h_c.t.z()) / ray.z() * ray);
  }
};

TEST(PredictPoint, TheAffineIsTheDerivativeThroughBothLenses) {
  const textplane::LensMap* const lenses[] = {nullptr, &lens_support::wide_lens(), &lens_support::fisheye()};
  for (const textplane::LensMap* lens : lenses) {
    const Seen seen(lens);
    PointPrediction prediction;
    ASSERT_TRUE(predict_point(seen.map, Parameters(), seen.map.point(0), seen.map.camera, seen.T_c_w,
                              seen.T_c_w.inverse().t, &prediction));
    EXPECT_LT((prediction.px - seen.map.camera.project(seen.T_c_w * seen.map.point(0).p_w)).norm(), 1e-9);
    ASSERT_LT((seen.host_px(prediction, prediction.px) - prediction.host->px).norm(), 1e-6);
    constexpr double kStep = 1e-3;
    for (int k = 0; k < 2; ++k) {
      const Vec2 step = kStep * Vec2::Unit(k);
      const Vec2 numeric =
          (seen.host_px(prediction, prediction.px + step) - seen.host_px(prediction, prediction.px - step)) /
          (2 * kStep);
      EXPECT_LT((prediction.A.col(k).cast<double>() - numeric).norm(), 1e-4) << "column " << k;
    }
  }
}

TEST(PredictPoint, WhatTheLensDoesNotShowIsNotPredicted) {
  Seen seen(&lens_support::fisheye());
  seen.T_c_w = moved({0, 0, 0}, {0, 1, 0});  // some 85 degrees off the axis
  ASSERT_GT((seen.T_c_w * seen.map.point(0).p_w).z(), 0);
  PointPrediction prediction;
  EXPECT_FALSE(
      predict_point(seen.map, Parameters(), seen.map.point(0), seen.map.camera, seen.T_c_w, Vec3::Zero(), &prediction));
}

// Tracks of known points, in key frames that saw them through a fisheye, become these points.
TEST(TriangulateTracks, FindsThePointsBehindALens) {
  std::mt19937 random(3);
  Map map;
  map.camera = {{230, 230, 319.5, 239.5}, &lens_support::fisheye()};
  map.width = 640;
  map.height = 480;
  const Parameters parameters;
  std::vector<Vec3> points;
  for (int i = 0; i < 40; ++i) {
    const double x = uniform(random, -1.3, 1.3), y = uniform(random, -0.9, 0.9), z = uniform(random, 2, 6);
    points.push_back(z * Vec3(x, y, 1));
  }
  std::vector<Track> tracks(points.size());
  for (const double x : {0.0, 0.2, 0.5}) {
    const SE3d T_w_c = moved({x, 0.1 * x, 0.2 * x}, {0.1 * x, -0.2 * x, 0.1});
    for (std::size_t i = 0; i < points.size(); ++i)
      tracks[i].px = map.camera.project(T_w_c.inverse() * points[i]).cast<float>();
    insert_keyframe(map, Frame(), T_w_c, tracks);
  }
  EXPECT_GT(triangulate_tracks(map, parameters, parameters.min_parallax, tracks), 35);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (tracks[i].point < 0) continue;
    EXPECT_LT((map.point(tracks[i].point).p_w - points[i]).norm(), 1e-3 * points[i].norm());
  }
  EXPECT_LT(reprojection_error(map), 1e-3);
  map.camera.lens = nullptr;
  EXPECT_GT(reprojection_error(map), 10);
}

}  // namespace track_lens_test
}  // namespace textslam
