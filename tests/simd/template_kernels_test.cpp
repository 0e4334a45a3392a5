// Template-Jacobian kernels on every target: fixed-point values against the bilinear interpolant, exact sums, and
// normal equations against the double reference.
#include <cstring>

#include "simd/policy_support.hpp"

namespace template_kernels_test {
namespace tp = textplane;
using textplane_test::PolicyScene;
using textplane_test::Random;

struct Sums {
  std::vector<float> u, v;
  std::vector<std::int16_t> rows, values;
  tp::Image<std::uint8_t> image = textplane_test::texture<std::uint8_t>(97, 61, 4);
  tp::PreparedTarget pairs;
  tp::simd::TemplateArgs args;

  explicit Sums(int n) : pairs(static_cast<const tp::Image<std::uint8_t>&>(image).view()) {
    Random random(static_cast<unsigned>(n));
    const int room = (n + 31) / 32 * 32;
    for (int i = 0; i < room; ++i) {
      u.push_back(i < n ? static_cast<float>(random.uniform(-30, 30)) : 0.0F);
      v.push_back(i < n ? static_cast<float>(random.uniform(-20, 20)) : 0.0F);
    }
    rows.assign(static_cast<std::size_t>(room) * 9, 0);
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < 9; ++c)
        rows[static_cast<std::size_t>((i / 32 * 9 + c) * 32 + i % 32)] =
            static_cast<std::int16_t>(n % 5 == 0 ? 8191 : random.integer(-8191, 8191));
    values.assign(static_cast<std::size_t>(room), 77);
    args.u = u.data();
    args.v = v.data();
    args.rows = rows.data();
    args.n = n;
    args.target.data = image.data();
    args.target.stride = args.target.width = 97;
    args.target.height = 61;
    const float g[8] = {1.05F, 0.1F, 42.3F, -0.08F, 0.95F, 27.4F, 1e-3F, -8e-4F};
    std::copy(g, g + 8, args.g);
    args.ox = 4;
    args.oy = 2;
    args.values = values.data();
  }
  void use_pairs() {
    args.target.pairs = pairs.view().data;
    args.target.pair_stride = pairs.view().stride;
  }
};

TEST(TemplateKernels, ValuesAreWithinTheirBoundAndSumsExact) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    for (int n = 1; n <= 67; ++n) {
      Sums s(n <= 65 ? n : n == 66 ? 1000 : 20000);
      SCOPED_TRACE(s.args.n);
      for (const bool paired : {false, true}) {
        if (paired) s.use_pairs();
        tp::simd::TemplateSums sums;
        tp::simd::template_sums(s.args, sums);
        std::int64_t value = 0, square = 0, column[9] = {};
        for (int i = 0; i < s.args.n; ++i) {
          const auto k = static_cast<std::size_t>(i);
          const double p = static_cast<double>(s.u[k]), q = static_cast<double>(s.v[k]);
          const auto g = [&](int j) { return static_cast<double>(s.args.g[j]); };
          const double w = g(6) * p + g(7) * q + 1;
          double exact = 0;
          ASSERT_TRUE(tp::sample_bilinear(tp::ImageView8(s.image.data(), 97, 61),
                                          (g(0) * p + g(1) * q + g(2)) / w + s.args.ox,
                                          (g(3) * p + g(4) * q + g(5)) / w + s.args.oy, &exact));
          // 0.025 of the fixed point; float positions within 2e-5 px at gradients below 255 a px and axis.
          ASSERT_NEAR(s.values[k] / 64.0 + 127.5, exact, 0.025 + 2 * 255 * 2e-5) << i;
          value += s.values[k];
          square += s.values[k] * s.values[k];
          for (int c = 0; c < 9; ++c)
            column[c] += s.values[k] * s.rows[static_cast<std::size_t>((i / 32 * 9 + c) * 32 + i % 32)];
        }
        for (std::size_t i = static_cast<std::size_t>(s.args.n); i < s.values.size(); ++i) EXPECT_EQ(s.values[i], 0);
        EXPECT_EQ(sums.value, value);
        EXPECT_EQ(sums.square, square);
        for (int c = 0; c < 9; ++c) EXPECT_EQ(sums.column[c], column[c]) << c;
        tp::simd::TemplateSums correlation;
        tp::simd::template_correlation(s.args, correlation);
        EXPECT_EQ(correlation.value, value);
        EXPECT_EQ(correlation.square, square);
        EXPECT_EQ(correlation.column[0], column[0]);
        EXPECT_EQ(correlation.column[8], 0);
      }
    }
  }
}

