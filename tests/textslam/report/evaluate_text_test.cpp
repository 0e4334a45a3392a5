// Text maps against true signs.
#include "textslam/report/evaluate_text.hpp"

#include <gtest/gtest.h>

#include <array>

#include "io/io_support.hpp"
#include "textplane/geometry/plane.hpp"
#include "textslam/map/text_views.hpp"
#include "textslam/scene_support.hpp"

namespace textslam {
namespace evaluate_text_test {

using namespace scene_support;

// A map with texts at known places: the truth is the map moved, turned and scaled.
class EvaluateTextTest : public testing::Test {
 protected:
  EvaluateTextTest() {
    map.camera = camera();
    map.keyframes.push_back({{}, moved({0.3, -0.2, 0.1}, {0.1, 0.2, -0.1}), {}});
    to_truth.scale = 2.5;
    to_truth.R = textplane::so3_exp<double>(Vec3(0.4, -1.1, 0.7));
    to_truth.t = {5, -3, 2};
  }
  // A text with its plane; returns the sign that it stands for.
  TrueSign add(const std::string& word, double x, const Vec3& normal, TextState state = TextState::mapped) {
    TextObject text;
    text.id = static_cast<int>(map.texts.size());
    text.state = state;
    text.host = 0;
    text.theta = textplane::plane_from_normal<double>(normal, 3);
    text.patch.camera = map.camera.pinhole;
    text.patch.quad.corner = {Vec2(x, 200), Vec2(x + 80, 200), Vec2(x + 80, 230), Vec2(x, 230)};
    text.votes[word] = 2;
    map.texts.push_back(text);
    TrueSign sign;
    sign.id = 10 + text.id;
    sign.word = word;
    sign.corners = world_corners(map, text);
    for (Vec3& corner : sign.corners) corner = to_truth * corner;
    sign.normal = to_truth.R * (map.keyframe(0).T_w_c.R * normal.normalized());
    sign.visible_frames = 50;
    return sign;
  }
  Map map;
  Similarity to_truth;
};

TEST_F(EvaluateTextTest, CornersLieOnThePlaneAndInTheQuad) {
  const TrueSign sign = add("EXIT", 200, {0.2, 0.1, -1});
  const SE3d T_c_w = map.keyframe(0).T_w_c.inverse();
  const std::array<Vec3, 4> corners = world_corners(map, map.texts[0]);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 p = T_c_w * corners[i];
    EXPECT_NEAR(map.texts[0].theta.dot(p), 1, 1e-12);
    EXPECT_LT((map.camera.project(p) - map.texts[0].patch.quad.corner[i]).norm(), 1e-9);
  }
}

TEST_F(EvaluateTextTest, ATextOnACylinderIsFalseAndNoSign) {
  std::vector<TrueSign> signs = {add("EXIT", 100, {0.2, 0, -1}), add("OPEN", 300, {0, 0, -1})};
  signs[1].radius = 0.2;
  const TextEvaluation round = evaluate_text(map, signs, to_truth);
  EXPECT_EQ(round.signs, 1);
  EXPECT_EQ(round.mapped, 1);
  EXPECT_EQ(round.false_texts, 1);
  EXPECT_EQ(round.matches[1].sign, -1);
  EXPECT_EQ(round.matches[1].text, 1);
  EXPECT_LT(round.angle.max, 1e-5) << "its normal is no error";
}

TEST_F(EvaluateTextTest, MatchesPlacesNormalsAndWords) {
  std::vector<TrueSign> signs = {add("EXIT", 100, {0.2, 0, -1}), add("OPEN", 300, {0, 0, -1}),
                                 add("TAXI", 450, {0, 0.3, -1})};
  const TextEvaluation exact = evaluate_text(map, signs, to_truth);
  EXPECT_TRUE(exact.available);
  EXPECT_EQ(exact.signs, 3);
  EXPECT_EQ(exact.mapped, 3);
  EXPECT_EQ(exact.false_texts, 0);
  EXPECT_LT(exact.angle.max, 1e-5);
  EXPECT_LT(exact.centre.max, 1e-12);
  ASSERT_EQ(exact.matches.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(exact.matches[i].sign, signs[i].id);
    EXPECT_TRUE(exact.matches[i].word);
  }

  // One normal off by 7 degrees, one word misread, one sign hardly ever seen, one that has no text.
  const Vec3 axis = signs[0].normal.cross(signs[0].corners[1] - signs[0].corners[0]).normalized();
  signs[0].normal = textplane::so3_exp<double>(Vec3(7 * kDegree * axis)) * signs[0].normal;
  map.texts[1].votes["0PEN"] = 3;
  signs[2].visible_frames = 2;
  TrueSign other = signs[1];
  other.id = 99;
  for (Vec3& corner : other.corners) corner += Vec3(0, 40, 0);
  signs.push_back(other);
  const TextEvaluation worse = evaluate_text(map, signs, to_truth);
  EXPECT_EQ(worse.signs, 3) << "the one hardly seen does not count";
  EXPECT_EQ(worse.mapped, 2);
  EXPECT_EQ(worse.false_texts, 0) << "but what stands for it is not false";
  EXPECT_NEAR(worse.angle.max, 7, 1e-6);
  EXPECT_FALSE(worse.matches[1].word);
}

TEST_F(EvaluateTextTest, TextsWithoutSignAreFalseAndUnfinishedOnesDoNotCount) {
  std::vector<TrueSign> signs = {add("EXIT", 100, {0, 0, -1})};
  add("GHOST", 400, {0, 0, -1});
  add("LATER", 250, {0, 0, -1}, TextState::tentative);
  const TextEvaluation evaluation = evaluate_text(map, signs, to_truth);
  EXPECT_EQ(evaluation.mapped, 1);
  EXPECT_EQ(evaluation.false_texts, 1);
  EXPECT_EQ(evaluation.matches.size(), 2u);
  EXPECT_FALSE(evaluate_text(map, {}, to_truth).available) << "nothing to compare with";
}

// Seen by a camera that walks by at distance 2: whole, 9 px high and wide, and not from the edge.
TEST_F(EvaluateTextTest, ClearSignsAreThoseThatCouldBeMapped) {
  const TemporaryFolder folder;
  Sequence sequence;
  sequence.folder = folder.path();
  folder.write("truth/signs.json",
               R"({"signs":[{"id":3,"text":"A","corners":[[-1,1,0],[1,1,0],[1,-1,0],[-1,-1,0]],"normal":[0,0,1]},
                            {"id":4,"text":"B","corners":[[-1,1,0],[1,1,0],[1,-1,0],[-1,-1,0]],"normal":[1,0,0]}]})");
  const auto write = [&](int frame, const std::string& visible, int height) {
    const std::string quad = "0,0,50,0,50," + std::to_string(height) + ",0," + std::to_string(height);
    folder.write("truth/quads/" + std::to_string(frame) + ".txt",
                 quad + ",A,3," + visible + "\n" + quad + ",B,4," + visible + "\n");
  };
  for (int i = 0; i < 30; ++i) {
    FrameRef frame;
    frame.timestamp = i;
    frame.stem = std::to_string(i);
    sequence.frames.push_back(frame);
    SE3d T_w_c;
    T_w_c.t = Vec3(0.01 * i, 0, 2);
    sequence.groundtruth.push_back({frame.timestamp, T_w_c});
    write(i, i < 5 ? "0.9" : "1", i < 8 ? 8 : 9);
  }
  std::vector<TrueSign> signs = read_true_signs(sequence);
  ASSERT_EQ(signs.size(), 2U);
  EXPECT_EQ(signs[0].visible_frames, 25);
  EXPECT_EQ(signs[0].clear_frames, 22);
  const double first = std::atan2(0.08, 2), last = std::atan2(0.29, 2);
  EXPECT_NEAR(signs[0].parallax, (last - first) / kDegree, 1e-6);
  EXPECT_TRUE(signs[0].is_clear());
  EXPECT_EQ(signs[1].clear_frames, 0) << "slanted by 82 degrees and more";
  EXPECT_FALSE(signs[1].is_clear());
  write(29, "1", 8);
  write(28, "1", 8);
  write(27, "1", 8);
  EXPECT_FALSE(read_true_signs(sequence)[0].is_clear()) << "in 19 frames";
  sequence.groundtruth.clear();
  EXPECT_EQ(read_true_signs(sequence)[0].clear_frames, 0) << "nobody knows from where";
  EXPECT_EQ(read_true_signs(sequence)[0].visible_frames, 25);
}

