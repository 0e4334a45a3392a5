#include "textplane/geometry/plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/calculus.hpp"

namespace tp = textplane;
using textplane_test::central_difference;
using textplane_test::Dual;
using textplane_test::dual_derivative;
using textplane_test::Random;
using textplane_test::relative_error;
using textplane_test::tolerance;
using textplane_test::value;
using textplane_test::values;
using Vector3d = Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;

#define TEXTPLANE_INSTANTIATE(S)                                                                           \
  template tp::Vector3<S> tp::plane_from_normal<S>(const tp::Vector3<S>&, const S&);                       \
  template tp::Vector3<S> tp::from_negated<S>(const tp::Vector3<S>&);                                      \
  template tp::Vector3<S> tp::plane_normal<S>(const tp::Vector3<S>&);                                      \
  template S tp::plane_distance<S>(const tp::Vector3<S>&);                                                 \
  template S tp::inverse_depth<S>(const tp::Vector3<S>&, const tp::Vector3<S>&);                           \
  template tp::Status tp::plane_point<S>(const tp::Vector3<S>&, const tp::Vector3<S>&, tp::Vector3<S>*);   \
  template tp::Vector3<S> tp::plane_point<S>(const tp::Vector3<S>&, const tp::Vector3<S>&);                \
  template tp::Status tp::reanchor_plane<S>(const tp::Vector3<S>&, const tp::SE3<S>&, tp::Vector3<S>*,     \
                                            tp::Matrix3<S>*, Eigen::Matrix<S, 3, 6>*);                     \
  template tp::Vector3<S> tp::reanchor_plane<S>(const tp::Vector3<S>&, const tp::SE3<S>&, tp::Matrix3<S>*, \
                                                Eigen::Matrix<S, 3, 6>*);
TEXTPLANE_INSTANTIATE(float)
TEXTPLANE_INSTANTIATE(double)
TEXTPLANE_INSTANTIATE(Dual<6>)
#undef TEXTPLANE_INSTANTIATE

namespace plane_test {

const double kNan = std::nan("");

template <class S>
class Plane : public testing::Test {};
using Scalars = testing::Types<float, double, Dual<6>>;
TYPED_TEST_SUITE(Plane, Scalars, );

// A plane before the camera, facing it: unit normal n towards the camera, distance d.
struct Truth {
  Vector3d n;
  double d;
};
Truth random_plane(Random& random) {
  Vector3d n(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), -1);
  return {n.normalized(), random.uniform(0.5, 4)};
}

TYPED_TEST(Plane, ThetaKeepsNormalDistanceAndPoints) {
  using S = TypeParam;
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Truth plane = random_plane(random);
    const double scale = random.uniform(0.1, 10);  // n need not be a unit vector
    const tp::Vector3<S> theta = tp::plane_from_normal<S>((scale * plane.n).cast<S>(), S(scale * plane.d));
    EXPECT_LT((values(tp::plane_normal(theta)) - plane.n).norm(), tolerance<S>(1e-6, 1e-15));
    EXPECT_NEAR(value(tp::plane_distance(theta)), plane.d, tolerance<S>(2e-6, 1e-14));
    const Vector3d m(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 1);
    const double depth = -plane.d / plane.n.dot(m);  // n^T (depth m) + d = 0
    EXPECT_NEAR(value(tp::inverse_depth<S>(theta, m.cast<S>())), 1 / depth, tolerance<S>(2e-6, 1e-14));
    EXPECT_LT((values(tp::plane_point<S>(theta, m.cast<S>())) - depth * m).norm(), tolerance<S>(2e-5, 1e-13));
    EXPECT_EQ(values(tp::from_negated<S>(-theta)), values(theta));
  }
}

TEST(PlaneTest, NormalPointsToTheCamera) {
  // The wall z = 2 seen from the origin: its normal towards the camera is -z and theta = (0, 0, 1/2).
  const Vector3d theta = tp::plane_from_normal<double>({0, 0, -1}, 2);
  EXPECT_EQ(theta, Vector3d(0, 0, 0.5));
  EXPECT_EQ(tp::plane_normal(theta), Vector3d(0, 0, -1));
  EXPECT_EQ(tp::plane_point<double>(theta, {0.25, -0.5, 1}), Vector3d(0.5, -1, 2));
}

TEST(PlaneTest, PointsBehindTheCameraAreRefused) {
  const Vector3d theta(0, 0, 0.5), untouched(7, 8, 9);
  Vector3d p = untouched;
  EXPECT_EQ(tp::plane_point<double>(-theta, {0, 0, 1}, &p), tp::Status::behind_camera);
  EXPECT_EQ(tp::plane_point<double>(Vector3d(0.5, 0, 0), {0, 0, 1}, &p), tp::Status::behind_camera)
      << "ray in the plane";
  EXPECT_EQ(tp::plane_point<double>(Vector3d(0, kNan, 1), {0, 0, 1}, &p), tp::Status::non_finite);
  EXPECT_EQ(tp::plane_point<double>(theta, {0, kNan, 1}, &p), tp::Status::non_finite);
  EXPECT_EQ(tp::plane_point<double>(Vector3d(0, 0, 1e-300), {1e10, 0, 1}, &p), tp::Status::non_finite) << "overflow";
  EXPECT_EQ(p, untouched);
  EXPECT_EQ(tp::plane_point<double>(-theta, {0, 0, 1}), Vector3d::Zero());
  EXPECT_EQ(tp::plane_from_normal<double>({0, 0, 1}, 0), Vector3d::Zero());
  EXPECT_EQ(tp::plane_from_normal<double>({0, 0, 1}, kNan), Vector3d::Zero());
}

