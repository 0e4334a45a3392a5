// A camera that walks up to a sign, for the tests of hosting.
#ifndef TESTS_TEXTSLAM_TEXT_TEXT_HOSTING_SUPPORT_HPP
#define TESTS_TEXTSLAM_TEXT_TEXT_HOSTING_SUPPORT_HPP

#include <gtest/gtest.h>

#include "landmarks/wall_support.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/landmarks/text_hosting.hpp"
#include "textslam/map/map.hpp"

namespace textslam {
namespace text_hosting_test {

constexpr double kDegree = M_PI / 180;

// A wall three units away with a sign about its origin; key frames step aside and up to it.
class TextHostingTest : public testing::Test {
 protected:
  TextHostingTest() {
    map.camera = wall.camera;
    map.width = landmarks_test::kWallWidth;
    map.height = landmarks_test::kWallHeight;
    begin();
  }

  // The walk's begin, in new noise.
  void begin() {
    map.keyframes.clear();
    map.texts.clear();
    for (const double z : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5}) add_keyframe(at(0.6 * z - 0.5, z));
    TextObject text;
    text.id = 0;
    text.state = TextState::mapped;
    text.host = 0;
    text.patch = make_text_patch(parameters.text, map.text_keyframe(0), quad_in(map.keyframe(0).T_w_c));
    text.theta = map.keyframe(0).T_w_c.R.transpose() * Vec3(0, 0, 1.0 / 3);
    text.views = {1, 2, 3, 4, 5};
    text.votes["EXIT"] = 3;
    text.detections = 6;
    map.texts.push_back(text);
    EXPECT_TRUE(
        refine_text_plane(parameters.text, textplane::KeyframeLookup(map), text.views, text.theta, 0.9, map.texts[0]));
  }

  static SE3d at(double x, double z, double y = 0.05) { return landmarks_test::Wall::at(x, z, y); }
  Quad<double> quad_in(const SE3d& T_w_c) const { return wall.quad_in(T_w_c); }

  int add_keyframe(const SE3d& T_w_c, int blur = 0) {
    KeyFrame keyframe;
    keyframe.frame.index = 5 * static_cast<int>(map.keyframes.size());
    keyframe.frame.image = wall.render(T_w_c, blur, parameters.pyramid_levels);
    keyframe.T_w_c = T_w_c;
    map.keyframes.push_back(keyframe);
    return static_cast<int>(map.keyframes.size()) - 1;
  }
  // One that the text has as a target.
  int add_target(const SE3d& T_w_c, int blur = 0) {
    const int id = add_keyframe(T_w_c, blur);
    text().views.push_back(id);
    return id;
  }

  TextObject& text() { return map.texts[0]; }
  double angle_error(const TextObject& text) const {
    return degrees_between(map.keyframe(text.host).T_w_c.R * textplane::plane_normal(text.theta), Vec3(0, 0, -1));
  }
  bool rehost_to(int id) { return rehost(parameters.text, textplane::KeyframeLookup(map), id, text()); }

  Map map;
  Parameters parameters;
  landmarks_test::Wall wall;
};

}  // namespace text_hosting_test
}  // namespace textslam

#endif  // TESTS_TEXTSLAM_TEXT_TEXT_HOSTING_SUPPORT_HPP
