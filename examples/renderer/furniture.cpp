#include "renderer/furniture.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace textslam {

namespace {

constexpr double kPlateThickness = 0.012;  // m

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

void SignPainter::board(Scene& scene, const Vector3<double>& centre, const Vector3<double>& towards, double width,
                        double roll) {
  const Made made = next(width);
  const double height = made.plate.paint.height();
  const Rectangle plate = facing(centre, towards, width, height, roll);
  scene.add(plate, made.plate.paint);
  scene.add(facing(centre - kPlateThickness * towards.normalized(), -towards, width, height, -roll),
            crate(width, height, 110.0, random_.word()));
  add_text(scene, plate, made);
}

}  // namespace textslam
