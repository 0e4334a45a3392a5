#include "renderer/scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace textslam {

namespace {

constexpr double kAmbient = 0.8;
constexpr double kLampStrength = 2.2;  // m^2
constexpr double kEdgeShade = 0.22;
constexpr double kEdgeWidth = 0.25;  // m

/// Light at a place: what comes from everywhere, and each lamp by Lambert's cosine and the square of its distance.
double light_at(const std::vector<Vector3<double>>& lamps, const Vector3<double>& p, const Vector3<double>& normal) {
  if (lamps.empty()) return 1.0;
  double light = kAmbient;
  for (const Vector3<double>& lamp : lamps) {
    const Vector3<double> to = lamp - p;
    const double d2 = to.squaredNorm();
    light += kLampStrength / static_cast<double>(lamps.size()) * std::max(0.0, normal.dot(to)) /
             (std::sqrt(d2) * (d2 + 1.0));
  }
  return light;
}

Image<std::uint8_t> lit(const Canvas& paint, const Rectangle& rectangle, const std::vector<Vector3<double>>& lamps,
                        bool corners_darken) {
  const Vector3<double> normal = rectangle.normal();
  const Image<float>& from = paint.pixels();
  Image<std::uint8_t> texture(from.width(), from.height());
  // Light is smooth: one value in eight texels each way, linear between.
  constexpr int kStep = 8;
  const Vector2<double> d = paint.density();
  const auto light = [&](int i, int j) {
    const double s = (i + 0.5) / d[0], t = (j + 0.5) / d[1];
    double l = light_at(lamps, rectangle.at(s, t), normal);
    if (corners_darken) {
      for (const double edge : {s, rectangle.width - s, t, rectangle.height - t}) {
        l *= 1.0 - kEdgeShade * std::exp(-std::max(0.0, edge) / kEdgeWidth);
      }
    }
    return l;
  };
  Image<float> lights(from.width() / kStep + 2, from.height() / kStep + 2);
  for (int j = 0; j < lights.height(); ++j) {
    for (int i = 0; i < lights.width(); ++i) lights(i, j) = static_cast<float>(light(i * kStep, j * kStep));
  }
  for (int j = 0; j < from.height(); ++j) {
    for (int i = 0; i < from.width(); ++i) {
      const int a = i / kStep, b = j / kStep;
      const float x = static_cast<float>(i % kStep) / kStep, y = static_cast<float>(j % kStep) / kStep;
      const float top = lights(a, b) + x * (lights(a + 1, b) - lights(a, b));
      const float bottom = lights(a, b + 1) + x * (lights(a + 1, b + 1) - lights(a, b + 1));
      const float value = from(i, j) * (top + y * (bottom - top));
      texture(i, j) = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
    }
  }
  return texture;
}

}  // namespace

Rectangle facing(const Vector3<double>& centre, const Vector3<double>& towards, double width, double height,
                 double roll) {
  const Vector3<double> forward = -towards.normalized();
  const Vector3<double> right = forward.cross(Vector3<double>::UnitZ()).normalized();
  const Vector3<double> down = forward.cross(right);
  Rectangle r;
  r.right = std::cos(roll) * right + std::sin(roll) * down;
  r.down = forward.cross(r.right);
  r.width = width;
  r.height = height;
  r.corner = centre - 0.5 * width * r.right - 0.5 * height * r.down;
  return r;
}

Rectangle on(const Rectangle& wall, double s, double t, double width, double height, double lift) {
  Rectangle r = wall;
  r.width = width;
  r.height = height;
  r.corner = wall.at(s - 0.5 * width, t - 0.5 * height) + lift * wall.normal();
  return r;
}

Rectangle Surface::at(double time) const {
  if (!carrier) return rectangle;
  const SE3d T = (*carrier)(time);
  Rectangle moved = rectangle;
  moved.corner = T * rectangle.corner;
  moved.right = T.R * rectangle.right;
  moved.down = T.R * rectangle.down;
  return moved;
}

Vector3<double> Surface::carried(const Vector3<double>& p, double from, double to) const {
  return carrier ? Vector3<double>((*carrier)(to) * ((*carrier)(from).inverse() * p)) : p;
}

void Scene::add(const Rectangle& rectangle, const Canvas& paint, bool corners_darken) {
  add_unlit(rectangle, lit(paint, rectangle, lamps, corners_darken));
}

void Scene::add(const Rectangle& rectangle, Paint paint, bool corners_darken) {
  textures_.emplace_back(
      [=, paint = std::move(paint), by = lamps] { return lit(paint(), rectangle, by, corners_darken); });
  surfaces_.push_back({rectangle, &textures_.back()});
}

void Scene::add_unlit(const Rectangle& rectangle, Image<std::uint8_t> texture) {
  textures_.emplace_back(std::move(texture));
  surfaces_.push_back({rectangle, &textures_.back()});
}

void Scene::add_pane(const Rectangle& rectangle, const Canvas& paint, Image<std::uint8_t> opacity) {
  add(rectangle, paint);
  textures_.emplace_back(std::move(opacity));
  surfaces_.back().opacity = &textures_.back();
}

void Scene::add_sign(std::string word, const Rectangle& text, double radius) {
  signs_.push_back(
      {static_cast<int>(signs_.size()),
       std::move(word),
       {text.at(0.0, 0.0), text.at(text.width, 0.0), text.at(text.width, text.height), text.at(0.0, text.height)},
       text.normal(),
       radius});
}

Vector3<double> Sign::at(double across, double down) const {
  const Vector3<double> right = corner[1] - corner[0];
  const Vector3<double> flat = corner[0] + across * right + down * (corner[3] - corner[0]);
  if (!(radius > 0.0)) return flat;
  const double half = std::asin(0.5 * right.norm() / radius), angle = (2.0 * across - 1.0) * half;
  return corner[0] + 0.5 * right + down * (corner[3] - corner[0]) + radius * std::sin(angle) * right.normalized() +
         radius * (std::cos(angle) - std::cos(half)) * normal;
}

Sign Sign::standing(double time) const {
  Sign there = *this;
  there.carrier = nullptr;
  if (!carrier) return there;
  const SE3d T = (*carrier)(time);
  for (Vector3<double>& c : there.corner) c = T * c;
  there.normal = T.R * normal;
  return there;
}

void Scene::carry(std::size_t first, Motion motion, std::size_t first_sign) {
  carriers_.push_back(std::move(motion));
  for (std::size_t i = first_sign; i < signs_.size(); ++i) signs_[i].carrier = &carriers_.back();
  for (std::size_t i = first; i < surfaces_.size(); ++i) surfaces_[i].carrier = &carriers_.back();
}

Hit Scene::first_hit(const Vector3<double>& origin, const Vector3<double>& direction, double time) const {
  Hit best;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    if (surfaces_[i].opacity) continue;
    const Rectangle r = surfaces_[i].at(time);
    const Vector3<double> normal = r.normal();
    const double approach = normal.dot(direction), height = normal.dot(origin - r.corner);
    if (!(approach < 0.0) || !(height > 0.0)) continue;
    const double distance = -height / approach;
    if (distance < 1e-9 || (best.surface >= 0 && distance >= best.distance)) continue;
    const Vector3<double> p = origin + distance * direction - r.corner;
    const double s = r.right.dot(p), t = r.down.dot(p);
    if (s < 0.0 || s > r.width || t < 0.0 || t > r.height) continue;
    best = {static_cast<int>(i), distance};
  }
  return best;
}

}  // namespace textslam
