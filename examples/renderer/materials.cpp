#include "renderer/materials.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/random.hpp"

namespace textslam {

namespace {

constexpr double kWallDensity = 320.0;  // texels per metre
constexpr double kFurnitureDensity = 600.0;

/// Spots of random size and shade, `per_square_metre` of them.
void speckle(Canvas& canvas, double per_square_metre, double smallest, double largest, double depth, Random& random) {
  const int n = static_cast<int>(per_square_metre * canvas.width() * canvas.height());
  for (int i = 0; i < n; ++i) {
    const double x = random.uniform(0.0, canvas.width()), y = random.uniform(0.0, canvas.height());
    const double a = smallest * std::pow(largest / smallest, random.uniform()), b = a * random.uniform(0.4, 1.0);
    const double value = 128.0 + (random.chance(0.65) ? -depth : depth);
    canvas.ellipse(x, y, a, b, random.uniform(0.0, 3.14), value, random.uniform(0.3, 0.9));
  }
}

/// A line that wanders: a crack, a scratch.
void crack(Canvas& canvas, double x, double y, double length, double thickness, double value, Random& random) {
  double angle = random.uniform(0.0, 6.283);
  for (double done = 0.0; done < length;) {
    const double step = random.uniform(0.01, 0.05);
    const double x1 = x + step * std::cos(angle), y1 = y + step * std::sin(angle);
    canvas.line(x, y, x1, y1, thickness * random.uniform(0.6, 1.3), value, 0.8);
    x = x1;
    y = y1;
    done += step;
    angle += 0.6 * random.normal();
  }
}

void grain(Canvas& canvas, double strength, std::uint64_t seed) {
  canvas.apply([=](double x, double y, double v) { return v + strength * value_noise(150.0 * x, 150.0 * y, seed); });
}

}  // namespace

Canvas bare_wall(double width, double height, double base, std::uint64_t seed) {
  Canvas canvas(width, height, 0.5 * kWallDensity, base);
  canvas.apply([=](double x, double y, double v) { return v + 2.5 * fractal_noise(1.5 * x, 1.5 * y, seed, 3); });
  return canvas;
}

Canvas plaster(double width, double height, double base, double strength, std::uint64_t seed) {
  Random random(seed);
  Canvas canvas(width, height, kWallDensity, base);
  canvas.apply([=](double x, double y, double v) {
    const double clouds = fractal_noise(1.3 * x, 1.3 * y, seed, 6, 0.6);
    const double blotch = std::max(0.0, fractal_noise(2.9 * x, 2.9 * y, seed + 99, 5, 0.65) - 0.25);
    return v + strength * (30.0 * clouds - 75.0 * blotch);
  });
  speckle(canvas, 90.0 * strength, 0.004, 0.018, 95.0, random);
  const int cracks = static_cast<int>(1.2 * strength * width * height);
  for (int i = 0; i < cracks; ++i) {
    crack(canvas, random.uniform(0.0, width), random.uniform(0.0, height), random.uniform(0.2, 0.8), 0.006, base - 75.0,
          random);
  }
  grain(canvas, 5.0, seed + 3);
  return canvas;
}

Canvas bricks(double width, double height, double base, std::uint64_t seed) {
  constexpr double kLong = 0.225, kHigh = 0.075, kJoint = 0.006;
  Canvas canvas(width, height, kWallDensity);
  canvas.apply([=](double x, double y, double) {
    // Crooked by a few millimetres, as bricks are.
    const double xw = x + 0.003 * value_noise(9.0 * x, 9.0 * y, seed),
                 yw = y + 0.003 * value_noise(7.0 * x, 7.0 * y, seed + 1);
    const double row = std::floor(yw / kHigh);
    const double shifted = xw / kLong + (std::fmod(row, 2.0) != 0.0 ? 0.5 : 0.0);
    const double column = std::floor(shifted);
    const double from_joint = std::min(
        {(shifted - column) * kLong, (1.0 - shifted + column) * kLong, yw - row * kHigh, (row + 1.0) * kHigh - yw});
    const double rough = fractal_noise(40.0 * x, 40.0 * y, seed + 2, 3);
    const double mortar = base + 45.0 + 12.0 * rough;
    const std::uint64_t own = hash(seed, static_cast<std::uint64_t>(static_cast<std::int64_t>(row)),
                                   static_cast<std::uint64_t>(static_cast<std::int64_t>(column)));
    const double brick =
        base + 70.0 * (unit(own) - 0.6) + 14.0 * rough + 16.0 * fractal_noise(6.0 * x, 6.0 * y, own, 2);
    const double a = std::clamp((from_joint - kJoint) / 0.003 + 0.5, 0.0, 1.0);
    return mortar + a * (brick - mortar);
  });
  Random random(seed + 5);
  speckle(canvas, 25.0, 0.003, 0.012, 80.0, random);
  return canvas;
}

Canvas boards(double width, double height, double base, bool upright, std::uint64_t seed) {
  constexpr double kBoard = 0.14;
  Canvas canvas(width, height, kWallDensity);
  canvas.apply([=](double x, double y, double) {
    const double across = upright ? x : y, along = upright ? y : x;
    const double board = std::floor(across / kBoard);
    const std::uint64_t own = hash(seed, static_cast<std::uint64_t>(static_cast<std::int64_t>(board)));
    // Each board is cut somewhere else.
    const double piece = std::floor(along / 1.1 + unit(own));
    const std::uint64_t wood = hash(own, static_cast<std::uint64_t>(static_cast<std::int64_t>(piece)));
    const double inside = across - board * kBoard;
    const double end = (along / 1.1 + unit(own) - piece) * 1.1;
    const double joint = std::min({inside, kBoard - inside, end, 1.1 - end});
    const double warp = across * 55.0 + 2.5 * value_noise(5.0 * along, 20.0 * across, wood);
    const double rings = fractal_noise(2.2 * along, warp, wood + 1, 4, 0.6);
    const double value = base + 42.0 * (unit(wood) - 0.5) + 28.0 * rings;
    return joint < 0.003 ? value - 70.0 : value;
  });
  Random random(seed + 7);
  const int knots = static_cast<int>(2.5 * width * height);
  for (int i = 0; i < knots; ++i) {
    const double x = random.uniform(0.0, width), y = random.uniform(0.0, height), r = random.uniform(0.006, 0.022);
    canvas.ellipse(x, y, upright ? r : 1.7 * r, upright ? 1.7 * r : r, 0.0, base - 55.0, 0.7);
    canvas.ellipse(x, y, 0.5 * r, 0.6 * r, 0.0, base - 90.0, 0.8);
  }
  return canvas;
}

Canvas tiles(double width, double height, double side, double base, std::uint64_t seed) {
  Canvas canvas(width, height, 0.75 * kWallDensity);
  canvas.apply([=](double x, double y, double) {
    const double i = std::floor(x / side), j = std::floor(y / side);
    const double joint = std::min({x - i * side, (i + 1) * side - x, y - j * side, (j + 1) * side - y});
    const std::uint64_t own = hash(seed, static_cast<std::uint64_t>(static_cast<std::int64_t>(i)),
                                   static_cast<std::uint64_t>(static_cast<std::int64_t>(j)));
    const double value = base + 30.0 * (unit(own) - 0.5) + 10.0 * fractal_noise(12.0 * x, 12.0 * y, own, 3);
    return joint < 0.004 ? base - 60.0 : value;
  });
  Random random(seed + 11);
  speckle(canvas, 110.0, 0.004, 0.018, 65.0, random);
  return canvas;
}

Canvas panels(double width, double height, double base, std::uint64_t seed) {
  constexpr double kSide = 0.6;
  Canvas canvas(width, height, 0.5 * kWallDensity);
  canvas.apply([=](double x, double y, double) {
    const double a = std::fmod(x, kSide), b = std::fmod(y, kSide);
    const double joint = std::min({a, kSide - a, b, kSide - b});
    return joint < 0.008 ? base - 70.0 : base + 10.0 * fractal_noise(8.0 * x, 8.0 * y, seed, 4);
  });
  Random random(seed);
  speckle(canvas, 45.0, 0.005, 0.012, 60.0, random);
  return canvas;
}

Canvas book_shelf(double width, double height, std::uint64_t seed) {
  constexpr double kShelf = 0.34, kBoard = 0.022;
  Random random(seed);
  Canvas canvas(width, height, kFurnitureDensity, 38.0);
  const int shelves = std::max(1, static_cast<int>(height / kShelf));
  const double step = height / shelves;
  for (int k = 0; k < shelves; ++k) {
    const double floor = (k + 1) * step - kBoard;
    double x = 0.03;
    while (x < width - 0.06) {
      const double thick = random.uniform(0.014, 0.05);
      if (x + thick > width - 0.03) break;
      if (random.chance(0.07)) {
        x += random.uniform(0.02, 0.09);
        continue;
      }
      const double tall = random.uniform(0.55, 0.93) * (step - kBoard), lean = random.chance(0.08) ? 0.06 : 0.0;
      const double shade = random.uniform(35.0, 225.0), middle = x + 0.5 * thick;
      canvas.rectangle(middle, floor - 0.5 * tall, 0.5 * thick - 0.001, 0.5 * tall, lean, shade);
      const int bands = random.below(4);
      for (int b = 0; b < bands; ++b) {
        canvas.rectangle(middle, floor - random.uniform(0.1, 0.9) * tall, 0.5 * thick - 0.003,
                         random.uniform(0.003, 0.02), lean,
                         shade > 120.0 ? random.uniform(20.0, 80.0) : random.uniform(150.0, 235.0));
      }
      x += thick + 0.001;
    }
    canvas.rectangle(0.5 * width, floor + 0.5 * kBoard, 0.5 * width, 0.5 * kBoard, 0.0, 150.0);
  }
  for (const double x : {0.0125, width - 0.0125}) canvas.rectangle(x, 0.5 * height, 0.0125, 0.5 * height, 0.0, 145.0);
  canvas.rectangle(0.5 * width, 0.0125, 0.5 * width, 0.0125, 0.0, 160.0);
  grain(canvas, 5.0, seed);
  return canvas;
}

Canvas door(double width, double height, double base, std::uint64_t seed) {
  Canvas canvas = boards(width, height, base, true, seed);
  for (const double y : {0.27, 0.72}) {
    canvas.rectangle(0.5 * width, y * height, 0.36 * width, 0.19 * height, 0.0, base - 45.0, 0.5);
    canvas.rectangle(0.5 * width, y * height, 0.34 * width, 0.18 * height, 0.0, base + 8.0, 0.8);
  }
  canvas.ellipse(0.9 * width, 0.52 * height, 0.03, 0.03, 0.0, 215.0);
  canvas.line(0.9 * width, 0.52 * height, 0.9 * width - 0.11, 0.52 * height, 0.02, 225.0);
  const double frame = 0.035;
  for (const double x : {0.5 * frame, width - 0.5 * frame}) {
    canvas.rectangle(x, 0.5 * height, 0.5 * frame, 0.5 * height, 0.0, base - 60.0);
  }
  canvas.rectangle(0.5 * width, 0.5 * frame, 0.5 * width, 0.5 * frame, 0.0, base - 60.0);
  return canvas;
}

Canvas crate(double width, double height, double base, std::uint64_t seed) {
  Random random(seed);
  Canvas canvas(width, height, kFurnitureDensity, base);
  canvas.apply([=](double x, double y, double v) { return v + 16.0 * fractal_noise(5.0 * x, 40.0 * y, seed, 4); });
  canvas.rectangle(0.5 * width, 0.5 * height, 0.5 * width, 0.025, 0.0, base + 45.0, 0.7);
  for (int i = 0; i < static_cast<int>(14.0 * width * height) + 3; ++i) {
    const double x = random.uniform(0.05, width - 0.05), y = random.uniform(0.05, height - 0.05);
    canvas.rectangle(x, y, random.uniform(0.01, 0.05), random.uniform(0.008, 0.035), random.uniform(-0.3, 0.3),
                     random.chance(0.5) ? 225.0 : 45.0, 0.85);
  }
  for (int i = 0; i < 5; ++i) {
    crack(canvas, random.uniform(0.0, width), random.uniform(0.0, height), random.uniform(0.05, 0.3), 0.005,
          base - 60.0, random);
  }
  grain(canvas, 6.0, seed + 1);
  return canvas;
}

}  // namespace textslam
