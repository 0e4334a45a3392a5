// The texts that a frame may show are found without a look at all, and none is missed.
#include "textplane/landmarks/text_bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "support/text_wall.hpp"
#include "textplane/core/cameras/radial_tangential.hpp"

namespace {
namespace tp = textplane;
using textplane_test::Random;
using textplane_test::TextWall;

class TextBoundsTest : public testing::Test {
 protected:
  TextBoundsTest() : map(wall.camera) {
    wall.fill(map, 500);
    frame.pyramid = wall.frame.view();
    frame.camera = wall.camera;
    bounds.update(map.objects(), map.keyframes());
  }
  std::vector<std::size_t> near(const tp::SE3d& T_c_w) const {
    std::vector<std::size_t> out;
    bounds.for_each_near(frame, T_c_w, [&](std::size_t i, const tp::SE3d&) { out.push_back(i); });
    return out;
  }
  bool in_view(std::size_t i, const tp::SE3d& T_c_w) const {
    const tp::TextObject& text = map.objects()[i];
    tp::Quad<double> quad;
    tp::TextOptions options;
    options.min_share = 0.02;  // signs that reach into the image by a corner are in view
    return text_in_view(options, text, T_c_w * map.keyframes().text_keyframe(text.host).T_w_c, frame, &quad);
  }

  // Whether the first text counts as near where its sphere touches, from outside, the plane through the camera and
  // the rays whose coordinate along an axis (x or y) is `m`.
  bool touches(int axis, double outwards, double m) const {
    const tp::TextObject& text = map.objects()[0];
    std::array<tp::Vector3<double>, 4> corners;
    EXPECT_EQ(quad_points(text.patch.quad, text.patch.camera, text.theta, &corners), tp::Status::ok);
    const tp::Vector3<double> centre = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    double radius = 0;
    for (const tp::Vector3<double>& corner : corners) radius = std::max(radius, (corner - centre).norm());
    tp::Vector3<double> ray(0, 0, 1), outside(0, 0, -outwards * m);
    ray[axis] = m;
    outside[axis] = outwards;
    tp::SE3d T_w_c;
    T_w_c.t =
        map.keyframes().text_keyframe(text.host).T_w_c * centre - 20 * ray - (1 - 1e-3) * radius * outside.normalized();
    const std::vector<std::size_t> found = near(T_w_c.inverse());
    return std::binary_search(found.begin(), found.end(), std::size_t{0});
  }

  const TextWall wall;
  tp::TextMap map;
  tp::TextImage frame;
  tp::TextBounds bounds;
};

TEST_F(TextBoundsTest, MissesNoTextInViewAndLeavesOutMostOthers) {
  Random random(3);
  std::size_t all_near = 0, all_in_view = 0;
  for (int trial = 0; trial < 300; ++trial) {
    tp::SE3d T_w_c;
    T_w_c.R = tp::so3_exp<double>(random.vector<3>(0.9));
    T_w_c.t = {random.uniform(-10, 210), random.uniform(-4, 4), random.uniform(-9, 2.5)};
    const tp::SE3d T_c_w = T_w_c.inverse();
    const std::vector<std::size_t> found = near(T_c_w);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    all_near += found.size();
    for (std::size_t i = 0; i < map.objects().size(); ++i) {
      if (!in_view(i, T_c_w)) continue;
      ++all_in_view;
      EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i)) << trial << " " << i;
    }
  }
  EXPECT_GT(all_in_view, 2000U);
  EXPECT_LT(all_near, 300U * 500U / 10) << "those that are too small or too slanted are among them";
}

TEST_F(TextBoundsTest, ReachesOnePixelBeyondTheImage) {
  const tp::Pinhole<double>& k = wall.camera;
  const double right = frame.width() - 1, bottom = frame.height() - 1;
  for (const double beyond : {0.5, 1.5}) {
    const bool near = beyond < 1;
    EXPECT_EQ(touches(0, -1, (-beyond - k.cx) / k.fx), near) << "left";
    EXPECT_EQ(touches(0, 1, (right + beyond - k.cx) / k.fx), near) << "right";
    EXPECT_EQ(touches(1, -1, (-beyond - k.cy) / k.fy), near) << "above";
    EXPECT_EQ(touches(1, 1, (bottom + beyond - k.cy) / k.fy), near) << "below";
  }
}

// Corners and middles of the sides, a tenth wider.
TEST_F(TextBoundsTest, ReachesATenthBeyondTheRaysOfTheBorderBehindALens) {
  const tp::LensMap lens(tp::RadialTangential<double>{{}, -0.1, 0.01, 2e-3, -1e-3, 0});
  frame.camera.lens = &lens;
  const double right = frame.width() - 1, bottom = frame.height() - 1;
  tp::Vector2<double> least(0, 0), most(0, 0);
  for (const double x : {0.0, 0.5 * right, right})
    for (const double y : {0.0, 0.5 * bottom, bottom}) {
      tp::Vector3<double> ray;
      ASSERT_EQ(frame.camera.unproject(tp::Vector2<double>(x, y), &ray), tp::Status::ok);
      least = least.cwiseMin(ray.head<2>());
      most = most.cwiseMax(ray.head<2>());
    }
  for (const double share : {0.999, 1.001})
    for (const int axis : {0, 1}) {
      EXPECT_EQ(touches(axis, -1, 1.1 * share * least[axis]), share < 1) << axis;
      EXPECT_EQ(touches(axis, 1, 1.1 * share * most[axis]), share < 1) << axis;
    }
}

TEST_F(TextBoundsTest, FollowsAPlaneThatChanges) {
  std::vector<tp::TextObject> texts = map.objects();
  texts[400].theta *= 0.02;  // fifty times as far away
  bounds.update_plane(400, texts[400]);
  tp::TextBounds anew;
  anew.update(texts, map.keyframes());
  Random random(4);
  std::size_t seen = 0;
  for (int trial = 0; trial < 300; ++trial) {
    tp::SE3d T_w_c;
    T_w_c.t = {random.uniform(-300, 500), random.uniform(-40, 40), random.uniform(-9, 140)};
    bool is_near = false;
    anew.for_each_near(frame, T_w_c.inverse(), [&](std::size_t i, const tp::SE3d&) { is_near |= i == 400; });
    const std::vector<std::size_t> found = near(T_w_c.inverse());
    EXPECT_EQ(std::binary_search(found.begin(), found.end(), 400U), is_near) << trial;
    seen += is_near ? 1U : 0U;
  }
  EXPECT_GT(seen, 20U);
  EXPECT_LT(seen, 280U);
}

TEST_F(TextBoundsTest, GivesThePosesOfTheHosts) {
  std::size_t seen = 0;
  bounds.for_each_near(frame, wall.T_c_w, [&](std::size_t i, const tp::SE3d& T_w_h) {
    ++seen;
    EXPECT_EQ(T_w_h.t, map.keyframes().text_keyframe(map.objects()[i].host).T_w_c.t);
  });
  EXPECT_EQ(seen, 20U);
}

TEST_F(TextBoundsTest, ATextWithoutAPlaceIsEverywhere) {
  std::vector<tp::TextObject> texts = map.objects();
  texts[499].theta = -texts[499].theta;  // behind its host
  bounds.update(texts, map.keyframes());
  EXPECT_EQ(near(wall.T_c_w).back(), 499U);
  texts[499].state = tp::TextState::tentative;
  texts[0].state = tp::TextState::tentative;
  bounds.update(texts, map.keyframes());
  EXPECT_EQ(near(wall.T_c_w).size(), 19U) << "of the mapped ones";
}

}  // namespace
