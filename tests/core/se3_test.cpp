#include "textplane/core/se3.hpp"

#include <gtest/gtest.h>

#include <array>
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
using Vector6d = Eigen::Matrix<double, 6, 1>;

template struct textplane::SE3<float>;
template struct textplane::SE3<double>;
template struct textplane::SE3<Dual<6>>;

namespace se3_test {

constexpr double kPi = 3.14159265358979323846;

// Every branch of exp and log with its neighbourhood: zero, the ends of the series, a zero trace, and close to pi.
const std::array<double, 19> kAngles = {0,      1e-300, 1e-15,      1e-9,       1e-5,      1e-3, 0.0199,
                                        0.0201, 0.0999, 0.1001,     0.4999,     0.5001,    1,    2.094,
                                        2.095,  3,      kPi - 1e-3, kPi - 1e-6, kPi - 1e-8};

template <class S>
class Se3 : public testing::Test {};
using Scalars = testing::Types<float, double, Dual<6>>;
TYPED_TEST_SUITE(Se3, Scalars, );

// The exponential of the 4 x 4 twist by scaling, a Taylor series and squaring: nothing in common with Rodrigues.
Eigen::Matrix4d series_exp(const Vector6d& xi) {
  Eigen::Matrix4d X = Eigen::Matrix4d::Zero();
  const Eigen::Vector3d w = xi.tail<3>();
  X.topLeftCorner<3, 3>() = tp::hat(w);
  X.topRightCorner<3, 1>() = xi.head<3>();
  X /= 1024;
  Eigen::Matrix4d sum = Eigen::Matrix4d::Identity(), term = sum;
  for (int k = 1; k < 20; ++k) {
    term = term * X / k;
    sum += term;
  }
  for (int k = 0; k < 10; ++k) sum = sum * sum;
  return sum;
}

Vector6d twist(Random& random, double angle) {
  Eigen::Vector3d axis = random.vector<3>(1);
  axis.normalize();
  Vector6d xi;
  xi << random.vector<3>(2), angle * axis;
  return xi;
}

TYPED_TEST(Se3, ExpIsTheMatrixExponential) {
  using S = TypeParam;
  Random random(1);
  for (const double angle : kAngles)
    for (int repeat = 0; repeat < 5; ++repeat) {
      const Vector6d xi = twist(random, angle);
      const tp::SE3<S> T = tp::se3_exp<S>(xi.cast<S>());
      const Eigen::Matrix4d M = series_exp(xi);
      EXPECT_LT((values(T.R) - M.topLeftCorner<3, 3>()).cwiseAbs().maxCoeff(), tolerance<S>(2e-6, 1e-12)) << angle;
      EXPECT_LT((values(T.t) - M.topRightCorner<3, 1>()).cwiseAbs().maxCoeff(), tolerance<S>(5e-6, 1e-12)) << angle;
      EXPECT_LT((values(tp::so3_exp<S>(xi.tail<3>().cast<S>())) - values(T.R)).norm(), tolerance<S>(1e-6, 1e-15));
    }
}

TYPED_TEST(Se3, LogInvertsExp) {
  using S = TypeParam;
  Random random(2);
  for (const double angle : kAngles)
    for (int repeat = 0; repeat < 20; ++repeat) {
      if (std::is_same<S, float>::value && angle > kPi - 1e-4) continue;  // beyond pi after rounding: tested below
      const Vector6d xi = twist(random, angle);
      const auto back = values(tp::se3_log(tp::se3_exp<S>(xi.cast<S>())));
      EXPECT_LT((back - xi).cwiseAbs().maxCoeff(), tolerance<S>(2e-5, 1e-13)) << angle;
    }
}

TYPED_TEST(Se3, ExpInvertsLogUpToPi) {
  using S = TypeParam;
  Random random(3);
  for (int repeat = 0; repeat < 200; ++repeat) {
    // pi itself, about each axis, about the diagonals, and about any axis.
    Eigen::Vector3d axis = random.vector<3>(1);
    if (repeat < 3) axis = Eigen::Vector3d::Unit(repeat);
    if (repeat == 3) axis = Eigen::Vector3d(1, 1, 0);
    if (repeat == 4) axis = Eigen::Vector3d(0, -1, 1);
    axis.normalize();
    Vector6d xi;
    xi << random.vector<3>(2), kPi * axis;
    const tp::SE3<S> T = tp::se3_exp<S>(xi.cast<S>());
    const auto log = tp::se3_log(T);
    EXPECT_LE(values(log).template tail<3>().norm(), kPi + tolerance<S>(1e-6, 1e-14));
    const tp::SE3<S> back = tp::se3_exp<S>(log);
    EXPECT_LT((values(back.R) - values(T.R)).cwiseAbs().maxCoeff(), tolerance<S>(3e-6, 1e-14));
    EXPECT_LT((values(back.t) - values(T.t)).cwiseAbs().maxCoeff(), tolerance<S>(1e-5, 1e-13));
  }
}

TYPED_TEST(Se3, GroupLaws) {
  using S = TypeParam;
  Random random(4);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const tp::SE3<S> a = random.pose(2, 2).cast<S>(), b = random.pose(2, 2).cast<S>();
    const tp::Vector3<S> p = random.vector<3>(3).template cast<S>();
    EXPECT_LT(values(tp::Vector3<S>((a * b) * p - a * (b * p))).norm(), tolerance<S>(1e-5, 1e-14));
    EXPECT_LT(values(tp::Vector3<S>(a.inverse() * (a * p) - p)).norm(), tolerance<S>(1e-5, 1e-14));
    EXPECT_LT(values(tp::Vector3<S>(tp::hat(p) * a.t - p.cross(a.t))).norm(), tolerance<S>(1e-6, 1e-15));
  }
}

