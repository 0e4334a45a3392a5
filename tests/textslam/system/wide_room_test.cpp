// The rendered room through a wide-angle lens: raw images give what those of a pinhole give.
#include <gtest/gtest.h>

#include <memory>

#include "support/long_test.hpp"
#include "textslam/system/room_run_support.hpp"

namespace textslam {
namespace wide_room_test {

// What rooms of other seeds give through either lens: 1.0 to 1.7 mm, 0.1 to 0.4 degrees, three to six of the signs.
void expect_good(const RunSummary& summary, std::size_t frames) {
  ASSERT_TRUE(is_aligned(summary));
  EXPECT_EQ(summary.tracked, frames);
  EXPECT_LT(summary.trajectory.ate.rmse, 2.5e-3) << "m";
  EXPECT_GE(summary.text.mapped, 3);
  EXPECT_EQ(summary.text.false_texts, 0);
  EXPECT_LT(summary.text.angle.median, 0.6) << "degrees";
  EXPECT_LT(summary.reprojection_px, 0.25);
}

TEST(WideRoom, PosesAndPlanesAreThoseOfAPinhole) {
  TEXTPLANE_LONG_TEST();
  constexpr int kFrames = 80;
  const ShortRoom straight(kFrames), wide(kFrames, "wide");
  ASSERT_TRUE(straight.sequence().camera.is_pinhole());
  ASSERT_FALSE(wide.sequence().camera.is_pinhole());
  const std::unique_ptr<System> by_pinhole = straight.system(), by_lens = wide.system();
  EXPECT_EQ(by_pinhole->map().camera.lens, nullptr);
  EXPECT_NE(by_lens->map().camera.lens, nullptr);
  expect_good(run_on(straight, *by_pinhole), kFrames);
  expect_good(run_on(wide, *by_lens), kFrames);
  // A map of the same images without their lens is bent: what is asked above is no matter of course.
  System bent(wide.sequence().camera.pinhole(), wide.sequence().camera.width, wide.sequence().camera.height, {});
  const RunSummary without = run_on(wide, bent);
  EXPECT_TRUE(!is_aligned(without) || without.trajectory.ate.rmse > 1e-2);
}

}  // namespace wide_room_test
}  // namespace textslam
