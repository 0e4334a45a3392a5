// Poses and residuals behind a rolling shutter.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "solver/rows/rows_scene.hpp"
#include "textplane/solver/pose.hpp"

namespace rows_test {

using namespace textplane_test;
using namespace textplane_test::rows;

// The sign's patch in the host and the target's image, taken as rolling or, against the truth, as still ones.
struct Pair {
  tp::CameraView target;
  tp::TextPatch patch;
  tp::Pyramid pyramid;

  explicit Pair(const Views& v, bool with_rows = true)
      : target(kCamera.pinhole, nullptr, with_rows ? &v.target : nullptr),
        patch(tp::make_patch(picture(v.T_h_w, v.host).view(),
                             tp::CameraView(kCamera.pinhole, nullptr, with_rows ? &v.host : nullptr), kQuad)),
        pyramid(picture(v.T_t_w, v.target).view(), 3) {
    EXPECT_TRUE(tp::is_ok(patch.status));
  }
  tp::PhotometricInput input(int level) const { return tp::photometric_input(patch, level, pyramid.view(), target); }
};

tp::SE3d aligned(const Views& v, bool with_rows) {
  const Pair pair(v, with_rows);
  const tp::SE3d start = tp::se3_exp<double>(tp::Vector6<double>::Constant(0.002)) * v.T_t_h();
  return tp::align_pose(pair.patch, v.theta, start, pair.pyramid.view(), pair.target).T_t_h;
}

// Where the middle of the sign is seen from: the weakly determined parts of a pose cancel.
double centre_error(const Views& v, const tp::SE3d& T_t_h) {
  double largest = 0;
  for (const tp::Vector2<double>& corner : kQuad.corner) {
    const tp::Vector3<double> p = tp::plane_point(v.theta, kCamera.pinhole.unproject(corner));
    largest = std::max(largest, (kCamera.project(T_t_h * p) - kCamera.project(v.T_t_h() * p)).norm());
  }
  return largest;
}

TEST(Rows, AlignsAPatchBetweenRollingImages) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Views views(seed);
    EXPECT_LT(centre_error(views, aligned(views, true)), 0.06) << seed;
    EXPECT_GT(centre_error(views, aligned(views, false)), 0.4) << seed;
  }
}

// Derivatives of the residuals against central differences, for pose and plane.
TEST(Rows, DerivativesAreThoseOfTheResiduals) {
  const Views v(3);
  const Pair pair(v);
  tp::PhotometricWorkspace workspace(pair.patch.max_pixels());
  for (int level = 0; level < 2; ++level) {
    const auto input = pair.input(level);
    const int n = input.patch.n;
    const auto at = [&](const Eigen::Matrix<double, 9, 1>& x, double* J) {
      std::vector<double> r(static_cast<std::size_t>(n));
      const tp::Vector6<double> xi = x.head<6>();
      const tp::ResidualRequest<std::uint8_t> q{input, v.theta + tp::Vector3<double>(x.tail<3>()),
                                                tp::se3_exp<double>(xi) * v.T_t_h()};
      EXPECT_TRUE(tp::is_ok(tp::reference::residuals<tp::Parameters::pose_plane>(q, workspace, r.data(), J).status));
      return r;
    };
    std::vector<double> J(static_cast<std::size_t>(9 * n));
    at(Eigen::Matrix<double, 9, 1>::Zero(), J.data());
    const double h = 1e-6;
    for (int k = 0; k < 9; ++k) {
      const std::vector<double> above = at(h * Eigen::Matrix<double, 9, 1>::Unit(k), nullptr),
                                below = at(-h * Eigen::Matrix<double, 9, 1>::Unit(k), nullptr);
      double product = 0, analytic = 0, numeric = 0;
      for (int i = 0; i < n; ++i) {
        const double a = J[static_cast<std::size_t>(9 * i + k)],
                     b = (above[static_cast<std::size_t>(i)] - below[static_cast<std::size_t>(i)]) / (2 * h);
        product += a * b;
        analytic += a * a;
        numeric += b * b;
      }
      EXPECT_NEAR(product / std::sqrt(analytic * numeric), 1, 0.005) << k << " on level " << level;
      EXPECT_NEAR(std::sqrt(analytic / numeric), 1, 0.02) << k << " on level " << level;
    }
  }
}