TYPED_TEST(Se3, AdjointMovesATwistAcross) {
  using S = TypeParam;
  Random random(5);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const tp::SE3<S> T = random.pose(2, 2).cast<S>();
    const tp::Vector6<S> xi = random.vector<6>(0.5).template cast<S>();
    const tp::SE3<S> right = T * tp::se3_exp(xi);
    const tp::SE3<S> left = tp::se3_exp<S>(tp::adjoint(T) * xi) * T;
    EXPECT_LT(relative_error(values(left.R), values(right.R)), tolerance<S>(5e-6, 1e-14));
    EXPECT_LT(relative_error(values(left.t), values(right.t)), tolerance<S>(5e-6, 1e-14));
  }
}

TYPED_TEST(Se3, AdjointIsAHomomorphism) {
  using S = TypeParam;
  Random random(6);
  const tp::SE3<S> a = random.pose(2, 2).cast<S>(), b = random.pose(2, 2).cast<S>();
  const Eigen::Matrix<S, 6, 6> product = tp::adjoint(a) * tp::adjoint(b);
  EXPECT_LT(relative_error(values(tp::adjoint(a * b)), values(product)), tolerance<S>(5e-6, 1e-14));
}

// d (Exp(xi) T p) / d xi at xi = 0 is [I, -[T p]x]: the convention that every Jacobian of the library rests on.
TEST(Se3Jacobian, LeftPerturbationOfAPoint) {
  Random random(7);
  for (int repeat = 0; repeat < 10; ++repeat) {
    const tp::SE3d T = random.pose(2, 2);
    const Eigen::Vector3d p = random.vector<3>(3);
    Eigen::Matrix<double, 3, 6> J;
    J << Eigen::Matrix3d::Identity(), -tp::hat<double>(T * p);
    const Vector6d zero = Vector6d::Zero();
    const auto f = [&](const auto& xi) {
      using S = typename std::decay_t<decltype(xi)>::Scalar;
      return tp::Vector3<S>(tp::se3_exp<S>(xi) * (T.cast<S>() * tp::Vector3<S>(p.cast<S>())));
    };
    EXPECT_LT(relative_error(J, (central_difference<3, 6>(f, zero))), 1e-10);
    EXPECT_LT(relative_error(J, (dual_derivative<3, 6>(f, zero))), 1e-14);
  }
}

// Ad by differences of log(T Exp(xi) T^-1) and by dual numbers.
TEST(Se3Jacobian, Adjoint) {
  Random random(8);
  const tp::SE3d T = random.pose(2, 2);
  const auto f = [&](const auto& xi) {
    using S = typename std::decay_t<decltype(xi)>::Scalar;
    return tp::Vector6<S>(tp::se3_log<S>(T.cast<S>() * tp::se3_exp<S>(xi) * T.inverse().cast<S>()));
  };
  EXPECT_LT(relative_error(tp::adjoint(T), (central_difference<6, 6>(f, Vector6d::Zero()))), 1e-9);
  EXPECT_LT(relative_error(tp::adjoint(T), (dual_derivative<6, 6>(f, Vector6d::Zero()))), 1e-13);
}

