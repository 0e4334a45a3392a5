#include "textplane/geometry/row_warp.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/random.hpp"

namespace {

namespace tp = textplane;
using textplane_test::Random;

const tp::CameraView kCamera(525, 525, 319.5, 239.5);
const tp::RollingShutter kShutter{0.03, 239.5, 480};

// A sign of 100 x 30 px (half: 50 x 15) about a place of the host's image, seen by a target about as large.
struct Sign {
  tp::RowMotion host, target;
  tp::Vector3<double> theta;
  tp::SE3d T_t_h;
  tp::Vector2<double> at;

  Sign(unsigned seed, double linear, double angular) {
    Random random(seed);
    host = {random.twist(linear, angular), kShutter};
    target = {random.twist(linear, angular), kShutter};
    const tp::Vector3<double> normal(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), -1);
    theta = -normal.normalized() / random.uniform(1.5, 4);
    T_t_h = tp::se3_exp<double>(random.twist(0.3, 0.1));
    at = {random.uniform(150, 490), random.uniform(100, 380)};
  }
  tp::Vector3<double> centre() const { return kCamera.pinhole.unproject(at); }

  // Where the target shows the host's pixel, by the pose of each row.
  bool exact(const tp::Vector2<double>& px, tp::Vector2<double>* out) const {
    const tp::SE3d T_row_stamp = host.at(px[1]);
    const tp::Vector3<double> theta_row = tp::reanchor_plane<double>(theta, T_row_stamp);
    const tp::Vector3<double> m = kCamera.pinhole.unproject(px);
    const tp::Vector3<double> p = T_row_stamp.inverse() * tp::Vector3<double>(m / theta_row.dot(m));
    const tp::RowProjection seen = tp::project_rows(target, kCamera, T_t_h * p);
    *out = seen.px;
    return tp::is_ok(seen.status);
  }
  tp::RowWarp warp() const {
    return tp::row_warp(theta, T_t_h, centre(), tp::patch_rows(host, kCamera, centre()), target, kCamera);
  }
};

tp::Vector2<double> pixel(const tp::RowWarp& warp, const tp::Vector3<double>& m) {
  const tp::Vector3<double> q = warp.T_t_h.R * m + warp.T_t_h.t * warp.theta.dot(m);
  return kCamera.pinhole.project(q);
}

// The largest error over the sign's border.
double error_of(const Sign& sign, const tp::RowWarp& warp) {
  double largest = 0;
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j) {
      const tp::Vector2<double> px = sign.at + tp::Vector2<double>(12.5 * i, 3.75 * j);
      tp::Vector2<double> exact;
      if (!sign.exact(px, &exact)) return -1;
      largest = std::max(largest, (pixel(warp, kCamera.pinhole.unproject(px)) - exact).norm());
    }
  return largest;
}

TEST(RowWarp, IsRightToAFewHundredthsOfAPixel) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Sign sign(seed, 0.5, 0.5);
    EXPECT_LT(error_of(sign, sign.warp()), 0.08) << seed;
  }
}

TEST(RowWarp, IsExactInTheMiddle) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const Sign sign(seed, 1.0, 1.0);
    tp::Vector2<double> exact;
    ASSERT_TRUE(sign.exact(sign.at, &exact));
    EXPECT_LT((pixel(sign.warp(), sign.centre()) - exact).norm(), 1e-6) << seed;
  }
}

TEST(RowWarp, PosesOfTheCentreAloneLeaveMore) {
  double with = 0, without = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Sign sign(seed, 0.5, 0.5);
    with += error_of(sign, sign.warp()) / 200;
    const tp::Vector3<double> centre = sign.centre();
    tp::PatchRows rows = tp::patch_rows(sign.host, kCamera, centre);
    rows.time = {0, 0, rows.time.dot(centre)};
    tp::RowWarp warp = tp::row_warp(sign.theta, sign.T_t_h, centre, rows, {}, kCamera);
    const tp::RowProjection seen =
        tp::project_rows(sign.target, kCamera, warp.T_t_h * tp::Vector3<double>(centre / warp.theta.dot(centre)));
    warp.T_t_h = sign.target.at(seen.px[1]) * warp.T_t_h;
    without += error_of(sign, warp) / 200;
  }
  EXPECT_LT(with, 0.025);
  EXPECT_GT(without, 0.3);
}

TEST(RowWarp, RaysOfTheHostLeadToTheirPlaces) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const Sign sign(seed, 0.5, 0.5);
    const tp::PatchRows rows = tp::patch_rows(sign.host, kCamera, sign.centre());
    const tp::Matrix3<double> C = tp::host_row_warp(rows, sign.theta, sign.centre());
    for (const double dy : {-15.0, 0.0, 15.0}) {
      const tp::Vector2<double> px = sign.at + tp::Vector2<double>(40, dy);
      const tp::SE3d T_row_stamp = sign.host.at(px[1]);
      const tp::Vector3<double> m = kCamera.pinhole.unproject(px);
      const tp::Vector3<double> p =
          T_row_stamp.inverse() * tp::Vector3<double>(m / tp::reanchor_plane<double>(sign.theta, T_row_stamp).dot(m));
      EXPECT_NEAR(sign.theta.dot(p), 1, 1e-12);
      const tp::Vector3<double> ray = C * m, found = ray / sign.theta.dot(ray);
      EXPECT_LT((kCamera.project(found) - kCamera.project(p)).norm(), 0.05) << seed;
    }
  }
  EXPECT_TRUE(tp::host_row_warp({}, {0, 0, 1}, {0, 0, 1}).isIdentity(0));
}

// A plane through the centre's ray shows nothing there: the target's motion counts as none.
TEST(RowWarp, APlaneThroughTheCentreHasNoRowInTheTarget) {
  const Sign sign(1, 0.5, 0.5);
  const tp::RowWarp warp = tp::row_warp({1, 0, 0}, sign.T_t_h, {0, 0, 1}, tp::PatchRows(), sign.target, kCamera);
  EXPECT_EQ(warp.T_t_h.R, sign.T_t_h.R);
  EXPECT_EQ(warp.T_t_h.t, sign.T_t_h.t);
}

TEST(RowWarp, IsTheHomographyWhereRowsAreTakenAtOnce) {
  const Sign sign(3, 1, 1);
  const tp::RowWarp warp = tp::row_warp(sign.theta, sign.T_t_h, sign.centre(), {}, {}, kCamera);
  EXPECT_TRUE(warp.T_t_h.R.isApprox(sign.T_t_h.R, 1e-15));
  EXPECT_TRUE(warp.T_t_h.t == sign.T_t_h.t);
  EXPECT_TRUE(warp.theta == sign.theta);
}

}  // namespace