TEST_F(EvaluateTextTest, CountsClearSignsAndErrorsInSigmas) {
  std::vector<TrueSign> signs = {add("EXIT", 100, {0.2, 0, -1}), add("OPEN", 300, {0, 0, -1}),
                                 add("TAXI", 450, {0, 0.3, -1}, TextState::dropped)};
  for (TrueSign& sign : signs) {
    sign.clear_frames = 20;
    sign.parallax = 3;
  }
  signs[1].parallax = 2.9;
  const TextEvaluation unsure = evaluate_text(map, signs, to_truth);
  EXPECT_EQ(unsure.clear, 2);
  EXPECT_EQ(unsure.clear_mapped, 1);
  EXPECT_EQ(unsure.angle_over_sigma.n, 0U) << "no sigma is stated";
  // A plane across the ray whose normal is known to half a degree, and a truth that is turned by one.
  map.texts[1].covariance = std::pow(0.5 * kDegree * map.texts[1].theta.norm(), 2) * Eigen::Matrix3d::Identity();
  signs[1].normal = textplane::so3_exp<double>(kDegree * signs[1].normal.unitOrthogonal()) * signs[1].normal;
  const TextEvaluation stated = evaluate_text(map, signs, to_truth);
  EXPECT_NEAR(stated.matches[1].sigma, 0.5, 1e-9);
  ASSERT_EQ(stated.angle_over_sigma.n, 1U);
  EXPECT_NEAR(stated.angle_over_sigma.median, 2, 1e-6);
}

