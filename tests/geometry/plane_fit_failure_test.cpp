// The plane fits where no plane comes of the input, or none that can be relied upon.
#include "textplane/geometry/plane_fit.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "geometry/plane_fit_scene.hpp"
#include "support/calculus.hpp"
#include "textplane/core/cameras/pinhole.hpp"

using textplane_test::value;
using textplane_test::values;

namespace plane_fit_test {

const double kNan = std::nan(""), kInf = std::numeric_limits<double>::infinity();

template <class S>
class PlaneFitFailures : public testing::Test {};
TYPED_TEST_SUITE(PlaneFitFailures, Scalars, );

TYPED_TEST(PlaneFitFailures, TooFewStillReportTheRank) {
  using S = TypeParam;
  Random random(9);
  const Scene<S> scene = make_scene<S>(random, 3);
  for (int n = 0; n < 3; ++n) {
    const auto by_depth = tp::plane_from_inverse_depths(scene.host.data(), scene.rho.data(), nullptr, n);
    const auto by_match = tp::plane_from_matches(scene.host.data(), scene.target.data(), n, scene.T_t_h);
    const auto by_point = tp::plane_from_points(scene.points.data(), n);
    for (const auto& fit : {by_depth, by_match, by_point}) {
      EXPECT_EQ(fit.status, tp::Status::too_few);
      EXPECT_EQ(fit.rank, n);
      EXPECT_TRUE(values(fit.value).isZero());
      EXPECT_TRUE(values(fit.covariance).isZero());
      EXPECT_EQ(fit.condition, S(std::numeric_limits<S>::max()));
    }
  }
  // A weight of zero takes a row out.
  const S weight[3] = {S(1), S(0), S(1)};
  EXPECT_EQ(tp::plane_from_inverse_depths(scene.host.data(), scene.rho.data(), weight, 3).status, tp::Status::too_few);
  EXPECT_EQ(tp::plane_from_matches(scene.host.data(), scene.target.data(), 3, scene.T_t_h, weight).rank, 2);
  EXPECT_EQ(tp::plane_from_points(scene.points.data(), 3, weight).status, tp::Status::too_few);
}

TYPED_TEST(PlaneFitFailures, CollinearAndCoincidentPointsAreRankDeficient) {
  using S = TypeParam;
  Random random(10);
  for (int repeat = 0; repeat < 30; ++repeat) {
    const Vector3d theta = facing_plane(random);
    const tp::SE3d T = random.pose(0.2, 0.2);
    const Eigen::Vector2d a = random.vector<2>(0.3),
                          b = repeat % 3 == 2 ? Eigen::Vector2d(0, 0) : random.vector<2>(0.3);
    const int rank = repeat % 3 == 2 ? 1 : 2;
    Scene<S> scene;
    for (int i = 0; i < 10; ++i) {
      const Eigen::Vector2d uv = a + random.uniform(-1, 1) * b;
      const Vector3d m(uv[0], uv[1], 1), p = m / theta.dot(m), q = T * p;
      scene.host.push_back(m.cast<S>());
      scene.rho.push_back(S(theta.dot(m)));
      scene.points.push_back(p.cast<S>());
      scene.target.push_back(Vector3d(q / q[2]).cast<S>());
    }
    const auto by_depth = tp::plane_from_inverse_depths(scene.host, scene.rho);
    const auto by_match = tp::plane_from_matches(scene.host, scene.target, tp::SE3<S>(T.cast<S>()));
    const auto by_point = tp::plane_from_points(scene.points);
    for (const auto& fit : {by_depth, by_match, by_point}) {
      EXPECT_EQ(fit.status, tp::Status::rank_deficient) << repeat;
      EXPECT_EQ(fit.rank, rank) << repeat;
      EXPECT_TRUE(values(fit.value).isZero());
      EXPECT_EQ(fit.condition, S(std::numeric_limits<S>::max()));
    }
  }
}

TYPED_TEST(PlaneFitFailures, NoBaselineIsDegenerate) {
  using S = TypeParam;
  Random random(11);
  for (int repeat = 0; repeat < 20; ++repeat) {
    Scene<S> scene = make_scene<S>(random, 10);
    tp::SE3d turn;
    if (repeat > 0) turn.R = tp::so3_exp<double>(random.vector<3>(0.2));
    // No motion; a pure rotation; a pure rotation whose translation is rounding noise.
    if (repeat > 10) turn.t = random.vector<3>(1e-17);
    for (std::size_t i = 0; i < 10; ++i) {
      const Vector3d q = turn.R * values(scene.host[i]);
      scene.target[i] = Vector3d(q / q[2]).cast<S>();
    }
    const auto fit = tp::plane_from_matches(scene.host, scene.target, tp::SE3<S>(turn.cast<S>()));
    EXPECT_FALSE(tp::is_ok(fit.status)) << repeat;
    if (repeat <= 10) {
      EXPECT_EQ(fit.status, tp::Status::degenerate) << repeat;
      EXPECT_EQ(fit.rank, 0);
      EXPECT_TRUE(values(fit.value).isZero());
    } else {
      EXPECT_TRUE(fit.status == tp::Status::degenerate || fit.status == tp::Status::behind_camera)
          << tp::to_string(fit.status);
    }
  }
}

TEST(PlaneFitFailure, PlanesThroughOrBehindTheCameraAreNamed) {
  // Points on the plane x = 0, which holds the camera centre.
  const std::vector<Vector3d> through = {{0, 0, 1}, {0, 1, 2}, {0, -1, 3}, {0, 0.5, 1}};
  EXPECT_EQ(tp::plane_from_points(through).status, tp::Status::behind_camera);
  // Inverse depths that change sign inside the sign.
  const std::vector<Vector3d> m = {{-0.1, 0, 1}, {0.1, 0, 1}, {0, 0.1, 1}, {0, -0.1, 1}};
  const std::vector<double> rho = {-0.5, 0.7, 0.1, 0.1};
  const auto fit = tp::plane_from_inverse_depths(m, rho);
  EXPECT_EQ(fit.status, tp::Status::behind_camera);
  EXPECT_LT((fit.value - Vector3d(6, 0, 0.1)).norm(), 1e-12) << "the algebraic solution is kept";
  // A baseline of the wrong sign mirrors the plane behind the cameras.
  Random random(12);
  auto scene = make_scene<double>(random, 10);
  scene.T_t_h.t = -scene.T_t_h.t;
  EXPECT_EQ(tp::plane_from_matches(scene.host, scene.target, scene.T_t_h).status, tp::Status::behind_camera);
}

TEST(PlaneFitFailure, BrokenInputGivesAStatus) {
  Random random(13);
  const auto scene = make_scene<double>(random, 5);
  for (const double bad : {kNan, kInf, -kInf}) {
    for (std::size_t i = 0; i < 5; ++i) {
      auto broken = scene;
      broken.rho[i] = bad;
      EXPECT_EQ(tp::plane_from_inverse_depths(broken.host, broken.rho).status, tp::Status::non_finite);
      broken.host[i][1] = bad;
      EXPECT_EQ(tp::plane_from_inverse_depths(broken.host, scene.rho).status, tp::Status::non_finite);
      EXPECT_EQ(tp::plane_from_matches(broken.host, scene.target, scene.T_t_h).status, tp::Status::non_finite);
      broken.target[i][0] = bad;
      EXPECT_EQ(tp::plane_from_matches(scene.host, broken.target, scene.T_t_h).status, tp::Status::non_finite);
      broken.points[i][2] = bad;
      EXPECT_EQ(tp::plane_from_points(broken.points).status, tp::Status::non_finite);
      std::array<double, 5> weight = {1, 1, 1, 1, 1};
      weight[i] = bad;
      EXPECT_EQ(tp::plane_from_points(scene.points.data(), 5, weight.data()).status, tp::Status::non_finite);
    }
    auto T = scene.T_t_h;
    T.R(1, 1) = bad;
    EXPECT_EQ(tp::plane_from_matches(scene.host, scene.target, T).status, tp::Status::non_finite);
  }
  const std::array<double, 5> negative = {1, 1, -1, 1, 1};
  EXPECT_EQ(tp::plane_from_matches(scene.host.data(), scene.target.data(), 5, scene.T_t_h, negative.data()).status,
            tp::Status::invalid_argument);
  const Vector3d* null = nullptr;
  EXPECT_EQ(tp::plane_from_points(null, 3).status, tp::Status::invalid_argument);
  EXPECT_EQ(tp::plane_from_points(scene.points.data(), -1).status, tp::Status::invalid_argument);
  EXPECT_EQ(tp::plane_from_matches(scene.host.data(), null, 5, scene.T_t_h).status, tp::Status::invalid_argument);
  const std::vector<double> short_rho(4, 1.0);
  EXPECT_EQ(tp::plane_from_inverse_depths(scene.host, short_rho).status, tp::Status::invalid_argument);
}

// Pixels in the place of normalised points gave an ok status and a plane of (0, 0, 300).
TEST(PlaneFitFailure, PixelsAreNoRays) {
  Random random(17);
  const auto scene = make_scene<double>(random, 8);
  const tp::Pinhole<double> camera(300, 300, 160, 120);
  auto pixels = scene;
  for (std::size_t i = 0; i < 8; ++i) {
    const auto at = [&camera](const Vector3d& m) {
      return camera.pixel({m[0] / m[2], m[1] / m[2]}).homogeneous().eval();
    };
    pixels.host[i] = at(scene.host[i]);
    pixels.target[i] = at(scene.target[i]);
  }
  for (const auto& fit : {tp::plane_from_matches(pixels.host, pixels.target, scene.T_t_h),
                          tp::plane_from_matches(pixels.host, scene.target, scene.T_t_h),
                          tp::plane_from_matches(scene.host, pixels.target, scene.T_t_h),
                          tp::plane_from_inverse_depths(pixels.host, scene.rho)}) {
    EXPECT_EQ(fit.status, tp::Status::invalid_argument);
    EXPECT_TRUE(fit.value.isZero());
  }
  EXPECT_TRUE(tp::is_ok(tp::plane_from_matches(scene.host, scene.target, scene.T_t_h).status));
  std::vector<Vector3d> wide = {{9.9, 0, 1}, {-9.9, 0, 1}, {0, 9.9, 1}, {0, -9.9, 1}};  // 84 degrees off the axis
  const std::vector<double> rho(4, 0.5);
  EXPECT_TRUE(tp::is_ok(tp::plane_from_inverse_depths(wide, rho).status));
  wide[2][1] = 10.1;
  EXPECT_EQ(tp::plane_from_inverse_depths(wide, rho).status, tp::Status::invalid_argument);
}

// Huge and tiny coordinates neither overflow into a NaN nor pass for a plane without a status.
TEST(PlaneFitFailure, ExtremeValuesNeverGiveNanWithAnOkStatus) {
  Random random(14);
  for (const double scale : {1e-300, 1e-160, 1e-80, 1e80, 1e160, 1e300})
    for (int repeat = 0; repeat < 10; ++repeat) {
      auto scene = make_scene<double>(random, 6);
      for (std::size_t i = 0; i < 6; ++i) {
        scene.rho[i] *= scale;
        scene.points[i] *= scale;
      }
      scene.T_t_h.t *= scale;
      for (const auto& fit :
           {tp::plane_from_inverse_depths(scene.host, scene.rho),
            tp::plane_from_matches(scene.host, scene.target, scene.T_t_h), tp::plane_from_points(scene.points)}) {
        EXPECT_TRUE(tp::all_finite(fit.value) || !tp::is_ok(fit.status)) << scale;
        EXPECT_TRUE(tp::all_finite(fit.covariance) || !tp::is_ok(fit.status)) << scale;
        EXPECT_TRUE(tp::is_finite(fit.sigma) || !tp::is_ok(fit.status)) << scale;
      }
    }
}

}  // namespace plane_fit_test
