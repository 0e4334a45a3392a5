// Every kind renders, looks usable to a tracker, and moves as its name says.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "renderer/exposure.hpp"
#include "renderer/kinds.hpp"
#include "renderer/render_sequence.hpp"
#include "renderer/renderer_support.hpp"
#include "renderer/truth.hpp"
#include "textplane/features/fast.hpp"

namespace textslam {
namespace renderer_kinds_test {

constexpr int kFrames = 240;
constexpr double kInterval = 1.0 / 30.0;

double angle_between(const SE3d& a, const SE3d& b) { return textplane::so3_log<double>(a.R.transpose() * b.R).norm(); }

struct Pace {
  double path = 0.0, fastest = 0.0, turn = 0.0;  // m, m/s, rad/s
};

/// Measured between frames; also that the path is smooth: speed changes by no more than a hand can make it.
Pace pace_of(const Motion& motion, double largest_turn_change) {
  Pace pace;
  constexpr double kStep = 1e-4;
  for (int i = 1; i < kFrames; ++i) {
    const SE3d a = motion((i - 1) * kInterval), b = motion(i * kInterval);
    EXPECT_LT((a.R.transpose() * a.R - Matrix3<double>::Identity()).norm(), 1e-12);
    EXPECT_NEAR(a.R.determinant(), 1.0, 1e-12);
    pace.path += (b.t - a.t).norm();
    pace.fastest = std::max(pace.fastest, (b.t - a.t).norm() / kInterval);
    pace.turn = std::max(pace.turn, angle_between(a, b) / kInterval);
    const SE3d before = motion(i * kInterval - kStep), after = motion(i * kInterval + kStep);
    const Vector3<double> acceleration = (after.t - 2.0 * b.t + before.t) / (kStep * kStep);
    EXPECT_LT(acceleration.norm(), 8.0) << "m/s^2 at frame " << i;
    const double turn_change =
        (textplane::so3_log<double>(b.R.transpose() * after.R) - textplane::so3_log<double>(before.R.transpose() * b.R))
            .norm() /
        (kStep * kStep);
    EXPECT_LT(turn_change, largest_turn_change) << "rad/s^2 at frame " << i;
  }
  return pace;
}

TEST(RendererKinds, TheRoomIsALoopOfAHandHeldCameraThatMovesFromTheStart) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Motion motion = room_motion(seed);
    const Pace pace = pace_of(motion, 5.0);
    EXPECT_GT(pace.path, 4.0);
    EXPECT_LT(pace.path, 7.0);
    EXPECT_LT(pace.fastest, 1.1);
    EXPECT_LT(pace.turn, 40.0 / 57.3);
    EXPECT_GT((motion(kInterval).t - motion(0.0).t).norm(), 0.5 * kInterval);
    EXPECT_LT((motion(8.0).t - motion(0.0).t).norm(), 0.2);
  }
}

TEST(RendererKinds, TheStillRoomStandsForFortyFrames) {
  const Motion motion = still_then_room_motion(1, 40 * kInterval);
  for (int i = 1; i <= 40; ++i) {
    EXPECT_EQ((motion(i * kInterval).t - motion(0.0).t).norm(), 0.0);
    EXPECT_EQ((motion(i * kInterval).R - motion(0.0).R).norm(), 0.0);
  }
  EXPECT_GT((motion(60 * kInterval).t - motion(0.0).t).norm(), 0.2);
  pace_of(motion, 5.0);
}

TEST(RendererKinds, TheCorridorIsAWalkOfTenMetres) {
  const Pace pace = pace_of(corridor_motion(1), 5.0);
  EXPECT_GT(pace.path, 9.0);
  EXPECT_LT(pace.path, 11.0);
  EXPECT_LT(pace.fastest, 1.6);
  EXPECT_LT(pace.turn, 40.0 / 57.3);
}

TEST(RendererKinds, TheLoopGoesOnceRoundAndOnToSeeTheFirstSignsAgain) {
  EXPECT_EQ(default_frames("room"), 240);
  const int frames = default_frames("loop");
  const CameraModel camera = test_camera();
  for (const std::uint64_t seed : {1U, 2U}) {
    const Shot shot = make_shot("loop", seed, camera.width, camera.height);
    const Pace pace = pace_of(shot.motion, 5.0);
    EXPECT_LT(pace.fastest, 1.1);
    EXPECT_LT(pace.turn, 50.0 / 57.3);
    const auto signs_in_view = [&](int frame) {
      std::set<int> ids;
      for (const SignView& view : views_of_signs(shot.scene, camera, shot.motion(frame * kInterval)))
        if (view.visible > 0.9) ids.insert(view.sign);
      return ids;
    };
    const std::set<int> first = signs_in_view(0);
    ASSERT_GE(first.size(), 3U);
    int longest_gap = 0, gap = 0;
    for (int i = 0; i < frames; i += 10) {
      const std::set<int> seen = signs_in_view(i);
      EXPECT_FALSE(seen.empty()) << "frame " << i << " shows no sign";
      const bool any = std::any_of(first.begin(), first.end(), [&](int id) { return seen.count(id) > 0; });
      gap = any ? 0 : gap + 10;
      longest_gap = std::max(longest_gap, gap);
    }
    EXPECT_GT(longest_gap, 100) << "out of sight";
    const std::set<int> again = signs_in_view(frames - 30);  // once round, in eleven seconds
    EXPECT_GE(std::count_if(first.begin(), first.end(), [&](int id) { return again.count(id) > 0; }), 3);
  }
}