// Dual numbers pass through exp and log at, near and far from zero and near pi, as differences say.
TEST(Se3Jacobian, DualsThroughExpAndLog) {
  Random random(9);
  for (const double angle :
       {0.0, 1e-9, 1e-5, 1e-3, 0.0199, 0.0201, 0.0999, 0.1001, 0.4999, 0.5001, 1.0, 2.094, 3.0, 3.14}) {
    const Vector6d xi = twist(random, angle);
    const auto exp = [](const auto& x) {
      using S = typename std::decay_t<decltype(x)>::Scalar;
      const tp::SE3<S> T = tp::se3_exp<S>(x);
      Eigen::Matrix<S, 12, 1> flat;
      flat << T.R.col(0), T.R.col(1), T.R.col(2), T.t;
      return flat;
    };
    EXPECT_LT(relative_error((dual_derivative<12, 6>(exp, xi)), (central_difference<12, 6>(exp, xi))), 1e-9) << angle;
    const tp::SE3d T = tp::se3_exp<double>(xi);
    const auto log = [&](const auto& x) {
      using S = typename std::decay_t<decltype(x)>::Scalar;
      return tp::Vector6<S>(tp::se3_log<S>(tp::se3_exp<S>(x) * T.cast<S>()));
    };
    EXPECT_LT(relative_error((dual_derivative<6, 6>(log, Vector6d::Zero())),
                             (central_difference<6, 6>(log, Vector6d::Zero(), 1e-4))),
              1e-8)
        << angle;
    // Log after Exp is the identity, so its derivative is too.
    const auto identity = [&](const auto& x) {
      using S = typename std::decay_t<decltype(x)>::Scalar;
      return tp::Vector6<S>(tp::se3_log<S>(tp::se3_exp<S>(x)));
    };
    EXPECT_LT(relative_error((dual_derivative<6, 6>(identity, xi)), Eigen::Matrix<double, 6, 6>::Identity()), 1e-11)
        << angle;
  }
}

TEST(Se3Tools, RenormalisedIsOrthonormalAndNear) {
  Random random(10);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const tp::SE3d exact = random.pose(2, 3);
    tp::SE3d rough = exact;
    for (int i = 0; i < 9; ++i) rough.R(i / 3, i % 3) += random.uniform(-1e-5, 1e-5);
    const tp::SE3d clean = tp::renormalised(rough);
    EXPECT_LT((clean.R * clean.R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(clean.R.determinant(), 1, 1e-14);
    EXPECT_LT((clean.R - exact.R).norm(), 1e-4);
    EXPECT_EQ(clean.t, exact.t);
  }
}

struct SophusLike {
  Eigen::Matrix3d R;
  Eigen::Vector3d t;
  const Eigen::Matrix3d& rotationMatrix() const { return R; }
  const Eigen::Vector3d& translation() const { return t; }
};

TEST(Se3Tools, AnyPoseTypeConverts) {
  Random random(11);
  const tp::SE3d T = random.pose(2, 2);
  Eigen::Isometry3d isometry = Eigen::Isometry3d::Identity();
  isometry.linear() = T.R;
  isometry.translation() = T.t;
  const tp::SE3d from_isometry = tp::to_se3(isometry), from_concept = tp::to_se3(SophusLike{T.R, T.t});
  EXPECT_EQ(from_isometry.R, T.R);
  EXPECT_EQ(from_isometry.t, T.t);
  EXPECT_EQ(from_concept.R, T.R);
  EXPECT_EQ(from_concept.t, T.t);
  EXPECT_EQ(&tp::to_se3(T), &T);
}

TEST(Se3Tools, AllFinite) {
  tp::SE3d T;
  EXPECT_TRUE(tp::all_finite(T));
  T.t[1] = std::nan("");
  EXPECT_FALSE(tp::all_finite(T));
  T.t[1] = 0;
  T.R(2, 0) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(tp::all_finite(T));
}

}  // namespace se3_test
