// Parameters that follow the size of the images.
#include "textslam/common/parameters.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>
#include <type_traits>
#include <utility>

namespace textslam {
namespace parameters_test {

// How many fields an aggregate of numbers has: as many as it can be made of, and no more.
struct AnyNumber {
  template <class T>
  operator T() const;
};
template <class Aggregate, class Indices, class = void>
struct TakesFields : std::false_type {};
template <class Aggregate, std::size_t... I>
struct TakesFields<Aggregate, std::index_sequence<I...>,
                   std::void_t<decltype(Aggregate{(static_cast<void>(I), AnyNumber())...})>> : std::true_type {};
template <class Aggregate, std::size_t N = 0>
constexpr std::size_t field_count() {
  if constexpr (TakesFields<Aggregate, std::make_index_sequence<N + 1>>::value) {
    return field_count<Aggregate, N + 1>();
  } else {
    return N;
  }
}

// A number of TextOptions that has no line here is in no report, and no experiment can change it.
TEST(ParametersOfTexts, AreAllListed) {
  struct Three {
    int a;
    double b, c;
  };
  static_assert(field_count<Three>() == 3);
  textplane::TextOptions options;
  std::multiset<const void*> listed;
#define SECTION(title)
#define FIELD(type, name, value, meaning)
#define TEXT_FIELD(name, member, meaning) listed.insert(&options.member);
#include "textslam/common/parameters.inc"
#undef TEXT_FIELD
#undef FIELD
#undef SECTION
  EXPECT_EQ(std::set<const void*>(listed.begin(), listed.end()).size(), listed.size()) << "one is there twice";
  EXPECT_EQ(listed.size(), field_count<textplane::TextOptions>());
}

TEST(ParametersAtSize, AreTheListsAt640By480) {
  const Parameters listed, p = at_size(listed, 640, 480);
  EXPECT_EQ(p.corner_cell, listed.corner_cell);
  EXPECT_EQ(p.text_corner_cell, listed.text_corner_cell);
  EXPECT_EQ(p.pyramid_levels, listed.pyramid_levels);
  EXPECT_DOUBLE_EQ(p.keyframe_flow, listed.keyframe_flow);
  EXPECT_DOUBLE_EQ(p.relocation_search, listed.relocation_search);
  EXPECT_DOUBLE_EQ(p.init_view_flow, listed.init_view_flow);
  EXPECT_DOUBLE_EQ(p.loop_max_shift, listed.loop_max_shift);
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
    const double scale = std::sqrt(width * height / (640.0 * 480.0));
    EXPECT_NEAR(p.keyframe_flow / listed.keyframe_flow, scale, 1e-9);
    EXPECT_NEAR(p.loop_max_shift / listed.loop_max_shift, scale, 1e-9);
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
