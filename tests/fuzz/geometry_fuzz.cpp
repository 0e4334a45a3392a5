// Planes, quads, homographies and triangulation on any numbers: an ok status never comes with a NaN, areas and overlaps
// stay in their ranges, and a plane that was fitted fits.
#include <cmath>
#include <vector>

#include "fuzz.hpp"
#include "textplane/geometry/homography.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/plane_fit.hpp"
#include "textplane/geometry/quad_projection.hpp"
#include "textplane/geometry/triangulate.hpp"

namespace textplane_fuzz {
namespace {

template <class Matrix>
bool all_finite(const Matrix& m) {
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j < m.cols(); ++j)
      if (!tp::is_finite(m(i, j))) return false;
  return true;
}

void check(const tp::PlaneFit<double>& fit) {
  TEXTPLANE_FUZZ_REQUIRE(fit.rank >= 0 && fit.rank <= 3);
  if (tp::is_ok(fit.status)) TEXTPLANE_FUZZ_REQUIRE(all_finite(fit.value) && all_finite(fit.covariance));
}

void planes(Input& in) {
  const int n = in.integer(0, 12);
  const tp::SE3d T = in.pose(1, 1);
  std::vector<tp::Vector3<double>> a, b, p;
  std::vector<double> rho, weight;
  for (int i = 0; i < n; ++i) {
    a.push_back({in.number(-1, 1), in.number(-1, 1), in.number(0.9, 1.1)});
    b.push_back({in.number(-1, 1), in.number(-1, 1), in.number(0.9, 1.1)});
    p.push_back(in.vector(5));
    rho.push_back(in.number(-0.1, 2));
    weight.push_back(in.number(0, 3));
  }
  const double* const weights = in.flag() ? weight.data() : nullptr;
  check(tp::plane_from_inverse_depths(a.data(), rho.data(), weights, n));
  check(tp::plane_from_matches(a.data(), b.data(), n, T, weights));
  check(tp::plane_from_points(p.data(), n, weights));
}

void transforms(Input& in) {
  const tp::SE3d T = in.pose(3, 2);
  const tp::Vector3<double> theta = in.vector(2), m = in.vector(1);
  tp::Vector3<double> point, moved;
  if (tp::is_ok(tp::plane_point(theta, m, &point))) TEXTPLANE_FUZZ_REQUIRE(all_finite(point));
  tp::Matrix3<double> J;
  if (tp::is_ok(tp::reanchor_plane<double>(theta, T, &moved, &J)))
    TEXTPLANE_FUZZ_REQUIRE(all_finite(moved) && all_finite(J));
  tp::Vector2<double> px;
  tp::WarpJacobians<double> jacobians;
  if (tp::is_ok(tp::warp_point(theta, T, m, &px, &jacobians)))
    TEXTPLANE_FUZZ_REQUIRE(all_finite(px) && all_finite(jacobians.pose) && all_finite(jacobians.theta));
  tp::Matrix3<double> inverse;
  if (tp::is_ok(tp::plane_homography_inverse(theta, T, &inverse))) TEXTPLANE_FUZZ_REQUIRE(all_finite(inverse));
  std::array<tp::Vector3<double>, 4> corners;
  const tp::Pinhole<double> camera = in.camera(60, 40);
  const tp::Quad<double> quad = in.quad(60, 40);
  if (tp::is_ok(tp::quad_points(quad, camera, theta, &corners)))
    for (const auto& corner : corners) TEXTPLANE_FUZZ_REQUIRE(all_finite(corner));
  tp::Quad<double> projected;
  if (tp::is_ok(tp::project_quad(quad, camera, theta, T, camera, &projected)))
    TEXTPLANE_FUZZ_REQUIRE(tp::all_finite(projected));
}

void quads(Input& in) {
  const tp::Quad<double> a = in.quad(60, 40), b = in.quad(60, 40);
  const double overlap = tp::iou(a, b);
  TEXTPLANE_FUZZ_REQUIRE(overlap >= 0 && overlap <= 1 + 1e-9);
  const auto clipped = tp::clip_to_image(a, 60, 40);
  const double area = tp::area(clipped);
  TEXTPLANE_FUZZ_REQUIRE(tp::is_finite(area) && area >= -1e-6 && area <= 60 * 40);
  static_cast<void>(tp::is_convex(a));
  static_cast<void>(tp::contains(a, b.corner[0]));
  static_cast<void>(tp::centroid(a));
}

void triangulation(Input& in) {
  const int n = in.integer(0, 6);
  std::vector<tp::SE3d> poses;
  std::vector<tp::Vector3<double>> rays;
  for (int i = 0; i < n; ++i) {
    poses.push_back(in.pose(1, 1));
    rays.push_back({in.number(-1, 1), in.number(-1, 1), in.number(0.9, 1.1)});
  }
  tp::Vector3<double> p;
  tp::Matrix3<double> covariance;
  if (tp::is_ok(tp::triangulate_views(poses.data(), rays.data(), n, &p, &covariance)))
    TEXTPLANE_FUZZ_REQUIRE(all_finite(p) && all_finite(covariance));
  if (n >= 2 && tp::is_ok(tp::triangulate(rays[0], rays[1], poses[0], &p, &covariance)))
    TEXTPLANE_FUZZ_REQUIRE(all_finite(p) && all_finite(covariance));
}

}  // namespace
}  // namespace textplane_fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace textplane_fuzz;
  Input in(data, size);
  const int what = in.integer(0, 3);
  if (what == 0) planes(in);
  if (what == 1) transforms(in);
  if (what == 2) quads(in);
  if (what == 3) triangulation(in);
  return 0;
}
