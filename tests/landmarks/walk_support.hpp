// A camera that walks up to a sign, for the tests of hosting and refinement.
#ifndef TESTS_LANDMARKS_WALK_SUPPORT_HPP
#define TESTS_LANDMARKS_WALK_SUPPORT_HPP

#include <gtest/gtest.h>

#include "landmarks/frames_support.hpp"
#include "landmarks/wall_support.hpp"
#include "textplane/landmarks/text_hosting.hpp"

namespace landmarks_test {

// Key frames step aside and up to the sign.
class WalkTest : public testing::Test {
 protected:
  WalkTest() { begin(); }

  // The walk's begin, in new noise.
  void begin() {
    frames.camera = wall.camera;
    frames.all.clear();
    for (const double z : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5}) add_keyframe(at(0.6 * z - 0.5, z));
    text = TextObject();
    text.id = 0;
    text.state = TextState::mapped;
    text.host = 0;
    text.patch = make_text_patch(options, frames.text_keyframe(0), wall.quad_in(frames[0].T_w_c));
    text.theta = frames[0].T_w_c.R.transpose() * Vec3(0, 0, 1.0 / 3);
    text.views = {1, 2, 3, 4, 5};
    text.votes["EXIT"] = 3;
    text.detections = 6;
    EXPECT_TRUE(refine_text_plane(options, KeyframeLookup(frames), text.views, text.theta, 0.9, text));
  }
  static SE3d at(double x, double z, double y = 0.05) { return Wall::at(x, z, y); }

  int add_keyframe(const SE3d& T_w_c, int blur = 0) {
    frames.all.push_back({T_w_c, wall.render(T_w_c, blur, 4)});
    return static_cast<int>(frames.all.size()) - 1;
  }
  // One that the text has as a target.
  int add_target(const SE3d& T_w_c, int blur = 0) {
    const int id = add_keyframe(T_w_c, blur);
    text.views.push_back(id);
    return id;
  }

  Vec3 corner(const TextObject& of, std::size_t i) const {
    return frames[of.host].T_w_c * plane_point<double>(of.theta, wall.camera.unproject(of.patch.quad.corner[i]));
  }
  double angle_error(const TextObject& of) const {
    return degrees_apart(frames[of.host].T_w_c.R * plane_normal(of.theta), Vec3(0, 0, -1));
  }
  bool rehosted(int id, TextObject& of) const { return rehost(options, KeyframeLookup(frames), id, of); }
  bool rehosted(int id) { return rehosted(id, text); }
  void expect_unchanged(const TextObject& before) {
    EXPECT_EQ(text.host, before.host);
    EXPECT_EQ(text.views, before.views);
    EXPECT_EQ(text.theta, before.theta);
    EXPECT_EQ(text.covariance, before.covariance);
    EXPECT_EQ(text.zncc, before.zncc);
    EXPECT_EQ(text.patch.quad.corner, before.patch.quad.corner);
  }
  void expect_refused(int id, const char* why) {
    const TextObject before = text;
    EXPECT_FALSE(rehosted(id)) << why;
    expect_unchanged(before);
  }

  Wall wall;
  Frames frames;
  TextObject text;
  TextOptions options;
};

}  // namespace landmarks_test

#endif  // TESTS_LANDMARKS_WALK_SUPPORT_HPP
