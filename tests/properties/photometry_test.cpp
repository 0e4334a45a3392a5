// Laws of the photometric cost and its normal equations, at drawn cameras, planes, poses, textures and numbers of
// pixels, on a drawn target of the machine.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "properties/properties.hpp"
#include "support/calculus.hpp"
#include "support/targets.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/photometry/residual_policy.hpp"

namespace textplane_test {
namespace photometry_properties {

constexpr int kWidth = 160, kHeight = 120;

// A patch and a target in which most of its pixels are seen. Grey levels from 10 to 117, so that they can be doubled.
struct Drawn {
  tp::Image<std::uint8_t> image{kWidth, kHeight};
  tp::Pinhole<double> host, target;
  tp::Vector3<double> theta = plane(1, 4);
  tp::SE3d T_t_h;
  std::vector<float> x, y, intensity, gx, gy;
  std::vector<std::uint8_t> mask;
  tp::PhotometricWorkspace workspace;
  tp::PhotometricOptions options;

  Drawn() {
    host = {number(120, 250), number(120, 250), number(70, 90), number(50, 70)};
    target = {number(120, 250), number(120, 250), number(70, 90), number(50, 70)};
    T_t_h = pose(0.12, 0.1);
    Random random(seed());
    const double a = random.uniform(0, 6), b = random.uniform(0, 6), noise = number(0, 15);
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u)
        image(u, v) = static_cast<std::uint8_t>(63 + 23 * std::sin(0.35 * u + 0.1 * v + a) +
                                                16 * std::cos(0.4 * v - 0.07 * u + b) + random.uniform(-noise, noise));
    const int n = integer(0, 2) == 0 ? integer(15, 40) : integer(40, 700);
    const double reach = number(10, 40);
    for (int i = 0; i < n; ++i) {
      x.push_back(static_cast<float>(80 + std::floor(random.uniform(-reach, reach))));
      y.push_back(static_cast<float>(60 + std::floor(random.uniform(-reach, reach))));
      const tp::Vector2<double> at = seen_at(x.back(), y.back());
      double value = random.uniform(0, 255);
      tp::sample_bilinear(view(), at[0], at[1], &value);
      intensity.push_back(static_cast<float>(1.3 * value + random.uniform(-8, 8)));
      gx.push_back(static_cast<float>(random.uniform(-30, 30)));
      gy.push_back(static_cast<float>(random.uniform(-30, 30)));
      mask.push_back(static_cast<std::uint8_t>(random.uniform(0, 1) < 0.5));
    }
    workspace.reserve(n);
    options.min_visible = 1;
    options.normalisation = integer(0, 1) == 0 ? tp::Normalisation::exact : tp::Normalisation::frozen;
    options.robust.kind = integer(0, 2) == 0 ? tp::RobustKind::l2 : tp::RobustKind::huber;
  }

  tp::Vector2<double> seen_at(double px, double py) const {
    const tp::Vector3<double> m = host.unproject({px, py});
    return target.project(T_t_h.R * m + theta.dot(m) * T_t_h.t);
  }
  tp::ImageView8 view() const { return image.view(); }
  int n() const { return static_cast<int>(x.size()); }
  tp::PhotometricInput input() const {
    tp::PhotometricInput in;
    in.patch = {x.data(), y.data(), intensity.data(), nullptr, n(), gx.data(), gy.data()};
    in.host_camera = host;
    in.target_camera = target;
    in.target = image.view();
    return in;
  }
  tp::ResidualRequest<std::uint8_t> request() const { return {input(), theta, T_t_h, options}; }
};

simd::Target any_target() {
  const auto all = testable_targets();
  return all[static_cast<std::size_t>(integer(0, static_cast<int>(all.size()) - 1))];
}

// Kernels sum in float: what the same sum may differ by in another order (simd/residual.hpp).
template <int P>
bool close(const tp::NormalEquations<P>& a, const tp::NormalEquations<P>& b, const tp::NormalEquations<P>& frozen) {
  if (a.status != b.status || a.visible != b.visible) return false;
  for (int i = 0; i < P; ++i) {
    const double size = std::sqrt(frozen.H(i, i));
    if (!(std::abs(a.b[i] - b.b[i]) <= 6e-5 * size)) return false;
    for (int j = 0; j < P; ++j)
      if (!(std::abs(a.H(i, j) - b.H(i, j)) <= 6e-5 * size * std::sqrt(frozen.H(j, j)))) return false;
  }
  return std::abs(a.cost - b.cost) <= 2e-5 * b.cost + 2e-6 && std::abs(a.error - b.error) <= 2e-5 * b.error + 2e-6;
}
tp::NormalEquations<9> frozen(Drawn& s, const tp::PhotometricInput& in) {
  tp::PhotometricOptions o = s.options;
  o.normalisation = tp::Normalisation::frozen;
  return tp::reference::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{in, s.theta, s.T_t_h, o},
                                                              s.workspace);
}

