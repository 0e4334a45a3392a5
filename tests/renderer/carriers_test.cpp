// Signs that are not flush on a wall: off it and turned, round a cylinder, on a clear pane. Truth and picture agree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/furniture.hpp"
#include "renderer/kinds.hpp"
#include "renderer/ray_caster.hpp"
#include "renderer/renderer_support.hpp"
#include "renderer/truth.hpp"

namespace textslam {
namespace renderer_carriers_test {

constexpr double kDegree = 1 / 57.29577951308232;

SE3d forward() {
  SE3d T_w_c;
  T_w_c.R << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return T_w_c;
}

TEST(RendererCarriers, SignsOffTheWallKeepTheirDistanceAndTurn) {
  const Rectangle wall = facing({0.0, 3.0, 0.0}, {0.3, -1.0, 0.0}, 6.0, 3.0);
  SignPainter signs(12, 5);
  Scene scene;
  double most = 0.0, least = 90.0, nearest = 1.0, farthest = 0.0;
  for (int i = 0; i < 12; ++i) {
    signs.off_wall(scene, wall, 1.0 + 0.3 * i, 1.5, 0.4 + 0.03 * i);
    const Sign& sign = scene.signs().back();
    const double turn = std::acos(std::min(1.0, sign.normal.dot(wall.normal()))) / kDegree;
    most = std::max(most, turn);
    least = std::min(least, turn);
    const Rectangle& plate = scene.surfaces().back().rectangle;
    double lift = 1.0;
    for (const double s : {0.0, plate.width})
      for (const double t : {0.0, plate.height}) lift = std::min(lift, wall.normal().dot(plate.at(s, t) - wall.corner));
    nearest = std::min(nearest, lift);
    farthest = std::max(farthest, lift);
    for (const Vector3<double>& corner : sign.corner)
      EXPECT_NEAR(sign.normal.dot(corner - plate.corner), 0.0, 1e-12) << "the text lies on its plate";
    EXPECT_EQ(sign.radius, 0.0);
  }
  EXPECT_LE(most, 15.0);
  EXPECT_GT(most, 10.0);
  EXPECT_LT(least, 5.0);
  EXPECT_GE(nearest, 0.02 - 1e-12);
  EXPECT_LE(farthest, 0.1 + 1e-12);
  EXPECT_GT(farthest - nearest, 0.05);
}

// The surface that the rays meet is the one that the truth states, to the flatness of its strips.
TEST(RendererCarriers, TheTruthOfACylinderLiesOnIt) {
  constexpr double kRadius = 0.25;
  const Vector3<double> front(0.1, 2.0, 0.2), towards = Vector3<double>(0.2, -1.0, 0.0).normalized();
  SignPainter signs(1, 3);
  Scene scene;
  signs.cylinder(scene, front, towards, 0.45, kRadius);
  const Sign& sign = scene.signs().front();
  EXPECT_EQ(sign.radius, kRadius);
  EXPECT_LT((sign.normal - towards).norm(), 1e-2) << "nearly in the plate's middle";
  const Vector3<double> axis = front - kRadius * towards;
  for (std::size_t k = 0; k < 4; ++k) {
    const double u = k == 1 || k == 2 ? 1.0 : 0.0, v = k >= 2 ? 1.0 : 0.0;
    EXPECT_LT((sign.at(u, v) - sign.corner[k]).norm(), 1e-12);
  }
  const Vector3<double> eye(0.0, 0.0, 0.0);
  for (double u = 0.0; u <= 1.0; u += 0.04) {
    for (const double v : {0.0, 0.5, 1.0}) {
      const Vector3<double> p = sign.at(u, v), from_axis = p - axis;
      EXPECT_NEAR(from_axis.head<2>().norm(), kRadius, 1e-12);
      const Hit hit = scene.first_hit(eye, p);
      ASSERT_GE(hit.surface, 0);
      EXPECT_NEAR(hit.distance * p.norm(), p.norm(), 5e-5) << "m";
    }
  }
  const std::vector<SignView> views = views_of_signs(scene, test_camera(), forward());
  ASSERT_EQ(views.size(), 1u);
  EXPECT_EQ(views.front().visible, 1.0) << "not hidden by its own bulge";
  EXPECT_EQ(nlohmann::json::parse(format_signs(scene.signs())).at("signs").at(0).at("radius"), kRadius);
}

TEST(RendererCarriers, LightPassesAPaneBesideItsLetters) {
  Scene scene;
  scene.add_unlit(facing({0.0, 4.0, 0.0}, {0.0, -1.0, 0.0}, 9.0, 9.0), Image<std::uint8_t>(2, 2, 100));
  const auto pane = [&](double y, std::uint8_t value, std::uint8_t opacity) {
    scene.add_pane(facing({0.0, y, 0.0}, {0.0, -1.0, 0.0}, 0.4, 0.4), Canvas(0.4, 0.4, 10.0, value),
                   Image<std::uint8_t>(4, 4, opacity));
  };
  const CameraModel camera = test_camera(160);
  const auto light = [&](int x, int y) {
    Image<double> picture(camera.width, camera.height, 0.0);
    RayCaster(camera, {Vector2<double>::Zero()}).add(scene, forward(), 0, 1.0, 1.0, picture);
    return picture(x, y);
  };
  pane(2.0, 220, 0);
  EXPECT_EQ(light(80, 60), 100.0) << "clear";
  pane(1.5, 200, 51);
  EXPECT_NEAR(light(80, 60), 0.2 * 200.0 + 0.8 * 100.0, 1e-9);
  EXPECT_EQ(light(5, 5), 100.0) << "beside it";
  pane(1.0, 60, 102);
  EXPECT_NEAR(light(80, 60), 0.4 * 60.0 + 0.6 * (0.2 * 200.0 + 0.8 * 100.0), 1e-9) << "one behind the other";
  pane(0.8, 30, 255);
  EXPECT_EQ(light(80, 60), 30.0) << "a letter";
  EXPECT_EQ(scene.first_hit({0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}).surface, 0) << "panes hide nothing";
}

TEST(RendererCarriers, EachKindHasWhatItIsNamedFor) {
  const auto round = [](const Scene& scene) {
    return std::count_if(scene.signs().begin(), scene.signs().end(), [](const Sign& s) { return s.radius > 0.0; });
  };
  const auto panes = [](const Scene& scene) {
    return std::count_if(scene.surfaces().begin(), scene.surfaces().end(),
                         [](const Surface& s) { return s.opacity != nullptr; });
  };
  const Shot cylinders = make_shot("cylinders", 1, 640, 480), glass = make_shot("glass", 1, 640, 480);
  EXPECT_EQ(round(cylinders.scene), 6);
  EXPECT_EQ(panes(cylinders.scene), 0);
  EXPECT_EQ(round(glass.scene), 0);
  EXPECT_EQ(panes(glass.scene), 6);
}

}  // namespace renderer_carriers_test
}  // namespace textslam
