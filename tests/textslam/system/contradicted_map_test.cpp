// A young map that the points it was begun with contradict is dropped, and its frames find their poses in the next one.
#include <gtest/gtest.h>

#include <algorithm>

#include "textslam/report/summary.hpp"
#include "textslam/system/short_room_support.hpp"

namespace textslam {
namespace contradicted_map_test {

constexpr int kFrames = 60;

class ContradictedMap : public testing::Test {
 protected:
  static void SetUpTestSuite() { room_ = new ShortRoom(kFrames); }
  static void TearDownTestSuite() { delete room_; }

  // The room, but above the middle row as it was in frame `still`: what is there moves with the camera.
  static Frame half_still(int index, int still) {
    const auto load = [](int i) { return load_frame(room_->sequence(), static_cast<std::size_t>(i)); };
    const Image<std::uint8_t> upper = load(still);
    Image<std::uint8_t> image = load(index);
    std::copy(upper.data(), upper.row(upper.height() / 2), image.data());
    Frame frame = room_->load(index);
    frame.image = std::make_shared<const Pyramid>(image.view(), Parameters().pyramid_levels);
    return frame;
  }

  struct Moving {
    int first, frames;
  };
  // Tracks until the map has so many key frames. Then half of what is seen moves with the camera for up to `most`
  // frames, or until the map is dropped; a dark frame follows, so that what begins then has not seen that half move.
  static Moving process(System& system, std::size_t keyframes, int most) {
    int index = 0;
    while (index < kFrames && system.map().keyframes.size() < keyframes) system.process(room_->load(index++));
    const int first = index;
    while (index < first + most && !system.map().keyframes.empty()) system.process(half_still(index++, first - 1));
    const int frames = index - first;
    if (system.map().keyframes.empty()) system.process(ShortRoom::dark(room_->load(index++)));
    while (index < kFrames) system.process(room_->load(index++));
    return {first, frames};
  }
  static bool was_live(const System& system, int frame) {
    return system.records()[static_cast<std::size_t>(frame)].live;
  }
  static RunSummary finished(System& system) {
    system.finish();
    system.fill_in([](int index) { return room_->load(index); });
    return summarise(system, room_->sequence(), kFrames);
  }

  static ShortRoom* room_;
};
ShortRoom* ContradictedMap::room_ = nullptr;

TEST_F(ContradictedMap, IsDroppedAndItsFramesAreFoundInTheNext) {
  const auto system = room_->system(), undisturbed = room_->system();
  const Moving moving = process(*system, 3, 20);
  EXPECT_LT(moving.frames, 20) << "it was dropped";
  ASSERT_FALSE(system->map().keyframes.empty()) << "another one began";
  EXPECT_EQ(system->map_frames().size(), 1u) << "nothing is left of the first";
  EXPECT_FALSE(was_live(*system, moving.first - 1));
  EXPECT_EQ(system->records()[static_cast<std::size_t>(moving.first - 1)].state, FrameState::waiting);
  const RunSummary summary = finished(*system);
  EXPECT_EQ(summary.tracked, static_cast<std::size_t>(kFrames));
  ASSERT_TRUE(textplane::is_ok(summary.trajectory.status));

  EXPECT_TRUE(was_live(*undisturbed, process(*undisturbed, 3, 0).first - 1));
  const RunSummary best = finished(*undisturbed);
  ASSERT_TRUE(textplane::is_ok(best.trajectory.status));
  EXPECT_LT(summary.trajectory.ate.rmse, 2 * best.trajectory.ate.rmse);
}

TEST_F(ContradictedMap, StaysWhereItIsProven) {
  Parameters parameters;
  parameters.trial_keyframes = 2;
  const auto system = room_->system(parameters);
  const Moving moving = process(*system, 3, 8);
  EXPECT_EQ(moving.frames, 8);
  EXPECT_TRUE(was_live(*system, moving.first - 1));
  EXPECT_EQ(system->map_frames().size(), 1u);
}

}  // namespace contradicted_map_test
}  // namespace textslam
