// The reference's normal equations by pose and plane, and their comparison.
#ifndef TEXTPLANE_TESTS_PHOTOMETRY_RESIDUAL_COMPARISON_HPP
#define TEXTPLANE_TESTS_PHOTOMETRY_RESIDUAL_COMPARISON_HPP

#include <gtest/gtest.h>

#include "photometry/scene.hpp"
#include "textplane/photometry/residual.hpp"

namespace textplane_test {

template <class T>
tp::NormalEquations<9> linearise(Scene<T>& scene, const tp::BasicPhotometricInput<T>& input,
                                 const tp::PhotometricOptions& options = {}) {
  return tp::reference::linearise<tp::Parameters::pose_plane>(
      tp::ResidualRequest{input, scene.theta, scene.T_t_h, options}, scene.workspace);
}

inline void expect_same(const tp::NormalEquations<9>& a, const tp::NormalEquations<9>& b, double tolerance) {
  ASSERT_EQ(a.status, tp::Status::ok);
  ASSERT_EQ(b.status, tp::Status::ok);
  EXPECT_EQ(a.visible, b.visible);
  EXPECT_LT((a.H - b.H).norm(), tolerance * a.H.norm());
  EXPECT_LT((a.b - b.b).norm(), tolerance * a.b.norm());
  EXPECT_NEAR(a.cost, b.cost, tolerance);
  EXPECT_NEAR(a.error, b.error, tolerance);
}
}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_PHOTOMETRY_RESIDUAL_COMPARISON_HPP
