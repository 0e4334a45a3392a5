// Textured planes with an analytic smooth texture, seen by pinhole cameras: input for the solver tests, not the
// examples' renderer.
#ifndef TEXTPLANE_TESTS_SOLVER_SYNTHETIC_HPP
#define TEXTPLANE_TESTS_SOLVER_SYNTHETIC_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "textplane/core/se3.hpp"
#include "textplane/photometry/patch.hpp"
#include "textplane/photometry/sample.hpp"
#include "textplane/solver/levels.hpp"

// A namespace of its own: the window tests of the same executable have another Scene.
namespace textplane_test {
namespace planar {
using textplane::Image;
using textplane::Pinhole;
using textplane::SE3d;
using textplane::TextPatch;
using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;

// Same numbers on every standard library.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(engine_()) + 0.5) / 4294967296.0;
  }
  double normal() {
    const double radius = std::sqrt(-2 * std::log(uniform(0, 1))), angle = uniform(0, 6.283185307179586);
    return radius * std::cos(angle);
  }
  Vec3 normal3(double sigma) {
    const double x = normal(), y = normal(), z = normal();
    return sigma * Vec3(x, y, z);
  }
  Vec6 twist(double v, double omega) {
    Vec6 xi;
    const Vec3 a = normal3(v), b = normal3(omega);
    xi << a, b;
    return xi;
  }

 private:
  std::mt19937 engine_;
};

struct FloatPyramid {
  std::vector<Image<float>> levels;
  textplane::PyramidViewF view() const {
    textplane::PyramidViewF v;
    for (std::size_t l = 0; l < levels.size(); ++l) v.level[l] = levels[l].view();
    v.levels = static_cast<int>(levels.size());
    return v;
  }
  template <class F>
  FloatPyramid map(F f) const {
    FloatPyramid out = *this;
    for (auto& image : out.levels)
      for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) image(x, y) = static_cast<float>(f(static_cast<double>(image(x, y))));
    return out;
  }
};

// A rectangle of host pixels [x0, x1] x [y0, y1] on the plane theta of a host camera. Its texture is a function of the
// host's normalised coordinates.
struct Sign {
  SE3d T_w_h;
  Vec3 theta;
  double x0, y0, x1, y1;
  int seed;
};

// Around 128, eight waves of 17 to 60 host pixels, as a function of the host's normalised coordinates.
class Texture {
 public:
  explicit Texture(int seed) {
    Random random(static_cast<unsigned>(seed) * 7919U + 11U);
    for (auto& w : waves_) {
      const double wavelength = random.uniform(17, 60) / 260, angle = random.uniform(0, 3.1416),
                   phase = random.uniform(0, 6.2832);
      w = Vec3(6.283185307179586 / wavelength * std::cos(angle), 6.283185307179586 / wavelength * std::sin(angle),
               phase);
    }
  }
  double operator()(double u, double v) const {
    double value = 128;
    for (const auto& w : waves_) value += 14 * std::sin(w[0] * u + w[1] * v + w[2]);
    return value;
  }

 private:
  std::array<Vec3, 8> waves_;
};

struct Scene {
  static constexpr int kWidth = 320, kHeight = 240, kLevels = 3;
  Pinhole<double> camera{260, 255, 160.3, 118.9};
  std::vector<Sign> signs;
  const textplane::LensMap* lens = nullptr;  // of the targets; hosts are pinholes

  textplane::CameraView view() const { return {camera, lens}; }

