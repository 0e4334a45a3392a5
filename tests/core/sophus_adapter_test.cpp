// adapters/sophus.hpp on types that look like Sophus's from outside.
#include "textplane/adapters/sophus.hpp"

#include <gtest/gtest.h>

#include "textplane/geometry/homography.hpp"

namespace sophus_adapter_test {

namespace tp = textplane;
namespace ad = textplane::adapters;

struct Rotation {
  Eigen::Quaterniond q;
  Eigen::Matrix3d matrix() const { return q.toRotationMatrix(); }
};

// What code for Sophus::SE3d may ask of it; stored as a unit quaternion, like the original.
class Pose {
 public:
  using Scalar = double;
  Pose(const Eigen::Quaterniond& q, const Eigen::Vector3d& t) : rotation_{q}, t_(t) {
    EXPECT_NEAR(q.norm(), 1, 1e-15);  // The original aborts.
  }
  const Rotation& so3() const { return rotation_; }
  Eigen::Matrix3d rotationMatrix() const { return rotation_.matrix(); }
  const Eigen::Vector3d& translation() const { return t_; }
  Pose operator*(const Pose& b) const { return {(rotation_.q * b.rotation_.q).normalized(), rotation_.q * b.t_ + t_}; }
  static Pose exp(const Eigen::Matrix<double, 6, 1>& xi) {  // Translation first.
    const tp::SE3d T = tp::se3_exp<double>(xi);
    return {Eigen::Quaterniond(T.R).normalized(), T.t};
  }

 private:
  Rotation rotation_;
  Eigen::Vector3d t_;
};

// The same without rotationMatrix().
struct Plain {
  using Scalar = double;
  Pose inner;
  const Rotation& so3() const { return inner.so3(); }
  const Eigen::Vector3d& translation() const { return inner.translation(); }
};

struct SophusAdapter : testing::Test {
  tp::Vector6<double> xi, step;
  tp::SE3d T;
  SophusAdapter() {
    xi << 0.3, -0.2, 0.4, 0.5, -0.6, 0.7;
    step << 0.01, 0.02, -0.03, 0.04, -0.05, 0.06;
    T = tp::se3_exp(xi);
  }
  static double distance(const tp::SE3d& a, const tp::SE3d& b) { return (a.R - b.R).norm() + (a.t - b.t).norm(); }
};

TEST_F(SophusAdapter, ThereAndBack) {
  const Pose pose = ad::to_sophus<Pose>(T);
  EXPECT_LT(distance(ad::from_sophus(pose), T), 1e-15);
  EXPECT_LT(distance(ad::from_sophus(Plain{pose}), T), 1e-15);
  EXPECT_LT(distance(tp::to_se3(pose), T), 1e-15);
}

// A long product is no longer orthogonal: what comes out is.
TEST_F(SophusAdapter, DriftIsNormalisedAway) {
  tp::SE3d drifted = T;
  drifted.R *= 1 + 1e-6;
  const tp::SE3d out = ad::from_sophus(ad::to_sophus<Pose>(drifted));
  EXPECT_LT(distance(out, T), 2e-6);
  EXPECT_LT((out.R.transpose() * out.R - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

TEST_F(SophusAdapter, StepsOfEitherSide) {
  const Pose pose = ad::to_sophus<Pose>(T);
  EXPECT_LT(distance(ad::from_sophus(ad::apply_left(pose, step)), tp::se3_exp(step) * T), 1e-15);
  EXPECT_LT(distance(ad::from_sophus(ad::apply_right(pose, step)), T * tp::se3_exp(step)), 1e-15);
  const tp::Vector6<double> left = tp::adjoint(T) * step;
  EXPECT_LT(distance(ad::from_sophus(ad::apply_left(pose, left)), ad::from_sophus(ad::apply_right(pose, step))), 1e-14);
}

}  // namespace sophus_adapter_test
