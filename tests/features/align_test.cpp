#include "textplane/features/align.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <vector>

#include "features/synthetic.hpp"
#include "textplane/features/fast.hpp"
#include "textplane/features/select.hpp"

namespace align_test {

using namespace textplane;
using namespace textplane_test;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Image<std::uint8_t> textured() { return TexturedPlane(5).render(Matrix3d::Identity(), 320, 240, {}, 1); }

// T~ and J~ = (1/s) (I - 1 1^T/N - T~ T~^T) grad T written out in double on sample_bilinear().
TEST(PointPatch, IsTheNormalisedPatchWithItsProjectedGradient) {
  const Image<std::uint8_t> image = textured();
  Eigen::Matrix2f A;
  A << 0.9F, 0.2F, -0.15F, 1.1F;
  const Vector2f centre(100.3F, 80.7F);
  for (const int half : {1, 4, 7, 8, 10}) {
    PointPatch t;
    ASSERT_EQ(extract_point_patch(image.view(), centre, A, half, &t), Status::ok);
    const int side = 2 * half + 1, n = side * side;
    ASSERT_EQ(t.count(), n);
    const auto sample = [&](int i, int j) {
      const Vector2d p = centre.cast<double>() + A.cast<double>() * Vector2d(i, j);
      double v = 0;
      EXPECT_TRUE(sample_bilinear(image.view(), p[0], p[1], &v));
      return v;
    };
    Eigen::VectorXd T(n), gx(n), gy(n);
    for (int j = -half, k = 0; j <= half; ++j)
      for (int i = -half; i <= half; ++i, ++k) {
        T[k] = sample(i, j);
        gx[k] = 0.5 * (sample(i + 1, j) - sample(i - 1, j));
        gy[k] = 0.5 * (sample(i, j + 1) - sample(i, j - 1));
      }
    const double mean = T.mean(), s = (T.array() - mean).matrix().norm();
    const Eigen::VectorXd unit = (T.array() - mean).matrix() / s;
    const auto projected = [&](const Eigen::VectorXd& g) -> Eigen::VectorXd {
      return ((g.array() - g.mean()).matrix() - unit * unit.dot(g)) / s;
    };
    const Eigen::VectorXd jx = projected(gx), jy = projected(gy);
    // Samples are off by 0.01 grey level (warp_patch()) and rounded to 1/32, half differences of them rounded down to
    // it: to first order, what that does to mean, s, T~ and J~.
    const double root = std::sqrt(n), e = 0.01 + 1.0 / 64, eg = e + 1.0 / 64;
    const double g = std::max((gx.array() - gx.mean()).matrix().norm(), (gy.array() - gy.mean()).matrix().norm());
    EXPECT_NEAR(t.mean, mean, e);
    EXPECT_NEAR(t.s, s, root * e);
    for (int k = 0; k < n; ++k) {
      const int i = k % side, j = k / side;
      const double u = std::abs(unit[k]), j_k = std::max(std::abs(jx[k]), std::abs(jy[k]));
      const double bound = 1.05 * (2 + u * root) * e / s;
      const double j_bound =
          1.05 * ((2 + u * root) * eg / s + bound * g / s + u * (root * e / s) * g / s + j_k * root * e / s);
      EXPECT_NEAR(t.value(i, j), unit[k], bound);
      EXPECT_NEAR(t.jx(i, j), jx[k], j_bound);
      EXPECT_NEAR(t.jy(i, j), jy[k], j_bound);
    }
    const double j_norm = std::max(jx.norm(), jy.norm());
    const double dj = 1.05 * (root * eg / s + 2 * root * e * g / (s * s) + j_norm * root * e / s);
    const double h_bound = 2 * j_norm * dj + dj * dj;
    EXPECT_NEAR(t.hxx, jx.squaredNorm(), h_bound);
    EXPECT_NEAR(t.hyy, jy.squaredNorm(), h_bound);
    EXPECT_NEAR(t.hxy, jx.dot(jy), h_bound);
  }
}

TEST(PointPatch, RowSamplingEqualsPixelSamplingUpToTheBorders) {
  const Image<std::uint8_t> image = textured();
  const ImageView8 small(image.data(), 41, 37, image.view().stride());
  std::vector<std::uint8_t> tight;  // no byte behind the last pixel
  for (int y = 0; y < 37; ++y) tight.insert(tight.end(), small.row(y), small.row(y) + 41);
  const ImageView8 view(tight.data(), 41, 37);
  for (const int half : {3, 7, 9}) {
    const float h = static_cast<float>(half);
    for (const float x : {h + 1.0F, h + 1.25F, 20.0F, 20.6F, 39.0F - h - 0.3F, 39.0F - h})
      for (const float y : {h + 1.0F, h + 1.75F, 18.5F, 35.0F - h - 0.6F, 35.0F - h}) {
        PointPatch a, b;
        a.left = a.top = half;
        a.columns = a.rows = 2 * half + 1;
        ASSERT_EQ(detail::extract_upright_patch(view, x, y, &a), Status::ok) << x << " " << y;
        ASSERT_LE(std::max(std::abs(a.dx), std::abs(a.dy)), 1.0F / 128);
        ASSERT_EQ(extract_point_patch(view, {x - a.dx, y - a.dy}, Eigen::Matrix2f::Identity(), half, &b), Status::ok);
        // Two samples differ by at most 5/128 and 0.01: one rounds to 1/64 and down to 1/32, the other to 1/32.
        const double e = 5.0 / 128 + 0.01, root = std::sqrt(a.count());
        for (int j = 0; j < a.rows; ++j)
          for (int i = 0; i < a.columns; ++i) {
            const double u = std::abs(a.value(i, j));
            ASSERT_NEAR(a.value(i, j), b.value(i, j), 1.05 * (2 + u * root) * e / b.s);
            ASSERT_NEAR(a.mean, b.mean, e);
          }
        ASSERT_EQ(detail::extract_upright_patch(view, 39.1F - h, y, &a), Status::out_of_view);
      }
  }
}

// Done is done: begun again where it ended, the alignment stays within the two cells of 1/64 px among which its last
// steps may cycle, and a third for the start's rounding to the grid.
TEST(AlignTemplate, EndsWhereItStays) {
  Matrix3d to_target;
  to_target << 0.93, -0.22, 40.37, 0.18, 1.04, -25.61, 0, 0, 1;
  const Eigen::Matrix2f A = to_target.inverse().topLeftCorner<2, 2>().cast<float>();
  const TexturedPlane plane(11);
  const Image<std::uint8_t> host = plane.render(Matrix3d::Identity(), 480, 360, {}, 1);
  const Image<std::uint8_t> target = plane.render(to_target.inverse(), 480, 360, {0.8, 15, 0, 0, 12}, 2);
  std::vector<Corner> corners, spread;
  detect_fast(host.view(), 20, true, corners);
  select_spread(corners, 480, 360, 24, 300, {}, spread);
  Random random(4);
  int converged = 0;
  for (const Corner& c : spread)
    for (const int half : {3, 5, 7}) {
      PointPatch t;
      if (extract_point_patch(host.view(), {c.x, c.y}, A, half, &t) != Status::ok) continue;
      const double right = random.uniform(-2, 2), down = random.uniform(-2, 2);
      const Vector2d start = TexturedPlane::apply(to_target, {c.x, c.y}) + Vector2d(right, down);
      const KltResult once = align_point_patch(t, target.view(), start.cast<float>());
      if (once.status != Status::converged) continue;
      const KltResult again = align_point_patch(t, target.view(), once.px);
      ++converged;
      EXPECT_EQ(again.status, Status::converged);
      EXPECT_LE((again.px - once.px).norm(), 3.0F / 64) << c.x << ' ' << c.y;
    }
  EXPECT_GT(converged, 300);
}

// What is left is interpolation, not convergence: a smaller epsilon, symmetric (ESM) gradients and cubic sampling of
// the template change nothing for the better. It grows in the few patches with little texture.
TEST(AlignTemplate, ReobservesAWarpedPatchToAFewHundredthsOfAPixel) {
  const int width = 480, height = 360;
  Matrix3d to_target;
  to_target << 0.93, -0.22, 40.37, 0.18, 1.04, -25.61, 0, 0, 1;
  const Eigen::Matrix2f A = to_target.inverse().topLeftCorner<2, 2>().cast<float>();
  Random random(3);
  int n = 0;
  std::vector<double> error;
  for (std::uint32_t seed = 11; seed <= 13; ++seed) {
    const TexturedPlane plane(seed);
    const Image<std::uint8_t> host = plane.render(Matrix3d::Identity(), width, height, {}, 1);
    const Image<std::uint8_t> target = plane.render(to_target.inverse(), width, height, {0.8, 15, 0, 0, 0}, 2);
    std::vector<Corner> corners, spread;
    detect_fast(host.view(), 20, true, corners);
    select_spread(corners, width, height, 24, 300, {}, spread);
    for (const Corner& c : spread) {
      const Vector2d truth = TexturedPlane::apply(to_target, {c.x, c.y});
      PointPatch t;
      if (extract_point_patch(host.view(), {c.x, c.y}, A, 7, &t) != Status::ok) continue;
      if (truth[0] < 12 || truth[1] < 12 || truth[0] > width - 13 || truth[1] > height - 13) continue;
      const Vector2d start = truth + Vector2d(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5));
      const KltResult r = align_point_patch(t, target.view(), start.cast<float>());
      ++n;
      if (!is_ok(r.status)) continue;
      EXPECT_GT(r.zncc, 0.9);
      error.push_back((r.px.cast<double>() - truth).norm());
    }
  }
  ASSERT_GT(n, 500);
  EXPECT_GE(static_cast<int>(error.size()), n * 97 / 100);
  std::sort(error.begin(), error.end());
  double mean = 0;
  for (const double e : error) mean += e / static_cast<double>(error.size());
  const double p99 = error[error.size() * 99 / 100];
  std::printf("%zu of %d aligned, mean %.4f px, p99 %.4f px, worst %.4f px\n", error.size(), n, mean, p99,
              error.back());
  EXPECT_LT(mean, 0.02);
  EXPECT_LT(p99, 0.05);
  EXPECT_LT(error.back(), 0.08);
}

