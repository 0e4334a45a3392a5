#include "textplane/core/robust.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tp = textplane;
using tp::Robust;
using tp::RobustKind;

namespace robust_test {

constexpr RobustKind kKinds[] = {RobustKind::l2, RobustKind::huber, RobustKind::cauchy, RobustKind::tukey};

TEST(Robust, WeightAndCurvatureAreDerivativesOfRho) {
  for (const RobustKind kind : kKinds)
    for (const double delta : {0.3, 1.0, 2.7}) {
      const Robust robust{kind, delta};
      for (double r = 0.05; r < 3 * delta; r += 0.0371) {
        const double r2 = r * r, h = 1e-5 * r2;
        if (std::abs(r2 - delta * delta) <= h) continue;  // the second derivative jumps there
        const double slope = (robust.rho(r2 + h) - robust.rho(r2 - h)) / (2 * h);
        ASSERT_NEAR(robust.weight(r2), slope, 1e-8) << static_cast<int>(kind) << " at " << r << " of " << delta;
        const double bend = (robust.weight(r2 + h) - robust.weight(r2 - h)) / (2 * h);
        ASSERT_NEAR(robust.curvature(r2), bend, 1e-7 * (1 + std::abs(bend))) << static_cast<int>(kind) << " at " << r;
      }
    }
}

TEST(Robust, IsLeastSquaresNearZeroAndMonotonicBeyond) {
  for (const RobustKind kind : kKinds) {
    const Robust robust{kind, 0.8};
    EXPECT_EQ(robust.rho(0), 0);
    EXPECT_EQ(robust.weight(0), 1);
    EXPECT_NEAR(robust.rho(1e-8) / 1e-8, 1, 1e-7);
    double rho = 0, weight = 1;
    for (double r2 = 0; r2 < 9; r2 += 0.01) {
      EXPECT_GE(robust.rho(r2), rho);
      EXPECT_LE(robust.weight(r2), weight);
      EXPECT_GE(robust.weight(r2), 0);
      EXPECT_LE(robust.rho(r2), r2 * (1 + 1e-15));
      rho = robust.rho(r2);
      weight = robust.weight(r2);
    }
  }
}

TEST(Robust, IsContinuousAtDelta) {
  for (const RobustKind kind : {RobustKind::huber, RobustKind::tukey}) {
    const Robust robust{kind, 1.7};
    const double d2 = 1.7 * 1.7;
    EXPECT_NEAR(robust.rho(d2 * (1 - 1e-12)), robust.rho(d2 * (1 + 1e-12)), 1e-10);
    EXPECT_NEAR(robust.weight(d2 * (1 - 1e-12)), robust.weight(d2 * (1 + 1e-12)), 1e-10);
  }
}

TEST(Robust, HuberCostFollowsFromItsWeight) {
  const Robust robust{RobustKind::huber, 0.6};
  for (double r = 0; r < 4; r += 0.01) {
    const double w = robust.weight(r * r);
    EXPECT_NEAR(robust.rho(r * r), w * r * r * (2 - w), 1e-13);
  }
}

TEST(Robust, KnowsBadParameters) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const RobustKind kind : {RobustKind::huber, RobustKind::cauchy, RobustKind::tukey}) {
    EXPECT_TRUE((Robust{kind, 0.1}.valid()));
    for (const double delta : {0.0, -1.0, 1e-300, 1e300, nan, inf}) EXPECT_FALSE((Robust{kind, delta}.valid()));
  }
  EXPECT_TRUE((Robust{RobustKind::l2, nan}.valid()));
  EXPECT_FALSE((Robust{static_cast<RobustKind>(9), 1.0}.valid()));
}

}  // namespace robust_test
