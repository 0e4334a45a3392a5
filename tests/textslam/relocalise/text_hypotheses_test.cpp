// Relocalisation of textslam in a scene made by formula: a lost frame by its signs, two maps of one place.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "textplane/features/select.hpp"
#include "textplane/geometry/plane.hpp"
#include "textslam/loop/map_join.hpp"
#include "textslam/map/observations.hpp"
#include "textslam/relocalise/text_hypotheses.hpp"

namespace textslam {
namespace text_recovery_test {

constexpr double kDegree = M_PI / 180;

SE3d moved(const Vec3& t, const Vec3& w) { return {textplane::so3_exp<double>(w), t}; }
double turn_between(const SE3d& a, const SE3d& b) { return textplane::so3_log<double>(a.R * b.R.transpose()).norm(); }

// Three boards that stand in the world; the first key frame, at the origin, sees them all and hosts a text on each.
class TextRecoveryTest : public testing::Test {
 protected:
  struct Board {
    SE3d T_w_b;  // its x to the right, y down, z away from the reader
    unsigned print;
  };

  TextRecoveryTest() {
    map.camera = {262, 262, 159.5, 119.5};
    map.width = 320;
    map.height = 240;
    map.number = 0;
    boards = {{moved({-0.9, -0.2, 3}, {0, -0.5, 0}), 1},
              {moved({0.1, 0.5, 3.4}, {0.3, 0, 0}), 2},
              {moved({1.0, -0.4, 3.1}, {0, 0.4, 0.1}), 3}};
    map.keyframes.push_back({frame_at(SE3d{}), SE3d{}, {}});
    const char* const words[] = {"EXIT", "OPEN", "TAXI"};
    for (std::size_t i = 0; i < boards.size(); ++i) {
      TextObject text;
      text.id = static_cast<int>(i);
      text.state = TextState::mapped;
      text.host = 0;
      const Vec3 normal = -boards[i].T_w_b.R.col(2);
      text.theta = textplane::plane_from_normal<double>(normal, -normal.dot(boards[i].T_w_b.t));
      textplane::SelectOptions options;
      options.levels = parameters.text_levels;
      text.patch =
          textplane::make_patch(map.keyframes[0].frame.image->view(), map.camera, quad_of(boards[i], SE3d{}), options);
      EXPECT_TRUE(textplane::is_ok(text.patch.status));
      text.votes[words[i]] = 3;
      map.texts.push_back(std::move(text));
    }
  }

  static constexpr double kHalfWidth = 0.35, kHalfHeight = 0.15;

  // Letters of a kind: random spots of 6 cm, other ones for each print.
  static double spot(int i, int j, unsigned print) {
    std::uint32_t h =
        static_cast<std::uint32_t>(i) * 2654435761U ^ static_cast<std::uint32_t>(j) * 2246822519U ^ print * 3266489917U;
    h = (h ^ (h >> 15)) * 739982445U;
    h = (h ^ (h >> 12)) * 695872825U;
    return (h ^ (h >> 15)) % 2 == 0 ? 30 : 220;
  }
  static double ink(double x, double y, unsigned print) {
    const double u = x / 0.06, v = y / 0.06;
    const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
    const double a = u - i, b = v - j;
    return (1 - b) * ((1 - a) * spot(i, j, print) + a * spot(i + 1, j, print)) +
           b * ((1 - a) * spot(i, j + 1, print) + a * spot(i + 1, j + 1, print));
  }

  Quad<double> quad_of(const Board& board, const SE3d& T_c_w) const {
    Quad<double> quad;
    const double signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (std::size_t i = 0; i < 4; ++i)
      quad.corner[i] =
          map.camera.project(T_c_w * board.T_w_b * Vec3(signs[i][0] * kHalfWidth, signs[i][1] * kHalfHeight, 0));
    return quad;
  }

  // Boards before a plain wall.
  Frame frame_at(const SE3d& T_c_w) const {
    Image<std::uint8_t> image(map.width, map.height, 120);
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x)
        for (const Board& board : boards) {
          const SE3d T_b_c = (T_c_w * board.T_w_b).inverse();
          const Vec3 ray = T_b_c.R * map.camera.unproject(Vec2(x, y));
          const Vec3 p = T_b_c.t - T_b_c.t.z() / ray.z() * ray;
          if (std::abs(p.x()) > 1.1 * kHalfWidth || std::abs(p.y()) > 1.1 * kHalfHeight) continue;
          image(x, y) = static_cast<std::uint8_t>(ink(p.x(), p.y(), board.print));
        }
    Frame frame;
    frame.image = std::make_shared<const Pyramid>(image.view(), parameters.pyramid_levels);
    return frame;
  }

