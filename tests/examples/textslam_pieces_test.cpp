// Pieces of textslam against known scenes: relative pose of two views, points of key frames, text maps against true signs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "examples/io_support.hpp"
#include "textplane/geometry/plane.hpp"
#include "textslam/common/parameters.hpp"
#include "textslam/init/two_view.hpp"
#include "textslam/map/point_mapper.hpp"
#include "textslam/report/evaluate_text.hpp"

namespace textslam {
namespace textslam_pieces_test {

constexpr double kFocal = 525;
constexpr double kDegree = M_PI / 180;

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

Pinhole<double> camera() { return {kFocal, kFocal, 319.5, 239.5}; }

// World points in view of a camera at the origin that looks along z: in a volume 2 to 6 units away, or on a slanted plane.
std::vector<Vec3> scene(int n, bool planar, std::mt19937& random) {
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) {
    const double x = uniform(random, -0.5, 0.5), y = uniform(random, -0.4, 0.4);
    const double z = planar ? 3 / (1 - 0.5 * x + 0.3 * y) : uniform(random, 2, 6);
    points.push_back(z * Vec3(x, y, 1));
  }
  return points;
}

// Normalised views of the points, with an even error of up to `noise` px.
std::vector<Vec3> views(const std::vector<Vec3>& points, const SE3d& T_c_w, double noise, std::mt19937& random) {
  std::vector<Vec3> rays;
  for (const Vec3& point : points) {
    const Vec3 p = T_c_w * point;
    rays.push_back({p.x() / p.z() + uniform(random, -noise, noise) / kFocal,
                    p.y() / p.z() + uniform(random, -noise, noise) / kFocal, 1});
  }
  return rays;
}

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }
double rotation_error(const SE3d& a, const SE3d& b) { return textplane::so3_log<double>(a.R * b.R.transpose()).norm(); }

SE3d moved(const Vec3& t, const Vec3& w) { return {textplane::so3_exp<double>(w), t}; }

TEST(TwoViewTest, ExactMatchesGiveTheMotionWhateverItsDirection) {
  std::mt19937 random(1);
  const std::vector<Vec3> points = scene(150, false, random);
  for (const Vec3& t : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1),
                        Vec3(0.6, -0.5, 0.62), Vec3(-0.4, -0.7, -0.59)}) {
    const SE3d T_b_a = moved(0.25 * t.normalized(), Vec3(0.03, -0.05, 0.02));
    const TwoView view = estimate_two_view(views(points, SE3d{}, 0, random), views(points, T_b_a, 0, random), kFocal);
    SCOPED_TRACE(t.transpose());
    ASSERT_TRUE(view.ok);
    EXPECT_NEAR(view.T_b_a.t.norm(), 1, 1e-12);
    EXPECT_LT(angle_between(view.T_b_a.t, T_b_a.t), 1e-3) << "the sign, too";
    EXPECT_LT(rotation_error(view.T_b_a, T_b_a), 1e-4);
    EXPECT_EQ(view.inliers, 150);
    EXPECT_LT(view.rms, 0.01);
    ASSERT_FALSE(view.motions.empty());
    EXPECT_EQ(view.motions[0].T_b_a.t, view.T_b_a.t);
    for (std::size_t i = 1; i < view.motions.size(); ++i) EXPECT_GT(view.motions[i].cost, 2 * view.motions[0].cost);
  }
}