TYPED_TEST(Plane, ReanchoredPlaneHoldsTheMovedPoints) {
  using S = TypeParam;
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const Truth plane = random_plane(random);
    const tp::SE3d T = random.pose(0.3, 0.5);
    const Vector3d theta = -plane.n / plane.d;
    const tp::Vector3<S> moved = tp::reanchor_plane<S>(theta.cast<S>(), T.cast<S>());
    for (int k = 0; k < 5; ++k) {
      const Vector3d m(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 1);
      EXPECT_NEAR(values(moved).dot(T * Vector3d(m / theta.dot(m))), 1, tolerance<S>(3e-6, 1e-14));
    }
  }
}

TYPED_TEST(Plane, ReanchoringRoundTrips) {
  using S = TypeParam;
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Truth plane = random_plane(random);
    const tp::SE3<S> a = random.pose(0.3, 0.5).cast<S>(), b = random.pose(0.1, 0.5).cast<S>();
    const tp::Vector3<S> theta = tp::plane_from_normal<S>(plane.n.cast<S>(), S(plane.d));
    const auto there = tp::reanchor_plane(theta, a);
    EXPECT_LT(relative_error(values(tp::reanchor_plane(there, a.inverse())), values(theta)), tolerance<S>(5e-6, 1e-13));
    EXPECT_LT(relative_error(values(tp::reanchor_plane(there, b)), values(tp::reanchor_plane<S>(theta, b * a))),
              tolerance<S>(5e-6, 1e-13));
  }
}

TEST(PlaneTest, DerivativesThatOverflowAreNoSuccess) {
  const Vector3d theta(0, 0, 1e200);
  const tp::SE3d T{Eigen::Matrix3d::Identity(), Vector3d(1e150, 0, 0)};
  Vector3d out;
  ASSERT_EQ(tp::reanchor_plane(theta, T, &out), tp::Status::ok) << "without derivatives";
  EXPECT_EQ(out, theta);
  out.setConstant(7);
  Eigen::Matrix3d J_theta = Eigen::Matrix3d::Constant(7);
  Eigen::Matrix<double, 3, 6> J_pose = Eigen::Matrix<double, 3, 6>::Constant(7);
  EXPECT_EQ(tp::reanchor_plane(theta, T, &out, &J_theta), tp::Status::non_finite);
  EXPECT_EQ(tp::reanchor_plane<double>(theta, T, &out, nullptr, &J_pose), tp::Status::non_finite);
  EXPECT_EQ(out, Vector3d::Constant(7)) << "untouched";
  EXPECT_EQ(J_theta, Eigen::Matrix3d::Constant(7));
  EXPECT_EQ(J_pose, decltype(J_pose)::Constant(7));
}

TEST(PlaneTest, ReanchorJacobians) {
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const Truth plane = random_plane(random);
    const tp::SE3d T = random.pose(0.3, 1);
    const Vector3d theta = -plane.n / plane.d;
    Eigen::Matrix3d J_theta;
    Eigen::Matrix<double, 3, 6> J_pose;
    const Vector3d moved = tp::reanchor_plane(theta, T, &J_theta, &J_pose);
    EXPECT_EQ(moved, tp::reanchor_plane(theta, T));
    const auto by_theta = [&](const auto& x) {
      using S = typename std::decay_t<decltype(x)>::Scalar;
      return tp::reanchor_plane<S>(x, T.cast<S>());
    };
    const auto by_pose = [&](const auto& xi) {
      using S = typename std::decay_t<decltype(xi)>::Scalar;
      return tp::reanchor_plane<S>(theta.cast<S>(), tp::se3_exp<S>(xi) * T.cast<S>());
    };
    EXPECT_LT(relative_error(J_theta, (central_difference<3, 3>(by_theta, theta))), 1e-9);
    EXPECT_LT(relative_error(J_theta, (dual_derivative<3, 3>(by_theta, theta))), 1e-13);
    EXPECT_LT(relative_error(J_pose, (central_difference<3, 6>(by_pose, Vector6d(Vector6d::Zero())))), 1e-9);
    EXPECT_LT(relative_error(J_pose, (dual_derivative<3, 6>(by_pose, Vector6d(Vector6d::Zero())))), 1e-13);
  }
}

TEST(PlaneTest, ReanchoringOntoOrBeyondThePlaneIsRefused) {
  const Vector3d theta(0, 0, 0.5), untouched(7, 8, 9);
  Vector3d out = untouched;
  tp::SE3d T;
  T.t = Vector3d(0, 0, -2);  // the target stands on the wall z = 2
  EXPECT_EQ(tp::reanchor_plane(theta, T, &out), tp::Status::behind_camera);
  T.t = Vector3d(0, 0, -3);
  EXPECT_EQ(tp::reanchor_plane(theta, T, &out), tp::Status::behind_camera);
  T.t = Vector3d(0, kNan, 0);
  EXPECT_EQ(tp::reanchor_plane(theta, T, &out), tp::Status::non_finite);
  EXPECT_EQ(out, untouched);
  Eigen::Matrix3d J_theta = Eigen::Matrix3d::Ones();
  Eigen::Matrix<double, 3, 6> J_pose = Eigen::Matrix<double, 3, 6>::Ones();
  EXPECT_EQ(tp::reanchor_plane(theta, T, &J_theta, &J_pose), Vector3d::Zero());
  EXPECT_TRUE(J_theta.isZero());
  EXPECT_TRUE(J_pose.isZero());
}

}  // namespace plane_test
