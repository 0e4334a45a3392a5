// What the tests of the residual kernels share: options, and the comparison with the double reference.
#ifndef TEXTPLANE_TESTS_SIMD_RESIDUAL_SUPPORT_HPP
#define TEXTPLANE_TESTS_SIMD_RESIDUAL_SUPPORT_HPP

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "photometry/scene.hpp"
#include "support/targets.hpp"
#include "textplane/photometry/residual.hpp"

namespace textplane_test {

/// Any number of pixels, any contrast.
inline tp::PhotometricOptions any_options(bool exact = true, bool huber = true) {
  tp::PhotometricOptions o;
  o.min_visible = 1;
  o.min_contrast = 0;
  if (!exact) o.normalisation = tp::Normalisation::frozen;
  if (!huber) o.robust = {tp::RobustKind::l2, 1};
  return o;
}

/// The bound that simd/residual.hpp states on textures like these. H and b are differences of larger numbers where the
/// normalisation is exact, so their errors are measured by what they are without it, `frozen`: coordinates are good to
/// 1e-5 px, and intensities and gradients vary by some 5 % of themselves a px and more. Ten pixels average less than a
/// thousand.
constexpr double kEntryBound = 3e-5, kCostBound = 1e-5, kCostFloor = 1e-6;

/// Huber's weight delta / |e| of a pixel near the threshold is as uncertain as e is in units of delta.
inline double entry_bound(const tp::PhotometricOptions& o) {
  return o.robust.kind == tp::RobustKind::huber && o.robust.delta < 0.1 ? kEntryBound * 0.1 / o.robust.delta
                                                                        : kEntryBound;
}

template <int P>
void expect_close(const tp::NormalEquations<P>& fast, const tp::NormalEquations<P>& exact,
                  const tp::NormalEquations<P>& frozen, double bound = kEntryBound) {
  ASSERT_EQ(fast.status, exact.status) << to_string(fast.status) << " " << to_string(exact.status);
  EXPECT_EQ(fast.visible, exact.visible);
  if (!is_ok(exact.status)) {
    EXPECT_TRUE(all_zero(fast));
    return;
  }
  ASSERT_EQ(frozen.status, exact.status);
  for (int i = 0; i < P; ++i) {
    const double size = std::sqrt(frozen.H(i, i));
    EXPECT_NEAR(fast.b[i], exact.b[i], bound * size) << i;
    for (int j = 0; j < P; ++j) {
      EXPECT_NEAR(fast.H(i, j), exact.H(i, j), bound * size * std::sqrt(frozen.H(j, j))) << i << " " << j;
      EXPECT_EQ(fast.H(i, j), fast.H(j, i));
    }
  }
  EXPECT_NEAR(fast.cost, exact.cost, kCostBound * exact.cost + kCostFloor);
  EXPECT_NEAR(fast.error, exact.error, kCostBound * exact.error + kCostFloor);
  EXPECT_EQ(fast.zncc, 1 - 0.5 * fast.error);
  EXPECT_NEAR(fast.mean, exact.mean, 1e-3);
  EXPECT_NEAR(fast.s, exact.s, 1e-5 * exact.s + 1e-3);
}

/// linearise() of the library, or of the reference.
template <int P, bool kReference = false>
tp::NormalEquations<P> equations(const tp::PhotometricInput& in, const tp::Vector3<double>& theta, const tp::SE3d& T,
                                 const tp::PhotometricOptions& o, tp::PhotometricWorkspace& workspace) {
  const tp::ResidualRequest request{in, theta, T, o};
  return kReference ? tp::reference::linearise<unknowns<P>()>(request, workspace)
                    : tp::linearise<unknowns<P>()>(request, workspace);
}

/// Equations, visible sets and costs on every target against the reference, within `factor` times the bound.
template <int P>
void compare_equations(const tp::PhotometricInput& in, const tp::Vector3<double>& theta, const tp::SE3d& T,
                       const tp::PhotometricOptions& o, double factor = 1) {
  tp::PhotometricWorkspace exact_workspace(in.patch.n), workspace(in.patch.n);
  tp::PhotometricOptions held = o;
  held.normalisation = tp::Normalisation::frozen;
  const auto frozen = equations<P, true>(in, theta, T, held, workspace);
  const auto exact = equations<P, true>(in, theta, T, o, exact_workspace);
  for (const simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    SCOPED_TRACE(simd::to_string(target));
    const auto fast = equations<P>(in, theta, T, o, workspace);
    expect_close<P>(fast, exact, frozen, factor * entry_bound(o));
    for (int i = 0; i < in.patch.n; ++i) ASSERT_EQ(workspace.visible()[i], exact_workspace.visible()[i]) << i;
  }
}
inline void compare_cost(const tp::PhotometricInput& in, const tp::Vector3<double>& theta, const tp::SE3d& T,
                         const tp::PhotometricOptions& o, const std::uint8_t* on_set = nullptr) {
  tp::PhotometricWorkspace workspace(in.patch.n);
  const auto exact = tp::reference::evaluate(tp::ResidualRequest{in, theta, T, o}, workspace, on_set);
  for (const simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    SCOPED_TRACE(simd::to_string(target));
    const auto fast = tp::evaluate(tp::ResidualRequest{in, theta, T, o}, workspace, on_set);
    ASSERT_EQ(fast.status, exact.status) << to_string(fast.status) << " " << to_string(exact.status);
    EXPECT_EQ(fast.visible, exact.visible);
    EXPECT_EQ(fast.lost, exact.lost);
    EXPECT_NEAR(fast.cost, exact.cost, kCostBound * exact.cost + kCostFloor);
    EXPECT_NEAR(fast.error, exact.error, kCostBound * exact.error + kCostFloor);
    EXPECT_EQ(fast.zncc, is_ok(fast.status) ? 1 - 0.5 * fast.error : 0);
  }
}
inline void compare_all(const tp::PhotometricInput& in, const tp::Vector3<double>& theta, const tp::SE3d& T,
                        const tp::PhotometricOptions& o, double factor = 1) {
  compare_equations<3>(in, theta, T, o, factor);
  compare_equations<6>(in, theta, T, o, factor);
  compare_equations<9>(in, theta, T, o, factor);
  compare_cost(in, theta, T, o);
}

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SIMD_RESIDUAL_SUPPORT_HPP
