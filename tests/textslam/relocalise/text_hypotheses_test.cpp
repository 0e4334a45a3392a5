// Relocalisation in a scene made by formula: a lost frame by its signs.
#include "textslam/relocalise/text_hypotheses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "textslam/lens_support.hpp"
#include "textslam/relocalise/boards_support.hpp"
#include "textslam/relocalise/relocalisation.hpp"

namespace textslam {
namespace text_hypotheses_test {

using namespace boards_support;

TEST_F(TextRecoveryTest, OneSignGivesThePose) {
  for (const SE3d& truth : {moved({0.4, 0.1, -0.3}, {0.05, 0.15, 0.1}), moved({-0.6, 0.2, 0.3}, {-0.1, -0.2, -0.2})}) {
    Frame frame = frame_at(truth);
    frame.detections = {detection(1, truth, "OPEN")};
    const auto found = text_hypotheses(map, parameters, frame, WordMatch::same);
    ASSERT_FALSE(found.empty());
    ASSERT_LE(found.size(), 2u) << "one a solution";
    for (const TextHypothesis& hypothesis : found) {
      EXPECT_EQ(hypothesis.text, 1);
      EXPECT_EQ(hypothesis.confirmed, 1);
      EXPECT_GT(hypothesis.zncc, 0.9);
    }
    // So small a sign looks much the same from two places; its pixels tell them apart.
    expect_pose(found[0].T_c_w, truth, 0.02, 0.5);
  }
}

// Signs of a raw image, through either lens.
template <bool kFisheye>
class BehindLens : public TextRecoveryTest {
 protected:
  BehindLens() : TextRecoveryTest(kFisheye ? &lens_support::fisheye() : &lens_support::wide_lens()) {}

  void expect_found() {
    const SE3d truth = moved({0.3, -0.1, 0.2}, {0.02, -0.1, 0.05});
    Frame frame = frame_at(truth);
    frame.detections = {detection(1, truth, "OPEN")};
    const auto found = text_hypotheses(map, parameters, frame, WordMatch::same);
    ASSERT_FALSE(found.empty());
    EXPECT_GT(found[0].zncc, 0.9);
    expect_pose(found[0].T_c_w, truth, 0.03, 0.7);
    for (const std::size_t i : {0U, 2U})
      frame.detections.push_back(detection(i, truth, textplane::consensus(map.texts[i].votes)));
    const Relocalisation recovery = relocalise(map, parameters, frame);
    ASSERT_TRUE(recovery.ok);
    EXPECT_EQ(recovery.texts, 3);
    expect_pose(recovery.T_c_w, truth, 0.006, 0.12);
  }
};
using WideTextRecoveryTest = BehindLens<false>;
using FisheyeTextRecoveryTest = BehindLens<true>;
TEST_F(WideTextRecoveryTest, SignsGiveThePose) { expect_found(); }
TEST_F(FisheyeTextRecoveryTest, SignsGiveThePose) { expect_found(); }
// The same images without their lens: the poses are off, so the tests above can fail.
TEST_F(WideTextRecoveryTest, WithoutTheLensThePoseIsOff) {
  const SE3d truth = moved({0.3, -0.1, 0.2}, {0.02, -0.1, 0.05});
  Frame frame = frame_at(truth);
  for (std::size_t i = 0; i < 3; ++i)
    frame.detections.push_back(detection(i, truth, textplane::consensus(map.texts[i].votes)));
  map.camera.lens = nullptr;
  const Relocalisation recovery = relocalise(map, parameters, frame);
  EXPECT_TRUE(!recovery.ok || (recovery.T_c_w.inverse().t - truth.inverse().t).norm() > 0.01);
}

TEST_F(TextRecoveryTest, SeveralSignsConfirmEachOther) {
  const SE3d truth = moved({0.3, -0.1, 0.2}, {0.02, -0.1, 0.05});
  Frame frame = frame_at(truth);
  for (std::size_t i = 0; i < 3; ++i)
    frame.detections.push_back(detection(i, truth, textplane::consensus(map.texts[i].votes)));
  const auto found = text_hypotheses(map, parameters, frame, WordMatch::same);
  ASSERT_GE(found.size(), 3u);
  EXPECT_EQ(found[0].confirmed, 3);
  expect_pose(found[0].T_c_w, truth, 0.05, 1.0);
  EXPECT_TRUE(text_hypotheses(map, parameters, frame, WordMatch::other).empty())
      << "a board is not taken for another one";

  const Relocalisation recovery = relocalise(map, parameters, frame);
  ASSERT_TRUE(recovery.ok) << "by texts alone: the map has no points";
  EXPECT_EQ(recovery.texts, 3);
  expect_pose(recovery.T_c_w, truth, 0.005, 0.1);
}

TEST_F(TextRecoveryTest, MisreadAndUnreadSignsAreFoundByTheirPixels) {
  const SE3d truth = moved({-0.2, 0.1, 0.3}, {0.02, 0.1, -0.05});
  Frame frame = frame_at(truth);
  frame.detections = {detection(0, truth, "###"), detection(1, truth, "0PEN")};
  EXPECT_TRUE(text_hypotheses(map, parameters, frame, WordMatch::same).empty());
  const auto found = text_hypotheses(map, parameters, frame, WordMatch::other);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].confirmed, 2);
  expect_pose(found[0].T_c_w, truth, 0.05, 1.0);
  EXPECT_TRUE(relocalise(map, parameters, frame).ok);
}

