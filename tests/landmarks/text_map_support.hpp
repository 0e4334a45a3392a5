// Three signs before a camera that moves sideways, for the tests of TextMap.
#ifndef TESTS_LANDMARKS_TEXT_MAP_SUPPORT_HPP
#define TESTS_LANDMARKS_TEXT_MAP_SUPPORT_HPP

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <set>
#include <vector>

#include "solver/synthetic.hpp"
#include "textplane/landmarks/text_map.hpp"

namespace text_map_test {
using namespace textplane_test::planar;
using textplane::Pyramid;
using textplane::Status;
using textplane::TextDetection;
using textplane::TextFit;
using textplane::TextMap;
using textplane::TextObject;
using textplane::TextPoint;
using textplane::TextState;
using textplane_test::planar::Random;  // beside textplane_test::Random

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

inline bool same_bits(const SE3d& a, const SE3d& b) {
  return std::memcmp(a.R.data(), b.R.data(), 9 * sizeof(double)) == 0 &&
         std::memcmp(a.t.data(), b.t.data(), 3 * sizeof(double)) == 0;
}

inline double shift(const SE3d& a, const SE3d& b) { return (a.inverse().t - b.inverse().t).norm(); }

class TextMapTest : public testing::Test {
 protected:
  static SE3d pose(double step) {
    Vec6 xi;
    xi << 0.05 * step, -0.01 * step, 0.012 * step, 0.002 * step, -0.012 * step, 0.003 * step;
    return textplane::se3_exp<double>(xi);
  }
  Pyramid image(const SE3d& T_c_w) const {
    const FloatPyramid rendered = scene.render(T_c_w);
    const Image<float>& from = rendered.levels[0];
    Image<std::uint8_t> to(from.width(), from.height());
    for (int y = 0; y < to.height(); ++y)
      for (int x = 0; x < to.width(); ++x) to(x, y) = static_cast<std::uint8_t>(std::lround(from(x, y)));
    return Pyramid(to.view(), 3);
  }
  // The quads of the signs, as an exact detector sees them.
  std::vector<TextDetection> quads(const SE3d& T_c_w) const {
    std::vector<TextDetection> out;
    for (const Sign& sign : scene.signs) {
      TextDetection found;
      std::size_t i = 0;
      for (const Vec2& corner :
           {Vec2(sign.x0, sign.y0), Vec2(sign.x1, sign.y0), Vec2(sign.x1, sign.y1), Vec2(sign.x0, sign.y1)}) {
        const Vec3 m = scene.camera.unproject(corner);
        found.quad.corner[i++] = scene.view().project(T_c_w * (sign.T_w_h * Vec3(m / sign.theta.dot(m))));
      }
      found.word = "sign";
      out.push_back(found);
    }
    return out;
  }
  // Points on the signs and about them, where this camera sees them, each with an error of `noise` px.
  std::vector<TextPoint> points(const SE3d& T_c_w, double noise, unsigned seed = 3) const {
    Random at(17), error(seed);
    std::vector<TextPoint> out;
    for (int i = 0; i < 90; ++i) {
      const Sign& sign = scene.signs[static_cast<std::size_t>(i % 3)];
      const Vec3 m = scene.camera.unproject({at.uniform(sign.x0, sign.x1), at.uniform(sign.y0, sign.y1)});
      const Vec3 p_w = sign.T_w_h * Vec3(m / sign.theta.dot(m));
      const Vec2 px = scene.view().project(T_c_w * p_w) + noise * Vec2{error.normal(), error.normal()};
      out.push_back(TextPoint::at(px, p_w, i));
    }
    return out;
  }
  // `map` after key frames 0 to last, which tell it points_at(pose).
  template <class PointsAt>
  void walk(TextMap& map, int last, PointsAt points_at) const {
    for (int id = 0; id <= last; ++id) {
      const SE3d T = pose(id);
      ASSERT_EQ(map.add_keyframe(id, image(T), T, quads(T), points_at(T)), Status::ok);
    }
  }
  void walk(TextMap& map, int last) const {
    walk(map, last, [&](const SE3d& T) { return points(T, 0.1); });
  }
  static int mapped(const TextMap& map) {
    int n = 0;
    for (const TextObject& text : map.objects()) n += text.state == TextState::mapped;
    return n;
  }
  // Largest angle between a mapped text's normal and that of the sign it lies on, degrees.
  double largest_angle(const TextMap& map) const {
    double largest = 0;
    for (const TextObject& text : map.objects()) {
      const Vec3 normal = map.keyframes().text_keyframe(text.host).T_w_c.R * textplane::plane_normal(text.theta);
      double closest = 180;
      for (const Sign& sign : scene.signs)
        closest = std::min(
            closest, textplane::detail::degrees_between(normal, sign.T_w_h.R * textplane::plane_normal(sign.theta)));
      if (text.state == TextState::mapped) largest = std::max(largest, closest);
    }
    return largest;
  }

  Scene scene = three_signs();
};

}  // namespace text_map_test

#endif  // TESTS_LANDMARKS_TEXT_MAP_SUPPORT_HPP
