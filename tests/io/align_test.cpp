// Alignment of positions and poses by a similarity.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "io/evaluate.hpp"
#include "io/random_similarity.hpp"

namespace textslam {
namespace io_align_test {

using random_similarity::Random;
using random_similarity::Vector;
using textplane::so3_exp;

double squared_error(const Similarity& s, const std::vector<Vector>& from, const std::vector<Vector>& to) {
  double sum = 0;
  for (std::size_t i = 0; i < from.size(); ++i) sum += (to[i] - s * from[i]).squaredNorm();
  return sum;
}

TEST(AlignPoints, RecoversRandomSimilarities) {
  Random random(11);
  for (int trial = 0; trial < 200; ++trial) {
    const Similarity truth = random.similarity();
    std::vector<Vector> from, to;
    for (int i = 0; i < 3 + trial % 20; ++i) {
      from.push_back(random.vector(5));
      if (trial % 3 == 0) from.back()[2] = 0.25;  // coplanar
      to.push_back(truth * from.back());
    }
    Similarity found;
    ASSERT_EQ(align_points(from, to, true, &found), Status::ok);
    EXPECT_NEAR(found.scale / truth.scale, 1, 1e-12);
    EXPECT_LT((found.R - truth.R).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_LT((found.t - truth.t).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_NEAR(found.R.determinant(), 1, 1e-12);
  }
}

TEST(AlignPoints, RigidKeepsTheScale) {
  Random random(5);
  Similarity truth = random.similarity();
  truth.scale = 1;
  std::vector<Vector> from, to;
  for (int i = 0; i < 10; ++i) {
    from.push_back(random.vector(2));
    to.push_back(truth * from.back());
  }
  Similarity found;
  ASSERT_EQ(align_points(from, to, false, &found), Status::ok);
  EXPECT_EQ(found.scale, 1);
  EXPECT_LT((found.R - truth.R).cwiseAbs().maxCoeff(), 1e-12);
}

// With noise there is no truth to compare with; the result must be a minimum: every small change costs.
TEST(AlignPoints, IsTheLeastSquaresMinimum) {
  Random random(23);
  for (int trial = 0; trial < 20; ++trial) {
    const Similarity truth = random.similarity();
    std::vector<Vector> from, to;
    for (int i = 0; i < 15; ++i) {
      from.push_back(random.vector(3));
      to.push_back(truth * from.back() + random.vector(0.3 * truth.scale));
    }
    Similarity best;
    ASSERT_EQ(align_points(from, to, true, &best), Status::ok);
    const double cost = squared_error(best, from, to);
    EXPECT_LE(cost, squared_error(truth, from, to));
    for (int parameter = 0; parameter < 7; ++parameter) {
      for (const double step : {-1e-4, 1e-4}) {
        Similarity other = best;
        if (parameter < 3) {
          Vector w = Vector::Zero();
          w[parameter] = step;
          other.R = so3_exp(w) * other.R;
        } else if (parameter < 6) {
          other.t[parameter - 3] += step;
        } else {
          other.scale *= 1 + step;
        }
        EXPECT_GT(squared_error(other, from, to), cost) << parameter;
      }
    }
  }
}

// A mirror image is where an unguarded SVD returns a reflection.
TEST(AlignPoints, NeverAReflection) {
  Random random(2);
  std::vector<Vector> from, to;
  for (int i = 0; i < 12; ++i) {
    from.push_back(random.vector(1));
    to.push_back(Vector(from.back()[0], from.back()[1], -from.back()[2]));
  }
  Similarity found;
  ASSERT_EQ(align_points(from, to, true, &found), Status::ok);
  EXPECT_NEAR(found.R.determinant(), 1, 1e-12);
  EXPECT_GT(found.scale, 0);
}

TEST(AlignPoints, LineAndHalfTurn) {
  std::vector<Vector> from, to;
  for (int i = 0; i < 5; ++i) {
    from.emplace_back(i, 0, 0);
    to.emplace_back(1 - 2.0 * i, 3, 0);
  }
  Similarity found;
  ASSERT_EQ(align_points(from, to, true, &found), Status::ok);
  EXPECT_NEAR(found.scale, 2, 1e-12);
  EXPECT_LT(squared_error(found, from, to), 1e-20);
}

TEST(AlignPoints, Refusals) {
  Similarity out;
  out.scale = 42;
  const Vector a(1, 2, 3), b(2, 2, 3), c(1, 5, 3);
  EXPECT_EQ(align_points({}, {}, true, &out), Status::too_few);
  EXPECT_EQ(align_points({a, b}, {a, b}, true, &out), Status::too_few);
  EXPECT_EQ(align_points({a, b, c}, {a, b}, true, &out), Status::too_few);
  EXPECT_EQ(align_points({a, a, a}, {a, b, c}, true, &out), Status::degenerate);
  EXPECT_EQ(align_points({a, b, c}, {b, b, b}, true, &out), Status::degenerate);
  const Vector third(1.0 / 3, 0.1, 0.7);  // whose mean is not exact
  EXPECT_EQ(align_points({third, third, third}, {a, b, c}, true, &out), Status::degenerate);
  const Vector bad(0, std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_EQ(align_points({a, b, bad}, {a, b, c}, true, &out), Status::non_finite);
  EXPECT_EQ(out.scale, 42) << "untouched";
}

SE3d random_pose(Random& random, double reach) { return {so3_exp(random.vector(3)), random.vector(reach)}; }

TEST(AlignPoses, FindsTheSimilarity) {
  Random random(31);
  for (const std::size_t n : {2U, 3U, 20U}) {
    const Similarity truth = random.similarity();
    std::vector<SE3d> from, to;
    for (std::size_t i = 0; i < n; ++i) {
      from.push_back(random_pose(random, 3));
      to.push_back(truth * from.back());
    }
    Similarity found;
    ASSERT_EQ(align_poses(from, to, &found), Status::ok) << n;
    EXPECT_NEAR(found.scale / truth.scale, 1, 1e-12);
    EXPECT_LT((found.R - truth.R).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_LT((found.t - truth.t).cwiseAbs().maxCoeff(), 1e-10);
  }
}

// Positions on a line do not tell the turn about it, the cameras' rotations do.
TEST(AlignPoses, PathOnALine) {
  Random random(32);
  const Similarity truth = random.similarity();
  const Vector direction = random.vector(1);
  std::vector<SE3d> from, to;
  for (int i = 0; i < 10; ++i) {
    from.push_back({so3_exp(random.vector(0.3)), i * direction});
    to.push_back(truth * from.back());
  }
  Similarity found;
  ASSERT_EQ(align_poses(from, to, &found), Status::ok);
  EXPECT_LT((found.R - truth.R).cwiseAbs().maxCoeff(), 1e-11);
}

// Where positions and rotations disagree, a tenth's share is the rotations'.
TEST(AlignPoses, PositionsCountForMost) {
  Random random(33);
  const double turn = 0.1;
  const Matrix3<double> by_positions = so3_exp(Vector(0, 0, turn));
  std::vector<SE3d> from, to;
  for (int i = 0; i < 50; ++i) {
    from.push_back(random_pose(random, 3));
    to.push_back({from.back().R, by_positions * from.back().t});
  }
  Similarity found;
  ASSERT_EQ(align_poses(from, to, &found), Status::ok);
  const double angle = std::atan2(found.R(1, 0), found.R(0, 0));
  EXPECT_GT(angle, 0.8 * turn);
  EXPECT_LT(angle, 0.99 * turn);
}

// What positions cannot say of the scale is left as it was.
TEST(AlignPoses, OnePlaceKeepsTheScale) {
  Random random(34);
  const SE3d a = random_pose(random, 2), b = random_pose(random, 2);
  Similarity found;
  found.scale = 3;
  ASSERT_EQ(align_poses({a}, {b}, &found), Status::ok);
  EXPECT_EQ(found.scale, 3);
  EXPECT_LT(((found * a).t - b.t).norm(), 1e-12);
  EXPECT_LT(((found * a).R - b.R).norm(), 1e-12);
  ASSERT_EQ(align_poses({a, a}, {b, b}, &found), Status::ok);
  EXPECT_EQ(found.scale, 3);
}

TEST(AlignPoses, Refusals) {
  Random random(35);
  Similarity out;
  out.scale = 42;
  const SE3d a = random_pose(random, 2), b = random_pose(random, 2);
  EXPECT_EQ(align_poses({}, {}, &out), Status::too_few);
  EXPECT_EQ(align_poses({a, b}, {a}, &out), Status::too_few);
  SE3d bad = a;
  bad.t[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(align_poses({a, bad}, {a, b}, &out), Status::non_finite);
  bad = a;
  bad.R(2, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(align_poses({a, b}, {bad, b}, &out), Status::non_finite);
  EXPECT_EQ(out.scale, 42);
}

}  // namespace io_align_test
}  // namespace textslam
