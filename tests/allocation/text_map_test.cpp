// A TextMap allocates nothing to track a frame, once it has tracked one like it.
#include <vector>

#include "allocation/count.hpp"
#include "support/text_wall.hpp"

namespace {
using textplane_test::NoAllocation;
using textplane_test::TextWall;

TEST(NoAllocation, TrackFramesWithTexts) {
  namespace tp = textplane;
  const TextWall wall;
  tp::TextMap map(wall.camera);
  wall.fill(map, 100);
  const tp::SE3d away = tp::se3_exp<double>((tp::Vector6<double>() << 0.05, 0, 0, 0, 0, 0).finished()) * wall.T_c_w;
  const auto track = [&](const tp::SE3d& T, const std::vector<tp::TextPoint>& points) -> const tp::TextFit& {
    return map.track(wall.frame, T, points);
  };
  track(away, {});  // from there the coarse levels are asked
  track(wall.start, wall.points);
  int texts = 0, texts_alone = 0;
  {
    const NoAllocation guard;
    texts = track(wall.start, wall.points).texts;
    texts_alone = track(away, {}).texts;
    track(tp::SE3d{wall.T_c_w.R, {0, 0, -100}}, wall.points);  // sees none
    track(wall.start, wall.points);
  }
  EXPECT_EQ(texts, TextWall::kInView);
  EXPECT_EQ(texts_alone, TextWall::kInView);
}

}  // namespace
