// The iteration of the convergence benchmarks: pose and plane of one object.
#ifndef TEXTPLANE_BENCH_KERNELS_ALIGN_HPP
#define TEXTPLANE_BENCH_KERNELS_ALIGN_HPP

#include <algorithm>
#include <vector>

#include "textplane/photometry/residual_policy.hpp"

namespace textplane_bench {

namespace tp = textplane;

struct Start {
  tp::SE3d T_t_h;
  tp::Vector3<double> theta;
};

/// Levenberg-Marquardt that linearises at each trial. It stops where a step promises less than `tolerance` of the cost,
/// and rejects a trial that loses more than a tenth of the visible pixels. (minimise() would refuse the problem: the
/// scale of t and 1 / theta is free.)
inline void align_level(const tp::PhotometricInput& in, const tp::TemplatePatch* prepared, tp::LinearisePolicy policy,
                        const tp::PhotometricOptions& options, double tolerance, tp::PhotometricWorkspace& workspace,
                        Start* s) {
  const auto linearise = [&](const Start& at) {
    return tp::linearise<tp::Parameters::pose_plane>(
        tp::ResidualRequest{in, at.theta, at.T_t_h, options}.by(policy, prepared), workspace);
  };
  double lambda = 1e-4, grow = 8;
  auto e = linearise(*s);
  for (int i = 0; i < 40 && is_ok(e.status); ++i) {
    auto H = e.H;
    H.diagonal() *= 1 + lambda;
    const tp::Ldlt<double, 9> ldlt(H);
    if (!ldlt.ok()) return;
    const Eigen::Matrix<double, 9, 1> step = -ldlt.solve(e.b);
    const double predicted = -step.dot(2 * e.b + e.H * step);
    if (predicted < tolerance * e.cost) return;
    const Start trial{tp::se3_exp<double>(step.head<6>()) * s->T_t_h, s->theta + step.tail<3>()};
    const auto next = linearise(trial);
    if (is_ok(next.status) && next.cost < e.cost && next.visible * 10 >= e.visible * 9) {
      const double gain = (e.cost - next.cost) / predicted, cube = 2 * gain - 1;
      lambda *= std::max(1.0 / 3, 1 - cube * cube * cube);
      grow = 8;
      *s = trial;
      e = next;
    } else {
      lambda *= grow;
      grow *= 2;
    }
  }
}

/// align_level() from coarse to fine, with its tolerances: a larger one is enough on coarse levels where the start is
/// near.
inline void align(const tp::TextPatch& patch, const std::vector<tp::TemplatePatch>& prepared, int levels,
                  const tp::PyramidView& target, const tp::Pinhole<double>& camera, tp::LinearisePolicy policy,
                  const tp::PhotometricOptions& options, double coarse_tolerance, double finest_tolerance,
                  tp::PhotometricWorkspace& workspace, Start* s) {
  for (int l = levels - 1; l >= 0; --l) {
    align_level(tp::photometric_input(patch, l, target, camera), &prepared[static_cast<std::size_t>(l)],
                tp::policy_at_level(policy, l, 0), options, l > 0 ? coarse_tolerance : finest_tolerance, workspace, s);
  }
}

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_KERNELS_ALIGN_HPP
