// The visible set of the photometric residual, and the judgement of trial steps on it.
#include <algorithm>
#include <limits>
#include <vector>

#include "photometry/residual_comparison.hpp"

namespace tp = textplane;
using textplane_test::expect_same;
using textplane_test::linearise;
using textplane_test::Random;
using textplane_test::Scene;

namespace visible_set_test {

// The patch without the pixels that `keep` leaves out.
struct Subset {
  std::vector<float> x, y, intensity;
  template <class Keep>
  Subset(const tp::PatchView& patch, const Keep& keep) {
    for (int i = 0; i < patch.n; ++i) {
      if (!keep(i)) continue;
      x.push_back(patch.x[i]);
      y.push_back(patch.y[i]);
      intensity.push_back(patch.intensity[i]);
    }
  }
  tp::PatchView view() const { return {x.data(), y.data(), intensity.data(), nullptr, static_cast<int>(x.size())}; }
};

// A scene whose target is cut down to `width` columns, so that the right part of the patch leaves it.
struct Cut {
  explicit Cut(unsigned seed) : scene(seed) {
    std::vector<double> columns;
    for (int i = 0; i < scene.n(); ++i) columns.push_back(column(i));
    std::sort(columns.begin(), columns.end());
    width = static_cast<int>(columns[static_cast<std::size_t>(scene.n()) * 2 / 3]) + 1;
    input = scene.input();
    input.target = {scene.image.data(), width, scene.image.height(), scene.kWidth};
  }
  double column(int i) const {
    return scene.project(scene.x[static_cast<std::size_t>(i)], scene.y[static_cast<std::size_t>(i)])[0];
  }
  bool inside(int i) const { return column(i) <= width - 1; }

  Scene<std::uint8_t> scene;
  int width = 0;
  tp::PhotometricInput input;
};
TEST(VisibleSet, MaskedPixelsDoNotCountOnEitherSide) {
  Scene<std::uint8_t> scene(6);
  std::vector<std::uint8_t> mask;
  for (int i = 0; i < scene.n(); ++i) mask.push_back(i % 3 ? 255 : 0);
  auto masked = scene.input(), subset = scene.input();
  masked.patch.mask = mask.data();
  const Subset kept(masked.patch, [&](int i) { return mask[static_cast<std::size_t>(i)] != 0; });
  subset.patch = kept.view();
  const auto actual = linearise(scene, masked);
  for (int i = 0; i < scene.n(); ++i) ASSERT_EQ(scene.workspace.visible()[i] != 0, i % 3 != 0);
  expect_same(actual, linearise(scene, subset), 0x1p-60);
  EXPECT_EQ(actual.visible, 80);
}

TEST(VisibleSet, AllMaskedIsTooFew) {
  Scene<std::uint8_t> scene(6);
  const std::vector<std::uint8_t> mask(scene.x.size(), 0);
  auto input = scene.input();
  input.patch.mask = mask.data();
  EXPECT_EQ(linearise(scene, input).status, tp::Status::too_few);
}

TEST(VisibleSet, PartlyVisiblePatchIsNormalisedOverWhatIsVisible) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Cut cut(seed);
    const auto actual = linearise(cut.scene, cut.input);
    ASSERT_EQ(actual.status, tp::Status::ok);
    for (int i = 0; i < cut.scene.n(); ++i) ASSERT_EQ(cut.scene.workspace.visible()[i] != 0, cut.inside(i));
    ASSERT_LT(actual.visible, cut.scene.n());
    const Subset kept(cut.input.patch, [&](int i) { return cut.inside(i); });
    auto whole = cut.scene.input();
    whole.patch = kept.view();
    expect_same(actual, linearise(cut.scene, whole), 0x1p-60);
  }
}

