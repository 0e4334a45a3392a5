// A textured plane seen under homographies and changing light, with exact point motion: input for the tracking tests.
#ifndef TEXTPLANE_TESTS_FEATURES_SYNTHETIC_HPP
#define TEXTPLANE_TESTS_FEATURES_SYNTHETIC_HPP

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "support/random.hpp"
#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"

namespace textplane_test {

using textplane::Image;
using Matrix3d = textplane::Matrix3<double>;
using Vector2d = textplane::Vector2<double>;
using Vector2f = textplane::Vector2<float>;

inline std::uint8_t to_byte(double v) { return static_cast<std::uint8_t>(std::min(std::max(v + 0.5, 0.0), 255.0)); }

// Light of one frame: gain and bias, a gain that falls off across the image (per px, along x and y), sensor noise.
struct Light {
  double gain = 1, bias = 0, slope_x = 0, slope_y = 0, noise = 0;
};

// Letter-like strokes and blocks on a mottled ground, drawn at two texels a pixel and smoothed.
class TexturedPlane {
 public:
  explicit TexturedPlane(std::uint32_t seed, int size = 1800) : texture_(size, size, 128.0F) {
    Random random(seed);
    mottle(random);
    for (int i = 0; i < size * size / 900; ++i) {
      const bool stroke = random.uniform(0, 1) < 0.7;
      const double length = stroke ? random.uniform(10, 40) : random.uniform(10, 60);
      const double thick = stroke ? random.uniform(4, 9) : random.uniform(10, 40);
      // One draw a statement: the order of arguments' evaluation, and so the picture, would be the compiler's choice.
      const auto tone = static_cast<float>(random.uniform(20, 235));
      const double angle = random.uniform(0, 3.1416), y = random.uniform(0, size), x = random.uniform(0, size);
      bar(x, y, angle, length, thick, tone);
    }
    smooth();
    smooth();
  }

  // Intensity at texture position (u, v) in px of the reference image, clamped at the border.
  double operator()(double u, double v) const {
    const double limit = texture_.width() - 1.001;
    const double x = std::min(std::max(2 * u + texture_.width() / 4.0, 0.0), limit);
    const double y = std::min(std::max(2 * v + texture_.width() / 4.0, 0.0), limit);
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const double a = x - x0, b = y - y0;
    return (1 - b) * ((1 - a) * static_cast<double>(texture_(x0, y0)) + a * static_cast<double>(texture_(x0 + 1, y0))) +
           b * ((1 - a) * static_cast<double>(texture_(x0, y0 + 1)) +
                a * static_cast<double>(texture_(x0 + 1, y0 + 1)));
  }

  // The image in which pixel p shows the plane at H p: 4 x 4 samples a pixel.
  Image<std::uint8_t> render(const Matrix3d& H, int width, int height, const Light& light, std::uint32_t seed) const {
    Random random(seed);
    Image<std::uint8_t> image(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        double sum = 0;
        for (int j = 0; j < 4; ++j)
          for (int i = 0; i < 4; ++i) {
            const Vector2d p = apply(H, {x + (i - 1.5) / 4, y + (j - 1.5) / 4});
            sum += (*this)(p[0], p[1]);
          }
        const double gain = light.gain + light.slope_x * (x - width / 2.0) + light.slope_y * (y - height / 2.0);
        const double noise = light.noise > 0 ? light.noise * random.normal() : 0;
        image(x, y) = to_byte(gain * sum / 16 + light.bias + noise);
      }
    return image;
  }

  static Vector2d apply(const Matrix3d& H, const Vector2d& p) {
    const double w = H(2, 0) * p[0] + H(2, 1) * p[1] + H(2, 2);
    return {(H(0, 0) * p[0] + H(0, 1) * p[1] + H(0, 2)) / w, (H(1, 0) * p[0] + H(1, 1) * p[1] + H(1, 2)) / w};
  }

 private:
  void mottle(Random& random) {
    const int size = texture_.width(), cell = 24, n = size / cell + 2;
    std::vector<float> knot(static_cast<std::size_t>(n * n));
    for (float& k : knot) k = static_cast<float>(random.uniform(90, 170));
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const int i = x / cell, j = y / cell;
        const float a = static_cast<float>(x % cell) / cell, b = static_cast<float>(y % cell) / cell;
        const auto at = [&](int c, int r) { return knot[static_cast<std::size_t>(r * n + c)]; };
        texture_(x, y) =
            (1 - b) * ((1 - a) * at(i, j) + a * at(i + 1, j)) + b * ((1 - a) * at(i, j + 1) + a * at(i + 1, j + 1));
      }
  }

  void bar(double cx, double cy, double angle, double length, double thick, float value) {
    const double c = std::cos(angle), s = std::sin(angle);
    const int reach = static_cast<int>(length + thick), size = texture_.width();
    for (int y = std::max(static_cast<int>(cy) - reach, 0); y < std::min(static_cast<int>(cy) + reach, size); ++y)
      for (int x = std::max(static_cast<int>(cx) - reach, 0); x < std::min(static_cast<int>(cx) + reach, size); ++x) {
        const double u = c * (x - cx) + s * (y - cy), v = -s * (x - cx) + c * (y - cy);
        if (std::abs(u) <= length / 2 && std::abs(v) <= thick / 2) texture_(x, y) = value;
      }
  }

  void smooth() {
    const Image<float> source = texture_;
    for (int y = 1; y + 1 < source.height(); ++y)
      for (int x = 1; x + 1 < source.width(); ++x) {
        float sum = 0;
        for (int j = -1; j <= 1; ++j)
          for (int i = -1; i <= 1; ++i) sum += source(x + i, y + j);
        texture_(x, y) = sum / 9;
      }
  }

  Image<float> texture_;
};

// Homography of pixels: rotation by `angle` and zoom about the image centre, shift, and a perspective part.
inline Matrix3d motion(double angle, double zoom, double dx, double dy, double px, double py, int width, int height) {
  Matrix3d centre, back, m;
  centre << 1, 0, -width / 2.0, 0, 1, -height / 2.0, 0, 0, 1;
  back << 1, 0, width / 2.0 + dx, 0, 1, height / 2.0 + dy, 0, 0, 1;
  m << zoom * std::cos(angle), -zoom * std::sin(angle), 0, zoom * std::sin(angle), zoom * std::cos(angle), 0, px, py, 1;
  return back * m * centre;
}

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_FEATURES_SYNTHETIC_HPP
