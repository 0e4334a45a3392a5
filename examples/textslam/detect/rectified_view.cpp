#include "textslam/detect/rectified_view.hpp"

#include <algorithm>
#include <cmath>

namespace textslam {
namespace {

const double kMostSide = std::tan(radians(50));

// Where a ray through the edge of the image at px goes along one axis, at most kMostSide from the optical axis.
double side(const CameraView& camera, const Vec2& px, int axis) {
  Vec3 ray;
  if (textplane::is_ok(camera.unproject(px, &ray))) return std::clamp(ray[axis], -kMostSide, kMostSide);
  const double middle = axis == 0 ? camera.pinhole.cx : camera.pinhole.cy;
  return px[axis] < middle ? -kMostSide : kMostSide;
}

}  // namespace

double line_bend(const CameraView& camera, int width, int height) {
  if (!camera.lens) return 0;
  const double right = width - 1, bottom = height - 1;
  const Vec2 corners[4] = {{0, 0}, {right, 0}, {right, bottom}, {0, bottom}};
  double most = 0;
  for (int i = 0; i < 4; ++i) {
    const Vec2 &a = corners[i], &b = corners[(i + 1) % 4];
    Vec3 ray_a, ray_b;
    if (!textplane::is_ok(camera.unproject(a, &ray_a)) || !textplane::is_ok(camera.unproject(b, &ray_b))) return 1;
    const Vec3 between = ray_a.normalized() + ray_b.normalized();
    if (!camera.in_domain(between)) return 1;
    const Vec2 off = camera.project(between) - a, along = (b - a).normalized();
    most = std::max(most, std::abs(along.x() * off.y() - along.y() * off.x()) / (b - a).norm());
  }
  return most;
}

RectifiedView::RectifiedView(const CameraView& camera, int width, int height) : camera_(camera) {
  const double cx = camera.pinhole.cx, cy = camera.pinhole.cy;
  const double left = side(camera, {0, cy}, 0), right = side(camera, {width - 1.0, cy}, 0);
  const double top = side(camera, {cx, 0}, 1), bottom = side(camera, {cx, height - 1.0}, 1);
  const double f = focal_at(camera, Vec3::UnitZ());
  pinhole_ = {f, f, -f * left, -f * top};
  width_ = std::max(1, static_cast<int>(std::lround(f * (right - left)) + 1));
  height_ = std::max(1, static_cast<int>(std::lround(f * (bottom - top)) + 1));
  places_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const Vec3 ray = pinhole_.unproject({x, y});
      Vec2 px = Vec2::Constant(std::nan(""));
      if (camera.in_domain(ray)) {
        px = camera.project(ray);
        px = {std::clamp(px.x(), 0.0, width - 1.0), std::clamp(px.y(), 0.0, height - 1.0)};
      }
      places_.push_back(px.cast<float>());
    }
}

Image<std::uint8_t> RectifiedView::operator()(ImageView8 image, int channels) const {
  Image<std::uint8_t> out(channels * width_, height_, 0);
  const int last_x = image.width() / channels - 1, last_y = image.height() - 1;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const Vec2f& px =
          places_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
      if (!px.allFinite()) continue;
      const int x0 = std::min(static_cast<int>(px.x()), last_x), y0 = std::min(static_cast<int>(px.y()), last_y);
      const int x1 = std::min(x0 + 1, last_x), y1 = std::min(y0 + 1, last_y);
      const float u = px.x() - static_cast<float>(x0), v = px.y() - static_cast<float>(y0);
      for (int c = 0; c < channels; ++c) {
        const auto at = [&](int column, int row) { return static_cast<float>(image(channels * column + c, row)); };
        const float value =
            (1 - v) * ((1 - u) * at(x0, y0) + u * at(x1, y0)) + v * ((1 - u) * at(x0, y1) + u * at(x1, y1));
        out(channels * x + c, y) = static_cast<std::uint8_t>(value + 0.5F);
      }
    }
  return out;
}

bool RectifiedView::to_image(Quad<double>* quad) const {
  Quad<double> raw;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 ray = pinhole_.unproject(quad->corner[i]);
    if (!camera_.in_domain(ray)) return false;
    raw.corner[i] = camera_.project(ray);
  }
  *quad = raw;
  return true;
}

bool RectifiedView::from_image(Quad<double>* quad) const {
  std::array<Vec3, 4> rays;
  if (!rays_of(camera_, *quad, &rays)) return false;
  Quad<double> seen;
  for (std::size_t i = 0; i < 4; ++i) seen.corner[i] = pinhole_.project(rays[i]);
  if (!textplane::inside_image(seen, width_, height_, 0.0)) return false;
  *quad = seen;
  return true;
}

}  // namespace textslam