// A position on the grid of 2^-15 px is not rounded. Two roundings to the unit of V are left, of half of it each,
// however much neighbouring pixels differ.
TEST(TemplateKernels, PositionsOnTheGridAreKept) {
  Random random(6);
  Sums s(1000);
  for (int y = 0; y < 61; ++y)
    for (int x = 0; x < 97; ++x) s.image(x, y) = static_cast<std::uint8_t>(255 * random.integer(0, 1));
  constexpr int kGrid = 32768;
  for (float& u : s.u) u = static_cast<float>(random.integer(-30 * kGrid, 30 * kGrid)) / kGrid;
  for (float& v : s.v) v = static_cast<float>(random.integer(-20 * kGrid, 20 * kGrid)) / kGrid;
  const float g[8] = {1, 0, 42, 0, 1, 27, 0, 0};
  std::copy(g, g + 8, s.args.g);
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    tp::simd::TemplateSums sums;
    tp::simd::template_sums(s.args, sums);
    for (std::size_t i = 0; i < 1000; ++i) {
      double exact = 0;
      ASSERT_TRUE(tp::sample_bilinear(tp::ImageView8(s.image.data(), 97, 61), static_cast<double>(s.u[i]) + 46,
                                      static_cast<double>(s.v[i]) + 29, &exact));
      ASSERT_NEAR(s.values[i], 64 * (exact - 127.5), 1 + 1e-9) << i;
    }
  }
}

// Two vectors share a division, so positions differ by a rounding between targets; values by no more than two units of
// 1/64.
TEST(TemplateKernels, TargetsAgree) {
  Sums first(777), other(777);
  tp::simd::TemplateSums sums;
  {
    const textplane_test::TargetScope scope(tp::simd::Target::scalar);
    tp::simd::template_sums(first.args, sums);
  }
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    tp::simd::template_sums(other.args, sums);
    for (std::size_t i = 0; i < first.values.size(); ++i) EXPECT_LE(std::abs(first.values[i] - other.values[i]), 2);
  }
}

TEST(TemplateKernels, PositionsOutsideTheImageReadNothingOutside) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    Sums s(64);
    // An image of its own that ends where its memory does: the address sanitiser sees a byte too much.
    std::vector<std::uint8_t> tight(97 * 61);
    std::memcpy(tight.data(), s.image.data(), tight.size());
    s.args.target.data = tight.data();
    tp::simd::TemplateSums sums;
    for (const float bad : {0.0F, 1e4F, -1e4F, 1e30F, std::nanf("")}) {
      s.args.g[2] = s.args.g[5] = bad;
      tp::simd::template_sums(s.args, sums);
    }
    for (const std::int16_t value : s.values) EXPECT_LE(std::abs(value), 8160);
  }
}

TEST(TemplateKernels, NormalEquations) {
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    SCOPED_TRACE(tp::simd::to_string(target));
    for (int n = 15; n <= 66; ++n) {
      PolicyScene scene(static_cast<unsigned>(1 + n % 7), n < 66 ? n : 900);
      SCOPED_TRACE(scene.n());
      const tp::PhotometricInput in = scene.policy_input();
      tp::TemplatePatch prepared;
      ASSERT_EQ(prepared.prepare(in.patch), tp::Status::ok);
      for (const auto& o : textplane_test::all_options(15)) {
        const auto policy = tp::LinearisePolicy::template_jacobian;
        const auto reference = tp::reference::linearise<tp::Parameters::pose_plane>(
            tp::ResidualRequest{in, scene.theta, scene.T_t_h, o}.by(policy), scene.workspace);
        const double sigma = reference.s / std::sqrt(reference.visible);
        ASSERT_GT(sigma, 30);
        // Of the fixed point: 0.08 / sigma (template_patch.hpp), sigma of the host being larger here.
        const auto fast = tp::linearise<tp::Parameters::pose_plane>(
            tp::ResidualRequest{in, scene.theta, scene.T_t_h, o}.by(policy, &prepared), scene.workspace);
        textplane_test::expect_close<9>(fast, reference, 0.08 / 30);
        // On average far below: 1.5e-4 is a tenth of a grey level's share.
        EXPECT_LT((fast.H - reference.H).norm(), 2e-3 * reference.H.norm());
        // A value's own bound, as above.
        EXPECT_NEAR(fast.mean, reference.mean, 0.025 + 2 * 255 * 2e-5);
        EXPECT_NEAR(fast.s, reference.s, (0.025 + 2 * 255 * 2e-5) * std::sqrt(reference.visible));
      }
    }
  }
}

