// Where a text lies and how it looks behind a rolling shutter.
#include <gtest/gtest.h>

#include <array>

#include "textplane/landmarks/text_view.hpp"

namespace {

namespace tp = textplane;

const tp::Pinhole<double> kPinhole(525, 525, 319.5, 239.5);
const tp::RollingShutter kShutter{0.03, 239.5, 480};

tp::RowMotion motion(double sign) {
  tp::RowMotion rows;
  rows.velocity << 0.4 * sign, -0.2, 0.3, 0.5, -0.4 * sign, 0.3;
  rows.shutter = kShutter;
  return rows;
}

// A text whose patch has a quad and rows, and no pixels.
tp::TextObject text(const tp::RowMotion* rows) {
  tp::TextPatch patch;
  patch.camera = kPinhole;
  patch.quad.corner = {tp::Vector2<double>(250, 90), {350, 95}, {349, 125}, {249, 120}};
  if (rows) patch.rows = tp::patch_rows(*rows, kPinhole, kPinhole.unproject(centroid(patch.quad)));
  return tp::outline_of(patch, tp::Vector3<double>(0.1, -0.05, 0.5));
}

TEST(TextRows, CornersAreThoseOfTheHostsRows) {
  const tp::RowMotion rows = motion(1);
  const tp::TextObject rolling = text(&rows), still = text(nullptr);
  std::array<tp::Vector3<double>, 4> corners, at_once;
  ASSERT_EQ(tp::text_corners(rolling, &corners), tp::Status::ok);
  ASSERT_EQ(tp::text_corners(still, &at_once), tp::Status::ok);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(rolling.theta.dot(corners[k]), 1, 1e-9) << "on the plane";
    const tp::RowProjection seen = tp::project_rows(rows, tp::CameraView(kPinhole), corners[k]);
    ASSERT_EQ(seen.status, tp::Status::ok);
    EXPECT_LT((seen.px - rolling.patch.quad.corner[k]).norm(), 0.05);
    EXPECT_TRUE(at_once[k] == tp::plane_point(still.theta, kPinhole.unproject(still.patch.quad.corner[k])));
    EXPECT_GT((at_once[k] - corners[k]).norm(), 1e-3);
  }
}

TEST(TextRows, QuadsAreWhereTheRowsShowThem) {
  const tp::RowMotion host = motion(1), target = motion(-1);
  const tp::TextObject rolling = text(&host);
  tp::SE3d T_t_h = tp::se3_exp<double>(0.05 * tp::Vector6<double>::Ones());
  const tp::CameraView camera(kPinhole, nullptr, &target);
  std::array<tp::Vector3<double>, 4> corners;
  tp::Quad<double> quad;
  ASSERT_EQ(tp::text_corners(rolling, &corners), tp::Status::ok);
  ASSERT_TRUE(tp::project_text(rolling, T_t_h, camera, &quad));
  for (std::size_t k = 0; k < 4; ++k) {
    const tp::RowProjection seen = tp::project_rows(target, camera, T_t_h * corners[k]);
    EXPECT_LT((seen.px - quad.corner[k]).norm(), 1e-6);
  }
  T_t_h.t[2] = -5;
  EXPECT_FALSE(tp::project_text(rolling, T_t_h, camera, &quad)) << "behind the camera";
}

}  // namespace