RC_GTEST_PROP(Photometry, CostsAreWithinTheirRanges, ()) {
  Drawn s;
  const TargetScope scope(any_target());
  // Any other patch, too: as far from the image as can be.
  if (integer(0, 3) == 0)
    for (std::size_t i = 0; i < s.intensity.size(); ++i) s.intensity[i] = 255 - s.intensity[i];
  const auto e = tp::evaluate(s.request(), s.workspace);
  RC_PRE(tp::is_ok(e.status));
  RC_ASSERT((e.error >= 0 && e.error <= 4 + 1e-5));
  RC_ASSERT((e.zncc <= 1 && e.zncc >= -1 - 1e-5));
  RC_ASSERT((e.cost >= 0 && e.cost <= e.error + 1e-6));
  const auto n = tp::linearise<tp::Parameters::pose_plane>(s.request(), s.workspace);
  RC_ASSERT((n.status == e.status && n.visible == e.visible));
  RC_ASSERT(std::abs(n.cost - e.cost) <= 2e-5 * e.cost + 2e-6);
  // J^T W J is never negative.
  const tp::Vector6<double> v = vector<6>(1);
  const Eigen::Matrix<double, 6, 6> H = n.H.topLeftCorner<6, 6>();
  RC_ASSERT(v.dot(H * v) >= -1e-4 * v.cwiseAbs2().dot(frozen(s, s.input()).H.diagonal().head<6>()));
}

RC_GTEST_PROP(Photometry, TheSameImageFromTheSamePlaceCostsNothing, ()) {
  Drawn s;
  const TargetScope scope(any_target());
  s.target = s.host;
  s.T_t_h = tp::SE3d();
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    s.x[i] += static_cast<float>(integer(0, 63)) / 64;
    s.y[i] += static_cast<float>(integer(0, 63)) / 64;
    tp::sample_bilinear(s.view(), s.x[i], s.y[i], &s.intensity[i]);
  }
  const auto e = tp::linearise<tp::Parameters::pose_plane>(s.request(), s.workspace);
  RC_PRE(tp::is_ok(e.status));
  RC_ASSERT(e.visible == s.n());
  RC_ASSERT((e.error < 1e-9 && e.zncc > 1 - 1e-9));
  const auto scale = frozen(s, s.input());
  for (int i = 0; i < 9; ++i) RC_ASSERT(std::abs(e.b[i]) <= 3e-5 * std::sqrt(scale.H(i, i)));
  RC_ASSERT(tp::reference::evaluate(s.request(), s.workspace).error < 1e-12);
}

RC_GTEST_PROP(Photometry, GainAndBiasOfEitherSideChangeNothing, ()) {
  Drawn s;
  const TargetScope scope(any_target());
  s.options.min_contrast = 0;
  const auto scale = frozen(s, s.input());
  const auto before = tp::linearise<tp::Parameters::pose_plane>(s.request(), s.workspace);
  RC_PRE(tp::is_ok(before.status));
  Drawn t = s;
  const double gain = number(0.5, 3), bias = number(-60, 60);
  for (float& value : t.intensity) value = static_cast<float>(gain * value + bias);
  RC_ASSERT(close<9>(tp::linearise<tp::Parameters::pose_plane>(t.request(), t.workspace), before, scale));
  const int offset = integer(0, 20);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) t.image(x, y) = static_cast<std::uint8_t>(2 * s.image(x, y) + offset);
  const auto after = tp::linearise<tp::Parameters::pose_plane>(t.request(), t.workspace);
  RC_ASSERT(close<9>(after, before, scale));
  RC_ASSERT(std::abs(after.s - 2 * before.s) < 1e-4 * after.s + 1e-3);
  RC_ASSERT(std::abs(after.mean - 2 * before.mean - offset) < 1e-3);
}

