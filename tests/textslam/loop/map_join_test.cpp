// Two maps of one place become one.
#include "textslam/loop/map_join.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "textslam/map/observations.hpp"
#include "textslam/map/text_views.hpp"
#include "textslam/relocalise/boards_support.hpp"
#include "textslam/relocalise/text_hypotheses.hpp"

namespace textslam {
namespace map_join_test {

using namespace boards_support;

// The same three boards, mapped twice: b's world is turned, moved and three times as large.
class MapJoinTest : public TextRecoveryTest {
 protected:
  MapJoinTest() {
    S_a_b.scale = 1 / scale;
    S_a_b.R = textplane::so3_exp<double>(Vec3(0.3, -0.8, 0.4));
    S_a_b.t = {1, 2, -0.5};
    map_again();
    add_points();
  }

  void map_again() {
    b.camera = map.camera;
    b.width = map.width;
    b.height = map.height;
    b.number = 1;
    for (const SE3d& T_c_a : poses) {
      const SE3d T_a_c = T_c_a.inverse();
      b.keyframes.push_back(
          {frame_at(T_c_a), {S_a_b.R.transpose() * T_a_c.R, scale * (S_a_b.R.transpose() * (T_a_c.t - S_a_b.t))}, {}});
    }
    for (const TextObject& text : map.texts) {
      TextObject other = text;
      Vec3 theta = Vec3::Zero();
      EXPECT_EQ(textplane::reanchor_plane<double>(text.theta, poses[0], &theta), textplane::Status::ok);
      other.theta = theta / scale;
      textplane::SelectOptions options;
      options.levels = parameters.text.levels;
      other.patch = textplane::make_patch(b.keyframes[0].frame.image->view(), b.camera,
                                          quad_of(boards[static_cast<std::size_t>(text.id)], poses[0]), options);
      other.views = {1};
      other.votes = {{textplane::consensus(text.votes), 2}};
      b.texts.push_back(std::move(other));
    }
  }

  // A point that both maps have, one of b alone, and a bad one.
  void add_points() {
    map.keyframes.push_back({frame_at(moved({0.2, 0, 0}, {0, 0, 0})), moved({0.2, 0, 0}, {0, 0, 0}).inverse(), {}});
    const Vec3 shared(0.1, 0.5, 3.4), own(-0.9, -0.2, 3);
    const auto in_b = [&](const Vec3& p) -> Vec3 { return scale * (S_a_b.R.transpose() * (p - S_a_b.t)); };
    map.points.resize(1);
    map.points[0].p_w = shared;
    for (int k = 0; k < 2; ++k)
      add_observation(map, 0, k, map.camera.project(map.keyframe(k).T_w_c.inverse() * shared));
    b.points.resize(3);
    b.points[0].bad = true;
    b.points[1].p_w = in_b(own);
    b.points[2].p_w = in_b(shared);
    for (int k = 0; k < 2; ++k) {
      add_observation(b, 1, k, b.camera.project(poses[static_cast<std::size_t>(k)] * own));
      add_observation(b, 2, k, b.camera.project(poses[static_cast<std::size_t>(k)] * shared));
    }
  }

  const double scale = 3;
  Similarity S_a_b;
  const std::vector<SE3d> poses = {moved({0.1, 0, 0}, {0, 0.03, 0}), moved({-0.2, 0.1, 0.1}, {0.02, -0.04, 0})};
  Map b;
};

TEST_F(MapJoinTest, JoinedMapsAreOne) {
  Frame newest = b.keyframe(1).frame;
  for (std::size_t i = 0; i < 3; ++i)
    newest.detections.push_back(detection(i, poses[1], textplane::consensus(map.texts[i].votes)));
  const Relocalisation seen = relocalise(map, parameters, newest);
  ASSERT_TRUE(seen.ok);
  Parameters few = parameters;
  few.join_min_pairs = 12;
  MapLink link = link_maps(map, b, few, seen);
  ASSERT_TRUE(link.ok);
  EXPECT_EQ(link.sightings.size(), 2u);
  EXPECT_EQ(link.texts.size(), 3u);
  EXPECT_NEAR(link.S_a_b.scale, S_a_b.scale, 0.01 * S_a_b.scale);
  EXPECT_LT((link.S_a_b.R - S_a_b.R).norm(), 0.01);
  EXPECT_LT((link.S_a_b.t - S_a_b.t).norm(), 0.03);
  few.join_min_keyframes = 3;
  EXPECT_FALSE(link_maps(map, b, few, seen).ok) << "more than b has";

  link.S_a_b = S_a_b;
  link.points = {{0, 2}};
  const JoinedIds ids = join_maps(map, b, link, parameters);
  EXPECT_EQ(ids.first_keyframe, 2);
  EXPECT_EQ(ids.points, (std::vector<int>{-1, 1, 0}));
  ASSERT_EQ(map.keyframes.size(), 4u);
  ASSERT_EQ(map.points.size(), 2u);
  EXPECT_EQ(map.points[0].observations.size(), 4u);
  for (std::size_t id = 0; id < 2; ++id)
    for (const PointObservation& o : map.points[id].observations) {
      const KeyFrame& keyframe = map.keyframe(o.keyframe);
      EXPECT_LT((map.camera.project(keyframe.T_w_c.inverse() * map.points[id].p_w) - o.px).norm(), 1e-6);
      EXPECT_EQ(std::count(keyframe.points.begin(), keyframe.points.end(), static_cast<int>(id)), 1);
    }
  ASSERT_EQ(map.texts.size(), 3u) << "each is one text";
  EXPECT_EQ(map.texts[0].views, (std::vector<int>{2, 3}));
  EXPECT_EQ(map.texts[0].votes.at("EXIT"), 5);

  // Texts that are not in a move over with their plane.
  map.texts.clear();
  link.texts.clear();
  join_maps(map, b, link, parameters);
  ASSERT_EQ(map.texts.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    Quad<double> quad;
    ASSERT_TRUE(project_text(map, map.texts[i], poses[1], &quad));
    EXPECT_GT(textplane::iou(quad, quad_of(boards[i], poses[1])), 0.99);
  }
}

}  // namespace map_join_test
}  // namespace textslam
