// Patience is time, not a number of frames: the same images at 30 and at 5 frames a second.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "io/image_file.hpp"
#include "io/io_support.hpp"
#include "renderer/render_sequence.hpp"
#include "textslam/system/system.hpp"

namespace textslam {
namespace frame_rate_test {

class FrameRate : public testing::TestWithParam<double> {
 protected:
  static constexpr int kFrames = 60;

  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    RenderOptions options;
    options.output = folder_->path("room");
    options.frames = kFrames;
    options.width = 320;
    options.height = 240;
    render_sequence(options);
    sequence_ = new Sequence(read_sequence(options.output));
  }
  static void TearDownTestSuite() {
    delete sequence_;
    delete folder_;
  }

  Frame frame(int index, const Image<std::uint8_t>& image) const {
    Frame out;
    out.index = index;
    out.timestamp = 1e9 + index / GetParam();
    out.image = std::make_shared<const Pyramid>(image.view(), Parameters().pyramid_levels);
    return out;
  }
  Frame load(int index) const { return frame(index, load_frame(*sequence_, static_cast<std::size_t>(index))); }
  std::unique_ptr<System> system(const Parameters& parameters = {}) const {
    return std::make_unique<System>(sequence_->camera.pinhole(), sequence_->camera.width, sequence_->camera.height,
                                    parameters);
  }

  // Tracks until the map has this many key frames, then in the dark. The number of lost frames after which the map was
  // left.
  int lost_frames(std::size_t keyframes) const {
    const std::unique_ptr<System> out = system();
    int index = 0;
    while (index < kFrames && out->map().keyframes.size() < keyframes) out->process(load(index++));
    EXPECT_GE(out->map().keyframes.size(), keyframes);
    const Image<std::uint8_t> dark(320, 240, 0);
    int lost = 0;
    while (lost < 100 && !out->map().keyframes.empty()) {
      out->process(frame(index++, dark));
      ++lost;
    }
    return lost;
  }

  // Frames between the two key frames that follow each other soonest, those that begin the map aside.
  int closest_keyframes(const Parameters& parameters) {
    const std::unique_ptr<System> out = system(parameters);
    for (int index = 0; index < kFrames; ++index) out->process(load(index));
    const auto& keyframes = out->map().keyframes;
    EXPECT_GE(keyframes.size(), 10u);
    int closest = kFrames;
    for (std::size_t i = 2; i < keyframes.size(); ++i)
      closest = std::min(closest, keyframes[i].frame.index - keyframes[i - 1].frame.index);
    return closest;
  }

  static TemporaryFolder* folder_;
  static Sequence* sequence_;
};
TemporaryFolder* FrameRate::folder_ = nullptr;
Sequence* FrameRate::sequence_ = nullptr;

// The first number of frames whose first and last are so far apart.
int frames_of(double seconds, double rate) { return 1 + static_cast<int>(std::ceil(seconds * rate)); }

TEST_P(FrameRate, AMapIsLeftAfterASecond) {
  const Parameters parameters;
  const int lost = lost_frames(static_cast<std::size_t>(parameters.young_map_keyframes));
  EXPECT_EQ(lost, frames_of(parameters.lost_patience, GetParam()));
  EXPECT_NEAR((lost - 0.5) / GetParam(), 1, 0.15) << "s, as docs/textslam.md says";
}

TEST_P(FrameRate, AYoungMapIsLeftAfterHalfASecond) {
  const int lost = lost_frames(2);
  EXPECT_EQ(lost, frames_of(Parameters().young_map_patience, GetParam()));
  EXPECT_NEAR((lost - 0.5) / GetParam(), 0.5, 0.25);
}

// Where points are lost slowly, key frames follow as close as the time allows, and no closer.
TEST_P(FrameRate, KeyFramesKeepATimeApart) {
  Parameters parameters;
  parameters.mode = Mode::points;
  parameters.keyframe_flow = 1e9;
  parameters.keyframe_min_share = 1e9;
  parameters.keyframe_urgent_share = 0;
  EXPECT_EQ(closest_keyframes(parameters), GetParam() < 10 ? 1 : 3) << "frames";
}

// A fast motion does not wait.
TEST_P(FrameRate, KeyFramesOfAFastMotionComeAtOnce) {
  Parameters parameters;
  parameters.mode = Mode::points;
  parameters.keyframe_flow = 0;
  EXPECT_EQ(closest_keyframes(parameters), 1) << "frames";
}

INSTANTIATE_TEST_SUITE_P(ThirtyAndFive, FrameRate, testing::Values(30.0, 5.0));

}  // namespace frame_rate_test
}  // namespace textslam
