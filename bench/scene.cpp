#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "support/random.hpp"
#include "textplane/geometry/homography.hpp"

namespace textplane_bench {

namespace {

using textplane_test::Random;

// A number in [0, 1) that depends on the cell alone.
double hash(int x, int y, unsigned seed) {
  std::uint32_t h =
      static_cast<std::uint32_t>(x) * 0x9E3779B1U ^ static_cast<std::uint32_t>(y) * 0x85EBCA77U ^ seed * 0xC2B2AE3DU;
  h ^= h >> 15;
  h *= 0x2C1B3C6DU;
  h ^= h >> 12;
  h *= 0x297A2D39U;
  h ^= h >> 15;
  return h / 4294967296.0;
}

// Smooth noise with cells of size 1.
double value_noise(double x, double y, unsigned seed) {
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
  const double u = fade(x - x0), v = fade(y - y0);
  const double upper = hash(x0, y0, seed) * (1 - u) + hash(x0 + 1, y0, seed) * u;
  const double lower = hash(x0, y0 + 1, seed) * (1 - u) + hash(x0 + 1, y0 + 1, seed) * u;
  return upper * (1 - v) + lower * v;
}

// The rectangle is 100 x 40, or larger where n pixels need it. It is near the middle, elsewhere in each scene.
void choose_rectangle(int n, Random& random, Scene* s) {
  s->columns = 100;
  s->rows = 40;
  while (s->columns * s->rows < n) {
    s->columns += 50;
    s->rows += 36;
  }
  s->columns = std::min(s->columns, 560);
  s->rows = std::min(s->rows, 420);
  s->left = (Scene::kWidth - s->columns) / 2 + static_cast<int>(s->columns <= 200 ? random.uniform(-120, 120) : 0);
  s->top = (Scene::kHeight - s->rows) / 2 + static_cast<int>(s->rows <= 120 ? random.uniform(-120, 120) : 0);
}

std::uint8_t pixel(double value) { return static_cast<std::uint8_t>(std::clamp(std::floor(value + 0.5), 0.0, 255.0)); }

void render(unsigned seed, const Light& light, Random& random, Scene* s) {
  s->host = tp::Image<std::uint8_t>(Scene::kWidth, Scene::kHeight);
  s->target = tp::Image<std::uint8_t>(Scene::kWidth, Scene::kHeight);
  for (int y = 0; y < Scene::kHeight; ++y)
    for (int x = 0; x < Scene::kWidth; ++x) s->host(x, y) = pixel(texture(x, y, seed));
  const tp::Matrix3<double> back = s->pixel_homography(s->T_t_h, s->theta).inverse();
  for (int y = 0; y < Scene::kHeight; ++y)
    for (int x = 0; x < Scene::kWidth; ++x) {
      tp::Vector3<double> ray;
      if (!tp::is_ok(tp::CameraView(s->camera, s->lens.get()).unproject({x, y}, &ray))) continue;
      const tp::Vector3<double> q = back * s->camera.pixel(ray.head<2>()).homogeneous();
      s->target(x, y) =
          pixel(light.gain * texture(q[0] / q[2], q[1] / q[2], seed) + light.bias + light.noise * random.normal());
    }
  // Outliers are in the host, where they stay with a pixel, as a highlight in the key frame does.
  for (int i = 0; i < Scene::kWidth * Scene::kHeight; ++i)
    if (random.uniform(0, 1) < light.outliers) s->host.data()[i] = pixel(s->host.data()[i] + random.uniform(-90, 90));
}

// n pixels of the rectangle, in the order of the rows.
void scatter_pixels(int n, Random& random, Scene* s) {
  std::vector<int> cells(static_cast<std::size_t>(s->columns * s->rows));
  std::iota(cells.begin(), cells.end(), 0);
  const std::size_t count = std::min(cells.size(), static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < count; ++i) {
    const auto j = i + static_cast<std::size_t>(random.uniform(0, 1) * static_cast<double>(cells.size() - i));
    std::swap(cells[i], cells[j]);
  }
  cells.resize(count);
  std::sort(cells.begin(), cells.end());
  for (const int cell : cells) {
    const int x = s->left + cell % s->columns, y = s->top + cell / s->columns;
    s->x.push_back(static_cast<float>(x));
    s->y.push_back(static_cast<float>(y));
    s->intensity.push_back(static_cast<float>(s->host(x, y)));
  }
}

// Moves pose and plane in a random direction until the corner error is `px`.
void displace_start(double px, Random& random, Scene* s) {
  const tp::Vector6<double> xi = tp::se3_log(random.pose(0.02, 0.01));
  const tp::Vector3<double> tilt(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02),
                                 random.uniform(-0.005, 0.005));
  double low = 0, high = 8;
  for (int i = 0; i < 50; ++i) {
    const double k = 0.5 * (low + high);
    s->T_start = tp::se3_exp<double>(k * xi) * s->T_t_h;
    s->theta_start = s->theta + k * tilt;
    (s->corner_error(s->pixel_homography(s->T_start, s->theta_start)) < px ? low : high) = k;
  }
}

}  // namespace