  // What the camera at T_t_w sees on one level; multiples of 2^-10, so that gains and biases can be applied without
  // rounding.
  FloatPyramid render(const SE3d& T_t_w) const {
    FloatPyramid out;
    for (int l = 0; l < kLevels; ++l) {
      const textplane::CameraView c = view().at_level(l);
      Image<float> image(kWidth >> l, kHeight >> l, 128.0F);
      std::vector<Vec3> rays;
      for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
          Vec3 ray(0, 0, -1);
          (void)c.unproject(Vec2(x, y), &ray);
          rays.push_back(ray);
        }
      for (const Sign& sign : signs) {
        const SE3d T_h_t = (T_t_w * sign.T_w_h).inverse();
        const Texture texture(sign.seed);
        for (int y = 0; y < image.height(); ++y)
          for (int x = 0; x < image.width(); ++x) {
            // Point o + s d on the plane theta of the host frame.
            const Vec3& ray = rays[static_cast<std::size_t>(y * image.width() + x)];
            if (!(ray[2] > 0)) continue;
            const Vec3 d = T_h_t.R * ray;
            const double s = (1 - sign.theta.dot(T_h_t.t)) / sign.theta.dot(d);
            if (!(s > 0)) continue;
            const Vec3 p = T_h_t.t + s * d;
            if (!(p[2] > 0)) continue;
            const Vec2 px = camera.project(p);
            const double margin = 14;
            if (px[0] < sign.x0 - margin || px[0] > sign.x1 + margin || px[1] < sign.y0 - margin ||
                px[1] > sign.y1 + margin)
              continue;
            const double value = texture(p[0] / p[2], p[1] / p[2]);
            image(x, y) = static_cast<float>(std::round(value * 1024) / 1024);
          }
      }
      out.levels.push_back(image);
    }
    return out;
  }

  // The sign's host pixels on every level, about `per_level` of them, with the texture's own values.
  TextPatch patch(const Sign& sign, int per_level = 250) const {
    TextPatch out;
    out.camera = camera;
    out.quad.corner = {Vec2(sign.x0, sign.y0), Vec2(sign.x1, sign.y0), Vec2(sign.x1, sign.y1), Vec2(sign.x0, sign.y1)};
    out.status = textplane::Status::ok;
    const Texture texture(sign.seed);
    for (int l = 0; l < kLevels; ++l) {
      const Pinhole<double> c = camera.at_level(l);
      const double scale = 1 << l, w = (sign.x1 - sign.x0) / scale, h = (sign.y1 - sign.y0) / scale;
      const double spacing = std::max(1.0, std::sqrt(w * h / per_level));
      textplane::PatchLevel level;
      for (double y = (sign.y0 + 0.5) / scale; y < (sign.y1 + 0.5) / scale; y += spacing)
        for (double x = (sign.x0 + 0.5) / scale; x < (sign.x1 + 0.5) / scale; x += spacing) {
          const double px = std::floor(x), py = std::floor(y);
          const Vec3 m = c.unproject({px, py});
          level.x.push_back(static_cast<float>(px));
          level.y.push_back(static_cast<float>(py));
          level.intensity.push_back(static_cast<float>(std::round(texture(m[0], m[1]) * 1024) / 1024));
        }
      out.levels.push_back(level);
    }
    return out;
  }

  // The same pixels with the values that a target's bilinear interpolant has at the true pose: the cost there is
  // exactly zero, so that recovery is limited by rounding alone. Pixels that the target does not see keep their values.
  TextPatch exact_patch(const Sign& sign, const FloatPyramid& target, const SE3d& T_t_w, int per_level = 250) const {
    TextPatch out = patch(sign, per_level);
    const SE3d T_t_h = T_t_w * sign.T_w_h;
    for (int l = 0; l < kLevels; ++l) {
      textplane::PatchLevel& level = out.levels[static_cast<std::size_t>(l)];
      const Pinhole<double> host = camera.at_level(l);
      const textplane::CameraView c = view().at_level(l);
      for (std::size_t i = 0; i < level.x.size(); ++i) {
        const Vec3 m = host.unproject({level.x[i], level.y[i]});
        const Vec2 px = c.project(T_t_h * Vec3(m / sign.theta.dot(m)));
        const textplane::ImageViewF view = target.levels[static_cast<std::size_t>(l)].view();
        double value;
        if (textplane::sample_bilinear(view, px[0], px[1], &value)) level.intensity[i] = static_cast<float>(value);
      }
    }
    return out;
  }

  // Mean distance in px between where two poses put the corners of a sign.
  double corner_error(const Sign& sign, const SE3d& a_t_w, const SE3d& b_t_w) const {
    double sum = 0;
    for (const Vec2& corner :
         {Vec2(sign.x0, sign.y0), Vec2(sign.x1, sign.y0), Vec2(sign.x1, sign.y1), Vec2(sign.x0, sign.y1)}) {
      const Vec3 m = camera.unproject(corner), p = sign.T_w_h * Vec3(m / sign.theta.dot(m));
      sum += (camera.project(a_t_w * p) - camera.project(b_t_w * p)).norm() / 4;
    }
    return sum;
  }
};

// Three signs about 2 m away, slanted differently, one of them from a host of its own.
inline Scene three_signs() {
  Scene scene;
  const auto theta = [](double nx, double ny, double nz, double d) {
    return Vec3(-Vec3(nx, ny, nz).normalized() / -d);
  };
  SE3d second;
  second.t = Vec3(0.3, -0.05, 0.1);
  second.R = textplane::so3_exp<double>(Vec3(0.02, -0.08, 0.03));
  scene.signs = {{SE3d(), theta(0.25, 0.1, 1, 2), 30, 40, 130, 90, 1},
                 {SE3d(), theta(-0.3, 0.2, 1, 2.3), 170, 140, 280, 200, 2},
                 {second, theta(0.1, -0.35, 1, 1.8), 150, 30, 240, 80, 3}};
  return scene;
}

// A target pose some 20 cm and 4 degrees away from the first host.
inline SE3d target_pose() {
  Vec6 xi;
  xi << 0.12, -0.06, 0.09, -0.03, 0.05, 0.02;
  return textplane::se3_exp<double>(xi);
}

// |log(a b^-1)|.
inline double pose_distance(const SE3d& a, const SE3d& b) { return textplane::se3_log<double>(a * b.inverse()).norm(); }

}  // namespace planar
}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SOLVER_SYNTHETIC_HPP
