// Rows by policy, derived here from what they mean: the change of the host's intensity where H(0)^-1 H(dp) m~ lands, by
// central differences.
#include "textplane/photometry/residual_policy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "photometry/scene.hpp"
#include "textplane/photometry/template_patch.hpp"

namespace residual_policy_test {
using namespace textplane_test;
using tp::LinearisePolicy;
using Row = Eigen::Matrix<double, 9, 1>;

struct Patch : Scene<float> {
  std::vector<float> gx, gy;

  Patch(unsigned seed, int pixels) : Scene<float>(seed, pixels) {
    Random random(seed + 5);
    for (int i = 0; i < pixels; ++i) {
      gx.push_back(static_cast<float>(random.uniform(-40, 40)));
      gy.push_back(static_cast<float>(random.uniform(-40, 40)));
    }
  }
  tp::PhotometricInputF input() const {
    tp::PhotometricInputF in = Scene<float>::input();
    in.patch.gx = gx.data();
    in.patch.gy = gy.data();
    return in;
  }
  tp::ResidualRequest<float> request(const tp::PhotometricOptions& options = {}) const {
    return {input(), theta, T_t_h, options};
  }
  tp::Matrix3<double> H(const Row& dp) const {
    const tp::SE3d T = tp::se3_exp<double>(dp.head<6>()) * T_t_h;
    return T.R + T.t * (theta + dp.tail<3>()).transpose();
  }
  // Where the host's pixel i goes, px of the host.
  tp::Vector2<double> moved(int i, const Row& dp) const {
    const auto k = static_cast<std::size_t>(i);
    const tp::Vector3<double> m = host_camera.unproject({static_cast<double>(x[k]), static_cast<double>(y[k])});
    return host_camera.project(H(Row::Zero()).inverse() * H(dp) * m);
  }
  // dI of the template.
  Row template_row(int i) const {
    const auto k = static_cast<std::size_t>(i);
    Row row;
    for (int j = 0; j < 9; ++j) {
      const double h = 1e-6;
      const tp::Vector2<double> d = (moved(i, h * Row::Unit(j)) - moved(i, -h * Row::Unit(j))) / (2 * h);
      row[j] = static_cast<double>(gx[k]) * d[0] + static_cast<double>(gy[k]) * d[1];
    }
    return row;
  }
};

// dr = -(1/s) (I - 1 1^T / N - h h^T) dI, or -dI / s: a row a pixel.
Eigen::MatrixXd project(const Eigen::MatrixXd& dI, const Eigen::VectorXd& h, double s, bool exact) {
  if (!exact) return -dI / s;
  const Eigen::RowVectorXd mean = dI.colwise().mean(), along = h.transpose() * dI;
  Eigen::MatrixXd out = dI;
  for (Eigen::Index i = 0; i < out.rows(); ++i) out.row(i) -= mean + h[i] * along;
  return -out / s;
}

TEST(LinearisePolicy, RowsAreWhatTheyMean) {
  for (unsigned seed = 1; seed <= 6; ++seed)
    for (const bool exact : {true, false}) {
      SCOPED_TRACE(seed);
      Patch scene(seed, 40);
      const int n = scene.n();
      tp::PhotometricOptions options;
      options.robust.kind = tp::RobustKind::l2;
      options.normalisation = exact ? tp::Normalisation::exact : tp::Normalisation::frozen;

      std::vector<double> r(static_cast<std::size_t>(n)), J(static_cast<std::size_t>(9 * n));
      ASSERT_EQ(tp::reference::residuals<tp::Parameters::pose_plane>(scene.request(options), scene.workspace, r.data(),
                                                                     J.data())
                    .status,
                tp::Status::ok);
      const Eigen::Map<const Eigen::VectorXd> residual(r.data(), n);
      const Eigen::MatrixXd forward =
          Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor>>(J.data(), n, 9);

      Eigen::VectorXd host(n);
      Eigen::MatrixXd dI(n, 9);
      for (int i = 0; i < n; ++i) {
        host[i] = static_cast<double>(scene.intensity[static_cast<std::size_t>(i)]);
        dI.row(i) = scene.template_row(i).transpose();
      }
      host.array() -= host.mean();
      const double s = host.norm();
      const Eigen::MatrixXd constant = project(dI, host / s, s, exact), mean = 0.5 * (forward + constant);

      for (const auto policy : {LinearisePolicy::forward, LinearisePolicy::template_jacobian, LinearisePolicy::esm}) {
        const Eigen::MatrixXd& rows = policy == LinearisePolicy::forward ? forward
                                      : policy == LinearisePolicy::esm   ? mean
                                                                         : constant;
        const auto e =
            tp::reference::linearise<tp::Parameters::pose_plane>(scene.request(options).by(policy), scene.workspace);
        ASSERT_EQ(e.status, tp::Status::ok);
        const Eigen::MatrixXd H = rows.transpose() * rows;
        const Eigen::VectorXd b = rows.transpose() * residual;
        for (int i = 0; i < 9; ++i) {
          EXPECT_NEAR(e.b[i], b[i], 1e-7 * std::sqrt(H(i, i)));
          for (int j = 0; j < 9; ++j) EXPECT_NEAR(e.H(i, j), H(i, j), 1e-7 * std::sqrt(H(i, i) * H(j, j)));
        }
        EXPECT_NEAR(e.cost, residual.squaredNorm(), 1e-12);
      }
    }
}

// By central differences: of the target's intensity at a warped pixel, and of the warp at the patch's centre. Its mean
// weight times the energy of the target's gradients, sum |J^T g|^2, over that of the host's.
double energy_ratio(const Patch& scene, const Eigen::VectorXd& residuals, const tp::Robust& robust) {
  const auto [low_x, high_x] = std::minmax_element(scene.x.begin(), scene.x.end());
  const auto [low_y, high_y] = std::minmax_element(scene.y.begin(), scene.y.end());
  const double cx = 0.5 * (static_cast<double>(*low_x) + static_cast<double>(*high_x)),
               cy = 0.5 * (static_cast<double>(*low_y) + static_cast<double>(*high_y)), h = 1e-5;
  const auto value = [&](double x, double y) {
    double v = 0;
    EXPECT_TRUE(tp::sample_bilinear(scene.view(), x, y, &v));
    return v;
  };
  Eigen::Matrix2d J;
  J.col(0) = (scene.project(cx + h, cy) - scene.project(cx - h, cy)) / (2 * h);
  J.col(1) = (scene.project(cx, cy + h) - scene.project(cx, cy - h)) / (2 * h);
  double target = 0, host = 0, weights = 0;
  const int n = scene.n();
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const tp::Vector2<double> at = scene.project(static_cast<double>(scene.x[k]), static_cast<double>(scene.y[k]));
    const Eigen::Vector2d g((value(at[0] + h, at[1]) - value(at[0] - h, at[1])) / (2 * h),
                            (value(at[0], at[1] + h) - value(at[0], at[1] - h)) / (2 * h));
    target += (J.transpose() * g).squaredNorm();
    host += Eigen::Vector2f(scene.gx[k], scene.gy[k]).cast<double>().squaredNorm();
    weights += robust.weight(n * residuals[i] * residuals[i]) / n;
  }
  return weights * target / host;
}

