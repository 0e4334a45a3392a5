// Texts are looked at squarely, whatever the slant and the box they were found in, and read where they are sharpest.
#include "textslam/text/text_reading.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "textplane/geometry/plane.hpp"
#include "textslam/lens_support.hpp"

namespace textslam {
namespace text_reading_test {

// A wall that the camera sees at a slant of 50 degrees, with smooth waves on it along its own axes, u to the right, v
// down.
struct Wall {
  Vec3 centre{0.1, 0.05, 3};
  Eigen::Matrix3d R = textplane::so3_exp<double>(Vec3(0.2, 0, 0)) * textplane::so3_exp<double>(Vec3(0, 0.85, 0)) *
                      textplane::so3_exp<double>(Vec3(0, 0, 0.3));
  Vec3 at(double u, double v) const { return centre + R * Vec3(u, v, 0); }
  static double grey(double u, double v) { return 128 + 50 * std::sin(12 * u) + 50 * std::cos(17 * v); }
};

class TextReading : public testing::Test {
 protected:
  explicit TextReading(const textplane::LensMap* lens = nullptr) {
    map.camera = {{525, 525, 319.5, 239.5}, lens};
    map.width = 640;
    map.height = 480;
    map.keyframes.resize(3);
    map.keyframes[1].T_w_c = {textplane::so3_exp<double>(Vec3(0.02, -0.1, 0.3)), Vec3(0.3, 0.1, 0.5)};
    map.keyframes[2].T_w_c = {textplane::so3_exp<double>(Vec3(0, 0.2, 0)), Vec3(-0.5, 0, -1)};
    for (KeyFrame& keyframe : map.keyframes) keyframe.frame.image = image_of(keyframe.T_w_c);
    text.id = 0;
    text.state = TextState::mapped;
    text.host = 0;
    text.views = {1, 2};
    const Vec3 normal = wall.R * Vec3(0, 0, -1);
    text.theta = textplane::plane_from_normal<double>(normal, -normal.dot(wall.centre));
    // A box round a sheared word: its sides are not at right angles on the wall.
    const double u[4] = {-0.3, 0.26, 0.3, -0.26}, v[4] = {-0.1, -0.1, 0.1, 0.1};
    text.patch.camera = map.camera.pinhole;
    for (std::size_t i = 0; i < 4; ++i) text.patch.quad.corner[i] = text.patch.camera.project(wall.at(u[i], v[i]));
  }

  std::shared_ptr<const Pyramid> image_of(const SE3d& T_w_c) const {
    Image<std::uint8_t> image(map.width, map.height);
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) {
        const Vec3 ray = wall.R.transpose() * (T_w_c.R * ray_of(map.camera, Vec2(x, y)));
        const Vec3 from = wall.R.transpose() * (T_w_c.t - wall.centre);
        const Vec3 p = from - from.z() / ray.z() * ray;
        image(x, y) = static_cast<std::uint8_t>(std::lround(Wall::grey(p.x(), p.y())));
      }
    return std::make_shared<const Pyramid>(image.view(), 3);
  }

  void expect_square_views() const {
    constexpr int kHeight = 40;
    for (const int id : {0, 1, 2}) {
      SCOPED_TRACE(id);
      const SquareView view = square_view(map, text, id, Parameters{});
      ASSERT_GT(view.picture.width(), 0);
      const auto& c = view.quad.corner;
      EXPECT_EQ((c[3] - c[0]).norm(), kHeight);
      EXPECT_EQ((c[1] - c[0]).norm(), 3 * kHeight) << "0.6 by 0.2";
      double worst = 0;
      for (int y = 0; y < view.picture.height(); ++y)
        for (int x = 0; x < view.picture.width(); ++x) {
          const double u = -0.3 + (x - c[0].x()) * 0.2 / kHeight, v = -0.1 + (y - c[0].y()) * 0.2 / kHeight;
          worst = std::max(worst, std::abs(view.picture(x, y) - Wall::grey(u, v)));
        }
      EXPECT_LT(worst, 4);
    }
  }

  Wall wall;
  Map map;
  TextObject text;
};

TEST_F(TextReading, ASquareViewShowsTheWallAsItIs) { expect_square_views(); }

class TextReadingByFisheye : public TextReading {
 protected:
  TextReadingByFisheye() : TextReading(&lens_support::fisheye()) {}
};
TEST_F(TextReadingByFisheye, ASquareViewShowsTheWallAsItIs) { expect_square_views(); }

TEST_F(TextReading, WhatAnImageCutsOffIsNotShown) {
  map.keyframes[1].T_w_c = {Eigen::Matrix3d::Identity(), Vec3(2, 0, 0)};
  EXPECT_EQ(square_view(map, text, 1, Parameters{}).picture.width(), 0);
  map.keyframes[1].T_w_c = {Eigen::Matrix3d::Identity(), Vec3(0, 0, 6)};
  EXPECT_EQ(square_view(map, text, 1, Parameters{}).picture.width(), 0) << "behind the camera";
}

// Reads what stands upright better than what is upside down; counts.
class Reader final : public TextReader {
 public:
  Reading read(ImageView8, const Quad<double>& quad) override {
    ++asked;
    return quad.corner[0].x() < quad.corner[1].x() ? Reading{"over", 0.6} : Reading{"upright", 0.8};
  }
  int asked = 0;
};

TEST_F(TextReading, ReadsTheSharpestViewsEitherWayUp) {
  map.texts = {text, text};
  map.texts[1].state = TextState::tentative;
  map.texts[0].votes = {{"before", 0.5}};
  Parameters parameters;
  parameters.reading_views = 2;
  Reader reader;
  read_texts(map, parameters, reader);
  EXPECT_EQ(reader.asked, 4) << "two views, two ways";
  EXPECT_EQ(map.texts[0].votes.size(), 2u);
  EXPECT_GT(map.texts[0].votes.at("upright"), 0.8) << "the sharpest view";
  EXPECT_LT(map.texts[0].votes.at("upright"), 1.6) << "and one less sharp";
  EXPECT_EQ(textplane::consensus(map.texts[0].votes), "upright");
  EXPECT_TRUE(map.texts[1].votes.empty()) << "not mapped";
}

}  // namespace text_reading_test
}  // namespace textslam
