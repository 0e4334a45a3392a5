// Checks one number of a project that fetched textplane: the homography of a plane is that of its points.
#include <cstdio>

#include <textplane/geometry/homography.hpp>

int main() {
  const textplane::Vector3<double> theta(0.1, -0.2, 0.5), p(0.4, 0.3, 2.04);  // theta^T p = 1
  textplane::SE3<double> T_t_h;
  T_t_h.t = {0.2, -0.1, 0.05};
  textplane::Vector2<double> m;
  const auto status = textplane::warp_point<double>(theta, T_t_h, {p[0] / p[2], p[1] / p[2], 1.0}, &m);
  const textplane::Vector3<double> q = T_t_h * p;
  const double error = (m - textplane::Vector2<double>(q[0] / q[2], q[1] / q[2])).norm();
  std::printf("%s, error %.3g\n", textplane::to_string(status), error);
  return textplane::is_ok(status) && error < 1e-15 ? 0 : 1;
}
