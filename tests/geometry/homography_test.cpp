#include "textplane/geometry/homography.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/calculus.hpp"

namespace tp = textplane;
using textplane_test::central_difference;
using textplane_test::Dual;
using textplane_test::dual_derivative;
using textplane_test::Random;
using textplane_test::relative_error;
using textplane_test::tolerance;
using textplane_test::values;
using Vector2d = Eigen::Vector2d;
using Vector3d = Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;

#define TEXTPLANE_INSTANTIATE(S)                                                                                  \
  template struct tp::WarpJacobians<S>;                                                                           \
  template struct tp::RelativePoseJacobians<S>;                                                                   \
  template tp::Matrix3<S> tp::plane_homography<S>(const tp::Vector3<S>&, const tp::SE3<S>&);                      \
  template tp::Status tp::plane_homography_inverse<S>(const tp::Vector3<S>&, const tp::SE3<S>&, tp::Matrix3<S>*); \
  template tp::Matrix3<S> tp::pixel_homography<S>(const tp::Matrix3<S>&, const tp::Pinhole<S>&,                   \
                                                  const tp::Pinhole<S>&);                                         \
  template tp::Status tp::warp<S>(const tp::Matrix3<S>&, const tp::Vector3<S>&, tp::Vector2<S>*);                 \
  template tp::Status tp::warp_point<S>(const tp::Vector3<S>&, const tp::SE3<S>&, const tp::Vector3<S>&,          \
                                        tp::Vector2<S>*, tp::WarpJacobians<S>*);                                  \
  template tp::RelativePoseJacobians<S> tp::relative_pose_jacobians<S>(const tp::SE3<S>&, const tp::SE3<S>&,      \
                                                                       tp::PerturbationSide);
TEXTPLANE_INSTANTIATE(float)
TEXTPLANE_INSTANTIATE(double)
TEXTPLANE_INSTANTIATE(Dual<6>)
#undef TEXTPLANE_INSTANTIATE

namespace homography_test {

const double kNan = std::nan("");

template <class S>
class Homography : public testing::Test {};
using Scalars = testing::Types<float, double, Dual<6>>;
TYPED_TEST_SUITE(Homography, Scalars, );

struct Scene {
  Vector3d n;
  double d;
  Vector3d theta;
  tp::SE3d T_w_h, T_w_t, T_t_h;
  Vector3d m;
};

Scene make_scene(Random& random) {
  Scene s;
  s.n = Vector3d(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), -1).normalized();
  s.d = random.uniform(1, 4);
  s.theta = -s.n / s.d;
  s.T_w_h = random.pose(2, 2);
  s.T_t_h = random.pose(0.3, 0.5);
  s.T_w_t = s.T_w_h * s.T_t_h.inverse();
  s.m = Vector3d(random.uniform(-0.4, 0.4), random.uniform(-0.3, 0.3), 1);
  return s;
}

// Independent of theta, of H and of the frames' convention: cast the ray of the host pixel in the world, intersect it
// with the plane given by a world point and a world normal, and look at the hit from the target.
Vector2d cast_ray(const Scene& s) {
  const Vector3d origin = s.T_w_h.t, direction = s.T_w_h.R * s.m;
  const Vector3d normal = s.T_w_h.R * s.n, foot = s.T_w_h.t - s.d * normal;
  const double length = normal.dot(foot - origin) / normal.dot(direction);
  const Vector3d hit = origin + length * direction, seen = s.T_w_t.R.transpose() * (hit - s.T_w_t.t);
  return {seen[0] / seen[2], seen[1] / seen[2]};
}

