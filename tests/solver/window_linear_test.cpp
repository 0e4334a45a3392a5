// The sums of the window solver against numeric differences of its cost, and its reduced system against the full dense
// one.
#include <gtest/gtest.h>

#include <Eigen/Core>

#include "solver/window_scene.hpp"
#include "support/dense.hpp"
#include "textplane/solver/window.hpp"

namespace textplane_test {
namespace window_linear_test {

using Dense = Eigen::MatrixXd;

// A general state: everything perturbed, some frames, a point and a text fixed, mixed weights and sigmas, one point
// seen twice in a frame. Parameters are ordered as free cameras (6 each), then all landmarks (3 each).
struct General {
  WindowScene scene;
  tp::Window w;
  tp::WindowOptions o;
  tp::detail::WindowState x;
  tp::detail::WindowStructure s;
  tp::detail::WindowTerms terms;
  tp::detail::WindowSchur system;
  double cost = 0;

  explicit General(bool with_scale = false) {
    Noise noise(11);
    scene.add_frames(5);
    scene.add_points(12, noise);
    add_signs(scene);
    w = scene.finish();
    w.frames[2].fixed = true;
    if (!with_scale) w.frames[4].fixed = true;
    if (!with_scale) {
      w.points[3].fixed = true;
      w.texts[2].fixed = true;
    }
    perturb(w, noise, 0.004, 0.03, 0.02);
    w.point_observations.push_back(w.point_observations[7]);
    for (std::size_t k = 0; k < w.point_observations.size(); ++k) {
      w.point_observations[k].px += 3 * noise.vector<2>();
      w.point_observations[k].sigma = 1 + 0.2 * static_cast<double>(k % 4);
    }
    for (std::size_t k = 0; k < w.text_observations.size(); ++k)
      w.text_observations[k].weight = 0.5 + 0.1 * static_cast<double>(k);
    if (with_scale) {
      o.scale_frame_a = 1;
      o.scale_frame_b = 3;
    }
    o.photometric.precise = true;  // numeric derivatives, and a dense system from the double residuals
    x.read(w);
    terms.prepare(w, o, x);
    EXPECT_EQ(s.build(w, o), tp::Status::ok);
    cost = terms.accumulate(w, o, x, s, system);
  }

  int cameras() const { return 6 * s.cameras(); }
  int size() const { return cameras() + 3 * s.landmarks(); }

  tp::detail::WindowState moved(const Eigen::VectorXd& d) const {
    tp::detail::WindowState y = x;
    for (int c = 0; c < s.cameras(); ++c) {
      tp::SE3d& T = tp::detail::at(y.T_w_c, tp::detail::at(s.frame_of_camera, c));
      T = T * tp::se3_exp<double>(d.segment<6>(6 * c));
    }
    for (int l = 0; l < s.landmarks(); ++l)
      if (tp::detail::at(s.landmark_free, l)) tp::detail::at(y.landmark, l) += d.segment<3>(cameras() + 3 * l);
    return y;
  }
  double cost_at(const Eigen::VectorXd& d) {
    tp::detail::WindowState y = moved(d);
    const tp::detail::WindowTrial t = terms.evaluate(w, o, x, s, y);
    EXPECT_TRUE(t.possible);
    EXPECT_EQ(t.lost_fraction, 0);
    return t.cost;
  }
  Eigen::VectorXd gradient() const {
    Eigen::VectorXd g(size());
    for (int c = 0; c < s.cameras(); ++c) g.segment<6>(6 * c) = system.camera_gradient(c);
    for (int l = 0; l < s.landmarks(); ++l) g.segment<3>(cameras() + 3 * l) = system.landmark_gradient(l);
    return g;
  }

