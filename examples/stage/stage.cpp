#include "stage/stage.hpp"

#include <algorithm>
#include <limits>

#include "renderer/exposure.hpp"
#include "renderer/materials.hpp"
#include "renderer/ray_caster.hpp"
#include "renderer/sign_plate.hpp"
#include "textplane/geometry/homography.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/quad_projection.hpp"

namespace textslam {

namespace {
constexpr int kWidth = 480, kHeight = 360;
constexpr double kDistance = 2.0, kPlateWidth = 1.1, kWallWidth = 6.0, kWallHeight = 5.0, kPlateThickness = 0.001;
constexpr std::uint64_t kSeed = 6;

/// An upright rectangle, seen by a camera that faces the wall, turned by R about the sign's centre.
Rectangle upright(double width, double height, double lift, const Matrix3<double>& R) {
  Rectangle r;
  r.right = R.col(0);
  r.down = R.col(1);
  r.width = width;
  r.height = height;
  r.corner = Vector3<double>(0, 0, kDistance) - 0.5 * width * r.right - 0.5 * height * r.down - lift * R.col(2);
  return r;
}
}  // namespace

Stage::Stage(const std::string& word, const Vector3<double>& turn) {
  const Matrix3<double> R = textplane::so3_exp<double>(turn);
  Random random(kSeed);
  const SignPlate plate = make_sign_plate(word, kPlateWidth, load_fonts(), random);
  scene_.add_unlit(upright(kWallWidth, kWallHeight, 0, R), [] {
    const Canvas wall = plaster(kWallWidth, kWallHeight, 150.0, 1.0, kSeed);
    Image<std::uint8_t> out(wall.pixels().width(), wall.pixels().height());
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x)
        out(x, y) = static_cast<std::uint8_t>(std::min(std::max(wall.pixels()(x, y), 0.0F), 255.0F));
    return out;
  }());
  const Rectangle at = upright(plate.paint.width(), plate.paint.height(), kPlateThickness, R);
  scene_.add(at, plate.paint);
  Rectangle text = at;
  text.corner = at.at(plate.text_x, plate.text_y);
  text.width = plate.text_width;
  text.height = plate.text_height;
  scene_.add_sign(word, text);
}

Image<std::uint8_t> Stage::view(const SE3d& T_w_c, const SensorState& sensor) const {
  CameraModel model;
  model.raw = RadialTangential<double>{camera_};
  model.width = kWidth;
  model.height = kHeight;
  const RayCaster caster(model, pixel_grid());
  Image<double> light(kWidth, kHeight, 0.0);
  for (int i = 0; i < caster.offsets(); ++i) caster.add(scene_, T_w_c, i, 0.5, 1.0 / caster.offsets(), light);
  return develop(light, sensor, kSeed);
}

Quad<double> Stage::quad(const SE3d& T_w_c) const {
  const SE3d T_c_w = T_w_c.inverse();
  Quad<double> out;
  for (std::size_t i = 0; i < 4; ++i) out.corner[i] = camera_.project(T_c_w * scene_.signs().front().corner[i]);
  return out;
}

Vector3<double> Stage::theta(const SE3d& T_w_c) const {
  const Sign& sign = scene_.signs().front();
  const Vector3<double> normal = T_w_c.R.transpose() * sign.normal;
  const double distance = sign.normal.dot(T_w_c.t - sign.corner[0]);
  return textplane::plane_from_normal(normal, distance);
}

SE3d camera_at(const Vector3<double>& position, const Vector3<double>& turn) {
  return {textplane::so3_exp<double>(turn), position};
}

double corner_error(const Quad<double>& a, const Quad<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += (a.corner[i] - b.corner[i]).norm();
  return sum / 4;
}

Quad<double> warped(const Quad<double>& quad, const Vector3<double>& theta, const SE3d& T_t_h,
                    const Pinhole<double>& camera) {
  Quad<double> out;
  for (auto& corner : out.corner) corner.setConstant(std::numeric_limits<double>::quiet_NaN());
  textplane::transform(quad, textplane::pixel_homography(textplane::plane_homography(theta, T_t_h), camera, camera),
                       &out);
  return out;
}

}  // namespace textslam