TYPED_TEST(Homography, WarpIsRayPlaneIntersection) {
  using S = TypeParam;
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Scene s = make_scene(random);
    const Vector2d expected = cast_ray(s);
    const tp::Vector3<S> theta = s.theta.cast<S>(), m = s.m.cast<S>();
    const tp::SE3<S> T = s.T_t_h.cast<S>();
    tp::Vector2<S> by_h = tp::Vector2<S>::Zero(), by_point = by_h;
    ASSERT_EQ(tp::warp(tp::plane_homography(theta, T), m, &by_h), tp::Status::ok);
    ASSERT_EQ(tp::warp_point(theta, T, m, &by_point), tp::Status::ok);
    EXPECT_LT((values(by_h) - expected).norm(), tolerance<S>(2e-6, 1e-13));
    EXPECT_LT((values(by_point) - expected).norm(), tolerance<S>(2e-6, 1e-13));
  }
}

TYPED_TEST(Homography, ComposesAndInverts) {
  using S = TypeParam;
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const Scene s = make_scene(random);
    const tp::SE3<S> T_b_a = s.T_t_h.cast<S>(), T_c_b = random.pose(0.2, 0.5).cast<S>();
    const tp::Vector3<S> theta = s.theta.cast<S>(), theta_b = tp::reanchor_plane(theta, T_b_a);
    const tp::Matrix3<S> H_b_a = tp::plane_homography(theta, T_b_a), H_c_b = tp::plane_homography(theta_b, T_c_b);
    const double bound = tolerance<S>(5e-6, 1e-13);
    // Scale and sign included, not only up to a factor.
    EXPECT_LT(
        relative_error(values(tp::Matrix3<S>(H_c_b * H_b_a)), values(tp::plane_homography<S>(theta, T_c_b * T_b_a))),
        bound);
    tp::Matrix3<S> inverse = tp::Matrix3<S>::Zero();
    ASSERT_EQ(tp::plane_homography_inverse(theta, T_b_a, &inverse), tp::Status::ok);
    EXPECT_LT((values(tp::Matrix3<S>(inverse * H_b_a)) - Eigen::Matrix3d::Identity()).norm(), bound);
    EXPECT_LT(relative_error(values(inverse), values(tp::plane_homography<S>(theta_b, T_b_a.inverse()))), bound);
  }
}

TYPED_TEST(Homography, PixelHomographyIsTheSameMapInPixels) {
  using S = TypeParam;
  Random random(3);
  const tp::Pinhole<S> host(S(525), S(520), S(319.5), S(239.5)), target(S(300), S(310), S(160), S(121));
  for (int i = 0; i < 50; ++i) {
    const Scene s = make_scene(random);
    const tp::Matrix3<S> H = tp::plane_homography<S>(s.theta.cast<S>(), s.T_t_h.cast<S>());
    const tp::Vector2<S> px = host.pixel(s.m.head<2>().cast<S>());
    tp::Vector2<S> m = tp::Vector2<S>::Zero(), warped = m;
    ASSERT_EQ(tp::warp<S>(H, s.m.cast<S>(), &m), tp::Status::ok);
    ASSERT_EQ(tp::warp<S>(tp::pixel_homography(H, host, target), {px[0], px[1], S(1)}, &warped), tp::Status::ok);
    EXPECT_LT((values(warped) - values(target.pixel(m))).norm(), tolerance<S>(2e-3, 1e-11));
  }
}

template <class S>
tp::Vector2<S> warped(const tp::Vector3<S>& theta, const tp::SE3<S>& T, const tp::Vector3<S>& m) {
  tp::Vector2<S> out = tp::Vector2<S>::Zero();
  EXPECT_EQ(tp::warp_point(theta, T, m, &out), tp::Status::ok);
  return out;
}

TEST(Homography, AnInverseThatOverflowsIsNoSuccess) {
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Constant(7);
  const tp::SE3d T{Eigen::Matrix3d::Identity(), Vector3d(1e150, 0, 0)};
  EXPECT_EQ(tp::plane_homography_inverse(Vector3d(0, 0, 1e200), T, &inverse), tp::Status::non_finite);
  EXPECT_EQ(inverse, Eigen::Matrix3d::Constant(7)) << "untouched";
}

