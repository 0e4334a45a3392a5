// One camera of each model, and points over the whole of its domain.
#ifndef TESTS_CORE_CAMERA_SUPPORT_HPP
#define TESTS_CORE_CAMERA_SUPPORT_HPP

#include <cmath>

#include "support/calculus.hpp"
#include "textplane/core/cameras/any_camera.hpp"

namespace camera_test {

namespace tp = textplane;
using textplane_test::Random;

const tp::Pinhole<double> kPinhole(525.5, 519.25, 319.5, 241.75);

// Lenses as calibrations of real ones give them.
inline void example(tp::Pinhole<double>* camera) { *camera = kPinhole; }
inline void example(tp::RadialTangential<double>* camera) { *camera = {kPinhole, -0.28, 0.07, 0.001, -0.0008, -0.005}; }
inline void example(tp::Rational<double>* camera) {
  *camera = {kPinhole, 0.52, -2.61, 0.0005, -0.0003, 1.55, 0.4, -2.43, 1.47};
}
inline void example(tp::KannalaBrandt<double>* camera) {
  *camera = {{190.978, 190.973, 254.932, 256.897}, 0.00348, 0.000715, -0.002053, 0.000203};
}
inline void example(tp::DoubleSphere<double>* camera) { *camera = {{158.3, 158.2, 254.9, 256.5}, -0.172, 0.593}; }
inline void example(tp::ExtendedUnified<double>* camera) { *camera = {{191.1, 191.0, 254.9, 256.5}, 0.626, 1.04}; }
inline void example(tp::Fov<double>* camera) { *camera = {{350.5, 351.25, 319.5, 241.75}, 0.93}; }

template <class Model>
Model example() {
  Model camera;
  example(&camera);
  return camera;
}

// The unit vector at an angle from the axis.
inline Eigen::Vector3d direction(double angle, double azimuth) {
  return {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle)};
}

// The angle where the domain ends, by bisection, at most 89.9 degrees for the models that end by the plane z = 0.
template <class Model>
double border(const Model& camera, double azimuth) {
  double in = 0, out = camera.in_domain({1, 0, 0}) ? M_PI : 0.49944 * M_PI;
  if (camera.in_domain(direction(out, azimuth))) return out;
  for (int i = 0; i < 60; ++i) {
    const double middle = (in + out) / 2;
    (camera.in_domain(direction(middle, azimuth)) ? in : out) = middle;
  }
  return in;
}

// A direction of the domain, up to `share` of the angle where it ends.
template <class Model>
Eigen::Vector3d seen_direction(const Model& camera, double share, Random& random) {
  const double azimuth = random.uniform(0, 2 * M_PI), angle = random.uniform(0, share * border(camera, azimuth));
  return direction(angle, azimuth);
}

}  // namespace camera_test

#endif  // TESTS_CORE_CAMERA_SUPPORT_HPP
