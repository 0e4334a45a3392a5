// Detections between key frames: remembered, carried along, and enough for a new text where two agree.
#include "textslam/text/pending_texts.hpp"

#include "textslam/text/text_hosting_support.hpp"
#include "textslam/text/text_mapper.hpp"

namespace textslam {
namespace text_hosting_test {

class PendingTextsTest : public TextHostingTest {
 protected:
  // Points on the wall, about the sign too, which the newest key frame observes. No text is known.
  PendingTextsTest() {
    map.number = 0;
    map.texts.clear();
    for (int i = 0; i < 81; ++i) {
      MapPoint point;
      point.p_w = Vec3(0.15 * (i % 9 - 4), 0.1 * (i / 9 - 4), 3);
      map.points.push_back(point);
      map.keyframes.back().points.push_back(i);
    }
  }
  Frame frame(double time, const SE3d& T_w_c) const {
    Frame out;
    out.timestamp = time;
    out.detections = {{quad_in(T_w_c), "EXIT", 1}};
    return out;
  }
  void see(double time, const SE3d& T_w_c) {
    const Frame seen = frame(time, T_w_c);
    pending.add(map, seen, T_w_c.inverse(), seen.detections);
  }
  PendingTexts pending{parameters};
};

TEST_F(PendingTextsTest, TwoThatAgreeAreCarriedToAFrame) {
  see(0, at(-0.2, 0.5));
  const SE3d next = at(0.1, 0.8);
  EXPECT_TRUE(pending.carried_to(map, next.inverse()).empty()) << "one alone may be false";
  see(0.3, at(-0.1, 0.6));
  const std::vector<Detection> carried = pending.carried_to(map, next.inverse());
  ASSERT_EQ(carried.size(), 1U);
  EXPECT_EQ(carried[0].text, "EXIT");
  EXPECT_GT(textplane::iou(carried[0].quad, quad_in(next)), 0.85);
}

TEST_F(PendingTextsTest, OthersElsewhereDoNotAgree) {
  see(0, at(-0.2, 0.5));
  Frame beside = frame(0.1, at(-0.2, 0.5));
  for (Vec2& corner : beside.detections[0].quad.corner) corner.y() += 30;
  pending.add(map, beside, at(-0.2, 0.5).inverse(), beside.detections);
  EXPECT_TRUE(pending.carried_to(map, at(-0.2, 0.5).inverse()).empty());
}

TEST_F(PendingTextsTest, WhatIsOldIsForgotten) {
  see(0, at(-0.2, 0.5));
  see(1.1 * parameters.text_pending, at(-0.2, 0.5));
  EXPECT_TRUE(pending.carried_to(map, at(-0.2, 0.5).inverse()).empty());
  see(1.5 * parameters.text_pending, at(-0.2, 0.5));
  EXPECT_EQ(pending.carried_to(map, at(-0.2, 0.5).inverse()).size(), 1U);
  map.number = 1;
  EXPECT_TRUE(pending.carried_to(map, at(-0.2, 0.5).inverse()).empty()) << "of another map";
}

TEST_F(PendingTextsTest, WithoutPointsAboutItNobodyKnowsWhereItIs) {
  for (MapPoint& point : map.points) point.bad = true;
  see(0, at(-0.2, 0.5));
  see(0.1, at(-0.2, 0.5));
  EXPECT_TRUE(pending.carried_to(map, at(-0.2, 0.5).inverse()).empty());
}

TEST_F(PendingTextsTest, WhatIsTakenIsCountedAndForgotten) {
  for (const double time : {0.0, 0.1, 0.2}) see(time, at(-0.2, 0.5));
  const SE3d T_c_w = at(-0.1, 0.6).inverse();
  Quad<double> elsewhere = quad_in(at(-0.1, 0.6));
  for (Vec2& corner : elsewhere.corner) corner.y() += 40;
  EXPECT_EQ(pending.take(map, T_c_w, elsewhere).detections, 0);
  EXPECT_EQ(pending.take(map, T_c_w, quad_in(at(-0.1, 0.6))).detections, 3);
  EXPECT_EQ(pending.take(map, T_c_w, quad_in(at(-0.1, 0.6))).detections, 0);
}

// Frames whose detections are all elsewhere could have shown it.
TEST_F(PendingTextsTest, MissesCountToo) {
  see(0, at(-0.2, 0.5));
  Frame none;
  for (const double time : {0.1, 0.2, 0.3}) {
    none.timestamp = time;
    pending.add(map, none, at(-0.2, 0.5).inverse(), {});
  }
  see(0.4, at(-0.2, 0.5));
  const PendingTexts::Count count = pending.take(map, at(-0.2, 0.5).inverse(), quad_in(at(-0.2, 0.5)));
  EXPECT_EQ(count.detections, 2);
  EXPECT_EQ(count.shown, 5);
}

// A detector that misses every key frame.
TEST_F(PendingTextsTest, TheMapperBeginsATextWithThem) {
  const LocalMap everywhere{};
  TextMapper mapper(map, everywhere, parameters);
  for (int i = 0; i < 3; ++i) {
    const SE3d T_w_c = at(-0.2 + 0.02 * i, 0.5);
    mapper.associate(frame(0.05 * i, T_w_c), T_w_c.inverse(), {});
  }
  const int id = add_keyframe(at(-0.1, 0.55));
  Frame missed = map.keyframe(id).frame;
  const std::vector<Detection> fresh = mapper.new_detections(missed, map.keyframe(id).T_w_c.inverse(), {});
  ASSERT_EQ(fresh.size(), 1U);
  mapper.add_candidates(id, fresh);
  ASSERT_EQ(map.texts.size(), 1U);
  EXPECT_EQ(text().host, id);
  EXPECT_EQ(text().detections, 3);
  EXPECT_EQ(text().shown, 3);
  EXPECT_TRUE(mapper.new_detections(missed, map.keyframe(id).T_w_c.inverse(), {}).empty()) << "it is known now";
}

class TextMapperViewsTest : public TextHostingTest {
 protected:
  // Corners of the sign that were followed from key frame `host` to the newest.
  std::vector<Track> corners_from(int host) const {
    std::vector<Track> tracks;
    for (int i = 0; i < 12; ++i) {
      const Vec3 p(0.12 * (i % 4 - 1.5), 0.06 * (i / 4 - 1), 3);
      Track track;
      for (int k = host; k <= map.newest_keyframe(); ++k)
        track.observations.push_back({k, map.camera.project(map.keyframe(k).T_w_c.inverse() * p)});
      tracks.push_back(track);
    }
    return tracks;
  }
  const LocalMap everywhere{};
};

// The key frames before the first detection show the text as well.
TEST_F(TextMapperViewsTest, APlaneIsSeenInKeyFramesBeforeItsHost) {
  text().state = TextState::candidate;
  text().host = 4;
  text().patch = make_text_patch(parameters.text, map.text_keyframe(4), quad_in(map.keyframe(4).T_w_c));
  text().views.clear();
  map.keyframe(1).culled = true;
  TextMapper(map, everywhere, parameters).update(5, corners_from(4));
  EXPECT_EQ(text().views, (std::vector<int>{0, 2, 3, 5}));
  EXPECT_EQ(text().state, TextState::mapped);
  EXPECT_LT(angle_error(text()), 1.5);
}

// An image that is blurred does not speak against a text that the detector sees in it.
TEST_F(TextMapperViewsTest, WhereTheDetectorSeesItItIsNotMissing) {
  for (const bool seen : {false, true}) {
    begin();
    TextMapper mapper(map, everywhere, parameters);
    for (int i = 0; i < 3; ++i) {
      const int id = add_keyframe(at(0.02 * i, 0.5), 12);
      if (seen) map.keyframe(id).frame.detections = {{quad_in(map.keyframe(id).T_w_c), "EXIT", 1}};
      mapper.update(id, {});
    }
    EXPECT_EQ(text().views.size(), 5U) << "the blurred ones do not show it";
    EXPECT_EQ(text().failures, seen ? 0 : 3);
  }
}

}  // namespace text_hosting_test
}  // namespace textslam
