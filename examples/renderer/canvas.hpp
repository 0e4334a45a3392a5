// Canvas: a float image with a physical size, on which textures are painted in metres before they become 8 bits.
#ifndef TEXTSLAM_RENDERER_CANVAS_HPP
#define TEXTSLAM_RENDERER_CANVAS_HPP

#include <cstdint>
#include <functional>

#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"

namespace textslam {

class Canvas {
 public:
  /// `width` x `height` metres at about `density` texels a metre (whole texels, at least one), filled with `value`.
  Canvas(double width, double height, double density, double value = 128.0);

  double width() const noexcept { return width_; }
  double height() const noexcept { return height_; }
  /// Texels a metre across and down.
  textplane::Vector2<double> density() const noexcept { return {pixels_.width() / width_, pixels_.height() / height_}; }
  textplane::Image<float>& pixels() noexcept { return pixels_; }
  const textplane::Image<float>& pixels() const noexcept { return pixels_; }

  /// A strip of whole columns, as wide as they are.
  Canvas columns(int first, int count) const;

  /// value = f(x, y, value) at every texel centre; x and y in metres from the top left.
  void apply(const std::function<double(double, double, double)>& f);

  /// Blends `value` over the texels where the signed distance `distance` (metres) is negative, with an edge one texel
  /// soft. Only the box [x0, x1] x [y0, y1] is visited.
  void fill(double x0, double y0, double x1, double y1, double value, double opacity,
            const std::function<double(double, double)>& distance);

  /// Shapes: filled, in metres, `angle` in radians.
  void rectangle(double x, double y, double half_width, double half_height, double angle, double value,
                 double opacity = 1.0);
  void ellipse(double x, double y, double radius_x, double radius_y, double angle, double value, double opacity = 1.0);
  void line(double x0, double y0, double x1, double y1, double thickness, double value, double opacity = 1.0);
  void triangle(const textplane::Vector2<double> corner[3], double value, double opacity = 1.0);

 private:
  double width_, height_;
  textplane::Image<float> pixels_;
};

/// Value noise in [-1, 1], smooth, features about one unit apart.
double value_noise(double x, double y, std::uint64_t seed) noexcept;

/// Octaves of value_noise, each of half the size and `gain` of the strength of the one before; mostly within [-1, 1].
double fractal_noise(double x, double y, std::uint64_t seed, int octaves, double gain = 0.5) noexcept;

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_CANVAS_HPP
