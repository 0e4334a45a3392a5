// Se3: the foreign tracker's own pose type, like Sophus's (Scalar, rotationMatrix(), translation(), data()).
#ifndef FOREIGN_TRACKER_SE3_HPP
#define FOREIGN_TRACKER_SE3_HPP

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace foreign {

class Se3 {
 public:
  using Scalar = double;

  Se3() = default;
  Se3(const Eigen::Quaterniond& q, const Eigen::Vector3d& t) { block_ << q.normalized().coeffs(), t; }
  Se3(const Eigen::Matrix3d& R, const Eigen::Vector3d& t) : Se3(Eigen::Quaterniond(R), t) {}

  Eigen::Quaterniond rotation() const { return Eigen::Quaterniond(block_.data()).normalized(); }
  Eigen::Matrix3d rotationMatrix() const { return rotation().toRotationMatrix(); }
  Eigen::Vector3d translation() const { return block_.tail<3>(); }
  Se3 inverse() const { return {rotation().conjugate(), -(rotation().conjugate() * translation())}; }
  Se3 operator*(const Se3& b) const {
    return {rotation() * b.rotation(), rotation() * b.translation() + translation()};
  }
  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return rotation() * p + translation(); }

  /// Quaternion x y z w, then translation.
  double* data() { return block_.data(); }

 private:
  Eigen::Matrix<double, 7, 1> block_ = (Eigen::Matrix<double, 7, 1>() << 0, 0, 0, 1, 0, 0, 0).finished();
};

}  // namespace foreign

#endif  // FOREIGN_TRACKER_SE3_HPP