  // As a detector sees them: corners a pixel off.
  Detection detection(std::size_t board, const SE3d& T_c_w, const std::string& word) const {
    Detection d;
    d.quad = quad_of(boards[board], T_c_w);
    for (std::size_t i = 0; i < 4; ++i) d.quad.corner[i] += Vec2(i % 2 == 0 ? 1.0 : -0.6, i < 2 ? -0.8 : 0.7);
    d.text = word;
    return d;
  }

  void expect_pose(const SE3d& found, const SE3d& truth, double metres, double degrees) const {
    EXPECT_LT((found.inverse().t - truth.inverse().t).norm(), metres);
    EXPECT_LT(turn_between(found, truth) / kDegree, degrees);
  }

  Parameters parameters;
  Map map;
  std::vector<Board> boards;
};

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

TEST_F(TextRecoveryTest, SeveralSignsConfirmEachOther) {
  const SE3d truth = moved({0.3, -0.1, 0.2}, {0.02, -0.1, 0.05});
  Frame frame = frame_at(truth);
  for (std::size_t i = 0; i < 3; ++i) frame.detections.push_back(detection(i, truth, map.texts[i].word()));
  const auto found = text_hypotheses(map, parameters, frame, WordMatch::same);
  ASSERT_GE(found.size(), 3u);
  EXPECT_EQ(found[0].confirmed, 3);
  expect_pose(found[0].T_c_w, truth, 0.05, 1.0);
  EXPECT_TRUE(text_hypotheses(map, parameters, frame, WordMatch::other).empty())
      << "a board is not taken for another one";

  const Relocalisation recovery = relocalise(map, parameters, frame);
  ASSERT_TRUE(recovery.ok) << "by texts alone: the map has no points";
  EXPECT_EQ(recovery.report.texts, 3);
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
  for (std::size_t i = 0; i < 3; ++i) frame.detections.push_back(detection(i, truth, map.texts[i].word()));
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

// The same three boards, mapped twice: b's world is turned, moved and three times as large.
TEST_F(TextRecoveryTest, JoinedMapsAreOne) {
  const double scale = 3;
  Similarity S_a_b;
  S_a_b.scale = 1 / scale;
  S_a_b.R = textplane::so3_exp<double>(Vec3(0.3, -0.8, 0.4));
  S_a_b.t = {1, 2, -0.5};
  const std::vector<SE3d> poses = {moved({0.1, 0, 0}, {0, 0.03, 0}), moved({-0.2, 0.1, 0.1}, {0.02, -0.04, 0})};

  Map b;
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
    ASSERT_EQ(textplane::reanchor_plane<double>(text.theta, poses[0], &theta), textplane::Status::ok);
    other.theta = theta / scale;
    textplane::SelectOptions options;
    options.levels = parameters.text_levels;
    other.patch = textplane::make_patch(b.keyframes[0].frame.image->view(), b.camera,
                                        quad_of(boards[static_cast<std::size_t>(text.id)], poses[0]), options);
    other.views = {1};
    other.votes = {{text.word(), 2}};
    b.texts.push_back(std::move(other));
  }
  // A point that both maps have, one of b alone, and a bad one.
  map.keyframes.push_back({frame_at(moved({0.2, 0, 0}, {0, 0, 0})), moved({0.2, 0, 0}, {0, 0, 0}).inverse(), {}});
  const Vec3 shared(0.1, 0.5, 3.4), own(-0.9, -0.2, 3);
  const auto in_b = [&](const Vec3& p) -> Vec3 { return scale * (S_a_b.R.transpose() * (p - S_a_b.t)); };
  map.points.resize(1);
  map.points[0].p_w = shared;
  for (int k = 0; k < 2; ++k) add_observation(map, 0, k, map.camera.project(map.keyframe(k).T_w_c.inverse() * shared));
  b.points.resize(3);
  b.points[0].bad = true;
  b.points[1].p_w = in_b(own);
  b.points[2].p_w = in_b(shared);
  for (int k = 0; k < 2; ++k) {
    add_observation(b, 1, k, b.camera.project(poses[static_cast<std::size_t>(k)] * own));
    add_observation(b, 2, k, b.camera.project(poses[static_cast<std::size_t>(k)] * shared));
  }

  Frame newest = b.keyframe(1).frame;
  for (std::size_t i = 0; i < 3; ++i) newest.detections.push_back(detection(i, poses[1], map.texts[i].word()));
  const Relocalisation seen = relocalise(map, parameters, newest);
  ASSERT_TRUE(seen.ok);
  Parameters few = parameters;
  few.join_min_pairs = 12;
  MapLink link = link_maps(map, b, few, seen);
  ASSERT_TRUE(link.ok);
  EXPECT_EQ(link.keyframes, 2);
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

}  // namespace text_recovery_test
}  // namespace textslam
