// Costs and weights of single residuals on every target against the double definition.
#include <gtest/gtest.h>

#include <cmath>

#include "support/targets.hpp"
#include "textplane/simd/robust.hpp"

#define TEXTPLANE_SIMD_KERNEL "simd/ops/robust_ops_kernel.inl"
#include "textplane/simd/foreach_target.inl"

namespace robust_ops_test {
namespace simd = textplane::simd;
using textplane::Robust;
using textplane::RobustKind;

void robust_costs(RobustKind kind, double delta, const float* squares, float* rho,
                  float* root){TEXTPLANE_SIMD_DISPATCH(robust_costs(kind, delta, squares, rho, root))}

TEST(RobustOps, CostsAndWeights) {
  for (const simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(simd::to_string(target));
    for (const RobustKind kind : {RobustKind::cauchy, RobustKind::tukey})
      for (const double delta : {1e-3, 0.1, 0.7, 3.0, 1e3})
        for (double e = 1e-4; e < 1e3; e *= 1.07) {
          float squares[16], rho[16], root[16];
          for (int i = 0; i < 16; ++i) squares[i] = static_cast<float>(e * e * (1 + 0.008 * i));
          robust_costs(kind, delta, squares, rho, root);
          const Robust robust{kind, delta};
          for (int i = 0; i < simd::lanes(target); ++i) {
            const double square = static_cast<double>(squares[i]), weight = robust.weight(square);
            EXPECT_NEAR(static_cast<double>(rho[i]), robust.rho(square), 1e-6 * robust.rho(square)) << square;
            EXPECT_NEAR(static_cast<double>(root[i]), std::sqrt(weight), 5e-7) << square;
            if (kind == RobustKind::cauchy) {
              EXPECT_NEAR(static_cast<double>(root[i]), std::sqrt(weight), 5e-7 * std::sqrt(weight));
            }
          }
        }
  }
}

// No residual at all, infinite ones, and deltas at the ends of what Robust::valid() lets through: numbers, and weights
// in [0, 1].
TEST(RobustOps, ExtremesStayNumbers) {
  for (const simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    for (const RobustKind kind : {RobustKind::cauchy, RobustKind::tukey})
      for (const double delta : {1e-100, 1e-12, 1.0, 1e12, 1e100})
        for (const float square : {0.0F, 1e-30F, 1.0F, 1e20F}) {
          float squares[16], rho[16], root[16];
          for (float& s : squares) s = square;
          robust_costs(kind, delta, squares, rho, root);
          EXPECT_TRUE(std::isfinite(rho[0]) && rho[0] >= 0 && root[0] >= 0 && root[0] <= 1.0000003F)
              << square << ' ' << delta << ' ' << rho[0] << ' ' << root[0];
          if (square == 0.0F) {
            EXPECT_EQ(rho[0], 0.0F);
          }
        }
  }
}

}  // namespace robust_ops_test
