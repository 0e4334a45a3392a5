// align_pose(): one sign at every size, and what it says where the target does not show it.
#include <gtest/gtest.h>

#include <cmath>

#include "features/synthetic.hpp"
#include "textplane/features/select.hpp"
#include "textplane/geometry/quad_projection.hpp"
#include "textplane/solver/pose.hpp"

namespace align_pose_test {
namespace tp = textplane;
using namespace textplane_test;

constexpr int kWidth = 480, kHeight = 320, kSmallWidth = 200, kSmallHeight = 150;
const tp::Pinhole<double> kHost(400, 400, 239.5, 159.5), kTarget(400, 400, 99.5, 74.5);

// The trace of a covariance is that of the axes it was made of, however they are turned.
TEST(PositionSigma, IsThatOfTheAxesOfTheCovariance) {
  Random random(12);
  for (int trial = 0; trial < 5; ++trial) {
    const tp::Matrix3<double> R = tp::so3_exp<double>(random.vector<3>(1.5));
    const double a = random.uniform(0.1, 2), b = random.uniform(0.1, 2), c = random.uniform(0.1, 2);
    tp::FixedMatrix<double, 6, 6> information = tp::FixedMatrix<double, 6, 6>::Identity();
    information.topLeftCorner<3, 3>() = R * tp::Vector3<double>(1 / a, 1 / b, 1 / c).asDiagonal() * R.transpose();
    EXPECT_NEAR(tp::position_sigma(information), std::sqrt(a + b + c), 1e-12);
  }
}

tp::Matrix3<double> calibration(const tp::Pinhole<double>& c) {
  tp::Matrix3<double> K;
  K << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1;
  return K;
}

struct Sign {
  TexturedPlane plane;
  tp::Vector3<double> theta{0.06, -0.04, 0.5};  // two units away, a little turned
  tp::Quad<double> quad;
  tp::TextPatch patch;