// The smallest contrast that is asked for is enough, in a target that has more.
TEST(AlignTemplate, TheLeastContrastIsEnough) {
  const TexturedPlane plane(5);
  const Image<std::uint8_t> host = plane.render(Matrix3d::Identity(), 320, 240, {0.5, 20, 0, 0, 0}, 1),
                            target = plane.render(Matrix3d::Identity(), 320, 240, {1, 0, 0, 0, 0}, 2);
  PointPatch t;
  ASSERT_EQ(extract_point_patch(host.view(), {100, 100}, Eigen::Matrix2f::Identity(), 7, &t), Status::ok);
  KltOptions options;
  options.min_contrast = t.contrast();
  EXPECT_EQ(align_point_patch(t, target.view(), {100.4F, 99.7F}, options).status, Status::converged);
  options.min_contrast = std::nextafter(t.contrast(), 100.0F);
  EXPECT_EQ(align_point_patch(t, target.view(), {100.4F, 99.7F}, options).status, Status::no_contrast);
}

TEST(AlignTemplate, FailuresAreStatusesWithoutNan) {
  const Image<std::uint8_t> image = textured();
  PointPatch t, bad;
  const Eigen::Matrix2f I = Eigen::Matrix2f::Identity();
  ASSERT_EQ(extract_point_patch(image.view(), {100, 100}, I, 7, &t), Status::ok);
  EXPECT_EQ(extract_point_patch(image.view(), {3, 100}, I, 7, &bad), Status::out_of_view);
  EXPECT_EQ(align_point_patch(bad, image.view(), {50, 50}).status, Status::out_of_view);
  EXPECT_EQ(extract_point_patch(image.view(), {kNan, 100}, I, 7, &bad), Status::non_finite);
  EXPECT_EQ(extract_point_patch(image.view(), {1e30F, 100}, I, 7, &bad), Status::out_of_view);
  EXPECT_EQ(extract_point_patch(image.view(), {100, 100}, Eigen::Matrix2f::Zero(), 7, &bad), Status::degenerate);
  EXPECT_EQ(extract_point_patch(image.view(), {100, 100}, kNan * I, 7, &bad), Status::non_finite);
  EXPECT_EQ(extract_point_patch(image.view(), {100, 100}, I, 11, &bad), Status::invalid_argument);
  EXPECT_EQ(extract_point_patch(ImageView8(), {100, 100}, I, 7, &bad), Status::invalid_argument);

  EXPECT_EQ(align_point_patch(t, image.view(), {kNan, 50}).status, Status::non_finite);
  EXPECT_EQ(align_point_patch(t, image.view(), {kNan, 50}).px, Vector2f(0, 0));
  EXPECT_EQ(align_point_patch(t, image.view(), {2, 50}).status, Status::out_of_view);
  EXPECT_EQ(align_point_patch(t, image.view(), {1e30F, -1e30F}).status, Status::out_of_view);
  EXPECT_EQ(align_point_patch(t, ImageView8(), {50, 50}).status, Status::invalid_argument);
  EXPECT_EQ(align_point_patch(PointPatch(), image.view(), {50, 50}).status, Status::invalid_argument);
  const Image<std::uint8_t> flat(100, 100, 90);
  EXPECT_EQ(align_point_patch(t, flat.view(), {50, 50}).status, Status::no_contrast);
  EXPECT_EQ(extract_point_patch(flat.view(), {50, 50}, I, 7, &bad), Status::no_contrast);

  Image<std::uint8_t> edge(100, 100, 50);
  for (int y = 0; y < 100; ++y)
    for (int x = 50; x < 100; ++x) edge(x, y) = 200;
  ASSERT_EQ(extract_point_patch(edge.view(), {50, 50}, I, 7, &bad), Status::ok);
  EXPECT_EQ(align_point_patch(bad, edge.view(), {50, 50}).status, Status::rank_deficient);

  const KltResult wrong =
      align_point_patch(t, TexturedPlane(77).render(Matrix3d::Identity(), 100, 100, {}, 1).view(), {50, 50});
  EXPECT_FALSE(is_ok(wrong.status));
  EXPECT_TRUE(is_finite(wrong.zncc) && all_finite(wrong.px));
}

}  // namespace align_test