RC_GTEST_PROP(Photometry, TheOrderOfPixelsDoesNotMatter, ()) {
  Drawn s;
  const TargetScope scope(any_target());
  const auto scale = frozen(s, s.input());
  const auto before = tp::linearise<tp::Parameters::pose_plane>(s.request(), s.workspace);
  const auto exact = tp::reference::evaluate(s.request(), s.workspace);
  RC_PRE(tp::is_ok(before.status));
  const std::vector<std::uint8_t> visible(s.workspace.visible(), s.workspace.visible() + s.n());
  std::vector<std::size_t> order(s.x.size());
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), std::mt19937(seed()));
  Drawn t = s;
  for (std::size_t i = 0; i < order.size(); ++i) {
    t.x[i] = s.x[order[i]];
    t.y[i] = s.y[order[i]];
    t.intensity[i] = s.intensity[order[i]];
  }
  RC_ASSERT(close<9>(tp::linearise<tp::Parameters::pose_plane>(t.request(), t.workspace), before, scale));
  for (std::size_t i = 0; i < order.size(); ++i) RC_ASSERT(t.workspace.visible()[i] == visible[order[i]]);
  const auto again = tp::reference::evaluate(t.request(), t.workspace);
  RC_ASSERT(std::abs(again.cost - exact.cost) <= 1e-12);
}

// With the derivatives of mean and s left out and no weights, s^2 H is a plain sum over pixels.
RC_GTEST_PROP(Photometry, APatchIsTheSumOfItsParts, ()) {
  Drawn s;
  const TargetScope scope(any_target());
  s.options.normalisation = tp::Normalisation::frozen;
  s.options.robust.kind = tp::RobustKind::l2;
  s.options.min_contrast = 0;
  std::vector<std::uint8_t> others;
  for (const std::uint8_t m : s.mask) others.push_back(m == 0);
  tp::PhotometricInput part = s.input();
  part.patch.mask = s.mask.data();
  const auto a =
      tp::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{part, s.theta, s.T_t_h, s.options}, s.workspace);
  part.patch.mask = others.data();
  const auto b =
      tp::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{part, s.theta, s.T_t_h, s.options}, s.workspace);
  const auto all = tp::linearise<tp::Parameters::pose_plane>(s.request(), s.workspace);
  RC_PRE((tp::is_ok(a.status) && tp::is_ok(b.status)));
  RC_ASSERT((tp::is_ok(all.status) && all.visible == a.visible + b.visible));
  const Eigen::Matrix<double, 9, 9> sum = a.s * a.s * a.H + b.s * b.s * b.H, whole = all.s * all.s * all.H;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j)
      RC_ASSERT(std::abs(sum(i, j) - whole(i, j)) <= 1e-4 * std::sqrt(whole(i, i) * whole(j, j)));
  const double squares =
      a.s * a.s + b.s * b.s + (a.mean - b.mean) * (a.mean - b.mean) * a.visible * b.visible / all.visible;
  RC_ASSERT(std::abs(all.s * all.s - squares) <= 1e-4 * squares + 1e-2);
}

// (t, theta) -> (s t, theta / s): the same rays. The kernels see the same homography, so powers of two change no bit of
// the cost; gradients scale as their parameters do.
RC_GTEST_PROP(Photometry, TheUnitOfLengthIsNotSeen, ()) {
  Drawn s;
  const TargetScope scope(any_target());
  const auto scale = frozen(s, s.input());
  const auto before = tp::linearise<tp::Parameters::pose_plane>(s.request(), s.workspace);
  RC_PRE(tp::is_ok(before.status));
  const bool power_of_two = integer(0, 1) == 0;
  const double factor = power_of_two ? std::ldexp(1.0, integer(-8, 8)) : number(0.01, 100);
  tp::SE3d T = s.T_t_h;
  T.t *= factor;
  auto after = tp::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{s.input(), s.theta / factor, T, s.options},
                                                         s.workspace);
  if (power_of_two) RC_ASSERT((after.cost == before.cost && after.mean == before.mean && after.s == before.s));
  Eigen::Matrix<double, 9, 1> units = Eigen::Matrix<double, 9, 1>::Ones();
  units.head<3>() *= factor;  // d / dv has the unit 1 / length, d / dtheta that of a length.
  units.tail<3>() /= factor;
  after.H = Eigen::Matrix<double, 9, 9>(units.asDiagonal() * after.H * units.asDiagonal());
  after.b = Eigen::Matrix<double, 9, 1>(units.asDiagonal() * after.b);
  RC_ASSERT(close<9>(after, before, scale));
}

