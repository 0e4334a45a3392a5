#include "textplane/core/row_motion.hpp"

#include <gtest/gtest.h>

#include "support/random.hpp"
#include "textplane/core/cameras/camera_view.hpp"

namespace {

namespace tp = textplane;
using textplane_test::Random;

const tp::CameraView kCamera(525, 520, 319.5, 239.5);
const tp::RollingShutter kShutter{0.03, 239.5, 480};

tp::RowMotion motion(Random& random, double linear, double angular) {
  return {random.twist(linear, angular), kShutter};
}

tp::Vector3<double> point(Random& random) {
  const double z = random.uniform(1, 5);
  return {z * random.uniform(-0.5, 0.5), z * random.uniform(-0.4, 0.4), z};
}

TEST(RollingShutter, TimesRows) {
  EXPECT_DOUBLE_EQ(kShutter.time(0), -0.015);
  EXPECT_DOUBLE_EQ(kShutter.time(479), 0.015);
  EXPECT_DOUBLE_EQ(kShutter.time(239.5), 0);
  EXPECT_FALSE(tp::RollingShutter().active());
  EXPECT_EQ(tp::RollingShutter().time(100), 0);
  EXPECT_FALSE((tp::RollingShutter{0.03, 0, 1}.valid()));
}

TEST(RowMotion, VelocityLeadsFromPoseToPose) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const tp::SE3d a = tp::se3_exp<double>(random.twist(2, 1));
    const tp::Vector6<double> velocity = random.twist(1, 1);
    const tp::SE3d b = tp::se3_exp<double>(0.1 * velocity) * a;
    EXPECT_LT((tp::velocity_between(a, b, 0.1) - velocity).norm(), 1e-12);
    EXPECT_TRUE(tp::velocity_between(a, b, 0).isZero(0));
  }
}

TEST(RowMotion, VelocityJacobianMatchesCentralDifferences) {
  Random random(4);
  const tp::Vector6<double> velocity = random.twist(2, 2);
  const double time = 0.05, h = 1e-5;
  const auto J = tp::velocity_jacobian(velocity, time);
  const tp::SE3d at = tp::se3_exp<double>(time * velocity);
  for (int k = 0; k < 6; ++k) {
    const auto off = [&](double step) {
      const tp::Vector6<double> moved = time * (velocity + step * tp::Vector6<double>::Unit(k));
      return tp::se3_log<double>(tp::se3_exp<double>(moved) * at.inverse());
    };
    EXPECT_LT((J.col(k) - (off(h) - off(-h)) / (2 * h)).norm(), 3e-4 * time) << k;
  }
}

TEST(ProjectRows, MeetsThePoseOfItsOwnRow) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const tp::RowMotion rows = motion(random, 1.5, 1.5);
    const tp::Vector3<double> p = point(random);
    const tp::RowProjection seen = tp::project_rows(rows, kCamera, p);
    ASSERT_EQ(seen.status, tp::Status::ok);
    const tp::Vector3<double> at_row = rows.at(seen.px[1]) * p;
    EXPECT_LT((kCamera.project(at_row) - seen.px).norm(), 1e-7);
    EXPECT_LT((at_row - seen.p).norm(), 1e-9);
  }
}

TEST(ProjectRows, IsThePlainProjectionWithoutMotionOrReadout) {
  Random random(6);
  const tp::Vector3<double> p = point(random);
  tp::RowMotion still{tp::Vector6<double>::Zero(), kShutter}, at_once{random.twist(1, 1), {}};
  for (const tp::RowMotion& rows : {still, at_once}) {
    EXPECT_FALSE(rows.active());
    const tp::RowProjection seen = tp::project_rows(rows, kCamera, p);
    EXPECT_EQ(seen.status, tp::Status::ok);
    EXPECT_TRUE(seen.px == kCamera.project(p));
  }
}

TEST(ProjectRows, SaysWhatItCannotSee) {
  Random random(7);
  const tp::RowMotion rows = motion(random, 1, 1);
  EXPECT_EQ(tp::project_rows(rows, kCamera, tp::Vector3<double>(0, 0, -1)).status, tp::Status::behind_camera);
  EXPECT_EQ(tp::project_rows(rows, kCamera, tp::Vector3<double>(0, std::nan(""), 1)).status, tp::Status::non_finite);
  // The image falls as fast as the rows are taken: 479 rows in 30 ms are 30.7 rad/s.
  tp::RowMotion falling{tp::Vector6<double>::Zero(), kShutter};
  falling.velocity[3] = -479 / 0.03 / kCamera.pinhole.fy;
  EXPECT_EQ(tp::project_rows(falling, kCamera, tp::Vector3<double>(0, 0.01, 1)).status, tp::Status::diverged);
}

}  // namespace
