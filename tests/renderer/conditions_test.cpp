// Each condition of a sweep does to the images and detections what it says, and nothing else.
#include "renderer/conditions.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "io/io_support.hpp"
#include "io/text_file.hpp"
#include "renderer/render_sequence.hpp"

namespace textslam {
namespace renderer_conditions_test {

struct Moments {
  double mean = 0.0, deviation = 0.0;
};
Moments moments_of(const Image<std::uint8_t>& picture) {
  double sum = 0.0, squares = 0.0;
  const double n = static_cast<double>(picture.width()) * picture.height();
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      sum += picture(x, y);
      squares += static_cast<double>(picture(x, y)) * picture(x, y);
    }
  }
  return {sum / n, std::sqrt(squares / n - sum / n * sum / n)};
}

TEST(RendererConditions, NoiseHasItsSigmaAtEveryBrightness) {
  for (const double sigma : {0.0, 5.0, 15.0}) {
    Conditions conditions;
    conditions.noise = sigma;
    Shot shot;
    shot.sensor = [](double) {
      SensorState state;
      state.noise = 2.0;
      state.shot = 0.5;
      return state;
    };
    apply(conditions, &shot);
    for (const double light : {80.0, 160.0}) {
      const Moments moments = moments_of(develop(Image<double>(200, 150, light), shot.sensor(0.0), 3));
      EXPECT_NEAR(moments.mean, light, 5 * sigma / std::sqrt(30000.0) + 1e-12);
      const double expected = sigma > 0 ? std::hypot(sigma, std::sqrt(1.0 / 12.0)) : 0.0;  // rounding to grey levels
      EXPECT_NEAR(moments.deviation, expected, 5 * sigma / std::sqrt(60000.0));
    }
  }
}

TEST(RendererConditions, GainIsConstantAndTheRestOfTheSensorStays) {
  const SensorProgram lights = changing_lights(1, 160, 120);
  Shot shot;
  shot.sensor = lights;
  Conditions conditions;
  conditions.gain = 0.3;
  apply(conditions, &shot);
  for (int frame = 0; frame < 240; frame += 7) {
    const SensorState kind = lights(frame / 30.0), state = shot.sensor(frame / 30.0);
    EXPECT_EQ(state.gain, 0.3);
    EXPECT_EQ(state.bias, kind.bias);
    EXPECT_EQ(state.noise, kind.noise);
    EXPECT_EQ(state.shot, kind.shot);
    EXPECT_EQ(state.glare.size(), kind.glare.size());
  }
}

TEST(RendererConditions, WithoutThemTheShotIsTheKinds) {
  Shot shot;
  shot.exposure = 0.0123;
  shot.sensor = steady_sensor();
  apply({}, &shot);
  EXPECT_EQ(shot.exposure, 0.0123);
  EXPECT_EQ(shot.sensor(1.0).gain, steady_sensor()(1.0).gain);
  EXPECT_EQ(shot.sensor(1.0).noise, steady_sensor()(1.0).noise);
}

// A bright dot becomes a line of that length and direction: its moments are those of an even distribution.
TEST(RendererConditions, BlurSpreadsADotAlongALine) {
  Image<double> dot(101, 81);
  dot(50, 40) = 1.0;
  for (const double length : {2.0, 7.5, 30.0}) {
    for (const double angle : {0.0, 0.6, 1.5707963267948966, 2.4}) {
      const Vector2<double> along(std::cos(angle), std::sin(angle)), across(-along[1], along[0]);
      const Image<double> line = blur_along(dot, along, length);
      double sum = 0.0, spread_along = 0.0, spread_across = 0.0;
      Vector2<double> mean = Vector2<double>::Zero();
      for (int y = 0; y < 81; ++y) {
        for (int x = 0; x < 101; ++x) {
          const Vector2<double> p(x - 50, y - 40);
          sum += line(x, y);
          mean += line(x, y) * p;
          spread_along += line(x, y) * along.dot(p) * along.dot(p);
          spread_across += line(x, y) * across.dot(p) * across.dot(p);
        }
      }
      EXPECT_NEAR(sum, 1.0, 1e-12);
      EXPECT_LT(mean.norm(), 1e-12) << "centred: the pose in the middle of the exposure stays the truth";
      EXPECT_NEAR(std::sqrt(12.0 * spread_along), length, 0.9);  // reading between pixels widens a little
      EXPECT_LT(spread_across, 0.25);
    }
  }
}

TEST(RendererConditions, BlurKeepsAnEvenPictureAndOfLengthZeroEveryPicture) {
  Image<double> picture(40, 30);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) picture(x, y) = 3.0 * x + 100.0 * (y % 2);
  const Image<double> same = blur_along(picture, {0.6, 0.8}, 0.0), even = blur_along({40, 30, 77.0}, {0.6, 0.8}, 12.0);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      EXPECT_EQ(same(x, y), picture(x, y));
      EXPECT_NEAR(even(x, y), 77.0, 1e-12) << "to the border";
    }
  }
}

RenderOptions small_render(const std::string& output) {
  RenderOptions options;
  options.kind = "sparse";  // the scene that is made fastest
  options.output = output;
  options.frames = 2;
  options.width = 160;
  options.height = 120;
  return options;
}

TEST(RendererConditions, AreWrittenToTheSequenceAndRepeatable) {
  const TemporaryFolder folder;
  RenderOptions options = small_render(folder.path("a"));
  options.conditions = {12.0, 0.5, 4.0};
  options.detector.missed = 1.0;
  options.detector.false_per_frame = 3.0;
  render_sequence(options);
  options.output = folder.path("b");
  options.threads = 1;
  render_sequence(options);
  options.output = folder.path("plain");
  options.conditions = {};
  options.detector = {};
  render_sequence(options);
  for (const char* name : {"images/000001.png", "detections/000001.txt", "truth/frames.txt"}) {
    EXPECT_TRUE(read_file(folder.path("a/") + name) == read_file(folder.path("b/") + name)) << name;
    EXPECT_FALSE(read_file(folder.path("a/") + name) == read_file(folder.path("plain/") + name)) << name;
  }
  EXPECT_EQ(read_file(folder.path("a/groundtruth.txt")), read_file(folder.path("plain/groundtruth.txt")));
  EXPECT_EQ(read_detections(read_sequence(folder.path("a")), read_sequence(folder.path("a")).frames[1]).size(), 3u)
      << "every sign missed, three false ones";
  // timestamp, exposure, blur (median, longest), gain, bias
  EXPECT_NE(read_file(folder.path("a/truth/frames.txt")).find(" 0.000000 12.000 12.000 0.5000 "), std::string::npos);
}

TEST(RendererConditions, RefusesWhatMakesNoSense) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& part, auto change) {
    RenderOptions options = small_render(folder.path("never"));
    change(options);
    expect_input_error([&] { render_sequence(options); }, "render options", 0, part);
  };
  refused("the blur", [](RenderOptions& o) { o.conditions.blur = -1.0; });
  refused("the gain", [](RenderOptions& o) { o.conditions.gain = std::nan(""); });
  refused("the noise", [](RenderOptions& o) { o.conditions.noise = 1e9; });
  refused("the jitter", [](RenderOptions& o) { o.detector.corner_sigma = -0.5; });
  refused("missed detections", [](RenderOptions& o) { o.detector.missed = 1.5; });
  refused("false detections", [](RenderOptions& o) { o.detector.false_per_frame = -1.0; });
  refused("spanning detections", [](RenderOptions& o) { o.detector.spanning = 21.0; });
}

}  // namespace renderer_conditions_test
}  // namespace textslam
