// A textured plane patch in two views, for the photometry tests.
#ifndef TEXTPLANE_TESTS_PHOTOMETRY_SCENE_HPP
#define TEXTPLANE_TESTS_PHOTOMETRY_SCENE_HPP

#include <cmath>
#include <cstdint>
#include <vector>

#include "support/random.hpp"
#include "textplane/core/image_view.hpp"
#include "textplane/photometry/residual.hpp"

namespace textplane_test {

namespace tp = textplane;

/// Integers in [20, 235]: waves and noise, so that neighbouring cells differ and both pixel types hold them exactly.
template <class T>
tp::Image<T> texture(int width, int height, unsigned seed) {
  Random random(seed);
  const double a = random.uniform(0, 6), b = random.uniform(0, 6);
  tp::Image<T> image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double wave = 128 + 50 * std::sin(0.35 * x + 0.1 * y + a) + 35 * std::cos(0.4 * y - 0.07 * x + b);
      image(x, y) = static_cast<T>(std::floor(wave + random.uniform(-20, 20)));
    }
  return image;
}

/// Cameras, plane, poses and host pixels such that every warped pixel lies inside a 200 x 160 target, at least 0.02 px
/// from the pixel lines: a small step of any parameter leaves it in its cell.
template <class T>
struct Scene {
  static constexpr int kWidth = 200, kHeight = 160;

  tp::Image<T> image;
  tp::Pinhole<double> host_camera{210, 205, 98.3, 79.6}, target_camera{190, 195, 101.2, 77.4};
  const tp::LensMap* lens = nullptr;
  tp::Vector3<double> theta;
  tp::SE3d T_w_h, T_w_t, T_t_h;
  std::vector<float> x, y, intensity;
  tp::PhotometricWorkspace workspace;

  explicit Scene(unsigned seed, int pixels = 120) : Scene(seed, pixels, nullptr, 1) {}
  /// Before the target a lens, which must outlive the scene; focal lengths of `zoom` times those above.
  Scene(unsigned seed, int pixels, const tp::LensMap* target_lens, double zoom)
      : image(texture<T>(kWidth, kHeight, seed)), lens(target_lens) {
    for (tp::Pinhole<double>* camera : {&host_camera, &target_camera}) {
      camera->fx *= zoom;
      camera->fy *= zoom;
    }
    Random random(seed * 7919 + 1);
    // One draw a statement, as in Random::twist().
    const double down = random.uniform(-0.4, 0.4), across = random.uniform(-0.4, 0.4);
    const tp::Vector3<double> normal(across, down, -1);
    theta = -normal.normalized() / random.uniform(1.0, 3.0);
    T_w_h = tp::se3_exp<double>(random.twist(2.0, 1.0));
    T_t_h = tp::se3_exp<double>(random.twist(0.15, 0.12));
    T_w_t = T_w_h * T_t_h.inverse();
    while (static_cast<int>(x.size()) < pixels) {
      const double px = random.integer(50, 150), py = random.integer(50, 110);
      const tp::Vector2<double> at = project(px, py);
      const double dx = at[0] - std::floor(at[0]), dy = at[1] - std::floor(at[1]);
      if (!image.view().contains(at[0], at[1]) || dx < 0.02 || dx > 0.98 || dy < 0.02 || dy > 0.98) continue;
      x.push_back(static_cast<float>(px));
      y.push_back(static_cast<float>(py));
      // The other view's intensity under another exposure, with noise and some gross outliers.
      double value = 0;
      tp::sample_bilinear(view(), at[0], at[1], &value);
      const double noise = random.uniform(-6, 6), outlier = random.integer(0, 9) == 0 ? random.uniform(-90, 90) : 0.0;
      value = 0.8 * value + 15 + noise + outlier;
      intensity.push_back(static_cast<float>(value));
    }
    workspace.reserve(pixels);
  }

  tp::ImageView<const T> view() const { return image.view(); }
  int n() const { return static_cast<int>(x.size()); }

  tp::Vector2<double> project(double px, double py) const {
    const tp::Vector3<double> m = host_camera.unproject({px, py});
    const tp::Vector3<double> q = T_t_h.R * m + T_t_h.t * theta.dot(m);
    if (!lens) return target_camera.project(q);
    return target_camera.pixel(lens->distort({q[0] / q[2], q[1] / q[2]}));
  }

  tp::BasicPhotometricInput<T> input() const {
    tp::BasicPhotometricInput<T> in;
    in.patch = {x.data(), y.data(), intensity.data(), nullptr, n()};
    in.host_camera = host_camera;
    in.target_camera = target_camera;
    in.target = view();
    in.lens = lens;
    return in;
  }
  tp::ResidualRequest<T> request(const tp::PhotometricOptions& options = {}) const {
    return {input(), theta, T_t_h, options};
  }
};

/// The unknowns of P derivatives.
template <int P>
constexpr tp::Parameters unknowns() {
  return P == 3 ? tp::Parameters::plane : P == 6 ? tp::Parameters::pose : tp::Parameters::pose_plane;
}

/// Everything that must be zero in a result that may not be used.
template <int P>
bool all_zero(const tp::NormalEquations<P>& e) {
  return e.H.isZero(0) && e.b.isZero(0) && e.cost == 0 && e.error == 0 && e.zncc == 0 && e.visible == 0 &&
         e.mean == 0 && e.s == 0;
}

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_PHOTOMETRY_SCENE_HPP
