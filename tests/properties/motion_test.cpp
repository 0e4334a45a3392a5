// Laws of rotations and rigid motions, at drawn states.
#include <algorithm>
#include <cmath>

#include "properties/properties.hpp"
#include "support/calculus.hpp"
#include "support/dense.hpp"
#include "textplane/geometry/homography.hpp"

namespace textplane_test {
namespace motion_properties {

constexpr double kPi = 3.14159265358979323846;
using Matrix4 = Eigen::Matrix<double, 4, 4>;

Matrix4 matrix(const tp::SE3d& T) {
  Matrix4 m = Matrix4::Identity();
  m.topLeftCorner<3, 3>() = T.R;
  m.topRightCorner<3, 1>() = T.t;
  return m;
}

Matrix4 twist_matrix(const tp::Vector6<double>& xi) {
  Matrix4 m = Matrix4::Zero();
  m.topLeftCorner<3, 3>() = tp::hat<double>(xi.tail<3>());
  m.topRightCorner<3, 1>() = xi.head<3>();
  return m;
}
RC_GTEST_PROP(Rotations, ExpIsOrthonormalAndItsInverseIsThatOfMinusW, ()) {
  const tp::Vector3<double> w = rotation_vector(10);
  const tp::Matrix3<double> R = tp::so3_exp(w);
  RC_ASSERT(largest(R * R.transpose() - tp::Matrix3<double>::Identity()) < 1e-14);
  RC_ASSERT(std::abs(R.col(0).cross(R.col(1)).dot(R.col(2)) - 1) < 1e-14);
  RC_ASSERT(largest(tp::so3_exp<double>(-w) - R.transpose()) < 1e-14);
  RC_ASSERT((R * w - w).norm() <= 1e-14 * (1 + w.norm()));
}

RC_GTEST_PROP(Rotations, LogIsTheInverseOfExp, ()) {
  const tp::Vector3<double> w = rotation_vector(kPi - 1e-6);
  RC_ASSERT((tp::so3_log(tp::so3_exp(w)) - w).norm() < 1e-14 + 1e-13 * w.norm());
}

RC_GTEST_PROP(Rotations, ExpOfLogIsTheRotationForAnyAngle, ()) {
  const tp::Matrix3<double> R = tp::so3_exp(rotation_vector(10));
  const tp::Vector3<double> w = tp::so3_log(R);
  RC_ASSERT(w.norm() <= kPi + 1e-14);
  RC_ASSERT(largest(tp::so3_exp(w) - R) < 1e-13);
}

RC_GTEST_PROP(Rotations, HatIsTheCrossProduct, ()) {
  const tp::Vector3<double> a = vector<3>(5), b = vector<3>(5);
  RC_ASSERT(largest(tp::hat(a) * b - a.cross(b)) < 1e-13);
  const tp::Matrix3<double> R = tp::so3_exp(rotation_vector(3));
  RC_ASSERT(largest(R * tp::hat(a) * R.transpose() - tp::hat<double>(R * a)) < 1e-13);
}

RC_GTEST_PROP(Motions, FormAGroup, ()) {
  const tp::SE3d a = pose(5, 3), b = pose(5, 3), c = pose(5, 3);
  RC_ASSERT(largest(matrix((a * b) * c) - matrix(a * (b * c))) < 1e-13);
  RC_ASSERT(largest(matrix(a * b) - matrix(a) * matrix(b)) < 1e-13);
  RC_ASSERT(largest(matrix(a * a.inverse()) - Matrix4::Identity()) < 1e-13);
  RC_ASSERT(largest(matrix((a * b).inverse()) - matrix(b.inverse() * a.inverse())) < 1e-13);
  const tp::Vector3<double> p = vector<3>(5);
  RC_ASSERT(((a * b) * p - a * (b * p)).norm() < 1e-13);
}

// The power series of the 4 x 4 matrix, by squaring: (exp(X / 2^k))^(2^k).
RC_GTEST_PROP(Motions, ExpIsTheMatrixExponential, ()) {
  tp::Vector6<double> xi;
  xi << vector<3>(4), rotation_vector(4);
  const Matrix4 X = twist_matrix(xi) / 64;
  Matrix4 sum = Matrix4::Identity(), power = Matrix4::Identity();
  for (int k = 1; k < 16; ++k) {
    power = power * X / k;
    sum += power;
  }
  for (int k = 0; k < 6; ++k) sum = Matrix4(sum * sum);
  RC_ASSERT(largest(matrix(tp::se3_exp(xi)) - sum) < 1e-12);
}

RC_GTEST_PROP(Motions, LogIsTheInverseOfExp, ()) {
  tp::Vector6<double> xi;
  xi << vector<3>(4), rotation_vector(kPi - 1e-3);
  RC_ASSERT((tp::se3_log(tp::se3_exp(xi)) - xi).norm() < 1e-10);
  const tp::SE3d T = pose(4, kPi - 1e-3);
  RC_ASSERT(largest(matrix(tp::se3_exp(tp::se3_log(T))) - matrix(T)) < 1e-11);
}

RC_GTEST_PROP(Motions, AdjointMovesAPerturbationToTheOtherSide, ()) {
  const tp::SE3d T = pose(3, 3), U = pose(3, 3);
  tp::Vector6<double> xi;
  xi << vector<3>(2), rotation_vector(2);
  const tp::Vector6<double> moved = tp::adjoint(T) * xi;
  RC_ASSERT(largest(matrix(T * tp::se3_exp(xi)) - matrix(tp::se3_exp(moved) * T)) < 1e-12);
  RC_ASSERT(largest(tp::adjoint<double>(T * U) - tp::adjoint(T) * tp::adjoint(U)) < 1e-12);
  RC_ASSERT(largest(matrix(T) * twist_matrix(xi) * matrix(T.inverse()) - twist_matrix(moved)) < 1e-12);
}

RC_GTEST_PROP(Motions, RelativePosesMoveAsTheirJacobiansSay, ()) {
  const tp::SE3d T_w_h = pose(3, 2), T_w_t = pose(3, 2);
  tp::Vector6<double> xi;
  xi << vector<3>(1), rotation_vector(1);
  const tp::SE3d before = T_w_t.inverse() * T_w_h, step = tp::se3_exp(xi);
  for (const auto side : {tp::PerturbationSide::left, tp::PerturbationSide::right}) {
    const bool left = side == tp::PerturbationSide::left;
    const auto J = tp::relative_pose_jacobians(T_w_h, T_w_t, side);
    const tp::SE3d host = left ? step * T_w_h : T_w_h * step, target = left ? step * T_w_t : T_w_t * step;
    RC_ASSERT(largest(matrix(T_w_t.inverse() * host) - matrix(tp::se3_exp<double>(J.host * xi) * before)) < 1e-11);
    RC_ASSERT(largest(matrix(target.inverse() * T_w_h) - matrix(tp::se3_exp<double>(J.target * xi) * before)) < 1e-11);
  }
}
}  // namespace motion_properties
}  // namespace textplane_test