TEST(TwoViewTest, NoiseAndWrongMatches) {
  std::mt19937 random(2);
  const std::vector<Vec3> points = scene(200, false, random);
  const SE3d T_b_a = moved({0.3, 0.05, 0.1}, {0.02, 0.06, -0.03});
  const std::vector<Vec3> a = views(points, SE3d{}, 0.5, random);
  std::vector<Vec3> b = views(points, T_b_a, 0.5, random);
  // Every tenth match has slid 6 to 40 px away.
  for (std::size_t i = 0; i < b.size(); i += 10) {
    const double angle = uniform(random, 0, 2 * M_PI), length = uniform(random, 6, 40) / kFocal;
    b[i] += length * Vec3(std::cos(angle), std::sin(angle), 0);
  }
  const TwoView view = estimate_two_view(a, b, kFocal);
  ASSERT_TRUE(view.ok);
  EXPECT_LT(angle_between(view.T_b_a.t, T_b_a.t), 3 * kDegree);
  EXPECT_LT(rotation_error(view.T_b_a, T_b_a), 0.5 * kDegree);
  EXPECT_LT(angle_between(view.T_b_a.t, T_b_a.t), 5 * view.direction_sigma) << "the uncertainty reported is honest";
  EXPECT_GE(view.inliers, 175);
  int wrong = 0;
  for (std::size_t i = 0; i < b.size(); i += 10) wrong += view.inlier[i];
  EXPECT_LE(wrong, 6) << "those that slid along their epipolar line";
  std::vector<double> parallaxes;
  for (const Vec3& p : points) parallaxes.push_back(angle_between(p, p + T_b_a.R.transpose() * T_b_a.t));
  std::nth_element(parallaxes.begin(), parallaxes.begin() + 100, parallaxes.end());
  EXPECT_NEAR(view.parallax, parallaxes[100] / kDegree, 0.15 * parallaxes[100] / kDegree) << "the rotation taken out";
}

// A plane has two motions that explain it. The right one is among those found, and another only where it costs about as much.
TEST(TwoViewTest, PlanarSceneHasTheRightMotionAmongThoseFound) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937 random(100 + seed);
    const std::vector<Vec3> points = scene(150, true, random);
    const Vec3 t(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -0.5, 0.5));
    const SE3d T_b_a = moved(0.4 * t.normalized(), {0.02, uniform(random, -0.08, 0.08), 0.03});
    const TwoView view =
        estimate_two_view(views(points, SE3d{}, 0.3, random), views(points, T_b_a, 0.3, random), kFocal);
    SCOPED_TRACE(seed);
    ASSERT_TRUE(view.ok);
    EXPECT_GE(view.inliers, 140) << "the plane is explained either way";
    const bool found = std::any_of(view.motions.begin(), view.motions.end(), [&](const TwoViewMotion& motion) {
      return angle_between(motion.T_b_a.t, T_b_a.t) < 10 * kDegree && rotation_error(motion.T_b_a, T_b_a) < 2 * kDegree;
    });
    EXPECT_TRUE(found);
    for (std::size_t i = 1; i < view.motions.size(); ++i) EXPECT_GE(view.motions[i].cost, view.motions[i - 1].cost);
  }
}

TEST(TwoViewTest, PureRotationHasNoParallax) {
  std::mt19937 random(3);
  const std::vector<Vec3> points = scene(150, false, random);
  const SE3d turn = moved({0, 0, 0}, {0.05, 0.08, -0.02});
  const TwoView view = estimate_two_view(views(points, SE3d{}, 0.3, random), views(points, turn, 0.3, random), kFocal);
  const Parameters parameters;
  EXPECT_TRUE(!view.ok || view.parallax < 0.3 * parameters.init_min_parallax) << view.parallax;
}

TEST(TwoViewTest, TooFewOrUnequalMatchesAreRefused) {
  std::mt19937 random(4);
  const std::vector<Vec3> rays = views(scene(20, false, random), SE3d{}, 0, random);
  const std::vector<Vec3> few(rays.begin(), rays.begin() + 11);
  EXPECT_FALSE(estimate_two_view(few, few, kFocal).ok);
  EXPECT_FALSE(estimate_two_view(rays, few, kFocal).ok);
  EXPECT_FALSE(estimate_two_view({}, {}, kFocal).ok);
  EXPECT_TRUE(estimate_two_view(rays, rays, kFocal).parallax < 0.01) << "no motion at all";
}