// A depth so small that the point is still a number and its derivatives are none.
TEST(WarpJacobian, OverflowIsNoSuccess) {
  const tp::SE3d T{Eigen::Matrix3d::Identity(), Vector3d(1e200, 0, 0)};
  const Vector3d m(0, 0, 1e-150), theta(0, 0, 1);
  Vector2d out;
  ASSERT_EQ(tp::warp_point(theta, T, m, &out), tp::Status::ok) << "without derivatives";
  EXPECT_NEAR(out[0] / 1e200, 1, 1e-12);
  out = {7, 7};
  tp::WarpJacobians<double> J;
  J.pose.setConstant(7);
  J.theta.setConstant(7);
  EXPECT_EQ(tp::warp_point(theta, T, m, &out, &J), tp::Status::non_finite);
  EXPECT_EQ(out, Vector2d(7, 7)) << "untouched";
  EXPECT_EQ(J.pose, decltype(J.pose)::Constant(7));
  EXPECT_EQ(J.theta, decltype(J.theta)::Constant(7));
}

TEST(WarpJacobian, RelativePoseAndTheta) {
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    const Scene s = make_scene(random);
    Vector2d out;
    tp::WarpJacobians<double> J;
    ASSERT_EQ(tp::warp_point(s.theta, s.T_t_h, s.m, &out, &J), tp::Status::ok);
    const auto by_pose = [&](const auto& xi) {
      using S = typename std::decay_t<decltype(xi)>::Scalar;
      return warped<S>(s.theta.cast<S>(), tp::se3_exp<S>(xi) * s.T_t_h.cast<S>(), s.m.cast<S>());
    };
    const auto by_theta = [&](const auto& theta) {
      using S = typename std::decay_t<decltype(theta)>::Scalar;
      return warped<S>(theta, s.T_t_h.cast<S>(), s.m.cast<S>());
    };
    const Vector6d zero = Vector6d::Zero();
    EXPECT_LT(relative_error(J.pose, (central_difference<2, 6>(by_pose, zero))), 1e-9);
    EXPECT_LT(relative_error(J.pose, (dual_derivative<2, 6>(by_pose, zero))), 1e-13);
    EXPECT_LT(relative_error(J.theta, (central_difference<2, 3>(by_theta, s.theta))), 1e-8);
    EXPECT_LT(relative_error(J.theta, (dual_derivative<2, 3>(by_theta, s.theta))), 1e-12);
  }
}

// Host pose and target pose, each perturbed on its left and on its right.
TEST(WarpJacobian, WorldPosesOnEitherSide) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const Scene s = make_scene(random);
    Vector2d out;
    tp::WarpJacobians<double> J;
    ASSERT_EQ(tp::warp_point(s.theta, s.T_w_t.inverse() * s.T_w_h, s.m, &out, &J), tp::Status::ok);
    for (const auto side : {tp::PerturbationSide::left, tp::PerturbationSide::right}) {
      const auto moved = [&](const tp::SE3d& T, const auto& xi) {
        using S = typename std::decay_t<decltype(xi)>::Scalar;
        const tp::SE3<S> E = tp::se3_exp<S>(xi), pose = T.cast<S>();
        return side == tp::PerturbationSide::left ? E * pose : pose * E;
      };
      const auto by_host = [&](const auto& xi) {
        using S = typename std::decay_t<decltype(xi)>::Scalar;
        return warped<S>(s.theta.cast<S>(), s.T_w_t.inverse().cast<S>() * moved(s.T_w_h, xi), s.m.cast<S>());
      };
      const auto by_target = [&](const auto& xi) {
        using S = typename std::decay_t<decltype(xi)>::Scalar;
        return warped<S>(s.theta.cast<S>(), moved(s.T_w_t, xi).inverse() * s.T_w_h.cast<S>(), s.m.cast<S>());
      };
      const auto map = tp::relative_pose_jacobians(s.T_w_h, s.T_w_t, side);
      const Eigen::Matrix<double, 2, 6> host = J.pose * map.host, target = J.pose * map.target;
      const Vector6d zero = Vector6d::Zero();
      EXPECT_LT(relative_error(host, (central_difference<2, 6>(by_host, zero))), 1e-9);
      EXPECT_LT(relative_error(host, (dual_derivative<2, 6>(by_host, zero))), 1e-12);
      EXPECT_LT(relative_error(target, (central_difference<2, 6>(by_target, zero))), 1e-9);
      EXPECT_LT(relative_error(target, (dual_derivative<2, 6>(by_target, zero))), 1e-12);
    }
  }
}

