#include "renderer/ray_caster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace textslam {

namespace {

constexpr int kTile = 16;       // px
constexpr double kNear = 0.02;  // m: the near plane, for rectangles that reach behind the camera
constexpr double kDepthFloor = 1e-9;
constexpr double kMostOff = 80 * M_PI / 180;  // off the axis, for rays on the plane z = 1

/// A rectangle in one camera. On the ray m~ = (m, 1): inverse depth rho = inverse . m~, and metres from the rectangle's
/// corner s = (across . m~) / rho, t = (along . m~) / rho. All three are linear, so the nearest hit has the
/// largest rho.
struct Facet {
  Vector3<double> inverse, across, along;
  double width, height;
  const Texture *texture, *opacity;
  double min_x, max_x, min_y, max_y;  // bounds in normalised coordinates, of what lies before the near plane
  Vector3<double> centre;             // in the camera
  double radius;                      // m: of the sphere about it
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

/// All that face the camera, in front of it or not.
std::vector<Facet> facets_of(const Scene& scene, const SE3d& T_w_c, double time) {
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
    f.centre = in_camera(0.5 * r.width, 0.5 * r.height);
    f.radius = 0.5 * std::hypot(r.width, r.height);
    facets.push_back(f);
  }
  return facets;
}

/// How a ray moves over the sides of a footprint.
struct PlaneSteps {  // of (m, 1)
  double x, y;
  double along_x(const Vector3<double>& v) const noexcept { return v[0]; }
  double along_y(const Vector3<double>& v) const noexcept { return v[1]; }
};
struct SphereSteps {  // of a unit vector
  double x, y;
  Vector3<double> towards_x, towards_y;
  double along_x(const Vector3<double>& v) const noexcept { return v.dot(towards_x); }
  double along_y(const Vector3<double>& v) const noexcept { return v.dot(towards_y); }
};

template <class Steps>
double shade(const Facet& f, const Texture& texture, const Vector3<double>& m, double rho, const Steps& steps) {
  texture.be_seen();
  const double texels_x = texture.width() / f.width, texels_y = texture.height() / f.height;  // per metre
  const double depth = 1.0 / rho;
  const double s = f.across.dot(m) * depth, t = f.along.dot(m) * depth;
  const Vector2<double> side_x((steps.along_x(f.across) - s * steps.along_x(f.inverse)) * depth * steps.x * texels_x,
                               (steps.along_x(f.along) - t * steps.along_x(f.inverse)) * depth * steps.x * texels_y);
  const Vector2<double> side_y((steps.along_y(f.across) - s * steps.along_y(f.inverse)) * depth * steps.y * texels_x,
                               (steps.along_y(f.along) - t * steps.along_y(f.inverse)) * depth * steps.y * texels_y);
  return texture.lookup({s * texels_x - 0.5, t * texels_y - 0.5}, side_x, side_y);
}

/// The light on the ray m: of the nearest facet, and where that is a pane, of those behind it.
template <class Steps>
double light_on(const std::vector<const Facet*>& candidates, const Vector3<double>& m, const Steps& steps) {
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
    const double opacity = nearest->opacity ? shade(*nearest, *nearest->opacity, m, best, steps) / 255.0 : 1.0;
    light += left * opacity * shade(*nearest, *nearest->texture, m, best, steps);
    left *= 1.0 - opacity;
    limit = best;
  }
  return light;
}

}  // namespace

RayCaster::RayCaster(const CameraModel& camera, std::vector<Vector2<double>> offsets)
    : camera_(camera), offsets_(std::move(offsets)) {
  if (camera_.is_pinhole()) return;
  const double least_z = std::cos(kMostOff);
  bool on_plane = true;
  for (const Vector2<double>& offset : offsets_) {
    std::vector<Vector2<double>> points;
    std::vector<Vector3<double>> directions;
    for (int y = 0; y < camera_.height; ++y) {
      for (int x = 0; x < camera_.width; ++x) {
        const Vector2<double> px(x + offset[0], y + offset[1]);
        Vector3<double> m, direction = Vector3<double>::Zero();
        camera_.raw.unproject_ray(px, &direction);
        directions.push_back(direction);
        on_plane = on_plane && direction[2] > least_z && textplane::is_ok(camera_.unproject(px, &m));
        if (on_plane) points.emplace_back(m.head<2>());
      }
    }
    rays_.push_back(std::move(points));
    directions_.push_back(std::move(directions));
  }
  if (on_plane)
    directions_.clear();
  else
    rays_.clear();
}