// b = J^T W r with d cost = 2 b . dp, for every parameter of both poses and the plane; by the double reference, whose
// cost can be differentiated numerically. That the kernels have the reference's sums is another test.
RC_GTEST_PROP(Photometry, BIsHalfTheGradientOfTheCost, ()) {
  Drawn s;
  s.options.normalisation = tp::Normalisation::exact;
  // Pixels on a line between two pixels have no derivative, and Huber's cost has no second one.
  std::vector<float> kept[3];
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const tp::Vector2<double> at = s.seen_at(s.x[i], s.y[i]);
    const double dx = at[0] - std::floor(at[0]), dy = at[1] - std::floor(at[1]);
    if (std::min({dx, dy, 1 - dx, 1 - dy}) < 0.02 || !s.image.view().contains(at[0], at[1])) continue;
    kept[0].push_back(s.x[i]);
    kept[1].push_back(s.y[i]);
    kept[2].push_back(s.intensity[i]);
  }
  RC_PRE(kept[0].size() >= 20U);
  std::swap(s.x, kept[0]);
  std::swap(s.y, kept[1]);
  std::swap(s.intensity, kept[2]);
  s.options.robust.kind = integer(0, 1) == 0 ? tp::RobustKind::l2 : tp::RobustKind::cauchy;
  const tp::SE3d T_w_h = pose(2, 2), T_w_t = T_w_h * s.T_t_h.inverse();
  const auto side = integer(0, 1) == 0 ? tp::PerturbationSide::left : tp::PerturbationSide::right;
  const auto e = tp::reference::linearise<tp::Parameters::host_target_plane>(
      tp::world_request(s.input(), s.theta, T_w_h, T_w_t, side, s.options), s.workspace);
  RC_PRE((tp::is_ok(e.status) && e.visible == s.n()));
  using Vector15 = Eigen::Matrix<double, 15, 1>;
  const auto cost = [&](const Vector15& p) {
    const tp::SE3d host = tp::se3_exp<double>(tp::Vector6<double>(p.head<6>()));
    const tp::SE3d target = tp::se3_exp<double>(tp::Vector6<double>(p.segment<6>(6)));
    const bool left = side == tp::PerturbationSide::left;
    const tp::SE3d h = left ? host * T_w_h : T_w_h * host, t = left ? target * T_w_t : T_w_t * target;
    tp::ResidualRequest<std::uint8_t> request = s.request();
    request.theta += p.tail<3>();
    request.T_t_h = t.inverse() * h;
    const auto c = tp::reference::evaluate(request, s.workspace);
    return Eigen::Matrix<double, 1, 1>(c.cost);
  };
  const auto gradient = central_difference<1, 15>(cost, Vector15(Vector15::Zero()), 5e-6);
  const double size = gradient.cwiseAbs().maxCoeff();
  RC_ASSERT((2 * e.b.transpose() - gradient).cwiseAbs().maxCoeff() <= 2e-6 * size + 1e-8);
}

// Whatever the policy, the cost is the same, and at a perfect match all derivatives of the residuals are.
RC_GTEST_PROP(Photometry, PoliciesDifferInDerivativesAlone, ()) {
  Drawn s;
  const TargetScope scope(any_target());
  const auto e = tp::linearise<tp::Parameters::pose>(s.request(), s.workspace);
  RC_PRE(tp::is_ok(e.status));
  for (const auto policy : {tp::LinearisePolicy::template_jacobian, tp::LinearisePolicy::esm}) {
    const auto p = tp::linearise<tp::Parameters::pose>(s.request().by(policy), s.workspace);
    RC_ASSERT((p.status == e.status && p.visible == e.visible));
    RC_ASSERT(
        (std::abs(p.cost - e.cost) <= 2e-5 * e.cost + 2e-6 && std::abs(p.error - e.error) <= 2e-5 * e.error + 2e-6));
  }
}

}  // namespace photometry_properties
}  // namespace textplane_test
