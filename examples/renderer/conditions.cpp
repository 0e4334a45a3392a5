#include "renderer/conditions.hpp"

#include <algorithm>
#include <cmath>

namespace textslam {

void apply(const Conditions& conditions, Shot* shot) {
  if (conditions.blur) shot->exposure = 0.0;
  if (!conditions.gain && !conditions.noise) return;
  shot->sensor = [conditions, kind = shot->sensor](double t) {
    SensorState state = kind(t);
    if (conditions.gain) state.gain = *conditions.gain;
    if (conditions.noise) {
      state.noise = *conditions.noise;
      state.shot = 0.0;
    }
    return state;
  };
}

Image<double> blur_along(const Image<double>& light, const Vector2<double>& direction, double length) {
  const int width = light.width(), height = light.height();
  const int samples = length > 0.0 ? static_cast<int>(std::ceil(length)) + 1 : 1;
  Image<double> sum(width, height);
  for (int i = 0; i < samples; ++i) {
    const Vector2<double> offset = direction * (length * ((i + 0.5) / samples - 0.5));
    const int x0 = static_cast<int>(std::floor(offset[0])), y0 = static_cast<int>(std::floor(offset[1]));
    const double fx = offset[0] - x0, fy = offset[1] - y0;
    for (int y = 0; y < height; ++y) {
      const double* upper = light.row(std::clamp(y + y0, 0, height - 1));
      const double* lower = light.row(std::clamp(y + y0 + 1, 0, height - 1));
      for (int x = 0; x < width; ++x) {
        const int a = std::clamp(x + x0, 0, width - 1), b = std::clamp(x + x0 + 1, 0, width - 1);
        sum(x, y) +=
            ((1.0 - fy) * ((1.0 - fx) * upper[a] + fx * upper[b]) + fy * ((1.0 - fx) * lower[a] + fx * lower[b])) /
            samples;
      }
    }
  }
  return sum;
}

}  // namespace textslam
