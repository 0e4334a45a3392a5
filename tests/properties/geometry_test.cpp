// Laws of planes, homographies, cameras, quads and moments, at drawn states.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "properties/properties.hpp"
#include "support/calculus.hpp"
#include "support/dense.hpp"
#include "textplane/core/cameras/pinhole.hpp"
#include "textplane/geometry/homography.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/quad.hpp"
#include "textplane/photometry/zncc.hpp"

namespace textplane_test {
namespace geometry_properties {

constexpr double kPi = 3.14159265358979323846;

RC_GTEST_PROP(Planes, ReanchoringThereAndBackIsTheSamePlane, ()) {
  const tp::Vector3<double> theta = plane(0.5, 20);
  const tp::SE3d T = pose(0.45, 3);
  tp::Vector3<double> there, back;
  tp::Matrix3<double> J_there, J_back;
  RC_ASSERT(
      (tp::reanchor_plane<double>(theta, T, &there, &J_there) == tp::Status::ok || 1 + (T.R * theta).dot(T.t) < 1e-15));
  RC_PRE(1 + (T.R * theta).dot(T.t) > 1e-3);
  RC_ASSERT(tp::is_ok(tp::reanchor_plane<double>(there, T.inverse(), &back, &J_back)));
  RC_ASSERT((back - theta).norm() < 1e-11 * theta.norm());
  RC_ASSERT(largest(J_back * J_there - tp::Matrix3<double>::Identity()) < 1e-9);
}

RC_GTEST_PROP(Planes, ReanchoringKeepsPointsOnThePlane, ()) {
  const tp::Vector3<double> theta = plane(0.5, 20), m(number(-0.3, 0.3), number(-0.3, 0.3), 1);
  const tp::SE3d T = pose(0.4, 3);
  RC_PRE((1 + (T.R * theta).dot(T.t) > 1e-2 && theta.dot(m) > 1e-2 * theta.norm()));
  const tp::Vector3<double> p = T * tp::plane_point(theta, m);
  RC_ASSERT(std::abs(tp::reanchor_plane(theta, T).dot(p) - 1) < 1e-11 * (1 + p.norm() / 0.5));
}

RC_GTEST_PROP(Planes, NormalAndDistanceGiveThetaBack, ()) {
  const tp::Vector3<double> theta = plane(0.1, 50);
  const tp::Vector3<double> n = tp::plane_normal(theta);
  RC_ASSERT(std::abs(n.norm() - 1) < 1e-15 * 4);
  RC_ASSERT(n[2] < 0);
  RC_ASSERT((tp::plane_from_normal(n, tp::plane_distance(theta)) - theta).norm() < 1e-14 * theta.norm());
}

RC_GTEST_PROP(Planes, JacobiansOfReanchoringAreItsDerivatives, ()) {
  const tp::Vector3<double> theta = plane(1, 5);
  const tp::SE3d T = pose(0.5, 2);
  RC_PRE(1 + (T.R * theta).dot(T.t) > 0.2);
  tp::Matrix3<double> J_theta;
  Eigen::Matrix<double, 3, 6> J_pose;
  tp::Vector3<double> out;
  RC_ASSERT(tp::is_ok(tp::reanchor_plane<double>(theta, T, &out, &J_theta, &J_pose)));
  const auto by_theta =
      central_difference<3, 3>([&](const tp::Vector3<double>& x) { return tp::reanchor_plane<double>(x, T); }, theta);
  const auto by_pose = central_difference<3, 6>(
      [&](const tp::Vector6<double>& xi) { return tp::reanchor_plane<double>(theta, tp::se3_exp(xi) * T); },
      tp::Vector6<double>(tp::Vector6<double>::Zero()));
  RC_ASSERT(relative_error(J_theta, by_theta) < 1e-8);
  RC_ASSERT(relative_error(J_pose, by_pose) < 1e-8);
}

RC_GTEST_PROP(Homographies, ComposeWithTheReanchoredPlane, ()) {
  const tp::Vector3<double> theta = plane(0.5, 20);
  const tp::SE3d T_b_a = pose(0.4, 2), T_c_b = pose(0.4, 2);
  RC_PRE(1 + (T_b_a.R * theta).dot(T_b_a.t) > 1e-2);
  const tp::Matrix3<double> H_b_a = tp::plane_homography(theta, T_b_a);
  const tp::Matrix3<double> H_c_b = tp::plane_homography(tp::reanchor_plane(theta, T_b_a), T_c_b);
  const tp::Matrix3<double> H_c_a = tp::plane_homography<double>(theta, T_c_b * T_b_a);
  RC_ASSERT(largest(H_c_b * H_b_a - H_c_a) < 1e-11);
}

RC_GTEST_PROP(Homographies, TheInverseIsThatOfTheWayBack, ()) {
  const tp::Vector3<double> theta = plane(0.5, 20);
  const tp::SE3d T = pose(0.4, 3);
  RC_PRE(1 + (T.R * theta).dot(T.t) > 1e-2);
  tp::Matrix3<double> inverse;
  RC_ASSERT(tp::is_ok(tp::plane_homography_inverse<double>(theta, T, &inverse)));
  const tp::Matrix3<double> H = tp::plane_homography(theta, T);
  RC_ASSERT(largest(inverse * H - tp::Matrix3<double>::Identity()) < 1e-11);
  RC_ASSERT(largest(H * inverse - tp::Matrix3<double>::Identity()) < 1e-11);
  RC_ASSERT(largest(inverse - tp::plane_homography<double>(tp::reanchor_plane(theta, T), T.inverse())) < 1e-11);
}

RC_GTEST_PROP(Homographies, WarpIsTheProjectionOfThePlanesPoint, ()) {
  const tp::Vector3<double> theta = plane(0.5, 20), m(number(-0.6, 0.6), number(-0.6, 0.6), 1);
  const tp::SE3d T = pose(0.4, 2);
  tp::Vector2<double> warped(7, 7);
  tp::Vector3<double> point;
  const bool seen = tp::is_ok(tp::plane_point(theta, m, &point)) && (T * point)[2] > 0;
  const tp::Status status = tp::warp_point<double>(theta, T, m, &warped);
  if (!tp::is_ok(status)) {
    RC_ASSERT(status == tp::Status::behind_camera);
    RC_ASSERT((!seen || std::abs((T * point)[2]) < 1e-9 * point.norm()));
    RC_ASSERT(warped == tp::Vector2<double>(7, 7));
    return;
  }
  RC_PRE((seen && (T * point)[2] > 1e-3 * point.norm()));
  const tp::Vector3<double> q = T * point;
  RC_ASSERT((warped - q.head<2>() / q[2]).norm() < 1e-9 * (1 + warped.norm()));
  // Through pixels it is the same point.
  const tp::Pinhole<double> host{number(100, 900), number(100, 900), number(0, 640), number(0, 480)};
  const tp::Pinhole<double> target{number(100, 900), number(100, 900), number(0, 640), number(0, 480)};
  const tp::Matrix3<double> H = tp::pixel_homography<double>(tp::plane_homography(theta, T), host, target);
  const tp::Vector2<double> from = host.pixel({m[0], m[1]});
  tp::Vector2<double> px(0, 0);
  RC_ASSERT(tp::is_ok(tp::warp<double>(H, {from[0], from[1], 1}, &px)));
  RC_ASSERT((px - target.pixel(warped)).norm() < 1e-6 * (1 + px.norm()));
}

RC_GTEST_PROP(Homographies, JacobiansOfTheWarpAreItsDerivatives, ()) {
  const tp::Vector3<double> theta = plane(1, 5), m(number(-0.5, 0.5), number(-0.5, 0.5), 1);
  const tp::SE3d T = pose(0.3, 0.7);
  const auto warped = [&](const tp::Vector3<double>& x, const tp::SE3d& pose_at) {
    tp::Vector2<double> out(0, 0);
    tp::warp_point<double>(x, pose_at, m, &out);
    return out;
  };
  RC_PRE((theta.dot(m) > 0.1 && (tp::plane_homography(theta, T) * m)[2] > 0.2));
  tp::Vector2<double> out(0, 0);
  tp::WarpJacobians<double> J;
  RC_ASSERT(tp::is_ok(tp::warp_point(theta, T, m, &out, &J)));
  const auto by_pose =
      central_difference<2, 6>([&](const tp::Vector6<double>& xi) { return warped(theta, tp::se3_exp(xi) * T); },
                               tp::Vector6<double>(tp::Vector6<double>::Zero()));
  const auto by_theta = central_difference<2, 3>([&](const tp::Vector3<double>& x) { return warped(x, T); }, theta);
  RC_ASSERT(relative_error(J.pose, by_pose) < 1e-7);
  RC_ASSERT(largest(J.theta - by_theta) < 1e-8 * (1 + largest(by_theta)));
}

// A unit of length is a convention: (t, theta) and (s t, theta / s) are the same scene.
RC_GTEST_PROP(Homographies, DoNotKnowTheScale, ()) {
  const tp::Vector3<double> theta = plane(0.5, 20);
  const tp::SE3d T = pose(2, 3);
  const int exponent = integer(-20, 20);
  const double power = std::ldexp(1.0, exponent), any = std::pow(10.0, number(-3, 3));
  const tp::Matrix3<double> H = tp::plane_homography(theta, T);
  tp::SE3d scaled = T;
  scaled.t = power * T.t;
  RC_ASSERT(tp::plane_homography<double>(theta / power, scaled) == H);  // Powers of two do not round.
  scaled.t = any * T.t;
  RC_ASSERT(largest(tp::plane_homography<double>(theta / any, scaled) - H) < 1e-14 * (1 + T.t.norm() * theta.norm()));
}

RC_GTEST_PROP(Cameras, LevelsAreHalvesOfOneImage, ()) {
  const tp::Pinhole<double> camera{number(100, 900), number(100, 900), number(0, 640), number(0, 480)};
  const int level = integer(0, 5);
  const tp::Vector2<double> m(number(-1, 1), number(-1, 1));
  const double k = std::ldexp(1.0, -level);
  const tp::Vector2<double> px = camera.pixel(m), at = camera.at_level(level).pixel(m);
  RC_ASSERT((((px.array() + 0.5) * k - 0.5).matrix() - at).norm() < 1e-10);
  const tp::Vector3<double> back = camera.unproject(px);
  RC_ASSERT((back - tp::Vector3<double>(m[0], m[1], 1)).norm() < 1e-13);
}

RC_GTEST_PROP(Quads, OverlapIsSymmetricAndItsOwnIsOne, ()) {
  const auto draw = [] {
    // A convex quad: a rectangle, turned, its corners moved by less than a tenth of its sides.
    const double w = number(20, 60), h = number(20, 60), a = number(-3, 3);
    const tp::Vector2<double> centre(number(0, 80), number(0, 80));
    tp::Quad<double> q;
    const double x[4] = {-w, w, w, -w}, y[4] = {-h, -h, h, h};
    for (std::size_t i = 0; i < 4; ++i) {
      const double u = x[i] / 2 + number(-0.1, 0.1) * w, v = y[i] / 2 + number(-0.1, 0.1) * h;
      q.corner[i] = centre + tp::Vector2<double>(std::cos(a) * u - std::sin(a) * v, std::sin(a) * u + std::cos(a) * v);
    }
    return q;
  };
  const tp::Quad<double> a = draw(), b = draw();
  RC_ASSERT((tp::is_convex(a) && tp::area(a) > 0));
  const double ab = tp::iou(a, b);
  RC_ASSERT((ab >= 0 && ab <= 1));
  RC_ASSERT(std::abs(ab - tp::iou(b, a)) < 1e-9);
  RC_ASSERT(std::abs(tp::iou(a, a) - 1) < 1e-9);
}

// Mean and norm of a whole from those of its parts.
RC_GTEST_PROP(Moments, OfTheWholeFollowFromThoseOfTheParts, ()) {
  const int n = integer(2, 60);
  std::vector<double> values;
  std::vector<std::uint8_t> left, right;
  for (int i = 0; i < n; ++i) {
    values.push_back(number(0, 255));
    left.push_back(static_cast<std::uint8_t>(integer(0, 1)));
    right.push_back(left.back() == 0);
  }
  const auto a = tp::intensity_stats(values.data(), left.data(), n),
             b = tp::intensity_stats(values.data(), right.data(), n);
  const auto all = tp::intensity_stats(values.data(), nullptr, n);
  RC_PRE((tp::is_ok(a.status) && tp::is_ok(b.status)));
  RC_ASSERT((tp::is_ok(all.status) && all.n == a.n + b.n));
  const double mean = (a.n * a.mean + b.n * b.mean) / n;
  const double squares = a.s * a.s + b.s * b.s + (a.mean - b.mean) * (a.mean - b.mean) * a.n * b.n / n;
  RC_ASSERT(std::abs(all.mean - mean) < 1e-11);
  RC_ASSERT(std::abs(all.s * all.s - squares) < 1e-9 * (1 + squares));
}

RC_GTEST_PROP(Zncc, IsBoundedSymmetricAndBlindToGainAndBias, ()) {
  const int n = integer(2, 80);
  std::vector<double> a, b, c, d;
  const double gain = number(0.1, 8), bias = number(-50, 50);
  for (int i = 0; i < n; ++i) {
    a.push_back(number(0, 255));
    b.push_back(number(0, 255));
    c.push_back(gain * b.back() + bias);
    d.push_back(-gain * b.back() + bias);
  }
  tp::Status status;
  const double z = tp::zncc(a.data(), b.data(), nullptr, n, &status);
  RC_PRE(tp::is_ok(status));
  RC_ASSERT((z <= 1 + 1e-14 && z >= -1 - 1e-14));
  RC_ASSERT(z == tp::zncc(b.data(), a.data(), nullptr, n));
  RC_ASSERT(std::abs(tp::zncc(a.data(), c.data(), nullptr, n) - z) < 1e-10);
  RC_ASSERT(std::abs(tp::zncc(a.data(), d.data(), nullptr, n) + z) < 1e-10);
  RC_ASSERT(std::abs(tp::zncc(b.data(), c.data(), nullptr, n) - 1) < 1e-10);
}

}  // namespace geometry_properties
}  // namespace textplane_test

// The same states from run to run, unless RC_PARAMS asks for others: RC_PARAMS='seed=7 max_success=100000 noshrink=1'
// draws more. Nothing is shrunk: a pose of smaller numbers is no simpler, and to try them all takes long.
int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  setenv("RC_PARAMS", "seed=20 max_success=100 noshrink=1", 0);
  std::printf("RC_PARAMS='%s'\n", std::getenv("RC_PARAMS"));
  return RUN_ALL_TESTS();
}