// b is forward's; H that of the template's rows of all pixels times that ratio.
TEST(LinearisePolicy, HybridIsForwardsGradientWithTheTemplatesMatrix) {
  for (unsigned seed = 1; seed <= 4; ++seed)
    for (const bool exact : {true, false}) {
      SCOPED_TRACE(seed);
      const Patch scene(seed, 300);
      tp::PhotometricWorkspace workspace(scene.n());
      tp::PhotometricOptions options;
      options.robust.delta = seed * 0.4;
      options.normalisation = exact ? tp::Normalisation::exact : tp::Normalisation::frozen;
      tp::TemplatePatch prepared;
      ASSERT_EQ(prepared.prepare(scene.input().patch), tp::Status::ok);
      Eigen::VectorXd residuals(scene.n());
      ASSERT_EQ(tp::reference::residuals<tp::Parameters::pose_plane>(scene.request(options), workspace,
                                                                     residuals.data(), nullptr)
                    .visible,
                scene.n());
      Eigen::VectorXd host(scene.n());
      Eigen::MatrixXd dI(scene.n(), 9);
      for (int i = 0; i < scene.n(); ++i) {
        host[i] = static_cast<double>(scene.intensity[static_cast<std::size_t>(i)]);
        dI.row(i) = scene.template_row(i).transpose();
      }
      host.array() -= host.mean();
      const double s = host.norm();
      const Eigen::MatrixXd rows = project(dI, host / s, s, exact);

      const auto forward = tp::reference::linearise<tp::Parameters::pose_plane>(scene.request(options), workspace);
      const auto hybrid = tp::reference::linearise<tp::Parameters::pose_plane>(
          scene.request(options).by(LinearisePolicy::hybrid, &prepared), workspace);
      ASSERT_EQ(hybrid.status, tp::Status::ok);
      EXPECT_EQ(hybrid.b, forward.b);
      EXPECT_EQ(hybrid.cost, forward.cost);
      EXPECT_EQ(hybrid.zncc, forward.zncc);
      const double ratio = energy_ratio(scene, residuals, options.robust) * (s * s) / (forward.s * forward.s);
      const Eigen::MatrixXd H = ratio * rows.transpose() * rows;
      for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j) EXPECT_NEAR(hybrid.H(i, j), H(i, j), 1e-6 * std::sqrt(H(i, i) * H(j, j)));
    }
}