TEST(VisibleSet, ResidualsOfInvisiblePixelsAreZero) {
  Cut cut(3);
  const auto n = static_cast<std::size_t>(cut.scene.n());
  std::vector<double> r(n, 9), J(n * 6, 9);
  const auto summary = tp::reference::residuals<tp::Parameters::pose>(
      tp::ResidualRequest{cut.input, cut.scene.theta, cut.scene.T_t_h}, cut.scene.workspace, r.data(), J.data());
  ASSERT_EQ(summary.status, tp::Status::ok);
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    sum += r[i];
    double row = 0;
    for (std::size_t j = 0; j < 6; ++j) row += std::abs(J[i * 6 + j]);
    EXPECT_EQ(row != 0, cut.inside(static_cast<int>(i)));
    EXPECT_TRUE(cut.inside(static_cast<int>(i)) || r[i] == 0);
  }
  EXPECT_NEAR(sum, 0, 1e-13);  // both sides have zero mean over the visible set
}

TEST(VisibleSet, BorderIsInsideAndAHairBeyondIsNot) {
  // Unit cameras and identity: host pixels are target pixels, without rounding.
  const auto image = textplane_test::texture<std::uint8_t>(20, 10, 4);
  std::vector<float> x, y, intensity;
  for (int i = 0; i < 10; ++i)
    for (const float column : {0.0f, 19.0f, 19.0f + 1e-5f, -1e-5f}) {
      x.push_back(column);
      y.push_back(static_cast<float>(i));
      intensity.push_back(static_cast<float>(7 * i % 11) + column);
    }
  tp::PhotometricWorkspace workspace(40);
  tp::PhotometricInput input;
  input.patch = {x.data(), y.data(), intensity.data(), nullptr, 40};
  input.target = image.view();
  const auto sums =
      tp::reference::linearise<tp::Parameters::plane>(tp::ResidualRequest{input, {0, 0, 1}, {}}, workspace);
  ASSERT_EQ(sums.visible, 20);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(workspace.visible()[i], i % 4 < 2 ? 1 : 0);
}

TEST(VisibleSet, PixelsBeyondTheHorizonOfThePlaneAreBehind) {
  Scene<std::uint8_t> scene(8);
  scene.T_t_h = tp::SE3d();
  scene.theta = {0.5, 0, 0.0};  // inverse depth 0.5 u: only the right half of the host image looks at the plane
  const auto sums = linearise(scene, scene.input());
  ASSERT_EQ(sums.status, tp::Status::ok);
  for (int i = 0; i < scene.n(); ++i)
    EXPECT_EQ(scene.workspace.visible()[i] != 0, scene.x[static_cast<std::size_t>(i)] > scene.host_camera.cx);
}

TEST(VisibleSet, NonFiniteIntensitiesAndPositionsDoNotCount) {
  Scene<float> scene(9);
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  auto keep = [](int i) { return i != 3 && i != 5 && i != 8 && i != 10 && i != 11; };
  const Subset kept(scene.input().patch, keep);
  auto subset = scene.input();
  subset.patch = kept.view();
  const auto expected = linearise(scene, subset);
  scene.intensity[3] = nan;
  scene.intensity[5] = inf;
  scene.x[8] = nan;
  scene.y[10] = -inf;
  scene.x[11] = 3e38f;
  expect_same(linearise(scene, scene.input()), expected, 0x1p-60);
}

TEST(VisibleSet, NonFiniteTargetPixelsDoNotCount) {
  Scene<float> scene(10);
  const tp::Vector2<double> hit = scene.project(scene.x[0], scene.y[0]);
  const int hx = static_cast<int>(hit[0]), hy = static_cast<int>(hit[1]);
  const auto touches = [&](int i) {
    const tp::Vector2<double> at =
        scene.project(scene.x[static_cast<std::size_t>(i)], scene.y[static_cast<std::size_t>(i)]);
    const int dx = hx - static_cast<int>(at[0]), dy = hy - static_cast<int>(at[1]);
    return (dx == 0 || dx == 1) && (dy == 0 || dy == 1);
  };
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Scene<float> broken = scene;
    broken.image(hx, hy) = bad;
    const auto sums = linearise(broken, broken.input());
    ASSERT_EQ(sums.status, tp::Status::ok);
    EXPECT_LT(sums.visible, scene.n());
    for (int i = 0; i < scene.n(); ++i) EXPECT_EQ(broken.workspace.visible()[i] != 0, !touches(i));
  }
}

