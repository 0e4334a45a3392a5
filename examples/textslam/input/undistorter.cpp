#include "textslam/input/undistorter.hpp"

#include <algorithm>

#include "textplane/photometry/sample.hpp"

namespace textslam {

Undistorter::Undistorter(const CameraModel& camera) : camera_(camera) {
  if (camera.is_pinhole()) return;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Vector2<double> raw = camera.project(camera.pinhole().unproject({x, y}));
      map_x_.push_back(static_cast<float>(std::clamp(raw.x(), 0.0, camera.width - 1.0)));
      map_y_.push_back(static_cast<float>(std::clamp(raw.y(), 0.0, camera.height - 1.0)));
    }
}

Image<std::uint8_t> Undistorter::operator()(const Image<std::uint8_t>& raw) const {
  if (map_x_.empty()) return raw;
  Image<std::uint8_t> out(raw.width(), raw.height());
  const ImageView8 view = raw.view();
  for (std::size_t i = 0; i < map_x_.size(); ++i) {
    float value = 0;
    textplane::sample_bilinear(view, map_x_[i], map_y_[i], &value);
    out.data()[i] = static_cast<std::uint8_t>(value + 0.5F);
  }
  return out;
}

std::vector<Detection> Undistorter::operator()(std::vector<Detection> raw) const {
  if (map_x_.empty()) return raw;
  std::vector<Detection> out;
  for (Detection& detection : raw) {
    bool valid = true;
    for (Vector2<double>& corner : detection.quad.corner) {
      Vector3<double> m;
      valid = valid && textplane::is_ok(camera_.unproject(corner, &m));
      if (valid) corner = camera_.pinhole().pixel(m.head<2>());
    }
    if (valid) out.push_back(std::move(detection));
  }
  return out;
}

}  // namespace textslam
