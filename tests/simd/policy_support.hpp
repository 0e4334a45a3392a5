// A patch with gradients and masks in a target, and how far normal equations may be from the reference.
#ifndef TEXTPLANE_TESTS_SIMD_POLICY_SUPPORT_HPP
#define TEXTPLANE_TESTS_SIMD_POLICY_SUPPORT_HPP

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "photometry/scene.hpp"
#include "support/targets.hpp"
#include "textplane/photometry/residual_policy.hpp"

namespace textplane_test {

struct PolicyScene : Scene<std::uint8_t> {
  std::vector<float> gx, gy;
  std::vector<std::uint8_t> mask;

  explicit PolicyScene(unsigned seed, int pixels) : PolicyScene(seed, pixels, nullptr, 1) {}
  PolicyScene(unsigned seed, int pixels, const tp::LensMap* target_lens, double zoom)
      : Scene<std::uint8_t>(seed, pixels, target_lens, zoom) {
    Random random(seed + 77);
    for (int i = 0; i < pixels; ++i) {
      gx.push_back(static_cast<float>(random.uniform(-40, 40)));
      gy.push_back(static_cast<float>(random.uniform(-40, 40)));
      mask.push_back(static_cast<std::uint8_t>(random.integer(0, 3) != 0));
    }
  }

  tp::PhotometricInput policy_input(bool masked = false) const {
    tp::PhotometricInput in = input();
    in.patch.gx = gx.data();
    in.patch.gy = gy.data();
    if (masked) in.patch.mask = mask.data();
    return in;
  }
};

/// The four combinations of normalisation and weights.
inline std::vector<tp::PhotometricOptions> all_options(int min_visible) {
  std::vector<tp::PhotometricOptions> all;
  for (const auto normalisation : {tp::Normalisation::exact, tp::Normalisation::frozen})
    for (const auto kind : {tp::RobustKind::l2, tp::RobustKind::huber}) {
      tp::PhotometricOptions o;
      o.normalisation = normalisation;
      o.robust.kind = kind;
      o.min_visible = min_visible;
      all.push_back(o);
    }
  return all;
}

/// H within `tolerance` of sqrt(H_ii H_jj), b within it of sqrt(H_ii), costs within it of 1; status and counts equal.
/// The H_ii are those of `scale`: of few pixels the projection leaves almost nothing, and rounding is that of what was
/// there before.
template <int P>
void expect_close(const tp::NormalEquations<P>& a, const tp::NormalEquations<P>& reference, double tolerance,
                  const tp::NormalEquations<P>& scale) {
  ASSERT_EQ(a.status, reference.status) << tp::to_string(a.status) << ' ' << tp::to_string(reference.status);
  if (!tp::is_ok(reference.status)) {
    EXPECT_TRUE(a.H.isZero(0) && a.b.isZero(0));
    return;
  }
  EXPECT_EQ(a.visible, reference.visible);
  EXPECT_NEAR(a.cost, reference.cost, tolerance);
  EXPECT_NEAR(a.error, reference.error, tolerance);
  for (int i = 0; i < P; ++i) {
    EXPECT_NEAR(a.b[i], reference.b[i], tolerance * std::sqrt(scale.H(i, i))) << i;
    for (int j = 0; j < P; ++j)
      EXPECT_NEAR(a.H(i, j), reference.H(i, j), tolerance * std::sqrt(scale.H(i, i) * scale.H(j, j))) << i << ' ' << j;
  }
}

template <int P>
void expect_close(const tp::NormalEquations<P>& a, const tp::NormalEquations<P>& reference, double tolerance) {
  expect_close<P>(a, reference, tolerance, reference);
}

/// Moves the pose aside until between a fifth and four fifths of the patch are visible.
inline void move_half_out(PolicyScene* scene) {
  for (int i = 0; i < 400; ++i) {
    const auto seen = tp::reference::evaluate(tp::ResidualRequest{scene->policy_input(), scene->theta, scene->T_t_h},
                                              scene->workspace);
    if (seen.visible < scene->n() * 4 / 5) break;
    scene->T_t_h.t[0] += 0.02;
  }
  const auto seen =
      tp::reference::evaluate(tp::ResidualRequest{scene->policy_input(), scene->theta, scene->T_t_h}, scene->workspace);
  ASSERT_GT(seen.visible, scene->n() / 5);
  ASSERT_LT(seen.visible, scene->n() * 4 / 5);
}

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SIMD_POLICY_SUPPORT_HPP