TEST(EvaluateOnSet, EqualsTheLinearisationWhereNothingIsLost) {
  Cut cut(4);
  const tp::PhotometricOptions options;
  const auto sums = linearise(cut.scene, cut.input, options);
  const auto cost = tp::reference::evaluate(tp::ResidualRequest{cut.input, cut.scene.theta, cut.scene.T_t_h, options},
                                            cut.scene.workspace, cut.scene.workspace.visible());
  EXPECT_EQ(cost.cost, sums.cost);
  EXPECT_EQ(cost.visible, sums.visible);
  EXPECT_EQ(cost.lost, 0);
}

TEST(EvaluateOnSet, ChargesTheLostAndIgnoresTheRest) {
  for (const tp::RobustKind kind : {tp::RobustKind::l2, tp::RobustKind::huber, tp::RobustKind::tukey}) {
    Scene<std::uint8_t> scene(12);
    const tp::PhotometricOptions options = [&] {
      tp::PhotometricOptions o;
      o.robust.kind = kind;
      return o;
    }();
    std::vector<std::uint8_t> on_set;
    for (int i = 0; i < scene.n(); ++i) on_set.push_back(i % 4 != 0);
    // The trial sees less of the image.
    std::vector<double> columns;
    for (std::size_t i = 0; i < scene.x.size(); ++i) columns.push_back(scene.project(scene.x[i], scene.y[i])[0]);
    std::vector<double> sorted = columns;
    std::sort(sorted.begin(), sorted.end());
    const int width = static_cast<int>(sorted[sorted.size() * 4 / 5]) + 1;
    auto trial = scene.input();
    trial.target = {scene.image.data(), width, scene.image.height(), scene.kWidth};
    linearise(scene, scene.input(), options);
    const std::vector<std::uint8_t> visible(scene.workspace.visible(), scene.workspace.visible() + scene.n());
    const auto cost = tp::reference::evaluate(tp::ResidualRequest{trial, scene.theta, scene.T_t_h, options},
                                              scene.workspace, on_set.data());

    const auto stays = [&](int i) {
      return on_set[static_cast<std::size_t>(i)] && columns[static_cast<std::size_t>(i)] <= width - 1;
    };
    const Subset kept(scene.input().patch, stays);
    auto subset = scene.input();
    subset.patch = kept.view();
    const auto remaining =
        tp::reference::evaluate(tp::ResidualRequest{subset, scene.theta, scene.T_t_h, options}, scene.workspace);
    const int set = 90;
    ASSERT_EQ(cost.status, tp::Status::ok);
    ASSERT_EQ(cost.visible, kept.view().n);
    ASSERT_EQ(cost.lost, set - kept.view().n);
    ASSERT_GT(cost.lost, 5);
    EXPECT_NEAR(cost.cost, remaining.cost + cost.lost * options.robust.rho(2.0) / set, 1e-14);
    EXPECT_EQ(cost.error, remaining.error);
    EXPECT_EQ(cost.zncc, remaining.zncc);
    EXPECT_EQ(std::vector<std::uint8_t>(scene.workspace.visible(), scene.workspace.visible() + scene.n()), visible)
        << "evaluate() has changed the set of the linearisation";
  }
}

TEST(EvaluateOnSet, ReportsTheLostWhereTooFewRemain) {
  Scene<std::uint8_t> scene(13);
  linearise(scene, scene.input());
  auto trial = scene.input();
  trial.target = {scene.image.data(), 4, 4, scene.kWidth};
  const auto cost = tp::reference::evaluate(tp::ResidualRequest{trial, scene.theta, scene.T_t_h}, scene.workspace,
                                            scene.workspace.visible());
  EXPECT_EQ(cost.status, tp::Status::out_of_view);
  EXPECT_EQ(cost.lost, scene.n());
  EXPECT_EQ(cost.cost, 0);
  const std::vector<std::uint8_t> none(scene.x.size(), 0);
  EXPECT_EQ(tp::reference::evaluate(scene.request(), scene.workspace, none.data()).status, tp::Status::too_few);
}
}  // namespace visible_set_test
