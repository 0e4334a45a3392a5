// A long wall of signs, of which one frame sees twenty: a TextMap of any size, made in no time.
//
// The wall is z = 3 m. It repeats every eight metres, and a key frame stands before each repetition, so that one host
// image gives the patches of all. The frame sees the first: 640 x 480 px, in another light, with noise. Its signs are
// 15 to 60 px high.
#ifndef TEXTPLANE_TESTS_SUPPORT_TEXT_WALL_HPP
#define TEXTPLANE_TESTS_SUPPORT_TEXT_WALL_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "support/random.hpp"
#include "support/spots.hpp"
#include "textplane/landmarks/text_map.hpp"

namespace textplane_test {

class TextWall {
 public:
  static constexpr int kInView = 20;

  const textplane::Pinhole<double> camera{480, 480, 319.5, 239.5};
  textplane::SE3d T_c_w;                     ///< Of the frame: the truth.
  textplane::SE3d start;                     ///< About 2 px off.
  textplane::Pyramid frame;                  ///< What it sees.
  std::vector<textplane::TextPoint> points;  ///< Two hundred of the wall, with noise of half a px.

  TextWall() {
    T_c_w = textplane::se3_exp<double>((Twist() << 0.12, -0.05, 0.06, 0.015, -0.03, 0.01).finished());
    start = textplane::se3_exp<double>((Twist() << 0.009, -0.006, 0.006, 0.0012, -0.0018, 0.002).finished()) * T_c_w;
    frame = textplane::Pyramid(render(T_c_w, 0.85, 18).view(), 3);
    const textplane::SE3d T_w_c = T_c_w.inverse();
    for (int i = 0; i < 200; ++i) {
      const textplane::Vector2<double> px(random_.uniform(10, 630), random_.uniform(10, 470));
      const textplane::Vector3<double> ray = T_w_c.R * camera.unproject(px);
      const textplane::Vector2<double> noise(random_.normal(), random_.normal());
      points.push_back(textplane::TextPoint::at(px + 0.5 * noise, T_w_c.t + (kDepth - T_w_c.t.z()) / ray.z() * ray, i));
    }
    const textplane::Pyramid image(render(textplane::SE3d(), 1, 0).view(), 3);
    for (int i = 0; i < kInView; ++i) texts_.push_back(sign(i, image));
  }

  /// Fills the map with so many texts, those of the frame first.
  void fill(textplane::TextMap& map, int texts) const {
    for (int i = 0; i < texts; ++i) {
      const int host = i / kInView;
      textplane::SE3d T_h_w;
      T_h_w.t = {-kPeriod * host, 0, 0};
      if (i % kInView == 0) map.restore_keyframe(host, T_h_w);
      textplane::TextObject text = texts_[static_cast<std::size_t>(i % kInView)];
      text.id = i;
      text.host = host;
      map.restore_text(std::move(text));
    }
  }

 private:
  using Twist = textplane::Vector6<double>;

  static constexpr double kDepth = 3, kPeriod = 8;  // m

  // Random spots of 2.5 cm, which are 4 px, linear between them.
  static double ink(double x, double y) {
    return between_spots(x / 0.025, y / 0.025, [](int i, int j) {
      const auto column = static_cast<std::uint32_t>(std::fmod(i + 32000, kPeriod / 0.025));
      return spot_number(column, static_cast<std::uint32_t>(j + 1000)) % 2 == 0 ? 30.0 : 220.0;
    });
  }

  textplane::Image<std::uint8_t> render(const textplane::SE3d& T, double gain, double bias) {
    const textplane::SE3d T_w_c = T.inverse();
    textplane::Image<std::uint8_t> image(640, 480);
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x) {
        double sum = 0;
        for (const double dy : {-0.25, 0.25})
          for (const double dx : {-0.25, 0.25}) {
            const textplane::Vector3<double> ray = T_w_c.R * camera.unproject({x + dx, y + dy});
            const textplane::Vector3<double> p = T_w_c.t + (kDepth - T_w_c.t.z()) / ray.z() * ray;
            sum += ink(p.x(), p.y()) / 4;
          }
        image(x, y) = static_cast<std::uint8_t>(std::lround(gain * sum + bias + 2 * random_.normal()));
      }
    return image;
  }

  // One of five columns and four rows, the higher the larger, with a plane that is known to half a degree.
  textplane::TextObject sign(int i, const textplane::Pyramid& image) const {
    const double height[] = {15, 25, 40, 60}, left = 60 + 106 * (i % 5), top = 50 + 98 * (i / 5);
    const double right = left + 90, bottom = top + height[i / 5];
    textplane::TextImage host;
    host.pyramid = image.view();
    host.camera = camera;
    textplane::Quad<double> quad;
    quad.corner = {textplane::Vector2<double>(left, top), textplane::Vector2<double>(right, top),
                   textplane::Vector2<double>(right, bottom), textplane::Vector2<double>(left, bottom)};
    textplane::TextObject text;
    text.state = textplane::TextState::mapped;
    text.patch = textplane::make_text_patch(textplane::TextOptions(), host, quad);
    text.theta = {0, 0, 1 / kDepth};
    const textplane::Vector3<double> m = camera.unproject(textplane::centroid(quad));
    const textplane::Matrix3<double> information =
        m * m.transpose() / (0.001 * 0.001) + textplane::Matrix3<double>::Identity() / (0.003 * 0.003);
    text.covariance = textplane::Ldlt<double, 3>(information).inverse();
    text.variance_factor = 4;
    return text;
  }

  Random random_{5};
  std::vector<textplane::TextObject> texts_;
};

/// Leaves the first n pixels of each level.
inline void keep_pixels(textplane::TextPatch& patch, int n) {
  for (textplane::PatchLevel& level : patch.levels) {
    const std::size_t kept = (std::min)(level.x.size(), static_cast<std::size_t>(n));
    for (std::vector<float>* values : {&level.x, &level.y, &level.intensity, &level.gx, &level.gy})
      if (values->size() > kept) values->resize(kept);
    level.find_bounds();
  }
}

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SUPPORT_TEXT_WALL_HPP
