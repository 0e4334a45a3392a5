// Detections that come frames after their frame was tracked: the signs are mapped all the same, where they are.
#include <gtest/gtest.h>

#include <deque>
#include <memory>

#include "textslam/report/evaluate_text.hpp"
#include "textslam/report/outputs.hpp"
#include "textslam/system/short_room_support.hpp"

namespace textslam {
namespace late_detections_test {

class LateDetections : public testing::Test {
 protected:
  static constexpr int kFrames = 90;

  static void SetUpTestSuite() { room_ = new ShortRoom(kFrames); }
  static void TearDownTestSuite() { delete room_; }

  static std::vector<Detection> detect(int index) {
    return read_detections(room_->sequence(), room_->sequence().frames[static_cast<std::size_t>(index)]);
  }

  // Every detection comes `late` frames late: those of frame i after frame i + late was tracked.
  static std::unique_ptr<System> run(int late, const Parameters& parameters = {}) {
    auto out = room_->system(parameters);
    for (int i = 0; i < kFrames; ++i) {
      out->process(room_->load(i));
      if (i >= late) out->add_detections(i - late, detect(i - late), 7);
    }
    out->finish();
    return out;
  }

  static ShortRoom* room_;
};
ShortRoom* LateDetections::room_ = nullptr;

TEST_F(LateDetections, SignsAreMappedWhereTheyAreHoweverLate) {
  for (const int late : {0, 5, 20}) {
    SCOPED_TRACE(std::to_string(late) + " frames late");
    const std::unique_ptr<System> out = run(late);
    const RunSummary summary = summarise(*out, room_->sequence(), kFrames);
    EXPECT_GE(summary.tracked_live, static_cast<std::size_t>(kFrames - 40));
    ASSERT_TRUE(textplane::is_ok(summary.trajectory.status));
    const TextEvaluation text =
        evaluate_text(out->map(), read_true_signs(room_->sequence()), summary.trajectory.alignment);
    EXPECT_GE(text.mapped, 1);
    EXPECT_EQ(text.false_texts, 0);
    EXPECT_LT(text.angle.median, 5);
    for (const int id : out->map().keyframe_ids()) {
      const Frame& frame = out->map().keyframe(id).frame;
      const std::size_t expected = frame.index < kFrames - late ? detect(frame.index).size() : 0;
      EXPECT_EQ(frame.detections.size(), expected) << "key frame of frame " << frame.index;
    }
    EXPECT_EQ(out->records()[10].detect_ms, 7);
  }
}

// Words are voted for by the frames between key frames, too: with as many frames a text has more detections than key
// frames.
TEST_F(LateDetections, FramesThatAreNoKeyFramesCount) {
  const std::unique_ptr<System> out = run(5);
  int most = 0;
  for (const TextObject& text : out->map().texts) most = std::max(most, text.detections);
  EXPECT_GT(most, static_cast<int>(out->map().keyframes.size()));
}

TEST_F(LateDetections, ModePointsDoesNotLookAtThem) {
  Parameters points;
  points.mode = Mode::points;
  EXPECT_TRUE(run(5, points)->map().texts.empty());
}

// The map is left where the camera is in the dark for long; then its frames are those of another map.
TEST_F(LateDetections, FramesOfAnotherMapAndLostOnesArePast) {
  Parameters parameters;
  parameters.lost_patience = parameters.young_map_patience = 0.05;
  auto out = room_->system(parameters);
  int index = 0;
  for (; index < 50; ++index) out->process(room_->load(index));
  ASSERT_EQ(out->records().back().state, FrameState::tracked);
  for (; index < 55; ++index) out->process(ShortRoom::dark(room_->load(index)));
  ASSERT_TRUE(out->map().keyframes.empty()) << "stored";
  for (int late = 0; late < 55; ++late) out->add_detections(late, detect(late), 1);
  EXPECT_TRUE(out->map().texts.empty());
  out->finish();
  EXPECT_FALSE(out->map().keyframes.empty());
  EXPECT_TRUE(out->map().texts.empty());
}

}  // namespace late_detections_test
}  // namespace textslam