// The adjoint maps hold for finite perturbations, not only to first order.
TYPED_TEST(Homography, RelativePoseMapsAreExact) {
  using S = TypeParam;
  Random random(6);
  const tp::SE3<S> T_w_h = random.pose(2, 2).cast<S>(), T_w_t = random.pose(2, 2).cast<S>(),
                   T_t_h = T_w_t.inverse() * T_w_h;
  const tp::Vector6<S> xi = random.vector<6>(0.5).cast<S>();
  const tp::SE3<S> E = tp::se3_exp(xi);
  for (const auto side : {tp::PerturbationSide::left, tp::PerturbationSide::right}) {
    const bool left = side == tp::PerturbationSide::left;
    const auto map = tp::relative_pose_jacobians(T_w_h, T_w_t, side);
    const tp::SE3<S> host = T_w_t.inverse() * (left ? E * T_w_h : T_w_h * E);
    const tp::SE3<S> target = (left ? E * T_w_t : T_w_t * E).inverse() * T_w_h;
    const tp::SE3<S> by_host = tp::se3_exp<S>(map.host * xi) * T_t_h,
                     by_target = tp::se3_exp<S>(map.target * xi) * T_t_h;
    EXPECT_LT((values(host.R) - values(by_host.R)).norm() + (values(host.t) - values(by_host.t)).norm(),
              tolerance<S>(3e-5, 1e-13));
    EXPECT_LT((values(target.R) - values(by_target.R)).norm() + (values(target.t) - values(by_target.t)).norm(),
              tolerance<S>(3e-5, 1e-13));
  }
}

TEST(WarpTest, PointsThatCannotBeSeenAreRefused) {
  const Vector3d theta(0, 0, 0.5), m(0, 0, 1);
  const Vector2d untouched(7, 8);
  Vector2d out = untouched;
  tp::SE3d T;
  EXPECT_EQ(tp::warp_point<double>(-theta, T, m, &out), tp::Status::behind_camera) << "behind the host";
  T.t = Vector3d(0, 0, -2.5);
  EXPECT_EQ(tp::warp_point(theta, T, m, &out), tp::Status::behind_camera) << "behind the target";
  EXPECT_EQ(tp::warp(tp::plane_homography(theta, T), m, &out), tp::Status::behind_camera);
  T.t = Vector3d(0, 0, -2);
  EXPECT_EQ(tp::warp_point(theta, T, m, &out), tp::Status::behind_camera) << "in the target's centre";
  T.t = Vector3d(0, kNan, 0);
  EXPECT_EQ(tp::warp_point(theta, T, m, &out), tp::Status::non_finite);
  EXPECT_EQ(tp::warp(tp::plane_homography(theta, T), m, &out), tp::Status::non_finite);
  EXPECT_EQ(tp::warp_point<double>(theta, tp::SE3d(), {kNan, 0, 1}, &out), tp::Status::non_finite);
  EXPECT_EQ(tp::warp_point<double>({0, 0, kNan}, tp::SE3d(), m, &out), tp::Status::non_finite);
  Eigen::Matrix3d tiny = Eigen::Matrix3d::Identity();
  tiny(2, 2) = 1e-300;
  EXPECT_EQ(tp::warp<double>(tiny, {1e10, 1, 1}, &out), tp::Status::non_finite) << "overflow";
  EXPECT_EQ(out, untouched);
  Eigen::Matrix3d H = Eigen::Matrix3d::Constant(5);
  T.t = Vector3d(0, 0, -2);
  EXPECT_EQ(tp::plane_homography_inverse(theta, T, &H), tp::Status::behind_camera);
  EXPECT_EQ(H, Eigen::Matrix3d::Constant(5));
}

}  // namespace homography_test
