#include "renderer/ray_caster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace textslam {

namespace {

constexpr int kTile = 16;       // px
constexpr double kNear = 0.02;  // m: the near plane, for rectangles that reach behind the camera
constexpr double kDepthFloor = 1e-9;

/// A rectangle in one camera. On the ray m~ = (m, 1): inverse depth rho = inverse . m~, and metres from the rectangle's
/// corner s = (across . m~) / rho, t = (along . m~) / rho. All three are linear, so the nearest hit has the
/// largest rho.
struct Facet {
  Vector3<double> inverse, across, along;
  double width, height;
  const Texture *texture, *opacity;
  double min_x, max_x, min_y, max_y;  // bounds in normalised coordinates
};

/// Bounds of the projection: corners in front, and where sides cross the near plane.
void bound(const std::array<Vector3<double>, 4>& corner, Facet& facet) {
  facet.min_x = facet.min_y = std::numeric_limits<double>::infinity();
  facet.max_x = facet.max_y = -facet.min_x;
  const auto include = [&facet](const Vector3<double>& p) {
    facet.min_x = std::min(facet.min_x, p[0] / p[2]);
    facet.max_x = std::max(facet.max_x, p[0] / p[2]);
    facet.min_y = std::min(facet.min_y, p[1] / p[2]);
    facet.max_y = std::max(facet.max_y, p[1] / p[2]);
  };
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3<double>&a = corner[i], &b = corner[(i + 1) % 4];
    if (a[2] >= kNear) include(a);
    if ((a[2] < kNear) != (b[2] < kNear)) {
      Vector3<double> p = a + (kNear - a[2]) / (b[2] - a[2]) * (b - a);
      p[2] = kNear;
      include(p);
    }
  }
}

std::vector<Facet> facets_in_view(const Scene& scene, const SE3d& T_w_c, double time) {
  std::vector<Facet> facets;
  const Matrix3<double> R_c_w = T_w_c.R.transpose();
  for (const Surface& surface : scene.surfaces()) {
    const Rectangle r = surface.at(time);
    const Vector3<double> to_eye = T_w_c.t - r.corner;
    const double height = r.normal().dot(to_eye);
    if (height < kDepthFloor) continue;  // seen from behind or edge on
    Facet f;
    f.inverse = -(R_c_w * r.normal()) / height;
    f.across = R_c_w * r.right + r.right.dot(to_eye) * f.inverse;
    f.along = R_c_w * r.down + r.down.dot(to_eye) * f.inverse;
    f.width = r.width;
    f.height = r.height;
    f.texture = surface.texture;
    f.opacity = surface.opacity;
    const auto in_camera = [&](double s, double t) { return Vector3<double>(R_c_w * (r.at(s, t) - T_w_c.t)); };
    bound({in_camera(0.0, 0.0), in_camera(r.width, 0.0), in_camera(r.width, r.height), in_camera(0.0, r.height)}, f);
    if (f.min_x <= f.max_x) facets.push_back(f);
  }
  return facets;
}

double shade(const Facet& f, const Texture& texture, const Vector3<double>& m, double rho, double step_x,
             double step_y) noexcept {
  const double texels_x = texture.width() / f.width, texels_y = texture.height() / f.height;  // per metre
  const double depth = 1.0 / rho;
  const double s = f.across.dot(m) * depth, t = f.along.dot(m) * depth;
  const Vector2<double> side_x((f.across[0] - s * f.inverse[0]) * depth * step_x * texels_x,
                               (f.along[0] - t * f.inverse[0]) * depth * step_x * texels_y);
  const Vector2<double> side_y((f.across[1] - s * f.inverse[1]) * depth * step_y * texels_x,
                               (f.along[1] - t * f.inverse[1]) * depth * step_y * texels_y);
  return texture.lookup({s * texels_x - 0.5, t * texels_y - 0.5}, side_x, side_y);
}