  explicit Sign(unsigned seed) : plane(seed) {
    quad.corner = {Vector2d(60, 60), Vector2d(420, 60), Vector2d(420, 260), Vector2d(60, 260)};
    const Image<std::uint8_t> host = plane.render(Matrix3d::Identity(), kWidth, kHeight, {}, 1);
    tp::SelectOptions options;
    options.levels = 4;
    patch = tp::make_patch(host.view(), kHost, quad, options);
  }
  // The target, drawn at eight times its size and halved: no sign is too small to be drawn right.
  Image<std::uint8_t> seen(const tp::SE3d& T_t_h) const {
    tp::Matrix3<double> enlarge = tp::Matrix3<double>::Identity();
    enlarge(0, 0) = enlarge(1, 1) = 1.0 / 8;
    enlarge(0, 2) = enlarge(1, 2) = 0.5 / 8 - 0.5;
    const tp::Matrix3<double> H =
        calibration(kTarget) * tp::plane_homography(theta, T_t_h) * calibration(kHost).inverse();
    const Image<std::uint8_t> large = plane.render(H.inverse() * enlarge, 8 * kSmallWidth, 8 * kSmallHeight, {}, 1);
    const tp::Pyramid pyramid(large.view(), 4);
    Image<std::uint8_t> out(kSmallWidth, kSmallHeight);
    for (int y = 0; y < kSmallHeight; ++y)
      for (int x = 0; x < kSmallWidth; ++x) out(x, y) = pyramid.level(3)(x, y);
    return out;
  }
  double corner_error(const tp::SE3d& a, const tp::SE3d& b) const {
    tp::Quad<double> in_a, in_b;
    if (!tp::is_ok(tp::project_quad<double>(quad, kHost, theta, a, kTarget, &in_a)) ||
        !tp::is_ok(tp::project_quad<double>(quad, kHost, theta, b, kTarget, &in_b)))
      return 1e9;
    double worst = 0;
    for (std::size_t i = 0; i < 4; ++i) worst = std::max(worst, (in_a.corner[i] - in_b.corner[i]).norm());
    return worst;
  }
};

// The sign at `size` of its size in the host.
tp::SE3d pose_at(double size) {
  tp::SE3d T = tp::se3_exp<double>((tp::Vector6<double>() << 0, 0, 0, 0.02, -0.03, 0.05).finished());
  T.t = tp::Vector3<double>(0.02, -0.01, 2 / size - 2);
  return T;
}

TEST(AlignPose, ChoosesTheLevelsForTheSignsSize) {
  const Sign sign(3);
  ASSERT_EQ(sign.patch.status, tp::Status::ok);
  const std::pair<double, int> sizes[] = {{0.1, -3}, {0.125, -3}, {0.25, -2}, {0.4, -1}, {0.5, -1}};
  for (const auto& [size, shift] : sizes) {
    const tp::SE3d truth = pose_at(size);
    const tp::Pyramid target(sign.seen(truth).view());
    Random random(7);
    for (int start = 0; start < 6; ++start) {
      SCOPED_TRACE(testing::Message() << "size " << size << ", start " << start);
      // About a pixel and a half off.
      const double angle = start * 1.0472;
      const tp::Vector6<double> xi =
          (tp::Vector6<double>() << 0, 0, 0, 0.0035 * std::sin(angle), 0.0035 * std::cos(angle), 0.01).finished();
      const tp::SE3d guess = tp::se3_exp<double>(xi) * truth;
      const auto fit = tp::align_pose(sign.patch, sign.theta, guess, target, kTarget);
      EXPECT_TRUE(tp::is_ok(fit.status)) << tp::to_string(fit.status);
      EXPECT_EQ(fit.scale_shift, shift);
      // Between two levels, host and target are blurred by a fifth differently.
      EXPECT_LT(sign.corner_error(fit.T_t_h, truth), size == 0.1 || size == 0.4 ? 0.35 : 0.1);
      EXPECT_GT(fit.zncc, 0.9);
    }
  }
}

// Larger in the target: its coarser levels are compared, as far as it has them.
TEST(AlignPose, TheShiftStaysWithinTheLevels) {
  const Sign sign(3);
  const tp::SE3d near = pose_at(4);
  const Image<std::uint8_t> image = sign.seen(near);
  for (int levels = 1; levels <= 4; ++levels) {
    const tp::Pyramid target(image.view(), levels);
    for (int finest = 0; finest < 3; ++finest) {
      tp::PoseOptions options;
      options.finest_level = finest;
      const int room = std::max(levels - 1 - finest, 0);
      EXPECT_EQ(tp::align_pose(sign.patch, sign.theta, near, target, kTarget, options).scale_shift, std::min(2, room));
      EXPECT_EQ(tp::align_pose(sign.patch, sign.theta, pose_at(0.05), target, kTarget, options).scale_shift,
                finest - 3);
    }
  }
  tp::SE3d behind;
  behind.t[2] = -100;
  const auto lost = tp::align_pose(sign.patch, sign.theta, behind, tp::Pyramid(image.view()), kTarget);
  EXPECT_EQ(lost.scale_shift, 0);
  EXPECT_FALSE(tp::is_ok(lost.status));
}

// A minimum that is not the sign: the numbers are there, the status does not say that it converged.
TEST(AlignPose, AnotherSignIsNoMatch) {
  const Sign sign(3), other(4);
  int diverged = 0;
  for (const double size : {0.3, 0.5}) {
    const tp::SE3d truth = pose_at(size);
    const tp::Pyramid target(other.seen(truth).view());
    tp::PoseOptions options;
    const auto fit = tp::align_pose(sign.patch, sign.theta, truth, target, kTarget, options);
    EXPECT_FALSE(tp::is_ok(fit.status)) << fit.zncc;
    EXPECT_LT(fit.zncc, 0.5);
    options.min_zncc = -1;
    const auto all = tp::align_pose(sign.patch, sign.theta, truth, target, kTarget, options);
    EXPECT_EQ(all.T_t_h.R, fit.T_t_h.R);
    EXPECT_EQ(all.zncc, fit.zncc);
    if (tp::is_ok(all.status)) {
      ++diverged;
      EXPECT_EQ(fit.status, tp::Status::diverged);
    }
    options.min_zncc = std::nan("");
    EXPECT_EQ(tp::align_pose(sign.patch, sign.theta, truth, target, kTarget, options).status,
              tp::Status::invalid_argument);
  }
  EXPECT_GT(diverged, 0);
}

}  // namespace align_pose_test