Vector2<double> RayCaster::ray(int offset, int x, int y) const noexcept {
  if (!rays_.empty()) return at(rays_, offset, x, y);
  const Vector2<double>& o = offsets_[static_cast<std::size_t>(offset)];
  return camera_.pinhole().unproject(Vector2<double>(x + o[0], y + o[1])).head<2>();
}

Vector3<double> RayCaster::step(int offset, int x, int y, int along_x, int along_y) const noexcept {
  const Vector3<double>& here = at(directions_, offset, x, y);
  const auto inside = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < camera_.width && j < camera_.height && !at(directions_, offset, i, j).isZero(0.0);
  };
  if (inside(x + along_x, y + along_y)) return at(directions_, offset, x + along_x, y + along_y) - here;
  if (inside(x - along_x, y - along_y)) return here - at(directions_, offset, x - along_x, y - along_y);
  return Vector3<double>::Zero();
}

void RayCaster::add_rows(const Scene& scene, const SE3d& T_w_c, int offset, double footprint, double weight, int first,
                         int end, Image<double>& sum, double time) const {
  if (directions_.empty())
    add_plane(scene, T_w_c, offset, footprint, weight, first, end, sum, time);
  else
    add_sphere(scene, T_w_c, offset, footprint, weight, first, end, sum, time);
}

void RayCaster::add_sphere(const Scene& scene, const SE3d& T_w_c, int offset, double footprint, double weight,
                           int first, int end, Image<double>& sum, double time) const {
  const std::vector<Facet> facets = facets_of(scene, T_w_c, time);
  std::vector<const Facet*> candidates;
  for (int y0 = first; y0 < end; y0 += kTile) {
    for (int x0 = 0; x0 < camera_.width; x0 += kTile) {
      const int x1 = std::min(x0 + kTile, camera_.width), y1 = std::min(y0 + kTile, end);
      // The cone of the tile's rays.
      Vector3<double> axis = Vector3<double>::Zero();
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) axis += at(directions_, offset, x, y);
      if (axis.isZero(0.0)) continue;
      axis.normalize();
      double spread = 0.0;
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) spread = std::max(spread, (at(directions_, offset, x, y) - axis).norm());
      const double half = 2.0 * std::asin(std::min(0.5 * spread, 1.0));
      candidates.clear();
      for (const Facet& f : facets) {
        const double distance = f.centre.norm();
        if (distance <= f.radius ||
            std::acos(std::clamp(axis.dot(f.centre) / distance, -1.0, 1.0)) <= half + std::asin(f.radius / distance))
          candidates.push_back(&f);
      }
      for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
          const Vector3<double>& direction = at(directions_, offset, x, y);
          if (direction.isZero(0.0)) continue;
          const SphereSteps steps{footprint, footprint, step(offset, x, y, 1, 0), step(offset, x, y, 0, 1)};
          sum(x, y) += weight * light_on(candidates, direction, steps);
        }
      }
    }
  }
}

void RayCaster::add_plane(const Scene& scene, const SE3d& T_w_c, int offset, double footprint, double weight, int first,
                          int end, Image<double>& sum, double time) const {
  const std::vector<Facet> facets = facets_of(scene, T_w_c, time);
  const PlaneSteps steps{footprint / camera_.pinhole().fx, footprint / camera_.pinhole().fy};
  std::array<Vector2<double>, kTile * kTile> rays;
  std::vector<const Facet*> candidates;
  for (int y0 = first; y0 < end; y0 += kTile) {
    for (int x0 = 0; x0 < camera_.width; x0 += kTile) {
      const int x1 = std::min(x0 + kTile, camera_.width), y1 = std::min(y0 + kTile, end);
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
          sum(x, y) += weight * light_on(candidates, m, steps);
        }
      }
    }
  }
}

bool ray_of(const CameraModel& camera, const Vector2<double>& px, Vector3<double>* ray) noexcept {
  return textplane::is_ok(camera.unproject(px, ray)) || textplane::is_ok(camera.raw.unproject_ray(px, ray));
}

bool project(const CameraModel& camera, const SE3d& T_c_w, const Vector3<double>& p_w, Vector2<double>* px) noexcept {
  const Vector3<double> p = T_c_w * p_w;
  if (camera.is_pinhole() ? !(p[2] > 1e-6) : !camera.raw.in_domain(p)) return false;
  *px = camera.project(p);
  return true;
}

}  // namespace textslam
