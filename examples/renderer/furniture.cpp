#include "renderer/furniture.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "textplane/core/se3.hpp"

namespace textslam {

namespace {

constexpr double kPlateThickness = 0.012;  // m
constexpr double kMostTurn = 15.0 / 57.29577951308232;
constexpr int kStripTexels = 6;  // of a cylinder: at a radius of 20 cm flat to .03 mm
constexpr int kBareStrips = 24;

}  // namespace

Walls walls_of(double x0, double x1, double y0, double y1, double height) {
  const Vector3<double> x = Vector3<double>::UnitX(), y = Vector3<double>::UnitY(), z = Vector3<double>::UnitZ();
  const double w = x1 - x0, d = y1 - y0;
  return {{{x0, y1, height}, x, -z, w, height},  {{x0, y0, height}, y, -z, d, height},
          {{x1, y1, height}, -y, -z, d, height}, {{x1, y0, height}, -x, -z, w, height},
          {{x0, y1, 0.0}, x, -y, w, d},          {{x0, y0, height}, x, y, w, d}};
}

Rectangle add_box(Scene& scene, const Vector3<double>& foot, const Vector3<double>& size, double yaw,
                  const Painter& front, const Painter& sides) {
  const Vector3<double> right(std::cos(yaw), std::sin(yaw), 0.0), back(-std::sin(yaw), std::cos(yaw), 0.0);
  const Vector3<double> middle = foot + 0.5 * size[2] * Vector3<double>::UnitZ();
  const Rectangle face = facing(middle - 0.5 * size[1] * back, -back, size[0], size[2]);
  scene.add(face, front(size[0], size[2]));
  scene.add(facing(middle + 0.5 * size[1] * back, back, size[0], size[2]), sides(size[0], size[2]));
  scene.add(facing(middle - 0.5 * size[0] * right, -right, size[1], size[2]), sides(size[1], size[2]));
  scene.add(facing(middle + 0.5 * size[0] * right, right, size[1], size[2]), sides(size[1], size[2]));
  Rectangle top;
  top.right = right;
  top.down = -back;
  top.width = size[0];
  top.height = size[1];
  top.corner = foot + size[2] * Vector3<double>::UnitZ() - 0.5 * size[0] * right + 0.5 * size[1] * back;
  scene.add(top, sides(size[0], size[1]));
  return face;
}

SignPainter::SignPainter(int words, std::uint64_t seed)
    : random_(seed), fonts_(load_fonts()), words_(sign_words(words, random_)) {}

SignPainter::Made SignPainter::next(double width) {
  if (used_ >= words_.size()) throw std::logic_error("more signs than words");
  const std::string& word = words_[used_++];
  return {word, make_sign_plate(word, width, fonts_, random_)};
}

void SignPainter::add_text(Scene& scene, const Rectangle& plate_at, const Made& made) {
  Rectangle text = plate_at;
  text.corner = plate_at.at(made.plate.text_x, made.plate.text_y);
  text.width = made.plate.text_width;
  text.height = made.plate.text_height;
  scene.add_sign(made.word, text);
}

void SignPainter::on_wall(Scene& scene, const Rectangle& wall, double s, double t, double width) {
  const Made made = next(width);
  const Rectangle plate = on(wall, s, t, made.plate.paint.width(), made.plate.paint.height(), kPlateThickness);
  scene.add(plate, made.plate.paint);
  add_text(scene, plate, made);
}

void SignPainter::off_wall(Scene& scene, const Rectangle& wall, double s, double t, double width) {
  const Made made = next(width);
  const double height = made.plate.paint.height();
  const double turn = kMostTurn * random_.uniform(), about = random_.uniform(0.0, 6.283185307179586);
  // Turned about an axis in its plane, then shifted out until its nearest corner stands off as drawn.
  const Vector3<double> axis = std::cos(about) * wall.right + std::sin(about) * wall.down;
  const Matrix3<double> R = textplane::so3_exp<double>(turn * axis);
  Rectangle plate = on(wall, s, t, width, height, 0.0);
  const Vector3<double> centre = plate.at(0.5 * width, 0.5 * height);
  plate.right = R * wall.right;
  plate.down = R * wall.down;
  const double reach =
      0.5 * width * std::abs(wall.normal().dot(plate.right)) + 0.5 * height * std::abs(wall.normal().dot(plate.down));
  plate.corner = centre + (reach + random_.uniform(0.02, 0.1)) * wall.normal() - 0.5 * width * plate.right -
                 0.5 * height * plate.down;
  scene.add(plate, made.plate.paint);
  add_text(scene, plate, made);
}

void SignPainter::cylinder(Scene& scene, const Vector3<double>& front, const Vector3<double>& towards, double width,
                           double radius) {
  const Made made = next(width);
  const Canvas& paint = made.plate.paint;
  const Vector3<double> out = towards.normalized(), right = out.cross(-Vector3<double>::UnitZ());
  const Vector3<double> top = front - radius * out + 0.5 * paint.height() * Vector3<double>::UnitZ();
  const auto at = [&](double arc) {
    return Vector3<double>(top + radius * (std::cos(arc / radius) * out + std::sin(arc / radius) * right));
  };
  const auto strip_between = [&](double from, double to) {
    Rectangle strip;
    strip.corner = at(from);
    strip.right = (at(to) - at(from)).normalized();
    strip.width = (at(to) - at(from)).norm();
    strip.height = paint.height();
    return strip;
  };
  const int columns = paint.pixels().width();
  const double metres = paint.width() / columns, start = -0.5 * paint.width();
  for (int i = 0; i < columns; i += kStripTexels) {
    const int n = std::min(kStripTexels, columns - i);
    scene.add(strip_between(start + metres * i, start + metres * (i + n)), paint.columns(i, n));
  }
  const double bare = (6.283185307179586 * radius - paint.width()) / kBareStrips;
  for (int i = 0; i < kBareStrips; ++i)
    scene.add(strip_between(bare * i - start, bare * (i + 1) - start),
              later(crate, bare, paint.height(), 120.0, random_.word()));
  Rectangle chord = strip_between(start + made.plate.text_x, start + made.plate.text_x + made.plate.text_width);
  chord.corner += made.plate.text_y * chord.down;
  chord.height = made.plate.text_height;
  scene.add_sign(made.word, chord, radius);
}

void SignPainter::pane(Scene& scene, const Vector3<double>& centre, const Vector3<double>& towards, double width) {
  Made made = next(width);
  const Rectangle plate = facing(centre, towards, width, made.plate.paint.height());
  scene.add_pane(plate, made.plate.paint, made.plate.letters);
  add_text(scene, plate, made);
}

void SignPainter::board(Scene& scene, const Vector3<double>& centre, const Vector3<double>& towards, double width,
                        double roll) {
  const Made made = next(width);
  const double height = made.plate.paint.height();
  const Rectangle plate = facing(centre, towards, width, height, roll);
  scene.add(plate, made.plate.paint);
  scene.add(facing(centre - kPlateThickness * towards.normalized(), -towards, width, height, -roll),
            later(crate, width, height, 110.0, random_.word()));
  add_text(scene, plate, made);
}

}  // namespace textslam
