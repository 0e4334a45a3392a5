// A text that waits to be mapped asks for key frames: where it is in view and has parallax since the last one.
#include "textslam/text/text_hosting_support.hpp"
#include "textslam/text/text_mapper.hpp"

namespace textslam {
namespace text_hosting_test {

class TextKeyframeTest : public TextHostingTest {
 protected:
  TextKeyframeTest() { text().state = TextState::tentative; }
  // At the distance of the last key frame from the sign, `degrees` round it.
  SE3d round(double degrees) const {
    const Vec3 sign(0, 0, 3), eye = map.keyframe(last).T_w_c.t - sign;
    const Vec3 moved = sign + textplane::so3_exp<double>(Vec3(0, degrees * kDegree, 0)) * eye;
    return at(moved.x(), moved.z(), moved.y()).inverse();
  }
  bool asks(const SE3d& T_c_w, const std::vector<Track>& tracks = {}) const {
    return TextMapper(const_cast<Map&>(map), local, parameters).has_parallax(T_c_w, tracks, last);
  }
  const int last = 5;
  LocalMap local;
};

TEST_F(TextKeyframeTest, WithParallax) {
  EXPECT_FALSE(asks(round(0)));
  EXPECT_FALSE(asks(round(0.9 * parameters.text_keyframe_parallax)));
  EXPECT_TRUE(asks(round(1.1 * parameters.text_keyframe_parallax)));
  SE3d turned = round(0);
  turned.R = textplane::so3_exp<double>(Vec3(0, 0.05, 0)) * turned.R;
  EXPECT_FALSE(asks(turned)) << "a rotation is no parallax";
}

TEST_F(TextKeyframeTest, NotOnceItIsMappedNorWhereNobodySeesIt) {
  const SE3d T_c_w = round(3);
  ASSERT_TRUE(asks(T_c_w));
  SE3d away = T_c_w;
  away.R = textplane::so3_exp<double>(Vec3(0, 0.5, 0)) * away.R;
  EXPECT_FALSE(asks(away)) << "it is not whole in the image";
  text().detections = 1;
  EXPECT_FALSE(asks(T_c_w)) << "a single hit of the detector";
  text().detections = 6;
  text().shown = 1000;
  EXPECT_FALSE(asks(T_c_w)) << "too seldom detected";
  text().shown = 6;
  for (const TextState state : {TextState::mapped, TextState::dropped}) {
    text().state = state;
    EXPECT_FALSE(asks(T_c_w));
  }
}

// Without a plane the corners tell.
TEST_F(TextKeyframeTest, ACandidateByItsCorners) {
  text().state = TextState::candidate;
  for (const double degrees : {0.5, 1.1}) {
    const double parallax = degrees * parameters.text_keyframe_parallax;
    const SE3d T_c_w = round(parallax);
    std::vector<Track> tracks;
    for (int i = 0; i < 9; ++i) {
      const Vec3 p(0.2 * (i % 3 - 1), 0.06 * (i / 3 - 1), 3);
      Track track;
      for (int k = 0; k <= last; ++k)
        track.observations.push_back({k, map.camera.project(map.keyframe(k).T_w_c.inverse() * p)});
      track.px = map.camera.project(T_c_w * p).cast<float>();
      tracks.push_back(track);
    }
    EXPECT_EQ(asks(T_c_w, tracks), degrees > 1);
    EXPECT_FALSE(asks(T_c_w)) << "and nothing without them";
  }
}

}  // namespace text_hosting_test
}  // namespace textslam
