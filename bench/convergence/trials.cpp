#include "convergence/trials.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "textplane/geometry/homography.hpp"

namespace textplane_bench {

namespace {

double unit(std::mt19937& random) { return static_cast<double>(random()) / 4294967296.0; }

// Letters are random bars on a grid; blobs are sums of Gaussians.
class Texture {
 public:
  explicit Texture(Kind kind) : kind_(kind) {
    std::mt19937 random(1 + 100 * static_cast<unsigned>(kind));
    for (auto& cell : cells_) cell = static_cast<std::uint32_t>(random());
    for (auto& b : blobs_)
      b = {-200 + 400 * unit(random), -120 + 240 * unit(random), 4 + 8 * unit(random), -90 + 180 * unit(random)};
  }

  // Grey level at (x, y), in host px from the centre of the image.
  double operator()(double x, double y) const {
    double value = 190 - 0.05 * x + 0.08 * y;
    if (kind_ == Kind::blobs) {
      value = 125;
      for (const auto& b : blobs_) {
        const double d = ((x - b[0]) * (x - b[0]) + (y - b[1]) * (y - b[1])) / (b[2] * b[2]);
        if (d < 12) value += b[3] * std::exp(-0.5 * d);
      }
    } else {
      value -= 140 * ink(x, y);
    }
    return std::clamp(value, 5.0, 250.0);
  }

 private:
  // The bits of a cell choose the letter's bars out of seven with soft edges.
  double ink(double x, double y) const {
    const double w = kind_ == Kind::large_print ? 18 : 9, h = kind_ == Kind::large_print ? 30 : 15;
    const double cx = std::floor(x / w), cy = std::floor(y / h), u = (x - cx * w) / w, v = (y - cy * h) / h;
    const auto index =
        static_cast<std::size_t>((static_cast<int>(cx) + 1000) * 31 + (static_cast<int>(cy) + 1000) * 17);
    const std::uint32_t bits = cells_[index % cells_.size()] | 1U;
    constexpr double kBars[7][4] = {{.15, .1, .15, .85},  {.75, .1, .75, .85},  {.15, .12, .75, .12},
                                    {.15, .48, .75, .48}, {.15, .85, .75, .85}, {.15, .1, .75, .85},
                                    {.45, .1, .45, .85}};
    double most = 0;
    for (int i = 0; i < 7; ++i) {
      if (!(bits >> i & 1U)) continue;
      const double ax = kBars[i][0], ay = kBars[i][1], bx = kBars[i][2] - ax, by = kBars[i][3] - ay;
      const double t = std::clamp(((u - ax) * bx + (v - ay) * by) / (bx * bx + by * by), 0.0, 1.0);
      const double distance = std::hypot((u - ax - t * bx) * w, (v - ay - t * by) * h);
      most = std::max(most, std::clamp(0.08 * w + 0.5 - distance, 0.0, 1.0));  // one px from full to none
    }
    return most;
  }

  Kind kind_;
  std::vector<std::uint32_t> cells_ = std::vector<std::uint32_t>(997);
  std::vector<std::array<double, 4>> blobs_ = std::vector<std::array<double, 4>>(260);
};

// A pixel is the mean of 2 x 2 samples, with gain, bias and noise of standard deviation sigma. `back` maps it to host
// px.
tp::Image<std::uint8_t> render(const Texture& texture, const tp::Matrix3<double>& back, double gain, double bias,
                               double sigma, std::mt19937& random) {
  tp::Image<std::uint8_t> image(640, 480);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      double sum = 0;
      for (int s = 0; s < 4; ++s) {
        const tp::Vector3<double> q =
            back * tp::Vector3<double>(x - 0.25 + 0.5 * (s & 1), y - 0.25 + 0.25 * (s & 2), 1);
        sum += 0.25 * texture(q[0] / q[2] - 320, q[1] / q[2] - 240);
      }
      // A sum of four has a variance of 1 / 3.
      const double noise = unit(random) + unit(random) + unit(random) + unit(random) - 2;
      image(x, y) = static_cast<std::uint8_t>(std::clamp(gain * sum + bias + sigma * noise * 1.732 + 0.5, 0.0, 255.0));
    }
  return image;
}

}  // namespace