double texture(double x, double y, unsigned seed) {
  const double coarse = value_noise(x / 23, y / 23, seed), fine = value_noise(x / 7.3 + 3, y / 7.3 + 9, seed + 1);
  const double strokes = 1 / (1 + std::exp(-14 * (value_noise(x / 9.1, y / 11.3, seed + 2) - 0.5)));  // soft steps
  return 20 + 215 * (0.25 * coarse + 0.25 * fine + 0.5 * strokes);
}

tp::PhotometricInput Scene::input() const {
  tp::PhotometricInput in;
  in.patch.x = x.data();
  in.patch.y = y.data();
  in.patch.intensity = intensity.data();
  in.patch.n = n();
  in.host_camera = in.target_camera = camera;
  in.target = target_view();
  in.lens = lens.get();
  return in;
}

Problem Scene::problem() const {
  Problem p;
  p.target = target.data();
  p.width = target.width();
  p.height = target.height();
  p.stride = target.width();
  p.x = x.data();
  p.y = y.data();
  p.intensity = intensity.data();
  p.n = n();
  p.fx = camera.fx;
  p.fy = camera.fy;
  p.cx = camera.cx;
  p.cy = camera.cy;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) p.R[3 * r + c] = T_start.R(r, c);
    p.t[r] = T_start.t[r];
    p.theta[r] = theta_start[r];
  }
  p.delta = tp::PhotometricOptions().robust.delta;
  return p;
}

tp::Matrix3<double> Scene::pixel_homography(const tp::SE3d& T, const tp::Vector3<double>& plane) const {
  return tp::pixel_homography(tp::plane_homography(plane, T), camera, camera);
}

double Scene::corner_error(const tp::Matrix3<double>& H) const {
  const tp::Matrix3<double> truth = pixel_homography(T_t_h, theta);
  double sum = 0;
  for (int k = 0; k < 4; ++k) {
    const tp::Vector3<double> corner(left + (k & 1 ? columns - 1 : 0), top + (k & 2 ? rows - 1 : 0), 1);
    const tp::Vector3<double> a = H * corner, b = truth * corner;
    sum += std::hypot(a[0] / a[2] - b[0] / b[2], a[1] / a[2] - b[1] / b[2]) / 4;
  }
  return sum;
}

Scene make_scene(int n, unsigned seed, double px, const Light& light, double motion,
                 const std::shared_ptr<const tp::LensMap>& lens) {
  Scene s;
  s.lens = lens;
  Random random(seed * 7919 + 17);
  const tp::Vector3<double> normal(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), -1);
  s.theta = -normal.normalized() / 2.0;
  s.T_t_h = random.pose(0.06 * motion, 0.03 * motion);
  choose_rectangle(n, random, &s);
  render(seed, light, random, &s);
  scatter_pixels(n, random, &s);
  s.theta_start = s.theta;
  s.T_start = s.T_t_h;
  if (px > 0) displace_start(px, random, &s);
  return s;
}

Scene make_dense_scene(int columns, int rows, unsigned seed, double px) {
  Scene s = make_scene(4000, seed, px);
  s.columns = columns;
  s.rows = rows;
  s.x.clear();
  s.y.clear();
  s.intensity.clear();
  for (int y = s.top; y < s.top + rows; ++y)
    for (int x = s.left; x < s.left + columns; ++x) {
      s.x.push_back(static_cast<float>(x));
      s.y.push_back(static_cast<float>(y));
      s.intensity.push_back(static_cast<float>(s.host(x, y)));
    }
  return s;
}

}  // namespace textplane_bench
