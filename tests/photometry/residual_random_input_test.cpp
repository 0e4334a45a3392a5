// The reference of the photometric residual on random input: a usable result or zeros, never a NaN.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "photometry/scene.hpp"
#include "textplane/photometry/residual.hpp"

namespace tp = textplane;
using textplane_test::all_zero;
using textplane_test::Random;
using textplane_test::Scene;

namespace residual_random_input_test {

const double kNaN = std::numeric_limits<double>::quiet_NaN();
const double kInf = std::numeric_limits<double>::infinity();

// Random calls, each input spoilt with some probability by a special value: ok means finite, anything else means zeros.
TEST(ResidualFuzz, OkIsFiniteAndTheRestIsZero) {
  const double special[] = {0.0, -0.0, kNaN, kInf, -kInf, 1e-310, 1e300, -1e300, 1e20, 0.5, -1.0};
  Random random(99);
  const auto pick = [&] { return special[random.integer(0, 10)]; };
  std::vector<Scene<float>> scenes;
  for (unsigned seed = 1; seed <= 7; ++seed) scenes.emplace_back(seed, 40);
  int ok = 0;
  for (int k = 0; k < 4000; ++k) {
    Scene<float> scene = scenes[static_cast<std::size_t>(k) % scenes.size()];
    // The copy's input views the copy's pixels.
    auto input = scene.input();
    for (int spoil = random.integer(0, 3); spoil > 0; --spoil) {
      const auto i = static_cast<std::size_t>(random.integer(0, 39));
      switch (random.integer(0, 8)) {
        case 0: scene.theta[random.integer(0, 2)] = pick(); break;
        case 1: scene.T_t_h.t[random.integer(0, 2)] = pick(); break;
        case 2: scene.T_t_h.R(random.integer(0, 2), random.integer(0, 2)) = pick(); break;
        case 3: input.host_camera.cx = pick(); break;
        case 4: input.target_camera.fx = pick(); break;
        case 5: scene.x[i] = static_cast<float>(std::min(std::max(pick(), -3e38), 3e38)); break;
        case 6: scene.intensity[i] = static_cast<float>(std::min(std::max(pick(), -3e38), 3e38)); break;
        case 7: scene.image(random.integer(60, 140), random.integer(50, 110)) = 3e38f; break;
        default: input.target = {scene.image.data(), random.integer(-1, 200), random.integer(-1, 160)}; break;
      }
    }
    tp::PhotometricOptions options;
    options.normalisation = k % 2 ? tp::Normalisation::exact : tp::Normalisation::frozen;
    const auto sums = tp::reference::linearise<tp::Parameters::pose_plane>(
        tp::ResidualRequest{input, scene.theta, scene.T_t_h, options}, scene.workspace);
    if (tp::is_ok(sums.status)) {
      ++ok;
      ASSERT_TRUE(tp::all_finite(sums.H) && tp::all_finite(sums.b));
      ASSERT_GE(sums.error, 0);
      ASSERT_LE(sums.error, 4 + 1e-12);
      ASSERT_GE(sums.visible, 15);
    } else {
      ASSERT_TRUE(all_zero(sums)) << tp::to_string(sums.status);
    }
  }
  EXPECT_GT(ok, 1000);
}
}  // namespace residual_random_input_test