// Three key frames and tracks of known points in them.
class PointMapperTest : public testing::Test {
 protected:
  PointMapperTest() {
    map.camera = camera();
    map.width = 640;
    map.height = 480;
    std::mt19937 random(5);
    points = scene(60, false, random);
    tracks.resize(points.size());
    poses = {SE3d{}, moved({-0.2, 0, 0}, {0, 0.02, 0}), moved({-0.4, 0.1, 0}, {0, 0.05, 0.01})};
  }
  Vec2 px(std::size_t point, std::size_t pose) const { return map.camera.project(poses[pose] * points[point]); }
  void insert(std::size_t pose) {
    for (std::size_t i = 0; i < tracks.size(); ++i) tracks[i].px = px(i, pose).cast<float>();
    EXPECT_EQ(insert_keyframe(map, {}, poses[pose].inverse(), tracks), static_cast<int>(pose));
  }
  // Each observation is known to its point and to its key frame.
  void expect_linked() const {
    std::size_t of_points = 0, of_keyframes = 0;
    for (std::size_t id = 0; id < map.points.size(); ++id)
      for (const PointObservation& o : map.points[id].observations) {
        const auto& seen = map.keyframe(o.keyframe).points;
        EXPECT_EQ(std::count(seen.begin(), seen.end(), static_cast<int>(id)), 1);
        ++of_points;
      }
    for (const KeyFrame& keyframe : map.keyframes) of_keyframes += keyframe.points.size();
    EXPECT_EQ(of_points, of_keyframes);
  }

  Map map;
  Parameters parameters;
  std::vector<Vec3> points;
  std::vector<SE3d> poses;
  std::vector<Track> tracks;
};

TEST_F(PointMapperTest, TriangulatesWhereThereIsParallax) {
  insert(0);
  EXPECT_EQ(triangulate_tracks(map, parameters, tracks), 0) << "one view";
  insert(1);
  EXPECT_EQ(triangulate_tracks(map, parameters, tracks), 60);
  insert(2);
  ASSERT_EQ(map.points.size(), 60u);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    ASSERT_GE(tracks[i].point, 0);
    EXPECT_TRUE(tracks[i].observations.empty()) << "the point has them now";
    const MapPoint& point = map.point(tracks[i].point);
    EXPECT_EQ(point.observations.size(), 3u);
    EXPECT_LT((point.p_w - points[i]).norm(), 1e-3 * points[i].norm());
  }
  expect_linked();
  std::vector<double> depths;
  for (const Vec3& p : points) depths.push_back((poses[2] * p).z());
  std::nth_element(depths.begin(), depths.begin() + 30, depths.end());
  EXPECT_NEAR(median_depth(map, 2), depths[30], 1e-3 * depths[30]);
}

TEST_F(PointMapperTest, NoPointsWithoutParallaxOrAgreement) {
  poses[1] = moved({-0.002, 0, 0}, {0, 0.02, 0});
  insert(0);
  insert(1);
  EXPECT_EQ(triangulate_tracks(map, parameters, tracks), 0) << "rays almost parallel";
  insert(2);
  for (std::size_t i = 0; i < 10; ++i) tracks[i].observations[1].px += Vec2(0, 12);  // slid across the epipolar line
  EXPECT_EQ(triangulate_tracks(map, parameters, tracks), 50);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(tracks[i].point, -1);
  expect_linked();
}

TEST_F(PointMapperTest, RemovalAndCullingKeepTheLinks) {
  insert(0);
  insert(1);
  triangulate_tracks(map, parameters, tracks);
  insert(2);
  const int twice = tracks[0].point;
  remove_observation(map, twice, 1);
  EXPECT_FALSE(map.point(twice).bad);
  expect_linked();
  remove_observation(map, twice, 0);
  EXPECT_TRUE(map.point(twice).bad) << "one view alone is no point";
  EXPECT_TRUE(map.point(twice).observations.empty());
  expect_linked();

  MapPoint& rare = map.point(tracks[1].point);
  rare.visible = 40;
  rare.found = 5;
  MapPoint& young = map.point(tracks[2].point);
  young.visible = 10;
  young.found = 0;
  MapPoint& steady = map.point(tracks[3].point);
  steady.visible = 40;
  steady.found = 30;
  cull_points(map, parameters, tracks);
  EXPECT_TRUE(rare.bad);
  EXPECT_FALSE(young.bad) << "too soon to tell";
  EXPECT_FALSE(steady.bad);
  EXPECT_EQ(tracks.size(), 58u) << "tracks of bad points are gone";
  expect_linked();
}

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

}  // namespace textslam_pieces_test
}  // namespace textslam
