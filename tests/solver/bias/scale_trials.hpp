// Trials of an alignment whose answer is known exactly: host and target are samples of one formula, so that no image is
// resampled before the estimator interpolates it. They measure the scale that is found, relative to the true one.
#ifndef TEXTPLANE_TESTS_SOLVER_BIAS_SCALE_TRIALS_HPP
#define TEXTPLANE_TESTS_SOLVER_BIAS_SCALE_TRIALS_HPP

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "support/random.hpp"
#include "textplane/core/image_view.hpp"
#include "textplane/geometry/homography.hpp"

namespace textplane_test {

namespace tp = textplane;

/// A sum of plane waves in random directions, of at most 0.15 cycles a px: far from what pixels can hold, and smooth
/// enough to be halved.
class Waves {
 public:
  explicit Waves(Random& random) {
    for (Wave& wave : waves_) {
      const double frequency = 6.283185307179586 * random.uniform(0.01, 0.15);
      const double direction = random.uniform(0, 3.141592653589793);
      wave.x = frequency * std::cos(direction);
      wave.y = frequency * std::sin(direction);
      wave.phase = random.uniform(0, 6.283185307179586);
    }
  }

  /// Grey level at (x, y): mean 127, standard deviation 34, so that next to none leaves 8 bits.
  double operator()(double x, double y) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::cos(wave.x * x + wave.y * y + wave.phase);
    return std::min(std::max(127 + 12 * sum, 0.0), 255.0);
  }

 private:
  struct Wave {
    double x = 0, y = 0, phase = 0;
  };
  Wave waves_[16];
};

/// A template of kColumns x kRows pixels and its target, which shows it with kMargin px around at a scale of 0.97 to
/// 1.03, rolled and shifted; `tilted`: with perspective too, otherwise by a similarity.
struct ScaleTrial {
  static constexpr int kColumns = 120, kRows = 90, kMargin = 24;

  Random random;
  Waves waves;
  tp::Vector3<double> theta{0, 0, 1};
  tp::SE3d T_t_h;
  tp::Pinhole<double> host_camera{300, 300, 0.5 * (kColumns - 1), 0.5 * (kRows - 1)};
  tp::Pinhole<double> target_camera{300, 300, host_camera.cx + kMargin, host_camera.cy + kMargin};

  ScaleTrial(unsigned seed, bool tilted) : random(seed), waves(random) {
    const double tilt = tilted ? 0.02 : 0;
    const tp::Vector3<double> turn(random.uniform(-tilt, tilt), random.uniform(-tilt, tilt),
                                   random.uniform(-0.05, 0.05));
    T_t_h.R = tp::so3_exp<double>(turn);
    if (tilted) theta = tp::Vector3<double>(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 1);
    const double scale = random.uniform(0.97, 1.03), px = 1 / host_camera.fx;
    T_t_h.t = tp::Vector3<double>(random.uniform(-4, 4) * px, random.uniform(-4, 4) * px, 1 / scale - 1);
  }

  /// Template px to target px.
  tp::Matrix3<double> homography(const tp::SE3d& T, const tp::Vector3<double>& plane) const {
    return tp::pixel_homography(tp::plane_homography(plane, T), host_camera, target_camera);
  }
  tp::Matrix3<double> homography() const { return homography(T_t_h, theta); }

  /// The template with `border` px around it.
  template <class T>
  tp::Image<T> host(int border) const {
    tp::Matrix3<double> shift = tp::Matrix3<double>::Identity();
    shift(0, 2) = shift(1, 2) = -border;
    return sampled<T>(shift, kColumns + 2 * border, kRows + 2 * border);
  }
  template <class T>
  tp::Image<T> target() const {
    return sampled<T>(homography().inverse(), kColumns + 2 * kMargin, kRows + 2 * kMargin);
  }

  /// The scale of H at the middle of the template over the true one, less 1.
  double scale_error(const tp::Matrix3<double>& H) const { return scale(H) / scale(homography()) - 1; }

  /// Root mean square distance of the corners from where they belong, px.
  double corner_error(const tp::Matrix3<double>& H) const {
    const tp::Matrix3<double> truth = homography();
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      const tp::Vector3<double> corner(k & 1 ? kColumns - 1 : 0, k & 2 ? kRows - 1 : 0, 1);
      const tp::Vector3<double> a = H * corner, b = truth * corner;
      sum += (a.head<2>() / a[2] - b.head<2>() / b[2]).squaredNorm() / 4;
    }
    return std::sqrt(sum);
  }

  /// A pose whose corners are `px` off the true ones.
  tp::SE3d start(double px) {
    const tp::Vector6<double> xi = random.twist(0.02, 0.02);
    double low = 0, high = 2;
    for (int i = 0; i < 40; ++i) {
      const double k = 0.5 * (low + high);
      (corner_error(homography(tp::se3_exp<double>(k * xi) * T_t_h, theta)) < px ? low : high) = k;
    }
    return tp::se3_exp<double>(low * xi) * T_t_h;
  }

 private:
  // Square root of the area that H makes of a unit square.
  static double scale(const tp::Matrix3<double>& H) {
    const double w = H(2, 0) * 0.5 * (kColumns - 1) + H(2, 1) * 0.5 * (kRows - 1) + H(2, 2);
    return std::sqrt(H.determinant() / (w * w * w));
  }

  template <class T>
  tp::Image<T> sampled(const tp::Matrix3<double>& to_template, int width, int height) const {
    tp::Image<T> image(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const tp::Vector3<double> q = to_template * tp::Vector3<double>(x, y, 1);
        const double value = waves(q[0] / q[2], q[1] / q[2]);
        image(x, y) = static_cast<T>(std::is_integral<T>::value ? std::floor(value + 0.5) : value);
      }
    return image;
  }
};

/// Mean of the errors of many trials, its standard error and the standard deviation of a single one.
struct Bias {
  double mean = 0, standard_error = 0, deviation = 0;

  explicit Bias(const std::vector<double>& errors) {
    const double n = static_cast<double>(errors.size());
    double squares = 0;
    for (const double e : errors) mean += e / n;
    for (const double e : errors) squares += (e - mean) * (e - mean);
    deviation = std::sqrt(squares / (n - 1));
    standard_error = deviation / std::sqrt(n);
  }
};

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SOLVER_BIAS_SCALE_TRIALS_HPP
