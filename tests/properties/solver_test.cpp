// Laws of minimise() and refine_pose() at drawn problems: accepted steps lower the cost, the best state seen is
// returned, and the unit of length does not matter.
#include <cmath>
#include <memory>
#include <vector>

#include "properties/properties.hpp"
#include "support/calculus.hpp"
#include "textplane/solver/gauss_newton.hpp"
#include "textplane/solver/pose.hpp"

namespace textplane_test {
namespace solver_properties {

const tp::Pinhole<double> kCamera{260, 255, 160.3, 118.9};

// Checks what minimise() promises of every step, and passes on to the problem.
template <class Problem>
struct Watched {
  using State = typename Problem::State;
  static constexpr int kParameters = Problem::kParameters;
  Problem& problem;
  double before = -1;  // Cost at the last linearisation that stood.
  double trial = -1;   // Cost of the last trial.
  double most_lost = 0.1;
  int taken = 0;
  double sum = 0;

  auto linearise(const State& x) {
    if (trial >= 0) {  // The trial is taken, or is tried to be.
      RC_ASSERT(trial < before);
      sum += before - trial;
      ++taken;
      trial = -1;
    }
    auto system = problem.linearise(x);
    before = system.cost;
    return system;
  }
  tp::Evaluation evaluate(const State& x) {
    const tp::Evaluation e = problem.evaluate(x);
    trial = tp::is_ok(e.status) && e.lost_fraction <= most_lost && e.cost < before ? e.cost : -1;
    return e;
  }
  State retract(const State& x, const Eigen::Matrix<double, kParameters, 1>& step) const {
    return problem.retract(x, step);
  }
};

// A textured sign, its target, and points.
struct Drawn {
  tp::Image<std::uint8_t> host{320, 240}, target{320, 240};
  std::unique_ptr<tp::Pyramid> host_pyramid, target_pyramid;
  tp::SE3d truth = pose(0.1, 0.08), start;
  tp::TextPatch patch;
  std::vector<tp::PoseTextTerm> texts;
  std::vector<tp::PosePointTerm> points;
  tp::PoseWorkspace workspace;
  tp::PoseOptions options;

