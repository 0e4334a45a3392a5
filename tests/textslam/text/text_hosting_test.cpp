// The mapper hosts a text anew where a key frame shows it better: textplane/landmarks/text_hosting.hpp.
#include <algorithm>

#include "textslam/text/text_hosting_support.hpp"
#include "textslam/text/text_mapper.hpp"

namespace textslam {
namespace text_hosting_test {

TEST_F(TextHostingTest, AKeyFrameThatWasCulledIsNoHost) {
  const int id = add_target(at(0.1, 1.6));
  map.keyframe(id).culled = true;
  map.keyframe(id).frame.image.reset();
  EXPECT_FALSE(rehost_to(id));
  EXPECT_EQ(text().host, 0);
}

TEST_F(TextHostingTest, TheMapperHostsAnewAsTheCameraWalksUp) {
  const LocalMap everywhere;
  TextMapper mapper(map, everywhere, parameters);
  std::vector<int> hosts;
  for (double z = 0.6; z < 2.4; z += 0.1) {
    const int id = add_keyframe(at(0.15 * (z - 3), z));
    mapper.update(id, {});
    ASSERT_EQ(text().state, TextState::mapped);
    const auto& targets = text().views;
    ASSERT_EQ(targets.size(), map.keyframes.size() - 1) << "all the others show it";
    ASSERT_TRUE(std::is_sorted(targets.begin(), targets.end()));
    ASSERT_EQ(std::count(targets.begin(), targets.end(), text().host), 0);
    if (hosts.empty() || hosts.back() != text().host) hosts.push_back(text().host);
  }
  EXPECT_EQ(hosts.size(), 3U) << "twice, as the last view is more than 16 times as large as the first";
  EXPECT_LT(angle_error(text()), 0.5);
}

}  // namespace text_hosting_test
}  // namespace textslam
