// Framed pictures: the posters of the scenes.
#include <algorithm>
#include <cmath>

#include "renderer/materials.hpp"
#include "renderer/random.hpp"

namespace textslam {

namespace {

constexpr double kDensity = 700.0;  // texels per metre

void landscape(Canvas& canvas, Random& random) {
  const double w = canvas.width(), h = canvas.height();
  const std::uint64_t seed = random.word();
  canvas.apply([=](double x, double y, double) {
    return 225.0 - 70.0 * y / h + 18.0 * fractal_noise(4.0 * x / w, 9.0 * y / h, seed, 4);
  });
  canvas.ellipse(random.uniform(0.2, 0.8) * w, 0.2 * h, 0.07 * w, 0.07 * w, 0.0, 252.0);
  for (int range = 0; range < 4; ++range) {
    const double level = (0.42 + 0.14 * range) * h, shade = 150.0 - 33.0 * range;
    const std::uint64_t own = random.word();
    canvas.apply([=](double x, double y, double v) {
      const double ridge = level + 0.13 * h * fractal_noise(3.5 * x / w, 0.0, own, 5, 0.55);
      return y > ridge ? shade + 22.0 * fractal_noise(14.0 * x / w, 14.0 * y / h, own + 1, 3) : v;
    });
  }
  for (int i = 0; i < 14; ++i) {
    const double x = random.uniform(0.03, 0.97) * w, y = random.uniform(0.72, 0.97) * h,
                 s = random.uniform(0.04, 0.1) * h;
    const Vector2<double> tree[3] = {{x, y - 2.0 * s}, {x + 0.6 * s, y}, {x - 0.6 * s, y}};
    canvas.triangle(tree, random.uniform(15.0, 60.0));
  }
}

void shapes(Canvas& canvas, Random& random) {
  const double w = canvas.width(), h = canvas.height(), size = std::min(w, h);
  canvas.rectangle(0.5 * w, 0.5 * h, 0.5 * w, 0.5 * h, 0.0, random.uniform(120.0, 235.0));
  for (int i = 0; i < 26; ++i) {
    const double x = random.uniform(0.0, w), y = random.uniform(0.0, h), s = size * random.uniform(0.04, 0.2);
    const double shade = random.uniform(10.0, 245.0), angle = random.uniform(0.0, 3.14);
    switch (random.below(4)) {
      case 0: canvas.rectangle(x, y, s, s * random.uniform(0.2, 1.0), angle, shade); break;
      case 1: canvas.ellipse(x, y, s, s * random.uniform(0.5, 1.0), angle, shade); break;
      case 2: canvas.line(x, y, x + 2.5 * s * std::cos(angle), y + 2.5 * s * std::sin(angle), 0.12 * s, shade); break;
      default: {
        const Vector2<double> corner[3] = {{x + s * std::cos(angle), y + s * std::sin(angle)},
                                           {x + s * std::cos(angle + 2.2), y + s * std::sin(angle + 2.2)},
                                           {x + s * std::cos(angle + 4.0), y + s * std::sin(angle + 4.0)}};
        canvas.triangle(corner, shade);
      }
    }
  }
}

void blossoms(Canvas& canvas, Random& random) {
  const double w = canvas.width(), h = canvas.height(), size = std::min(w, h);
  const std::uint64_t seed = random.word();
  canvas.apply(
      [=](double x, double y, double) { return 70.0 + 40.0 * fractal_noise(7.0 * x / w, 7.0 * y / h, seed, 5, 0.6); });
  for (int i = 0; i < 22; ++i) {
    const double x = random.uniform(0.0, w), y = random.uniform(0.0, h), s = size * random.uniform(0.04, 0.1);
    const double shade = random.uniform(140.0, 250.0), turn = random.uniform(0.0, 1.2);
    canvas.line(x, y, x + random.uniform(-0.2, 0.2) * w, h, 0.008, 35.0, 0.8);
    for (int leaf = 0; leaf < 5; ++leaf) {
      const double angle = turn + 1.2566 * leaf;
      canvas.ellipse(x + 0.8 * s * std::cos(angle), y + 0.8 * s * std::sin(angle), 0.75 * s, 0.36 * s, angle, shade);
    }
    canvas.ellipse(x, y, 0.36 * s, 0.36 * s, 0.0, 40.0);
  }
}

void mosaic(Canvas& canvas, Random& random) {
  const double w = canvas.width(), h = canvas.height();
  const std::uint64_t seed = random.word();
  const double pieces = 11.0 + 8.0 * random.uniform();
  canvas.apply([=](double x, double y, double) {
    // Voronoi cells of one jittered point a unit square.
    const double px = pieces * x / w, py = pieces * y / w;
    double nearest = 1e9, second = 1e9, shade = 0.0;
    for (int dj = -1; dj <= 1; ++dj) {
      for (int di = -1; di <= 1; ++di) {
        const double i = std::floor(px) + di, j = std::floor(py) + dj;
        const std::uint64_t own = hash(seed, static_cast<std::uint64_t>(static_cast<std::int64_t>(i)),
                                       static_cast<std::uint64_t>(static_cast<std::int64_t>(j)));
        const double d = std::hypot(i + unit(own) - px, j + unit(mix(own + 1)) - py);
        if (d < nearest) {
          second = nearest;
          nearest = d;
          shade = unit(mix(own + 2));
        } else {
          second = std::min(second, d);
        }
      }
    }
    const double wave = fractal_noise(2.5 * x / w, 2.5 * y / h, seed, 2);
    return second - nearest < 0.07 ? 30.0 : std::clamp(130.0 + 90.0 * wave + 90.0 * (shade - 0.5), 20.0, 245.0);
  });
}

}  // namespace

Canvas picture(double width, double height, int style, std::uint64_t seed) {
  Random random(seed);
  Canvas canvas(width, height, kDensity);
  switch (style) {
    case 0: landscape(canvas, random); break;
    case 1: shapes(canvas, random); break;
    case 2: blossoms(canvas, random); break;
    default: mosaic(canvas, random);
  }
  const std::uint64_t own = random.word();
  canvas.apply([=](double x, double y, double v) { return v + 7.0 * value_noise(90.0 * x, 90.0 * y, own); });
  const double frame = 0.022, shade = random.chance(0.5) ? 40.0 : 225.0;
  for (const double x : {0.5 * frame, width - 0.5 * frame}) {
    canvas.rectangle(x, 0.5 * height, 0.5 * frame, 0.5 * height, 0.0, shade);
  }
  for (const double y : {0.5 * frame, height - 0.5 * frame}) {
    canvas.rectangle(0.5 * width, y, 0.5 * width, 0.5 * frame, 0.0, shade);
  }
  return canvas;
}

}  // namespace textslam
