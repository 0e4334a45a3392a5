// Values of the photometric residual: identities and invariance.
#include "photometry/residual_comparison.hpp"

namespace tp = textplane;
using textplane_test::expect_same;
using textplane_test::linearise;
using textplane_test::Random;
using textplane_test::Scene;

namespace residual_cost_test {

TEST(ResidualCost, IsZeroForTheSameImageAndIdentity) {
  Scene<std::uint8_t> scene(1);
  scene.T_t_h = tp::SE3d();
  scene.target_camera = scene.host_camera;
  for (std::size_t i = 0; i < scene.x.size(); ++i)
    scene.intensity[i] = scene.image(static_cast<int>(scene.x[i]), static_cast<int>(scene.y[i]));
  const auto sums = linearise(scene, scene.input());
  ASSERT_EQ(sums.status, tp::Status::ok);
  EXPECT_LT(sums.error, 1e-24);
  EXPECT_LT(sums.cost, 1e-24);
  EXPECT_NEAR(sums.zncc, 1, 1e-15);
  EXPECT_LT(sums.b.norm(), 1e-9 * sums.H.norm());
}

TEST(ResidualCost, IsFourForTheInvertedImage) {
  Scene<float> scene(2);
  for (std::size_t i = 0; i < scene.x.size(); ++i) {
    const tp::Vector2<double> at = scene.project(scene.x[i], scene.y[i]);
    double value = 0;
    tp::sample_bilinear(scene.view(), at[0], at[1], &value);
    scene.intensity[i] = static_cast<float>(255 - value);
  }
  const auto sums = linearise(scene, scene.input());
  ASSERT_EQ(sums.status, tp::Status::ok);
  EXPECT_NEAR(sums.error, 4, 1e-9);
  EXPECT_LE(sums.error, 4);
  EXPECT_NEAR(sums.zncc, -1, 1e-9);
}

TEST(ResidualCost, ErrorStaysInRangeAndGivesTheZncc) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    Scene<std::uint8_t> scene(seed);
    Random random(seed + 100);
    std::vector<double> target;
    for (std::size_t i = 0; i < scene.x.size(); ++i) {
      if (seed % 2) scene.intensity[i] = static_cast<float>(random.uniform(0, 255));
      const tp::Vector2<double> at = scene.project(scene.x[i], scene.y[i]);
      double value = 0;
      tp::sample_bilinear(scene.view(), at[0], at[1], &value);
      target.push_back(value);
    }
    const tp::PhotometricOptions options;
    const auto cost = tp::reference::evaluate(scene.request(options), scene.workspace);
    ASSERT_EQ(cost.status, tp::Status::ok);
    EXPECT_GE(cost.error, 0);
    EXPECT_LE(cost.error, 4);
    EXPECT_NEAR(cost.zncc, tp::zncc(scene.intensity.data(), target.data(), nullptr, scene.n()), 1e-12);
    EXPECT_EQ(cost.zncc, 1 - cost.error / 2);
    EXPECT_LT(cost.cost, cost.error);  // Huber, and there are outliers
    const auto sums = linearise(scene, scene.input());
    EXPECT_EQ(sums.cost, cost.cost);
    EXPECT_EQ(sums.error, cost.error);
  }
}

TEST(ResidualCost, DoesNotSeeGainAndBiasOfEitherImage) {
  // Factors and offsets that keep integers exact in a float.
  const double changes[][2] = {{1.25, 18}, {0.5, -3}, {3, 1000}, {0.0625, 7.5}};
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Scene<float> scene(seed);
    for (float& v : scene.intensity) v = std::floor(v);
    const tp::PhotometricOptions options;
    const auto before = linearise(scene, scene.input());
    std::vector<double> r(scene.x.size()), changed(scene.x.size());
    tp::reference::residuals<tp::Parameters::pose>(scene.request(options), scene.workspace, r.data(), nullptr);
    for (const auto& target : changes)
      for (const auto& host : changes) {
        Scene<float> other = scene;
        for (int y = 0; y < scene.kHeight; ++y)
          for (int x = 0; x < scene.kWidth; ++x)
            other.image(x, y) = static_cast<float>(target[0] * static_cast<double>(scene.image(x, y)) + target[1]);
        for (float& v : other.intensity) v = static_cast<float>(host[0] * static_cast<double>(v) + host[1]);
        expect_same(linearise(other, other.input()), before, 1e-9);
        tp::reference::residuals<tp::Parameters::pose>(other.request(options), other.workspace, changed.data(),
                                                       nullptr);
        for (std::size_t i = 0; i < r.size(); ++i) ASSERT_NEAR(changed[i], r[i], 1e-9);
      }
  }
}

TEST(ResidualCost, EightBitAndFloatImagesAgree) {
  Scene<std::uint8_t> bytes(5);
  Scene<float> floats(5);
  expect_same(linearise(bytes, bytes.input()), linearise(floats, floats.input()), 1e-15);
}
}  // namespace residual_cost_test
