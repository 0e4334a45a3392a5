// A camera that walks up to a sign, for the tests of hosting.
#ifndef TESTS_TEXTSLAM_TEXT_TEXT_HOSTING_SUPPORT_HPP
#define TESTS_TEXTSLAM_TEXT_TEXT_HOSTING_SUPPORT_HPP

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>

#include "textplane/geometry/plane.hpp"
#include "textslam/text/text_hosting.hpp"
#include "textslam/text/text_plane.hpp"

namespace textslam {
namespace text_hosting_test {

constexpr double kDegree = M_PI / 180;
constexpr double kHalfWidth = 0.3, kHalfHeight = 0.12;

// Random spots of 3 cm, linear between them.
inline double ink(double x, double y) {
  const auto index = [](double i) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(i) + 1000); };
  const auto spot = [&](double i, double j) {
    auto h = index(i) * 2654435761U ^ index(j) * 2246822519U;
    h = (h ^ (h >> 15)) * 739982445U;
    h = (h ^ (h >> 12)) * 695872825U;
    return (h ^ (h >> 15)) % 2 == 0 ? 30.0 : 220.0;
  };
  const double u = x / 0.03, v = y / 0.03, i = std::floor(u), j = std::floor(v), a = u - i, b = v - j;
  return (1 - b) * ((1 - a) * spot(i, j) + a * spot(i + 1, j)) +
         b * ((1 - a) * spot(i, j + 1) + a * spot(i + 1, j + 1));
}

// A wall three units away with a sign about its origin; key frames step aside and up to it.
class TextHostingTest : public testing::Test {
 protected:
  TextHostingTest() {
    map.camera = {262, 262, 159.5, 119.5};
    map.width = 320;
    map.height = 240;
    begin();
  }

  // The walk's begin, in new noise.
  void begin() {
    map.keyframes.clear();
    map.texts.clear();
    for (const double z : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5}) add_keyframe(at(0.6 * z - 0.5, z));
    TextObject text;
    text.id = 0;
    text.state = TextState::mapped;
    text.host = 0;
    text.patch = make_text_patch(map, parameters, 0, quad_in(map.keyframe(0).T_w_c));
    text.theta = map.keyframe(0).T_w_c.R.transpose() * Vec3(0, 0, 1.0 / 3);
    text.views = {1, 2, 3, 4, 5};
    text.votes["EXIT"] = 3;
    text.detections = 6;
    map.texts.push_back(text);
    EXPECT_TRUE(refine_plane(map, parameters, text.views, text.theta, 0.9, map.texts[0]));
  }

  // Beside the axis by x, walked up to the wall by z, and turned to the sign's middle.
  static SE3d at(double x, double z, double y = 0.05) {
    const Vec3 forward = (Vec3(0, 0, 3) - Vec3(x, y, z)).normalized(),
               right = Vec3(0, 1, 0).cross(forward).normalized();
    SE3d T_w_c;
    T_w_c.R << right, forward.cross(right), forward;
    T_w_c.t = {x, y, z};
    return T_w_c;
  }

  // A pixel is the mean over it, then over so many pixels to its right and left, for blur, with a sensor's noise.
  std::shared_ptr<const Pyramid> render(const SE3d& T_w_c, int blur) {
    constexpr int kSamples = 3, kNoise = 8;  // grey levels, at most
    textplane::Image<std::uint8_t> image(map.width, map.height);
    std::vector<double> row(static_cast<std::size_t>(map.width + 2 * blur));
    for (int y = 0; y < map.height; ++y) {
      for (int x = -blur; x < map.width + blur; ++x) {
        double sum = 0;
        for (int k = 0; k < kSamples * kSamples; ++k) {
          const Vec2 px(x + (k % kSamples - 1) / 3.0, y + (k / kSamples - 1) / 3.0);
          const Vec3 ray = T_w_c.R * map.camera.unproject(px);
          Vec3 p = T_w_c.t + (3 - T_w_c.t.z()) / ray.z() * ray;
          for (int i = 0; relief && i < 20; ++i) p = T_w_c.t + (3 + relief(p.x()) - T_w_c.t.z()) / ray.z() * ray;
          const bool meets = ray.z() > 0 && p.norm() < 1e6;  // not so where a ray runs along a bent wall
          sum += meets ? ink(p.x(), p.y()) : 0;
        }
        row[static_cast<std::size_t>(x + blur)] = sum / (kSamples * kSamples);
      }
      for (int x = 0; x < map.width; ++x) {
        double sum = 0;
        for (int k = 0; k <= 2 * blur; ++k) sum += row[static_cast<std::size_t>(x + k)];
        image.view().row(y)[x] = static_cast<std::uint8_t>(std::lround(sum / (2 * blur + 1)) - kNoise +
                                                           static_cast<int>(random_() % (2 * kNoise + 1)));
      }
    }
    return std::make_shared<const Pyramid>(image.view(), parameters.pyramid_levels);
  }

  int add_keyframe(const SE3d& T_w_c, int blur = 0) {
    KeyFrame keyframe;
    keyframe.frame.index = 5 * static_cast<int>(map.keyframes.size());
    keyframe.frame.image = render(T_w_c, blur);
    keyframe.T_w_c = T_w_c;
    map.keyframes.push_back(keyframe);
    return static_cast<int>(map.keyframes.size()) - 1;
  }
  // One that the text has as a target.
  int add_target(const SE3d& T_w_c, int blur = 0) {
    const int id = add_keyframe(T_w_c, blur);
    text().views.push_back(id);
    return id;
  }

  Quad<double> quad_in(const SE3d& T_w_c) const {
    const Vec2 signs[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    Quad<double> quad;
    for (std::size_t i = 0; i < 4; ++i)
      quad.corner[i] =
          map.camera.project(T_w_c.inverse() * Vec3(signs[i].x() * kHalfWidth, signs[i].y() * kHalfHeight, 3));
    return quad;
  }

  TextObject& text() { return map.texts[0]; }
  Vec3 corner(const TextObject& text, std::size_t i) const {
    return map.keyframe(text.host).T_w_c *
           textplane::plane_point<double>(text.theta, map.camera.unproject(text.patch.quad.corner[i]));
  }
  double angle_error(const TextObject& text) const {
    return degrees_between(map.keyframe(text.host).T_w_c.R * textplane::plane_normal(text.theta), Vec3(0, 0, -1));
  }
  void expect_unchanged(const TextObject& before) {
    EXPECT_EQ(text().host, before.host);
    EXPECT_EQ(text().views, before.views);
    EXPECT_EQ(text().theta, before.theta);
    EXPECT_EQ(text().covariance, before.covariance);
    EXPECT_EQ(text().zncc, before.zncc);
    EXPECT_EQ(text().patch.quad.corner, before.patch.quad.corner);
  }
  void expect_refused(int id, const char* why) {
    const TextObject before = text();
    EXPECT_FALSE(rehost(map, parameters, id, text())) << why;
    expect_unchanged(before);
  }

  Map map;
  Parameters parameters;
  std::function<double(double)> relief;  // of the wall at x, away from the camera; begin() renders anew
  std::mt19937 random_{1};
};

}  // namespace text_hosting_test
}  // namespace textslam

#endif  // TESTS_TEXTSLAM_TEXT_TEXT_HOSTING_SUPPORT_HPP