TEST_F(EvaluateTextTest, BrokenTruthNamesFileAndLine) {
  const TemporaryFolder folder;
  Sequence sequence;
  sequence.folder = folder.path();
  FrameRef frame;
  frame.stem = "000000";
  sequence.frames.push_back(frame);
  EXPECT_TRUE(read_true_signs(sequence).empty());
  const std::string signs = folder.write(
      "truth/signs.json",
      R"({"signs":[{"id":3,"text":"A,B","corners":[[0,0,0],[1,0,0],[1,1,0],[0,1,0]],"normal":[0,0,-1]}]})");
  folder.write("truth/quads/000000.txt", "0,0,1,0,1,1,0,1,A,B,3,1\n0,0,1,0,1,1,0,1,A,B,3,0.5\n");
  ASSERT_EQ(read_true_signs(sequence).size(), 1u);
  EXPECT_EQ(read_true_signs(sequence)[0].visible_frames, 1) << "whole in one line, half hidden in the other";
  const std::string quads =
      folder.write("truth/quads/000000.txt", "0,0,1,0,1,1,0,1,A,3,1\n0,0,1,0,1,1,0,1,A,three,1\n");
  expect_input_error([&] { read_true_signs(sequence); }, quads, 2, "a sign");
  folder.write("truth/quads/000000.txt", "no quad at all\n");
  expect_input_error([&] { read_true_signs(sequence); }, quads, 1, "eight coordinates");
  folder.write("truth/signs.json", "{\"signs\":[{\"id\":3}]}");
  expect_input_error([&] { read_true_signs(sequence); }, signs, 0, "signs[0]");
  folder.write("truth/signs.json", "{\"signs\":[\n{\"id\":3,}]}");
  expect_input_error([&] { read_true_signs(sequence); }, signs, 2, "parse error");
}

}  // namespace evaluate_text_test
}  // namespace textslam