TEST(RendererKinds, RapidBlursByEightToTwentyPixelsWhereItIsFast) {
  const Shot shot = make_shot("rapid", 1, 640, 480);
  const CameraModel camera = test_camera();
  pace_of(shot.motion, 40.0);
  int fast = 0, slow = 0, bursts = 0;
  bool was_fast = false;
  for (int i = 0; i < kFrames; ++i) {
    // From the truth alone: how far the centres of the signs in view move from one end of the exposure to the other.
    const double t = i * kInterval, half = 0.5 * shot.exposure;
    const SE3d opened = shot.motion(t - half).inverse(), closed = shot.motion(t + half).inverse();
    std::vector<double> lengths;
    for (const SignView& view : views_of_signs(shot.scene, camera, shot.motion(t))) {
      if (view.visible < 0.9) continue;
      const Sign& sign = shot.scene.signs()[static_cast<std::size_t>(view.sign)];
      const Vector3<double> a = opened * (0.5 * (sign.corner[0] + sign.corner[2]));
      const Vector3<double> b = closed * (0.5 * (sign.corner[0] + sign.corner[2]));
      lengths.push_back((camera.pinhole().project(b) - camera.pinhole().project(a)).norm());
    }
    ASSERT_FALSE(lengths.empty()) << "frame " << i << " shows no sign";
    std::sort(lengths.begin(), lengths.end());
    const double median = lengths[lengths.size() / 2];
    EXPECT_LE(lengths.back(), 20.0) << "frame " << i;
    const Blur blur = blur_of(shot.scene, camera, shot.motion, t, shot.exposure);
    EXPECT_LE(blur.median, 20.0);
    EXPECT_NEAR(blur.median, median, 1.0 + 0.35 * median) << "frame " << i;
    const bool is_fast = median >= 8.0;
    fast += is_fast;
    slow += median < 5.0;
    bursts += is_fast && !was_fast;
    was_fast = is_fast;
  }
  EXPECT_GE(fast, 30);
  EXPECT_GE(bursts, 5);
  EXPECT_GE(slow, 150);
}

TEST(RendererKinds, LightsSwingSmoothlyAndFlicker) {
  const SensorProgram sensor = changing_lights(1, 640, 480);
  double low = 1e9, high = 0.0, low_bias = 1e9, high_bias = -1e9, flicker = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    const SensorState state = sensor(i * kInterval);
    low = std::min(low, state.gain);
    high = std::max(high, state.gain);
    low_bias = std::min(low_bias, state.bias);
    high_bias = std::max(high_bias, state.bias);
    EXPECT_FALSE(state.glare.empty());
    EXPECT_GT(state.vignette, 0.2);
    if (i > 0) flicker = std::max(flicker, std::abs(state.gain - sensor((i - 1) * kInterval).gain) / state.gain);
  }
  EXPECT_GT(low, 0.25);
  EXPECT_GT(high / low, 2.0);
  EXPECT_GT(high_bias - low_bias, 20.0);
  EXPECT_GT(flicker, 0.1);
}

TEST(RendererKinds, NightStepsItsGainBetweenLongRestsAndIsNoisy) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const SensorProgram sensor = night(seed);
    int up = 0, down = 0, moving = 0, longest = 0;
    double from = sensor(0.0).gain, last = from;
    for (int i = 1; i < kFrames; ++i) {
      const SensorState state = sensor(i * kInterval);
      EXPECT_EQ(state.noise, 20.0);
      EXPECT_EQ(state.shot, 0.0);
      EXPECT_GE(state.vignette, 0.5);
      if (std::abs(state.gain - last) > 1e-9) {
        longest = std::max(longest, ++moving);
      } else if (moving > 0) {
        up += std::abs(state.gain / from - 2.0) < 1e-9;
        down += std::abs(state.gain / from - 0.5) < 1e-9;
        from = state.gain;
        moving = 0;
      }
      last = state.gain;
    }
    EXPECT_GE(up, 2) << "seed " << seed;
    EXPECT_GE(down, 2) << "seed " << seed;
    EXPECT_LE(longest, 4) << "a step of three frames' length is seen in four";
  }
}