TEST(Rows, KernelsAndReferenceAgree) {
  const Views v(4);
  const Pair pair(v);
  tp::PhotometricWorkspace workspace(pair.patch.max_pixels());
  const tp::ResidualRequest<std::uint8_t> q{pair.input(0), v.theta, v.T_t_h()};
  const auto fast = tp::linearise<tp::Parameters::pose_plane>(q, workspace);
  const auto slow = tp::reference::linearise<tp::Parameters::pose_plane>(q, workspace);
  EXPECT_EQ(fast.path, tp::Path::kernel);
  EXPECT_GT(fast.zncc, 0.995);
  EXPECT_LT((fast.H - slow.H).norm(), 1e-4 * slow.H.norm());
  EXPECT_NEAR(tp::evaluate(q, workspace).cost, slow.cost, 1e-4 * slow.cost + 1e-9);
}

TEST(Rows, PoseByPointsIsExact) {
  Random random(11);
  for (int trial = 0; trial < 20; ++trial) {
    const tp::SE3d truth = tp::se3_exp<double>(random.twist(0.2, 0.1));
    const tp::RowMotion rows{random.twist(1, 1), kShutter};
    const tp::CameraView camera(kCamera.pinhole, nullptr, &rows);
    std::vector<tp::PosePointTerm> terms;
    for (const tp::Vector3<double>& p : cloud(random, 40)) {
      const tp::RowProjection seen = tp::project_rows(rows, camera, truth * p);
      ASSERT_TRUE(tp::is_ok(seen.status));
      terms.push_back({p, seen.px});
    }
    tp::PoseWorkspace workspace;
    workspace.reserve(nullptr, 0, 40);
    const auto solve = [&](const tp::CameraView& as) {
      return tp::refine_pose(nullptr, 0, terms.data(), 40, tp::PyramidView(), as, tp::SE3d(), {}, workspace);
    };
    EXPECT_LT(distance(solve(camera).T_t_w, truth), 1e-5);
    EXPECT_LT(solve(camera).iterations, 12);
    EXPECT_GT(distance(solve(kCamera).T_t_w, truth), 1e-3);
  }
}

// The gradient and the Hessian of a point's term by the left increment of the pose at the time stamp.
TEST(Rows, PointDerivativesMatchCentralDifferences) {
  Random random(12);
  const tp::RowMotion rows{random.twist(2, 2), kShutter};
  const tp::CameraView camera(kCamera.pinhole, nullptr, &rows);
  const tp::SE3d T = tp::se3_exp<double>(random.twist(0.2, 0.1));
  const tp::PosePointTerm term{{0.3, -0.2, 2.0}, {40, 20}};
  const tp::SE3d row = rows.at(term.px[1]);
  tp::detail::PoseSystem system;
  ASSERT_TRUE(tp::detail::add_point(term, T, camera, &row, {}, system));
  tp::detail::mirror(system);
  const auto error = [&](const tp::Vector6<double>& xi) {
    tp::Vector3<double> p;
    tp::Vector2<double> e;
    EXPECT_TRUE(tp::detail::reproject(term, tp::se3_exp<double>(xi) * T, camera, &row, &p, &e));
    return e;
  };
  tp::FixedMatrix<double, 2, 6> J;
  const double h = 1e-6;
  for (int k = 0; k < 6; ++k) {
    const tp::Vector6<double> step = h * tp::Vector6<double>::Unit(k);
    J.col(k) = (error(step) - error(-step)) / (2 * h);
  }
  const tp::Robust none;
  const double weight = none.weight(error(tp::Vector6<double>::Zero()).squaredNorm());
  EXPECT_LT((system.H - weight * J.transpose() * J).norm(), 1e-6 * system.H.norm());
  EXPECT_LT((system.b - weight * J.transpose() * error(tp::Vector6<double>::Zero())).norm(), 1e-6 * system.b.norm());
}

}  // namespace rows_test
