// A text gets another host while the adjustment of the map is under way: the adjusted plane follows it there.
#include "textslam/adjust/adjustment.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/text/text_hosting_support.hpp"

namespace textslam {
namespace text_hosting_test {

// A thread adjusts the map with the old host while the text gets a new one.
class AdjustedMeanwhile : public TextHostingTest {
 protected:
  AdjustedMeanwhile() {
    near_ = add_target(at(0.1, 1.6));
    for (int i = 0; i < 60; ++i) {
      map.points.emplace_back();
      const Vec3 p(-0.5 + 0.1 * (i % 10), -0.35 + 0.12 * (i / 10), 3);
      map.points.back().p_w = p + 0.01 * Vec3(i % 3 - 1, (i + 1) % 3 - 1, (i + 2) % 5 - 2);
      for (const int k : map.keyframe_ids())
        add_observation(map, i, k, map.camera.project(map.keyframe(k).T_w_c.inverse() * p));
    }
    for (int k = 2; k <= near_; ++k) map.keyframe(k).T_w_c.t += 0.004 * Vec3(k % 3 - 1, k % 2, (k + 1) % 3 - 1);
    text().theta *= 1.01;
  }
  // Where four rays of the first key frame meet the plane of the text.
  std::vector<Vec3> plane() {
    Vec3 theta = text().theta;
    Eigen::Matrix3d unused = Eigen::Matrix3d::Zero();
    EXPECT_TRUE(textplane::transport_plane(map.text_keyframe(0).from(map.text_keyframe(text().host)), &theta, &unused));
    std::vector<Vec3> points;
    for (const Vec2& m : {Vec2(0, 0), Vec2(-0.1, 0), Vec2(0.1, 0), Vec2(0, 0.05)})
      points.push_back(map.keyframe(0).T_w_c * textplane::plane_point<double>(theta, m.homogeneous()));
    return points;
  }
  void expect_plane(const std::vector<Vec3>& expected) {
    const std::vector<Vec3> points = plane();
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT((points[i] - expected[i]).norm(), 1e-9) << i;
  }
  int near_;
};

TEST_F(AdjustedMeanwhile, ThePlaneIsCarriedToTheNewHost) {
  const auto adjustment = StagedAdjustment::around_newest(map, parameters);
  ASSERT_NE(adjustment, nullptr);
  adjustment->solve();
  Map rehosted = map;
  adjustment->apply(map);
  const std::vector<Vec3> in_step = plane();
  const Vec3 theta = text().theta;

  std::swap(map, rehosted);
  const std::vector<Vec3> before = plane();
  ASSERT_TRUE(rehost_to(near_));
  adjustment->apply(map);
  EXPECT_EQ(text().host, near_);
  EXPECT_GT((text().theta - theta).norm(), 0.05) << "not what was solved for the first host";
  expect_plane(in_step);
  EXPECT_GT((before[0] - in_step[0]).norm(), 1e-3) << "the test moves nothing";
}

TEST_F(AdjustedMeanwhile, AndToOneThatCameSince) {
  const auto adjustment = StagedAdjustment::around_newest(map, parameters);
  ASSERT_NE(adjustment, nullptr);
  adjustment->solve();
  Map rehosted = map;
  adjustment->apply(map);
  const std::vector<Vec3> in_step = plane();

  std::swap(map, rehosted);
  const int newer = add_target(at(0.08, 1.65));
  map.keyframe(newer).T_w_c.t += map.keyframe(near_).T_w_c.t - at(0.1, 1.6).t;
  ASSERT_TRUE(rehost_to(newer));
  const SE3d relative = map.keyframe(near_).T_w_c.inverse() * map.keyframe(newer).T_w_c;
  adjustment->apply(map);
  EXPECT_EQ(text().host, newer);
  EXPECT_LT((map.keyframe(near_).T_w_c.inverse() * map.keyframe(newer).T_w_c.t - relative.t).norm(), 1e-9);
  expect_plane(in_step);
}

}  // namespace text_hosting_test
}  // namespace textslam
