// What moves in a rendered scene: picture, rays and truth show it where it is at the time, and interruptions come and
// go.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/exposure.hpp"
#include "renderer/furniture.hpp"
#include "renderer/kinds.hpp"
#include "renderer/ray_caster.hpp"
#include "renderer/renderer_support.hpp"
#include "renderer/truth.hpp"

namespace textslam {
namespace renderer_crowd_test {

constexpr double kInterval = 1.0 / 30.0;

/// Share of the image that shows surfaces that move, on a grid.
double hidden_share(const Scene& scene, const CameraModel& camera, const SE3d& T_w_c, double time) {
  int hidden = 0, all = 0;
  for (int y = 10; y < camera.height; y += 20) {
    for (int x = 10; x < camera.width; x += 20, ++all) {
      Vector3<double> m;
      if (!textplane::is_ok(camera.unproject(Vector2<double>(x, y), &m))) continue;
      const Hit hit = scene.first_hit(T_w_c.t, T_w_c.R * m, time);
      hidden += hit.surface >= 0 && scene.surfaces()[static_cast<std::size_t>(hit.surface)].carrier != nullptr;
    }
  }
  return static_cast<double>(hidden) / all;
}

TEST(RendererCrowd, PeopleHideMuchOfTheImageFromTheStartAtWalkingSpeed) {
  const CameraModel camera = test_camera();
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Motion motion = room_motion(seed);
    Scene scene;
    add_crowd(scene, seed);
    double most = 0.0, mean = 0.0;
    for (int frame = 0; frame < 240; frame += 4) {
      const double share = hidden_share(scene, camera, motion(frame * kInterval), frame * kInterval);
      most = std::max(most, share);
      mean += share / 60.0;
    }
    EXPECT_GT(hidden_share(scene, camera, motion(0.0), 0.0), 0.1) << seed;
    EXPECT_GT(most, 0.3) << seed;
    EXPECT_LT(most, 0.6) << seed;
    EXPECT_GT(mean, 0.08) << seed;
    for (const Surface& surface : scene.surfaces()) {
      if (!surface.carrier) continue;
      double fastest = 0.0;
      for (double t = 0.0; t < 8.0; t += kInterval)
        fastest = std::max(fastest, (surface.at(t + 1e-3).corner - surface.at(t).corner).norm() / 1e-3);
      EXPECT_GT(fastest, 0.45);
      EXPECT_LT(fastest, 2.2) << "as it turns, a corner is faster than the walker";
    }
  }
}

TEST(RendererCrowd, WhatMovesHidesASignAndLetsItBeSeenAgain) {
  SE3d T_w_c;
  T_w_c.R << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  Scene scene;
  const Rectangle wall = facing({0.0, 3.0, 0.0}, {0.0, -1.0, 0.0}, 4.0, 3.0);
  scene.add_unlit(wall, Image<std::uint8_t>(400, 300, 200));
  scene.add_sign("EXIT", on(wall, 2.0, 1.5, 0.6, 0.2, 0.0));
  const std::size_t first = scene.surfaces().size();
  scene.add_unlit(facing({0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, 1.0, 1.0), Image<std::uint8_t>(10, 10, 50));
  scene.carry(first, [](double t) { return SE3d{Matrix3<double>::Identity(), {t, 2.0, 0.0}}; });
  const CameraModel camera = test_camera();
  EXPECT_TRUE(views_of_signs(scene, camera, T_w_c, 0.0).empty());
  const std::vector<SignView> later = views_of_signs(scene, camera, T_w_c, 1.5);
  ASSERT_EQ(later.size(), 1u);
  EXPECT_EQ(later[0].visible, 1.0);
  EXPECT_NEAR(scene.first_hit({0, 0, 0}, {0, 1, 0}, 0.2).distance, 2.0, 1e-12);
  EXPECT_NEAR(scene.first_hit({0, 0, 0}, {0, 1, 0}, 1.0).distance, 3.0, 1e-12);
  const Surface& board = scene.surfaces().back();
  EXPECT_LT((board.carried({0.3, 2.0, 0.1}, 0.0, 2.0) - Vector3<double>(2.3, 2.0, 0.1)).norm(), 1e-12);

  // The edge of the board at x = .5 + t, 2 m away, in the picture.
  const RayCaster caster(camera, pixel_grid());
  for (const double t : {0.0, 0.4}) {
    const Image<double> light = expose(
        scene, caster, [&](double) { return T_w_c; }, t, 0.0, 4);
    Vector2<double> edge;
    ASSERT_TRUE(project(camera, T_w_c.inverse(), {0.5 + t, 2.0, 0.0}, &edge));
    const int y = static_cast<int>(edge[1]), x = static_cast<int>(std::lround(edge[0]));
    EXPECT_NEAR(light(x - 3, y), 50.0, 1.0);
    EXPECT_NEAR(light(x + 3, y), 200.0, 1.0);
  }
}

TEST(RendererCrowd, CutsGoElsewhereAndBackAndACoverIsDark) {
  const Shot cuts = make_shot("cuts", 1, 64, 48), covered = make_shot("covered", 1, 64, 48);
  const Motion room = room_motion(1);
  int away = 0, dark = 0;
  for (int frame = 0; frame < 240; ++frame) {
    const double t = frame * kInterval;
    away += (cuts.motion(t).t - room(t).t).norm() > 1e-9;
    dark += covered.sensor(t).gain == 0.0;
  }
  EXPECT_EQ(away, 60);
  EXPECT_EQ(dark, 30);
}

}  // namespace renderer_crowd_test
}  // namespace textslam