  // J^T W J and J^T W r from the residuals themselves: point rows by numeric differences of the projection, text rows
  // from residuals<9>() through relative_pose_jacobians().
  void dense(Dense* H, Eigen::VectorXd* g) {
    *H = Dense::Zero(size(), size());
    *g = Eigen::VectorXd::Zero(size());
    for (const tp::WindowPointObservation& k : w.point_observations) {
      const auto residual = [&](const tp::detail::WindowState& y) {
        const auto p = tp::detail::at(y.T_w_c, k.frame).inverse() * tp::detail::at(y.landmark, k.point);
        return tp::Vector2<double>((w.camera.project(p) - k.px) / k.sigma);
      };
      const tp::Vector2<double> r = residual(x);
      const double weight = o.point_robust.weight(r.squaredNorm());
      Dense J = Dense::Zero(2, size());
      for (int i = 0; i < size(); ++i) {
        Eigen::VectorXd d = Eigen::VectorXd::Zero(size());
        d[i] = 1e-5;
        J.col(i) = (residual(moved(d)) - residual(moved(-d))) / 2e-5;
      }
      *H += weight * J.transpose() * J;
      *g += weight * J.transpose() * r;
    }
    for (const tp::WindowTextObservation& k : w.text_observations) {
      const tp::WindowText& t = tp::detail::at(w.texts, k.text);
      const tp::SE3d T_w_h = tp::detail::at(x.T_w_c, t.host), T_w_t = tp::detail::at(x.T_w_c, k.frame);
      const tp::PhotometricInput in =
          tp::photometric_input(*t.patch, 0, tp::detail::at(w.frames, k.frame).image, w.camera);
      tp::PhotometricWorkspace workspace(in.patch.n);
      std::vector<double> r(static_cast<std::size_t>(in.patch.n)), rows(9 * r.size());
      const tp::ResidualSummary sum = tp::reference::residuals<tp::Parameters::pose_plane>(
          tp::ResidualRequest{in, t.theta, T_w_t.inverse() * T_w_h, o.photometric}, workspace, r.data(), rows.data());
      ASSERT_EQ(sum.status, tp::Status::ok);
      const auto map = tp::relative_pose_jacobians<double>(T_w_h, T_w_t, tp::PerturbationSide::right);
      Dense local = Dense::Zero(9, size());
      const int host = tp::detail::at(s.camera_of_frame, t.host), target = tp::detail::at(s.camera_of_frame, k.frame);
      const int landmark = static_cast<int>(w.points.size()) + k.text;
      if (host >= 0) local.block<6, 6>(0, 6 * host) = map.host;
      if (target >= 0) local.block<6, 6>(0, 6 * target) = map.target;
      if (tp::detail::at(s.landmark_free, landmark)) local.block<3, 3>(6, cameras() + 3 * landmark).setIdentity();
      Eigen::Matrix<double, 9, 9> H9 = Eigen::Matrix<double, 9, 9>::Zero();
      Eigen::Matrix<double, 9, 1> g9 = Eigen::Matrix<double, 9, 1>::Zero();
      for (std::size_t i = 0; i < r.size(); ++i) {
        const Eigen::Map<const Eigen::Matrix<double, 9, 1>> row(rows.data() + 9 * i);
        const double weight = o.photometric.robust.weight(r[i] * r[i] * sum.visible);
        H9 += weight * row * row.transpose();
        g9 += weight * row * r[i];
      }
      const double scale = k.weight * sum.visible * std::pow(o.sigma_rep / o.sigma_photo, 2);
      *H += scale * local.transpose() * H9 * local;
      *g += scale * local.transpose() * g9;
    }
  }
};

TEST(WindowLinear, GradientIsThatOfTheTotalCost) {
  General p;
  EXPECT_NEAR(p.cost_at(Eigen::VectorXd::Zero(p.size())), p.cost, 1e-9 * p.cost);
  const Eigen::VectorXd g = p.gradient();
  ASSERT_GT(g.norm(), 1);
  // A step so small that no pixel crosses a cell of the interpolant, where the derivative jumps. Rounding then is 1e-4
  // of units of g.
  const double h = 1e-8;
  for (int i = 0; i < p.size(); ++i) {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(p.size());
    d[i] = h;
    const double numeric = (p.cost_at(d) - p.cost_at(-d)) / (4 * h);
    EXPECT_NEAR(g[i], numeric, 1e-6 * g.cwiseAbs().maxCoeff()) << i;
  }
}

TEST(WindowLinear, ReducedStepIsTheDenseStep) {
  General p;
  Dense H;
  Eigen::VectorXd g;
  p.dense(&H, &g);
  const Eigen::VectorXd mine = p.gradient();
  for (int i = 0; i < p.size(); ++i) EXPECT_NEAR(mine[i], g[i], 1e-8 * g.norm()) << i;

  for (double lambda : {1e-1, 1e-5}) {
    Dense damped = H;
    damped.diagonal() *= 1 + lambda;
    // Rows of what is fixed are zero: identity there.
    for (int i = 0; i < p.size(); ++i)
      if (damped(i, i) == 0) damped(i, i) = 1;
    const Eigen::VectorXd step = -dense_solve(damped, g);
    ASSERT_TRUE(p.system.reduce(lambda));
    ASSERT_TRUE(p.system.solve());
    for (int c = 0; c < p.s.cameras(); ++c)
      EXPECT_LT((p.system.camera_step(c) - step.segment<6>(6 * c)).norm(), 1e-7 * step.head(p.cameras()).norm());
    for (int l = 0; l < p.s.landmarks(); ++l)
      if (tp::detail::at(p.s.landmark_free, l)) {
        const Eigen::Vector3d d = step.segment<3>(p.cameras() + 3 * l);
        EXPECT_LT((p.system.landmark_step(l) - d).norm(), 1e-6 * d.norm()) << l;
      }
    const double predicted = -(2 * g.dot(step) + step.dot(H * step));
    EXPECT_NEAR(p.system.predicted_decrease(), predicted, 1e-7 * predicted);
  }
}

TEST(WindowLinear, CovarianceIsTheBlockOfTheDenseInverse) {
  General p;
  Dense H;
  Eigen::VectorXd g;
  p.dense(&H, &g);
  for (int i = 0; i < p.size(); ++i)
    if (H(i, i) == 0) H(i, i) = 1;
  const Dense inverse = dense_solve(H, Dense::Identity(p.size(), p.size()));
  ASSERT_TRUE(p.system.reduce(0));
  for (int t = 0; t < 2; ++t) {
    const int l = static_cast<int>(p.w.points.size()) + t, i = p.cameras() + 3 * l;
    const tp::Matrix3<double> expected = inverse.block<3, 3>(i, i);
    EXPECT_LT((p.system.covariance(l) - expected).norm(), 1e-6 * expected.norm());
    const tp::Matrix3<double> own = H.block<3, 3>(i, i);
    EXPECT_LT((p.system.information(l) - own).norm(), 1e-8 * own.norm());
  }
}

// The held distance as a dense problem with a Lagrange multiplier; without damping, where S alone is singular.
TEST(WindowLinear, ScaleRowIsTheConstrainedSolution) {
  General p(true);
  Dense H;
  Eigen::VectorXd g;
  p.dense(&H, &g);
  const int n = p.size();
  Eigen::VectorXd row = Eigen::VectorXd::Zero(n);
  const tp::SE3d &a = p.x.T_w_c[1], &b = p.x.T_w_c[3];
  const tp::Vector3<double> u = (b.t - a.t).normalized();
  row.segment<3>(6 * p.s.camera_of_frame[1]) = -(a.R.transpose() * u);
  row.segment<3>(6 * p.s.camera_of_frame[3]) = b.R.transpose() * u;
  for (double lambda : {0.0, 1e-3}) {
    Dense kkt = Dense::Zero(n + 1, n + 1);
    kkt.topLeftCorner(n, n) = H;
    kkt.topLeftCorner(n, n).diagonal() *= 1 + lambda;
    kkt.col(n).head(n) = row;
    kkt.row(n).head(n) = row.transpose();
    const Dense inverse = dense_solve(kkt, Dense::Identity(kkt.rows(), kkt.cols()));
    const Eigen::VectorXd step = -(inverse.topLeftCorner(n, n) * g);
    ASSERT_TRUE(p.system.reduce(lambda));
    ASSERT_TRUE(p.system.solve());
    double along = 0;
    for (int c = 0; c < p.s.cameras(); ++c) {
      EXPECT_FALSE(p.system.camera_deficient(c));
      EXPECT_LT((p.system.camera_step(c) - step.segment<6>(6 * c)).norm(), 1e-5 * step.head(p.cameras()).norm());
      along += row.segment<6>(6 * c).dot(p.system.camera_step(c));
    }
    EXPECT_LT(std::abs(along), 1e-12);
    if (lambda > 0) continue;
    const int l = static_cast<int>(p.w.points.size()), i = p.cameras() + 3 * l;
    const tp::Matrix3<double> expected = inverse.block<3, 3>(i, i);
    EXPECT_LT((p.system.covariance(l) - expected).norm(), 1e-5 * expected.norm());
  }
}

TEST(BlockCholesky, SolvesABandAndASparseMatrix) {
  Noise noise(21);
  for (int band : {1, 2, 6}) {
    const int n = 7;
    tp::detail::BlockCholesky cholesky;
    cholesky.reset(n);
    Dense a = Dense::Zero(6 * n, 6 * n);
    for (int i = 0; i < n; ++i)
      for (int j = std::max(0, i - band); j < i; ++j) {
        Dense b(6, 6);
        for (int k = 0; k < 36; ++k) b(k / 6, k % 6) = noise();
        a.block(6 * i, 6 * j, 6, 6) = b;
        a.block(6 * j, 6 * i, 6, 6) = b.transpose();
        cholesky.at(i, j) = b;
      }
    Eigen::VectorXd scale(6 * n), x(6 * n);
    for (int i = 0; i < 6 * n; ++i) {
      a(i, i) = 45 + noise();
      cholesky.at(i / 6, i / 6)(i % 6, i % 6) = a(i, i);
      scale[i] = a(i, i);
      x[i] = noise();
    }
    const Eigen::VectorXd expected = dense_solve(a, x);
    EXPECT_EQ(cholesky.factorise(scale.data(), 1e-12), 0);
    cholesky.solve(x.data());
    EXPECT_LT((x - expected).norm(), 1e-13 * expected.norm());
  }
}

TEST(BlockCholesky, AZeroPivotIsHeldAndTold) {
  tp::detail::BlockCholesky cholesky;
  cholesky.reset(2);
  Eigen::Matrix<double, 12, 1> scale = Eigen::Matrix<double, 12, 1>::Ones(), x = scale;
  for (int c = 0; c < 2; ++c) cholesky.at(c, c).setIdentity();
  cholesky.at(1, 1)(3, 3) = 0;
  EXPECT_EQ(cholesky.factorise(scale.data(), 1e-12), 1);
  EXPECT_FALSE(cholesky.deficient(0));
  EXPECT_TRUE(cholesky.deficient(1));
  cholesky.solve(x.data());
  EXPECT_LT(std::abs(x[9]), 1e-150);
  EXPECT_EQ(x[8], 1);
  cholesky.reset(1);
  cholesky.at(0, 0)(2, 2) = std::nan("");
  EXPECT_EQ(cholesky.factorise(scale.data(), 1e-12), -1);
}

}  // namespace window_linear_test
}  // namespace textplane_test