TEST_F(TextRecoveryTest, AWordAloneIsNoPlace) {
  // The same words, printed otherwise.
  const SE3d truth = moved({0.2, 0, 0.1}, {0, 0.1, 0});
  for (Board& board : boards) board.print += 10;
  Frame frame = frame_at(truth);
  for (std::size_t i = 0; i < 3; ++i)
    frame.detections.push_back(detection(i, truth, textplane::consensus(map.texts[i].votes)));
  EXPECT_FALSE(relocalise(map, parameters, frame).ok);
  // The same sign, hung elsewhere, and nothing else.
  boards = {{moved({0.5, 0.5, 2.5}, {0, 0.3, 0}), 1}};
  frame = frame_at(SE3d{});
  frame.detections = {detection(0, SE3d{}, "EXIT")};
  EXPECT_FALSE(text_hypotheses(map, parameters, frame, WordMatch::same).empty());
  EXPECT_FALSE(relocalise(map, parameters, frame).ok);
  // Senseless quads.
  frame.detections[0].quad.corner[2] = frame.detections[0].quad.corner[0];
  EXPECT_TRUE(text_hypotheses(map, parameters, frame, WordMatch::same).empty());
  frame.detections[0].quad.corner[2].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(text_hypotheses(map, parameters, frame, WordMatch::same).empty());
}

// Two of the three signs hang alike in another room. The frame shows all three, its detector missed the third.
TEST_F(TextRecoveryTest, ThePoseThatExplainsMostIsTaken) {
  const SE3d truth = moved({0.3, -0.1, 0.2}, {0.02, -0.1, 0.05}), T_w_other = moved({30, 0, 0}, {0, 0, 0});
  const std::vector<Board> room = boards;
  const SE3d T_c_other = truth * T_w_other.inverse();
  boards = {{T_w_other * room[0].T_w_b, room[0].print}, {T_w_other * room[1].T_w_b, room[1].print}};
  map.keyframes.push_back({frame_at(T_c_other), T_c_other.inverse(), {}});
  map.keyframes.back().frame.index = 1;
  add_text(boards[0], 1, "EXIT");
  add_text(boards[1], 1, "OPEN");

  boards = room;
  Frame frame = frame_at(truth);
  frame.detections = {detection(0, truth, "EXIT"), detection(1, truth, "OPEN")};
  const auto found = text_hypotheses(map, parameters, frame, WordMatch::same);
  ASSERT_FALSE(found.empty());
  EXPECT_GE(found[0].text, 3) << "the other room's key frame saw them from here: it comes first";
  ASSERT_TRUE(recognise_from(map, parameters, frame, found[0].T_c_w).ok) << "and would do";
  const Relocalisation recovery = relocalise_by_texts(map, parameters, frame, {WordMatch::same});
  ASSERT_TRUE(recovery.ok);
  EXPECT_EQ(recovery.texts, 3);
  expect_pose(recovery.T_c_w, truth, 0.006, 0.12);
}

