// Planes in view and what two cameras see of a sign on them, exact, for the plane fits.
#ifndef TEXTPLANE_TESTS_GEOMETRY_PLANE_FIT_SCENE_HPP
#define TEXTPLANE_TESTS_GEOMETRY_PLANE_FIT_SCENE_HPP

#include <gtest/gtest.h>

#include <vector>

#include "support/calculus.hpp"
#include "support/random.hpp"
#include "textplane/geometry/plane_fit.hpp"

namespace plane_fit_test {
namespace tp = textplane;
using textplane_test::Random;
using Vector3d = Eigen::Vector3d;
using Scalars = testing::Types<float, double, textplane_test::Dual<6>>;

// A sign of about a tenth of a radian, somewhere in view, seen from a second pose.
template <class S>
struct Scene {
  Vector3d theta;
  tp::SE3<S> T_t_h;
  std::vector<tp::Vector3<S>> host, target, points;
  std::vector<S> rho;
};

inline Vector3d facing_plane(Random& random) {
  const Vector3d n(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), -1);
  return -n.normalized() / random.uniform(0.8, 4);
}

template <class S>
Scene<S> make_scene(Random& random, int n, double half_width = 0.1, double half_height = 0.04) {
  Scene<S> scene;
  scene.theta = facing_plane(random);
  const tp::SE3d T = random.pose(0.15, 0.1);
  scene.T_t_h = T.cast<S>();
  const double u = random.uniform(-0.3, 0.3), v = random.uniform(-0.2, 0.2);
  for (int i = 0; i < n; ++i) {
    const Vector3d m(u + random.uniform(-half_width, half_width), v + random.uniform(-half_height, half_height), 1);
    const Vector3d p = m / scene.theta.dot(m), q = T * p;
    scene.host.push_back(m.cast<S>());
    scene.target.push_back(Vector3d(q / q[2]).cast<S>());
    scene.points.push_back(p.cast<S>());
    scene.rho.push_back(S(scene.theta.dot(m)));
  }
  return scene;
}

}  // namespace plane_fit_test

#endif  // TEXTPLANE_TESTS_GEOMETRY_PLANE_FIT_SCENE_HPP