// A host that equals the target but for gain and bias: nothing to gain by any policy.
TEST(LinearisePolicy, AllVanishAtAPerfectMatch) {
  Patch scene(2, 50);
  for (int i = 0; i < scene.n(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const tp::Vector2<double> at = scene.project(static_cast<double>(scene.x[k]), static_cast<double>(scene.y[k]));
    double value = 0;
    ASSERT_TRUE(tp::sample_bilinear(scene.view(), at[0], at[1], &value));
    scene.intensity[k] = static_cast<float>(0.5 * value + 30);
  }
  for (const auto policy : {LinearisePolicy::forward, LinearisePolicy::template_jacobian, LinearisePolicy::esm}) {
    const auto e = tp::reference::linearise<tp::Parameters::pose_plane>(scene.request().by(policy), scene.workspace);
    ASSERT_EQ(e.status, tp::Status::ok);
    for (int i = 0; i < 9; ++i) EXPECT_LT(std::abs(e.b[i]), 1e-6 * std::sqrt(e.H(i, i)));
  }
}

TEST(LinearisePolicy, StatusOfWhatCannotBe) {
  Patch scene(3, 30);
  const auto run = [&](const tp::PhotometricInputF& in, LinearisePolicy policy, const tp::SE3d& T) {
    return tp::reference::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, scene.theta, T}.by(policy),
                                                          scene.workspace)
        .status;
  };
  tp::PhotometricInputF bare = scene.input();
  bare.patch.gx = nullptr;
  EXPECT_EQ(run(bare, LinearisePolicy::forward, scene.T_t_h), tp::Status::ok);
  EXPECT_EQ(run(bare, LinearisePolicy::template_jacobian, scene.T_t_h), tp::Status::invalid_argument);
  EXPECT_EQ(run(bare, LinearisePolicy::esm, scene.T_t_h), tp::Status::invalid_argument);
  EXPECT_EQ(run(scene.input(), LinearisePolicy::automatic, scene.T_t_h), tp::Status::invalid_argument);
  scene.gy[7] = std::nanf("");
  EXPECT_EQ(run(scene.input(), LinearisePolicy::esm, scene.T_t_h), tp::Status::non_finite);
}

}  // namespace residual_policy_test