// The signs of a room that is not mapped hang alike in a mapped one, where much else hangs too that the frame does not
// show. What an earlier frame saw from nearby is the better answer.
TEST_F(TextRecoveryTest, APoseThatExplainsLittleIsNotTakenBeforeOthersAreTried) {
  const SE3d truth = moved({0.1, -0.05, 0.1}, {0.02, -0.03, 0.02}), T_w_other = moved({30, 0, 0}, {0, 0, 0});
  map_points_of_five_boards();
  const std::vector<Board> room = boards;
  map.texts.clear();
  boards = {{T_w_other * room[0].T_w_b, room[0].print}, {T_w_other * room[1].T_w_b, room[1].print}};
  for (const double x : {-1.0, -0.2, 0.6, 1.4})
    boards.push_back({T_w_other * moved({x, -0.9, 3.5}, {0, 0, 0}), static_cast<unsigned>(20 + 10 * x)});
  map.keyframes.push_back({frame_at(T_w_other.inverse()), T_w_other, {}});
  map.keyframes.back().frame.index = 1;
  add_text(boards[0], 1, "EXIT");
  add_text(boards[1], 1, "OPEN");
  add_points(1);

  boards = room;
  Frame frame = frame_at(truth);
  frame.detections = {detection(0, truth, "EXIT"), detection(1, truth, "OPEN")};
  const Relocalisation by_texts = relocalise_by_texts(map, parameters, frame, {WordMatch::same});
  ASSERT_TRUE(by_texts.ok) << "the wrong pose would do";
  EXPECT_GT(by_texts.T_c_w.inverse().t.x(), 29);
  const Relocalisation recovery = relocalise(map, parameters, frame);
  ASSERT_TRUE(recovery.ok);
  EXPECT_GT(recovery.inliers, by_texts.inliers + by_texts.texts);
  expect_pose(recovery.T_c_w, truth, 0.01, 0.2);
}

// Key frames and points find the same pose, by chance with some points more.
TEST_F(TextRecoveryTest, ThePoseOfASignStaysItsOwnWhereOthersConfirmIt) {
  map_points_of_five_boards();
  parameters.relocalise_clear_share = 2;  // no pose is so clear that no others are tried
  for (const int i : {18, 49}) {          // of sixty, where the points have some more
    const double x = 0.6 * std::sin(i * 1.7), y = 0.4 * std::sin(i * 2.9);
    const SE3d truth = moved({x, y, 0.6 * std::sin(i * 0.7)}, {0.2 * x, -0.2 * y, 0.3 * std::sin(i * 3.3)});
    Frame frame = frame_at(truth);
    frame.detections = {detection(1, truth, "OPEN")};
    const Relocalisation sign = relocalise_by_texts(map, parameters, frame, {WordMatch::same});
    const Relocalisation recovery = relocalise(map, parameters, frame);
    ASSERT_TRUE(sign.ok && recovery.ok) << i;
    EXPECT_GT(recovery.shown(), sign.shown());
    EXPECT_EQ(recovery.by, FoundBy::texts) << i;
    expect_pose(recovery.T_c_w, truth, 0.01, 0.2);
  }
}

// From so far away the pose by the sign alone is off by more than points are searched.
TEST_F(TextRecoveryTest, PointsAroundASignHelpWhereItsPoseIsRough) {
  map_points_of_five_boards();
  constexpr int i = 67;  // of 120, the one where the search alone fails
  const double x = 0.8 * std::sin(i * 1.7), y = 0.6 * std::sin(i * 2.9), z = -0.6 + 1.2 * std::sin(i * 0.7);
  const SE3d truth = moved({x, y, z}, {0.3 * x, -0.3 * y, 0.3 * std::sin(i * 3.3)});
  Frame frame = frame_at(truth);
  frame.detections = {detection(1, truth, "OPEN")};
  FrameLooks looks(frame, parameters);
  EXPECT_FALSE(relocalise_by_texts(map, parameters, frame, {WordMatch::same}).ok);
  const Relocalisation recovery = relocalise_by_texts(map, parameters, frame, {WordMatch::same}, &looks);
  ASSERT_TRUE(recovery.ok);
  EXPECT_EQ(recovery.by, FoundBy::texts);
  expect_pose(recovery.T_c_w, truth, 0.01, 0.2);
}

}  // namespace text_hypotheses_test
}  // namespace textslam