  Drawn() {
    Random random(seed());
    const tp::Vector3<double> theta = plane(1.5, 3);
    double wave[6][3];
    for (auto& w : wave) {
      const double length = random.uniform(12, 60), angle = random.uniform(0, 3.14);
      w[0] = 6.28 / length * std::cos(angle);
      w[1] = 6.28 / length * std::sin(angle);
      w[2] = random.uniform(0, 6.28);
    }
    const auto texture = [&](double x, double y) {
      double value = 128;
      for (const auto& w : wave) value += 18 * std::sin(w[0] * x + w[1] * y + w[2]);
      return value;
    };
    const tp::Matrix3<double> back =
        tp::pixel_homography<double>(tp::plane_homography(theta, truth), kCamera, kCamera).inverse();
    const double gain = number(0.6, 1), bias = number(0, 30);
    for (int y = 0; y < 240; ++y)
      for (int x = 0; x < 320; ++x) {
        host(x, y) = static_cast<std::uint8_t>(texture(x, y) + 0.5);
        const tp::Vector3<double> q = back * tp::Vector3<double>(x, y, 1);
        target(x, y) =
            static_cast<std::uint8_t>(gain * texture(q[0] / q[2], q[1] / q[2]) + bias + random.uniform(0, 4));
      }
    host_pyramid = std::make_unique<tp::Pyramid>(host.view(), 3);
    target_pyramid = std::make_unique<tp::Pyramid>(target.view(), 3);
    std::vector<std::vector<tp::Vector2<float>>> pixels(3);
    for (int l = 0; l < 3; ++l)
      for (int i = 0; i < 160; ++i)
        pixels[static_cast<std::size_t>(l)].push_back(
            {static_cast<float>(std::floor(random.uniform(100, 220) / (1 << l))),
             static_cast<float>(std::floor(random.uniform(80, 160) / (1 << l)))});
    tp::Quad<double> quad;
    quad.corner = {tp::Vector2<double>(100, 80), tp::Vector2<double>(220, 80), tp::Vector2<double>(220, 160),
                   tp::Vector2<double>(100, 160)};
    patch = tp::patch_from_pixels(host_pyramid->view(), kCamera, quad, pixels);
    const int what = integer(0, 2);
    if (what != 0) texts.push_back({&patch, theta, tp::SE3d(), 1});
    for (int i = what == 1 ? 40 : integer(0, 40); i < 40; ++i) {
      tp::PosePointTerm p;
      const tp::Vector2<double> px(random.uniform(0, 319), random.uniform(0, 239));
      p.p_w = truth.inverse() * tp::Vector3<double>(random.uniform(1, 6) * kCamera.unproject(px));
      p.px = px + random.vector<2>(random.uniform(0, 1) < 0.2 ? 30 : 1);
      p.sigma = random.uniform(0.5, 3);
      points.push_back(p);
    }
    // From where it recovers to where it cannot.
    start = tp::se3_exp<double>(std::pow(10.0, number(-4, -0.7)) * vector<6>(1)) * truth;
    workspace.reserve(texts.data(), static_cast<int>(texts.size()), static_cast<int>(points.size()));
    options.policy = static_cast<tp::LinearisePolicy>(integer(0, 3));
    options.solve.max_iterations = integer(0, 12);
  }
};

RC_GTEST_PROP(Steps, AcceptedOnesLowerTheCostAndAddUp, ()) {
  Drawn s;
  const tp::PyramidView view = s.target_pyramid->view();
  tp::detail::PoseProblem<tp::PyramidView> problem(s.texts.data(), static_cast<int>(s.texts.size()), s.points.data(),
                                                   static_cast<int>(s.points.size()), view, kCamera, s.options,
                                                   s.workspace);
  problem.set_level(integer(0, 2));
  Watched<tp::detail::PoseProblem<tp::PyramidView>> watched{problem};
  tp::SE3d T = s.start;
  tp::detail::PoseSystem system;
  const tp::SolveSummary sum = tp::minimise(watched, T, s.options.solve, &system);
  RC_ASSERT((sum.iterations <= s.options.solve.max_iterations && sum.accepted <= sum.iterations));
  RC_ASSERT(sum.reduction >= 0);
  if (!tp::is_ok(sum.status) && sum.status != tp::Status::diverged) {
    RC_ASSERT((T.R == s.start.R && T.t == s.start.t));
    return;
  }
  RC_ASSERT(sum.accepted <= watched.taken);
  if (sum.accepted == watched.taken) RC_ASSERT(std::abs(sum.reduction - watched.sum) <= 1e-9 * (1 + watched.sum));
  if (sum.accepted == 0) RC_ASSERT((T.R == s.start.R && T.t == s.start.t));
  // What is given back is of the state that is given back.
  RC_ASSERT(system.cost == sum.final_cost);
  RC_ASSERT(problem.linearise(T).cost == sum.final_cost);
  if (s.texts.empty()) {  // Points may be lost only behind the camera, and are not here.
    RC_ASSERT(sum.final_cost <= sum.initial_cost);
    RC_ASSERT(std::abs(sum.initial_cost - sum.final_cost - sum.reduction) <= 1e-9 * (1 + sum.initial_cost));
  }
}

RC_GTEST_PROP(Steps, ThePoseDoesNotKnowTheUnitOfLength, ()) {
  Drawn s;
  s.options.solve.max_iterations = 12;
  const int n = static_cast<int>(s.texts.size()), m = static_cast<int>(s.points.size());
  const auto solve = [&](const tp::SE3d& from) {
    return tp::refine_pose(s.texts.data(), n, s.points.data(), m, s.target_pyramid->view(), kCamera, from, s.options,
                           s.workspace);
  };
  s.options.solve.step_tolerance = 0;  // In units of the parameters, which change; on coarser levels it is never zero.
  s.options.coarsest_level = 0;
  const tp::PoseFit before = solve(s.start);
  const double unit = std::ldexp(1.0, integer(-6, 6));
  for (auto& t : s.texts) t.theta /= unit;
  for (auto& p : s.points) p.p_w *= unit;
  tp::SE3d scaled = s.start;
  scaled.t *= unit;
  const tp::PoseFit after = solve(scaled);
  RC_ASSERT(after.status == before.status);
  RC_ASSERT((after.texts == before.texts && after.inlier_points == before.inlier_points));
  RC_PRE(tp::is_ok(before.status));
  RC_ASSERT(std::abs(after.cost - before.cost) <= 1e-6 * before.cost + 1e-9);
  RC_ASSERT((after.T_t_w.t / unit - before.T_t_w.t).norm() < 1e-6);
  RC_ASSERT(largest(after.T_t_w.R - before.T_t_w.R) < 1e-6);
}

}  // namespace solver_properties
}  // namespace textplane_test