// The host seen again, with the same gain or another: the gradient vanishes exactly, whatever the columns were rounded
// to.
TEST(TemplateKernels, RoundedColumnsDoNotMoveTheFixedPoint) {
  const auto image = textplane_test::texture<std::uint8_t>(120, 90, 9);
  const tp::Pyramid pyramid(image.view(), 1);
  const tp::Pinhole<double> camera(128, 128, 60, 45);  // powers of two: the warp is exact
  std::vector<std::vector<tp::Vector2<float>>> pixels(1);
  for (int y = 20; y < 60; ++y)
    for (int x = 30; x < 90; ++x) pixels[0].push_back({static_cast<float>(x), static_cast<float>(y)});
  tp::Quad<double> quad;
  quad.corner = {tp::Vector2<double>(30, 20), tp::Vector2<double>(89, 20), tp::Vector2<double>(89, 59),
                 tp::Vector2<double>(30, 59)};
  const tp::TextPatch patch = tp::patch_from_pixels(pyramid.view(), camera, quad, pixels);
  tp::TemplatePatch prepared;
  ASSERT_EQ(prepared.prepare(patch.levels[0].view()), tp::Status::ok);
  tp::PhotometricInput in = tp::photometric_input(patch, 0, pyramid.view(), camera);
  tp::PhotometricWorkspace workspace(in.patch.n);
  for (const tp::simd::Target target : textplane_test::testable_targets()) {
    const textplane_test::TargetScope scope(target);
    for (const auto& o : textplane_test::all_options(15)) {
      const auto e = tp::linearise<tp::Parameters::pose_plane>(
          tp::ResidualRequest{in, {0, 0, 1}, tp::SE3d(), o}.by(tp::LinearisePolicy::template_jacobian, &prepared),
          workspace);
      ASSERT_EQ(e.status, tp::Status::ok);
      EXPECT_EQ(e.visible, in.patch.n);
      EXPECT_NEAR(e.error, 0, 1e-12);
      // The scale direction of (v, theta) has H_ii > 0 each, so this is 1e-9 of a step of 1 in the unit of each
      // parameter.
      for (int i = 0; i < 9; ++i) EXPECT_NEAR(e.b[i], 0, 1e-9 * std::sqrt(e.H(i, i)));
    }
  }
}

TEST(TemplateKernels, PartOfThePatchVisibleTakesTheSumsOfWhatIs) {
  PolicyScene scene(5, 300);
  const tp::PhotometricInput in = scene.policy_input();
  tp::TemplatePatch prepared;
  ASSERT_EQ(prepared.prepare(in.patch), tp::Status::ok);
  textplane_test::move_half_out(&scene);
  const auto policy = tp::LinearisePolicy::template_jacobian;
  for (const auto& o : textplane_test::all_options(15)) {
    const auto reference = tp::reference::linearise<tp::Parameters::pose>(
        tp::ResidualRequest{in, scene.theta, scene.T_t_h, o}.by(policy), scene.workspace);
    const auto fast = tp::linearise<tp::Parameters::pose>(
        tp::ResidualRequest{in, scene.theta, scene.T_t_h, o}.by(policy, &prepared), scene.workspace);
    textplane_test::expect_close<6>(fast, reference, 3e-5);
  }
}

TEST(TemplateKernels, StatusOfPreparing) {
  PolicyScene scene(1, 40);
  tp::TemplatePatch prepared;
  EXPECT_EQ(prepared.prepare(scene.policy_input(true).patch), tp::Status::invalid_argument);
  EXPECT_EQ(prepared.prepare(scene.input().patch), tp::Status::invalid_argument);
  tp::PatchView patch = scene.policy_input().patch;
  patch.n = 0;
  EXPECT_EQ(prepared.prepare(patch), tp::Status::too_few);
  patch.n = 40;
  scene.gy[3] = std::nanf("");
  EXPECT_EQ(prepared.prepare(patch), tp::Status::non_finite);
  EXPECT_FALSE(prepared.ready());
  scene.gy[3] = 0;
  const std::vector<float> flat(40, 80.0F);
  patch.intensity = flat.data();
  EXPECT_EQ(prepared.prepare(patch), tp::Status::no_contrast);
}

}  // namespace template_kernels_test
