#include "textslam/text/text_reading.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/quad_projection.hpp"
#include "textplane/landmarks/words.hpp"
#include "textplane/photometry/sample.hpp"
#include "textslam/map/text_views.hpp"

namespace textslam {
namespace {

// The upright rectangle in the host's frame: corner and its sides, each as long as the rectangle.
struct Rectangle3 {
  Vec3 corner, along, down;
};

bool upright_rectangle(const TextObject& text, double max_length, Rectangle3* out) {
  std::array<Vec3, 4> p;
  if (!textplane::is_ok(textplane::text_corners(text, &p))) return false;
  const Vec3 right = (p[1] - p[0] + p[2] - p[3]).normalized();
  const Vec3 down = right.cross(textplane::plane_normal(text.theta));
  double low_x = 0, high_x = 0, low_y = 0, high_y = 0;
  for (const Vec3& corner : p) {
    const Vec3 d = corner - p[0];
    low_x = std::min(low_x, right.dot(d));
    high_x = std::max(high_x, right.dot(d));
    low_y = std::min(low_y, down.dot(d));
    high_y = std::max(high_y, down.dot(d));
  }
  *out = {p[0] + low_x * right + low_y * down, (high_x - low_x) * right, (high_y - low_y) * down};
  return out->along.allFinite() && out->down.norm() > 0 && out->along.norm() < max_length * out->down.norm();
}

double sharpness_of(const Image<std::uint8_t>& picture) {
  double sum = 0;
  for (int y = 0; y + 1 < picture.height(); ++y)
    for (int x = 0; x + 1 < picture.width(); ++x) {
      const double dx = picture(x + 1, y) - picture(x, y), dy = picture(x, y + 1) - picture(x, y);
      sum += dx * dx + dy * dy;
    }
  return sum;
}

// A detector seldom tells which way is up; a reader is surer of a text that is.
TextReader::Reading read_either_way(TextReader& reader, const SquareView& view) {
  const auto& c = view.quad.corner;
  Quad<double> turned;
  turned.corner = {c[2], c[3], c[0], c[1]};
  const TextReader::Reading upright = reader.read(view.picture.view(), view.quad);
  const TextReader::Reading over = reader.read(view.picture.view(), turned);
  return over.score > upright.score ? over : upright;
}

}  // namespace

SquareView square_view(const Map& map, const TextObject& text, int id, const Parameters& parameters) {
  const int height = parameters.reading_height;
  SquareView view;
  Rectangle3 rectangle;
  if (!upright_rectangle(text, parameters.reading_max_length, &rectangle)) return view;
  const SE3d T_k_h = map.T_c_h(map.keyframe(id).T_w_c.inverse(), text.host);
  const double step = rectangle.down.norm() / height;
  const int width = std::max(1, static_cast<int>(std::lround(rectangle.along.norm() / step)));
  const int margin = static_cast<int>(std::lround(parameters.reading_margin * height));
  const Vec3 dx = T_k_h.R * rectangle.along / width, dy = T_k_h.R * rectangle.down / height;
  const Vec3 first = T_k_h * rectangle.corner + (0.5 - margin) * (dx + dy);  // centre of the picture's first pixel
  const Vec3 centre = first + 0.5 * (width + 2 * margin) * dx + 0.5 * (height + 2 * margin) * dy;
  if (!map.camera.in_domain(centre)) return view;

  const Pyramid& image = *map.keyframe(id).frame.image;
  const double px_a_step = focal_at(map.camera, centre) * step / centre.z();
  int level = 0;
  while (level + 1 < image.levels() && std::ldexp(px_a_step, -level) > parameters.reading_max_step) ++level;
  const ImageView8 pixels = image.level(level);
  const auto place = [&](double x, double y, Vec2* px) {
    const Vec3 p = first + x * dx + y * dy;
    if (!map.camera.in_domain(p)) return false;
    *px = ((map.camera.project(p).array() + 0.5) * std::ldexp(1.0, -level) - 0.5).matrix();
    return true;
  };

  view.quad.corner = {Vec2(margin - 0.5, margin - 0.5), Vec2(margin + width - 0.5, margin - 0.5),
                      Vec2(margin + width - 0.5, margin + height - 0.5), Vec2(margin - 0.5, margin + height - 0.5)};
  for (const Vec2& corner : view.quad.corner) {
    Vec2 px;
    if (!place(corner.x(), corner.y(), &px) || !pixels.contains(px.x(), px.y())) return view;
  }
  Image<std::uint8_t> picture(width + 2 * margin, height + 2 * margin);
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      Vec2 px;
      double value = 0;
      if (!place(x, y, &px)) return view;
      px.x() = std::clamp(px.x(), 0.0, pixels.width() - 1.0);
      px.y() = std::clamp(px.y(), 0.0, pixels.height() - 1.0);
      textplane::sample_bilinear(pixels, px.x(), px.y(), &value);
      picture(x, y) = static_cast<std::uint8_t>(std::lround(value));
    }
  view.picture = std::move(picture);
  view.sharpness = sharpness_of(view.picture);
  return view;
}

void read_texts(Map& map, const Parameters& parameters, TextReader& reader) {
  for (TextObject& text : map.texts) {
    if (text.state != TextState::mapped) continue;
    std::vector<int> keyframes = text.views;
    keyframes.push_back(text.host);
    std::vector<SquareView> views;
    for (const int id : keyframes) {
      if (facing(map, text, map.keyframe(id).T_w_c.inverse()) <= 0) continue;
      views.push_back(square_view(map, text, id, parameters));
    }
    std::stable_sort(views.begin(), views.end(),
                     [](const SquareView& a, const SquareView& b) { return a.sharpness > b.sharpness; });
    if (views.size() > static_cast<std::size_t>(parameters.reading_views))
      views.resize(static_cast<std::size_t>(parameters.reading_views));
    for (const SquareView& view : views) {
      if (!(view.sharpness > 0)) continue;
      const TextReader::Reading reading = read_either_way(reader, view);
      if (is_read(reading.text))
        vote(&text.votes, reading.text, reading.score * view.sharpness / views.front().sharpness, parameters.text);
    }
  }
}

}  // namespace textslam