Trials::Trials(Kind kind) {
  const Texture texture(kind);
  std::mt19937 random(8);
  const bool slanted = kind == Kind::slanted_print;
  const double distance = 2.0;
  truth.theta = tp::Vector3<double>(0, 0, 1 / distance);
  // The target's camera goes round the patch.
  const double yaw = slanted ? 0.96 : 0.25, away = slanted ? 2.5 : 2.1;
  truth.T_t_h.R = tp::so3_exp<double>({0.06, yaw, 0.08});
  truth.T_t_h.t = tp::Vector3<double>(0.02, -0.03, away) - truth.T_t_h.R * tp::Vector3<double>(0, 0, distance);
  host = render(texture, tp::Matrix3<double>::Identity(), 1.0, 0.0, 1.5, random);
  target = render(texture, homography(truth).inverse(), 0.85, 18.0, 2.0, random);
  host_pyramid.build(host.view(), kLevels);
  target_pyramid.build(target.view(), kLevels);

  const double right = kLeft + kColumns - 1, bottom = kTop + kRows - 1;
  tp::Quad<double> quad;
  quad.corner = {tp::Vector2<double>(kLeft, kTop), tp::Vector2<double>(right, kTop), tp::Vector2<double>(right, bottom),
                 tp::Vector2<double>(kLeft, bottom)};
  std::vector<std::vector<tp::Vector2<float>>> pixels(kLevels);
  for (std::size_t l = 0; l < kLevels; ++l) {
    const double k = 1.0 / (1 << l), left = (kLeft + 0.5) * k - 0.5, top = (kTop + 0.5) * k - 0.5;
    for (int y = static_cast<int>(std::ceil(top)); y <= top + (kRows - 1) * k; ++y)
      for (int x = static_cast<int>(std::ceil(left)); x <= left + (kColumns - 1) * k; ++x)
        pixels[l].push_back({static_cast<float>(x), static_cast<float>(y)});
  }
  patch = tp::patch_from_pixels(host_pyramid.view(), camera, quad, pixels);
  prepared.resize(kLevels);
  for (std::size_t l = 0; l < kLevels; ++l) prepared[l].prepare(patch.levels[l].view());
}

tp::Matrix3<double> Trials::homography(const Start& s) const {
  return tp::pixel_homography(tp::plane_homography(s.theta, s.T_t_h), camera, camera);
}

double Trials::corner_error(const tp::Matrix3<double>& H) const {
  const tp::Matrix3<double> true_H = homography(truth);
  double sum = 0;
  for (const tp::Vector2<double>& p : patch.quad.corner) {
    const tp::Vector3<double> m(p[0], p[1], 1), a = H * m, b = true_H * m;
    const double d = std::hypot(a[0] / a[2] - b[0] / b[2], a[1] / a[2] - b[1] / b[2]);
    sum += std::isfinite(d) ? d : 1e9;
  }
  return sum / 4;
}

Start Trials::start(double px, unsigned trial, bool tilt) const {
  std::mt19937 random(trial * 9973 + 5);
  const auto uniform = [&random](double most) { return most * (2 * unit(random) - 1); };
  tp::Vector6<double> xi;
  for (int i = 0; i < 3; ++i) xi[i] = uniform(i == 2 ? 0.6 : 0.2);
  for (int i = 3; i < 6; ++i) xi[i] = uniform(i == 5 ? 0.6 : 0.1);
  const tp::Vector3<double> plane(uniform(0.2), uniform(0.2), uniform(0.05));
  const auto at = [&](double k) {
    Start s{tp::se3_exp<double>(k * xi) * truth.T_t_h, truth.theta};
    if (tilt) s.theta += k * plane;
    return s;
  };
  double low = 0, high = 1e-3;
  while (corner_error(homography(at(high))) < px && high < 10) high *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (corner_error(homography(at(middle))) < px ? low : high) = middle;
  }
  return at(high);
}

}  // namespace textplane_bench
