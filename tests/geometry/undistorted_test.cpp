// Quads of raw images as pinhole images have them, by any lens.
#include "textplane/geometry/undistorted.hpp"

#include <gtest/gtest.h>

#include <cstddef>

#include "geometry/quad_support.hpp"
#include "textplane/core/cameras/radial_tangential.hpp"

namespace tp = textplane;
using textplane_test::Dual;

#define TEXTPLANE_INSTANTIATE(S)                                                                                    \
  template tp::Status tp::undistorted<S>(const tp::Quad<S>&, const tp::RadialTangential<S>&, const tp::Pinhole<S>&, \
                                         tp::Quad<S>*);
TEXTPLANE_INSTANTIATE(float)
TEXTPLANE_INSTANTIATE(double)
TEXTPLANE_INSTANTIATE(Dual<2>)
#undef TEXTPLANE_INSTANTIATE

namespace quad_test {

const tp::RadialTangential<double> kLens{{458, 457, 367, 248}, -0.28, 0.07, 2e-4, 1.8e-5, 0};
const tp::Pinhole<double> kStraight(400, 410, 320, 240);

Quad raw_of(const Quad& straight) {
  Quad raw;
  for (std::size_t i = 0; i < 4; ++i) raw.corner[i] = kLens.project(kStraight.unproject(straight.corner[i]));
  return raw;
}

TYPED_TEST(Quads, UndistortedIsWhatTheLensDistorted) {
  using S = TypeParam;
  const Quad straight = make_quad({100, 60}, {560, 40}, {600, 430}, {80, 400});
  const Quad raw = raw_of(straight);
  EXPECT_GT((raw.corner[0] - straight.corner[0]).norm(), 5);
  tp::Quad<S> out;
  ASSERT_EQ(tp::undistorted(raw.cast<S>(), kLens.cast<S>(), kStraight.cast<S>(), &out), tp::Status::ok);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT((values(out.corner[i]) - straight.corner[i]).norm(), tolerance<S>(2e-3, 1e-9));
}

// A host's own lens: a function, that says by a bool or a Status whether there is a ray, and gives it any length.
TEST(Undistorted, TakesFunctions) {
  const Quad raw = raw_of(rectangle(100, 60, 560, 400));
  Quad by_lens, by_bool, by_status;
  ASSERT_EQ(tp::undistorted(raw, kLens, kStraight, &by_lens), tp::Status::ok);
  const auto says_bool = [](const Vector2d& px, Vector3d* ray) {
    if (!tp::is_ok(kLens.unproject(px, ray))) return false;
    *ray *= 0.25;
    return true;
  };
  ASSERT_EQ(tp::undistorted(raw, says_bool, kStraight, &by_bool), tp::Status::ok);
  const auto says_status = [](const Vector2d& px, Vector3d* ray) { return kLens.unproject(px, ray); };
  ASSERT_EQ(tp::undistorted(raw, says_status, kStraight, &by_status), tp::Status::ok);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(by_bool.corner[i], by_lens.corner[i]);
    EXPECT_EQ(by_status.corner[i], by_lens.corner[i]);
  }
}

TEST(Undistorted, FailuresLeaveTheQuad) {
  const Quad before = rectangle(1, 2, 3, 4), raw = rectangle(10, 20, 30, 40);
  const auto expect_status = [&](const Quad& quad, auto lens, const tp::Pinhole<double>& pinhole, tp::Status status) {
    Quad out = before;
    EXPECT_EQ(tp::undistorted(quad, lens, pinhole, &out), status);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(out.corner[i], before.corner[i]);
  };
  const auto ray = [](const Vector3d& where) {
    return [where](const Vector2d& px, Vector3d* out) {
      *out = px.y() > 30 ? where : Vector3d(px.x(), px.y(), 1);  // the last two corners fail
      return true;
    };
  };
  const auto blind = [](const Vector2d& /*px*/, Vector3d* /*ray*/) { return false; };
  expect_status(raw, blind, kStraight, tp::Status::degenerate);
  const auto own = [](const Vector2d& /*px*/, Vector3d* /*ray*/) { return tp::Status::out_of_view; };
  expect_status(raw, own, kStraight, tp::Status::out_of_view);
  expect_status(raw, ray({1, 1, 0}), kStraight, tp::Status::behind_camera);
  expect_status(raw, ray({1, 1, -1}), kStraight, tp::Status::behind_camera);
  expect_status(raw, ray({1, kNan, 1}), kStraight, tp::Status::non_finite);
  expect_status(raw, ray({1e300, 1, 1e-300}), kStraight, tp::Status::non_finite);
  expect_status(raw, kLens, tp::Pinhole<double>(kInf, 400, 0, 0), tp::Status::non_finite);
  Quad bad = raw;
  bad.corner[2].x() = kNan;
  expect_status(bad, ray({1, 1, 1}), kStraight, tp::Status::non_finite);
  const tp::RadialTangential<double> folds{{458, 457, 367, 248}, -0.28, 0, 0, 0, 0};
  expect_status(rectangle(10, 20, 30, 1e5), folds, kStraight, tp::Status::degenerate);
}

}  // namespace quad_test
