// Patience is time, not a number of frames: the same images at 30 and at 5 frames a second.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "textslam/system/short_room_support.hpp"

namespace textslam {
namespace frame_rate_test {

class FrameRate : public testing::TestWithParam<double> {
 protected:
  static constexpr int kFrames = 60;

  static void SetUpTestSuite() { room_ = new ShortRoom(kFrames); }
  static void TearDownTestSuite() { delete room_; }

  Frame at_rate(int index, Frame frame) const {
    frame.index = index;
    frame.timestamp = 1e9 + index / GetParam();
    return frame;
  }
  Frame load(int index) const { return at_rate(index, room_->load(index)); }

  // Tracks until the map has this many key frames, then in the dark. The number of lost frames after which the map was
  // left.
  int lost_frames(std::size_t keyframes) const {
    const std::unique_ptr<System> out = room_->system();
    int index = 0;
    while (index < kFrames && out->map().keyframes.size() < keyframes) out->process(load(index++));
    EXPECT_GE(out->map().keyframes.size(), keyframes);
    const Frame dark = ShortRoom::dark({});
    int lost = 0;
    while (lost < 100 && !out->map().keyframes.empty()) {
      out->process(at_rate(index, dark));
      ++index;
      ++lost;
    }
    return lost;
  }

  // Frames between the two key frames that follow each other soonest, those that begin the map aside.
  int closest_keyframes(const Parameters& parameters) {
    const std::unique_ptr<System> out = room_->system(parameters);
    for (int index = 0; index < kFrames; ++index) out->process(load(index));
    const auto& keyframes = out->map().keyframes;
    EXPECT_GE(keyframes.size(), 10u);
    int closest = kFrames;
    for (std::size_t i = 2; i < keyframes.size(); ++i)
      closest = std::min(closest, keyframes[i].frame.index - keyframes[i - 1].frame.index);
    return closest;
  }

  static ShortRoom* room_;
};
ShortRoom* FrameRate::room_ = nullptr;

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
