// Parameters that follow the size of the images.
#include "textslam/common/parameters.hpp"

#include <gtest/gtest.h>

namespace textslam {
namespace parameters_test {

TEST(ParametersAtSize, AreTheListsAt640By480) {
  const Parameters listed, p = at_size(listed, 640, 480);
  EXPECT_EQ(p.corner_cell, listed.corner_cell);
  EXPECT_EQ(p.text_corner_cell, listed.text_corner_cell);
  EXPECT_EQ(p.pyramid_levels, listed.pyramid_levels);
  EXPECT_DOUBLE_EQ(p.keyframe_flow, listed.keyframe_flow);
  EXPECT_DOUBLE_EQ(p.relocation_search, listed.relocation_search);
  EXPECT_DOUBLE_EQ(p.init_view_flow, listed.init_view_flow);
}

// An image of any size has room for about as many corners, so that a small one is not starved.
TEST(ParametersAtSize, LeaveRoomForTheCorners) {
  const Parameters listed;
  for (const auto& [width, height] : {std::pair(416, 128), {320, 240}, {752, 480}, {1226, 370}, {1920, 1080}}) {
    SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
    const Parameters p = at_size(listed, width, height);
    const double cells = static_cast<double>(width) * height / (p.corner_cell * p.corner_cell);
    EXPECT_GT(cells, listed.max_tracks);
    EXPECT_LT(cells, 2 * listed.max_tracks);
    EXPECT_GE(p.pyramid_levels, p.text.levels);
    EXPECT_LE(p.pyramid_levels, textplane::kMaxPyramidLevels);
    EXPECT_GE(std::min(width, height) >> (p.pyramid_levels - 1), p.coarsest_side);
    EXPECT_NEAR(p.keyframe_flow / listed.keyframe_flow, std::sqrt(width * height / (640.0 * 480.0)), 1e-9);
  }
}

TEST(ParametersAtSize, KeepCornersApartInTinyImages) {
  const Parameters p = at_size(Parameters(), 64, 48);
  EXPECT_EQ(p.corner_cell, p.min_corner_cell);
  EXPECT_EQ(p.text_corner_cell, p.min_corner_cell);
  EXPECT_EQ(p.pyramid_levels, p.text.levels);
}

}  // namespace parameters_test
}  // namespace textslam