TEST(RendererSensor, DevelopsGainBiasVignetteAndNoise) {
  const Image<double> light(320, 240, 100.0);
  SensorState state;
  state.gain = 1.2;
  state.bias = 10.0;
  state.vignette = 0.5;
  state.noise = 3.0;
  state.shot = 0.0;
  const auto mean_of = [](const Image<std::uint8_t>& picture, int x0, int y0, double* deviation) {
    double sum = 0.0, squares = 0.0;
    for (int y = y0; y < y0 + 20; ++y) {
      for (int x = x0; x < x0 + 20; ++x) {
        sum += picture(x, y);
        squares += static_cast<double>(picture(x, y)) * picture(x, y);
      }
    }
    *deviation = std::sqrt(squares / 400.0 - sum / 400.0 * sum / 400.0);
    return sum / 400.0;
  };
  double deviation = 0.0;
  const Image<std::uint8_t> picture = develop(light, state, 1);
  EXPECT_NEAR(mean_of(picture, 150, 110, &deviation), 130.0, 0.8);
  EXPECT_NEAR(deviation, std::hypot(3.0, std::sqrt(1.0 / 12.0)), 0.5);
  EXPECT_NEAR(mean_of(picture, 0, 0, &deviation), 10.0 + 120.0 * (1.0 - 0.5 * 0.86), 2.5);
  state.glare.push_back({{160.0, 120.0}, 20.0, 60.0});
  EXPECT_NEAR(mean_of(develop(light, state, 1), 150, 110, &deviation), 187.0, 3.0);
  EXPECT_NE(develop(light, state, 1)(5, 5) * 256 + develop(light, state, 1)(6, 5),
            develop(light, state, 2)(5, 5) * 256 + develop(light, state, 2)(6, 5));
  const Image<std::uint8_t> burnt = develop(Image<double>(8, 8, 400.0), state, 1);
  EXPECT_EQ(burnt(4, 4), 255);
}

class EveryKind : public testing::TestWithParam<std::string> {};

TEST_P(EveryKind, RendersFramesThatATrackerCanUse) {
  const CameraModel camera = test_camera();
  const Shot shot = make_shot(GetParam(), 1, camera.width, camera.height);
  const bool bare = GetParam() == "sparse", dark = GetParam() == "night";
  EXPECT_EQ(shot.scene.signs().empty(), GetParam() == "notext");
  if (GetParam() != "notext") {
    EXPECT_GE(shot.scene.signs().size(), 11u);
  }
  for (const Sign& sign : shot.scene.signs()) {
    const double width = (sign.corner[1] - sign.corner[0]).norm();
    EXPECT_GT(width, 0.2) << sign.word;
    EXPECT_LT(width, 0.8) << sign.word;
  }
  const RayCaster caster(camera, pixel_grid());
  for (const int frame : {0, 130}) {
    const double t = frame * kInterval;
    const int instants = instants_for(blur_of(shot.scene, camera, shot.motion, t, shot.exposure).max);
    const Image<double> light = expose(shot.scene, caster, shot.motion, t, shot.exposure, instants);
    const double darkest = *std::min_element(light.data(), light.data() + 640 * 480);
    EXPECT_GT(darkest, 0.0) << "a ray left the scene";
    const Image<std::uint8_t> picture = develop(light, shot.sensor(t), 7);
    double sum = 0.0;
    int clipped = 0;
    for (int i = 0; i < 640 * 480; ++i) {
      sum += picture.data()[i];
      clipped += picture.data()[i] == 0 || picture.data()[i] == 255;
    }
    EXPECT_GT(sum / (640 * 480), dark ? 20.0 : 45.0);
    EXPECT_LT(sum / (640 * 480), dark ? 80.0 : 200.0);
    EXPECT_LT(clipped, 640 * 480 / (dark ? 6 : 50)) << "noise about black";

    std::vector<textplane::Corner> corners;
    ASSERT_TRUE(textplane::is_ok(textplane::detect_fast(picture.view(), 20, true, corners)));
    const std::vector<SignView> views = views_of_signs(shot.scene, camera, shot.motion(t));
    if (bare) {
      // Little but text: most corners lie on a sign (words, or the plate's edge within a word's height of them).
      int on_signs = 0;
      for (const textplane::Corner& c : corners) {
        on_signs += std::any_of(views.begin(), views.end(), [&c](const SignView& view) {
          const textplane::Bounds<double> box = textplane::bounds(view.quad);
          const double margin = box.max[1] - box.min[1];
          return c.x > box.min[0] - margin && c.x < box.max[0] + margin && c.y > box.min[1] - margin &&
                 c.y < box.max[1] + margin;
        });
      }
      EXPECT_GT(corners.size(), 60u) << "frame " << frame;
      EXPECT_GT(on_signs, static_cast<int>(corners.size()) * 8 / 10) << "frame " << frame;
      continue;
    }
    EXPECT_GT(corners.size(), 250u) << "frame " << frame;
    std::array<int, 12> cell{};
    for (const textplane::Corner& c : corners)
      ++cell[static_cast<std::size_t>(static_cast<int>(c.x) / 160 + 4 * (static_cast<int>(c.y) / 160))];
    EXPECT_GE(std::count_if(cell.begin(), cell.end(), [](int n) { return n >= 3; }), 9) << "frame " << frame;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryKind, testing::ValuesIn(render_kinds()), [](const auto& kind) {
  std::string name = kind.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace renderer_kinds_test
}  // namespace textslam