/// The light on the ray (m, 1): of the nearest facet, and where that is a pane, of those behind it.
double light_on(const std::vector<const Facet*>& candidates, const Vector3<double>& m, double step_x,
                double step_y) noexcept {
  double light = 0.0, left = 1.0, limit = std::numeric_limits<double>::infinity();
  while (left > 0.0) {
    const Facet* nearest = nullptr;
    double best = 0.0;
    for (const Facet* f : candidates) {
      const double rho = f->inverse.dot(m);
      if (rho <= best || rho >= limit) continue;
      const double s = f->across.dot(m), t = f->along.dot(m);
      if (s < 0.0 || t < 0.0 || s > f->width * rho || t > f->height * rho) continue;
      best = rho;
      nearest = f;
    }
    if (!nearest) break;
    const double opacity = nearest->opacity ? shade(*nearest, *nearest->opacity, m, best, step_x, step_y) / 255.0 : 1.0;
    light += left * opacity * shade(*nearest, *nearest->texture, m, best, step_x, step_y);
    left *= 1.0 - opacity;
    limit = best;
  }
  return light;
}

}  // namespace

RayCaster::RayCaster(const CameraModel& camera, std::vector<Vector2<double>> offsets)
    : camera_(camera), offsets_(std::move(offsets)) {
  if (camera_.is_pinhole()) return;
  for (const Vector2<double>& offset : offsets_) {
    std::vector<Vector2<double>> rays;
    rays.reserve(static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height));
    for (int y = 0; y < camera_.height; ++y) {
      for (int x = 0; x < camera_.width; ++x) {
        Vector3<double> m;
        if (!textplane::is_ok(camera_.unproject(Vector2<double>(x + offset[0], y + offset[1]), &m))) {
          throw std::invalid_argument("the lens cannot be inverted at pixel " + std::to_string(x) + "," +
                                      std::to_string(y));
        }
        rays.push_back(m.head<2>());
      }
    }
    rays_.push_back(std::move(rays));
  }
}

Vector2<double> RayCaster::ray(int offset, int x, int y) const noexcept {
  const std::size_t o = static_cast<std::size_t>(offset);
  if (!rays_.empty()) {
    return rays_[o]
                [static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width) + static_cast<std::size_t>(x)];
  }
  return camera_.pinhole().unproject(Vector2<double>(x + offsets_[o][0], y + offsets_[o][1])).head<2>();
}

void RayCaster::add(const Scene& scene, const SE3d& T_w_c, int offset, double footprint, double weight,
                    Image<double>& sum, double time) const {
  const std::vector<Facet> facets = facets_in_view(scene, T_w_c, time);
  const double step_x = footprint / camera_.pinhole().fx, step_y = footprint / camera_.pinhole().fy;
  std::array<Vector2<double>, kTile * kTile> rays;
  std::vector<const Facet*> candidates;
  for (int y0 = 0; y0 < camera_.height; y0 += kTile) {
    for (int x0 = 0; x0 < camera_.width; x0 += kTile) {
      const int x1 = std::min(x0 + kTile, camera_.width), y1 = std::min(y0 + kTile, camera_.height);
      Vector2<double> low = ray(offset, x0, y0), high = low;
      std::size_t n = 0;
      for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
          rays[n] = ray(offset, x, y);
          low = low.cwiseMin(rays[n]);
          high = high.cwiseMax(rays[n]);
          ++n;
        }
      }
      candidates.clear();
      for (const Facet& f : facets) {
        if (f.min_x <= high[0] && f.max_x >= low[0] && f.min_y <= high[1] && f.max_y >= low[1])
          candidates.push_back(&f);
      }
      n = 0;
      for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x, ++n) {
          const Vector3<double> m(rays[n][0], rays[n][1], 1.0);
          sum(x, y) += weight * light_on(candidates, m, step_x, step_y);
        }
      }
    }
  }
}

bool project(const CameraModel& camera, const SE3d& T_c_w, const Vector3<double>& p_w, Vector2<double>* px) noexcept {
  const Vector3<double> p = T_c_w * p_w;
  if (!(p[2] > 1e-6)) return false;
  *px = camera.project(p);
  return true;
}

}  // namespace textslam
