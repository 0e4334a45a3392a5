// The plane of a small text settles on the surface that the text lies on; one that is well known, or lies on nothing
// that the points show, stays.
#include "textplane/landmarks/text_surface.hpp"

#include <gtest/gtest.h>

#include <random>

#include "landmarks/frames_support.hpp"

namespace landmarks_test {

// A table seen from 1 m at a slant of 45 degrees, in the frame of the text's host, and a text at the middle of it.
class TextSurfaceTest : public testing::Test {
 protected:
  const Vec3 normal = Vec3(0, -1, -1).normalized(), centre = Vec3(0, 0, 1);
  const Vec3 right = Vec3(1, 0, 0), below = normal.cross(right);

  Vec3 turned(double degrees) const {
    const Vec3 n = so3_exp<double>(Vec3(right * degrees * kDegree)) * normal;
    return plane_from_normal<double>(n, -n.dot(centre));
  }
  // By the four corners of a text of 12 x 3 cm, each known to sigma along its ray, as a share of its distance.
  Eigen::Matrix3d known_to(double sigma) const {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (const double x : {-0.06, 0.06})
      for (const double y : {-0.015, 0.015}) {
        const Vec3 p = centre + x * right + y * below;
        information += p * p.transpose() / (sigma * sigma);
      }
    return information.inverse();
  }
  // Points of the table within 20 cm, 2 mm off it; every `other_every`-th `height` above it.
  std::vector<SurfacePoint> table(int count, int other_every = 1 << 30, double height = 0) const {
    std::mt19937 random(7);
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967295.0 * 2 - 1; };
    std::vector<SurfacePoint> points;
    for (int i = 1; i <= count; ++i) {
      const double x = 0.2 * uniform(), y = 0.2 * uniform(),
                   z = 0.0035 * uniform() + (i % other_every == 0 ? height : 0);
      points.push_back({centre + x * right + y * below + z * normal, 0.002});
    }
    return points;
  }
  double off(const Vec3& theta) const { return degrees_apart(plane_normal(theta), normal); }

  TextOptions options;
};

TEST_F(TextSurfaceTest, ASmallTextSettlesOnIt) {
  Vec3 theta = turned(8);
  Eigen::Matrix3d covariance = known_to(0.0025);
  TextObject before;
  before.theta = theta;
  before.covariance = covariance;
  ASSERT_GT(normal_sigma(before), 3 * kDegree);
  ASSERT_TRUE(fit_to_surface(table(60), centre, options, &theta, &covariance));
  EXPECT_LT(off(theta), 0.5);
  before.theta = theta;
  before.covariance = covariance;
  EXPECT_LT(normal_sigma(before), 0.6 * kDegree);
  EXPECT_GE(normal_sigma(before), 0.9 * options.surface_bend * kDegree);  // no number of points makes it surer
}

TEST_F(TextSurfaceTest, ThingsThatStandBesideItDoNotCount) {
  Vec3 theta = turned(4);
  Eigen::Matrix3d covariance = known_to(0.0025);
  ASSERT_TRUE(fit_to_surface(table(90, 3, 0.1), centre, options, &theta, &covariance));
  EXPECT_LT(off(theta), 0.7);
}

TEST_F(TextSurfaceTest, AWellKnownTextOnAnotherPlaneStays) {
  Vec3 theta = turned(8);
  Eigen::Matrix3d covariance = known_to(0.00005);
  fit_to_surface(table(60), centre, options, &theta, &covariance);
  EXPECT_NEAR(off(theta), 8, 0.4);
}

TEST_F(TextSurfaceTest, FewPointsSayNothing) {
  Vec3 theta = turned(8);
  Eigen::Matrix3d covariance = known_to(0.0025);
  const Vec3 theta_before = theta;
  const Eigen::Matrix3d covariance_before = covariance;
  EXPECT_FALSE(fit_to_surface(table(5), centre, options, &theta, &covariance));
  EXPECT_FALSE(fit_to_surface({}, centre, options, &theta, &covariance));
  EXPECT_EQ(theta, theta_before);
  EXPECT_EQ(covariance, covariance_before);
  covariance.setZero();
  EXPECT_FALSE(fit_to_surface(table(60), centre, options, &theta, &covariance));
}

// Points that key frames see to a pixel, for PointLookup.
struct SeenPoints {
  struct Point {
    Vec3 p_w;
    std::vector<int> seen_by;
    bool bad = false;
  };

  Frames frames;
  std::vector<Point> all;

  int text_point_count() const { return static_cast<int>(all.size()); }
  bool text_point(int i, Vec3* p_w) const {
    *p_w = all[static_cast<std::size_t>(i)].p_w;
    return !all[static_cast<std::size_t>(i)].bad;
  }
  double text_point_variance(int i, const Vec3& direction_w) const {
    const Point& point = all[static_cast<std::size_t>(i)];
    if (point.seen_by.size() < 2) return 0;
    Matrix3<double> information = Matrix3<double>::Zero();
    for (const int k : point.seen_by) {
      const SE3d T_c_w = frames.text_keyframe(k).T_c_w();
      Eigen::Matrix<double, 2, 3> J;
      frames.camera.project(T_c_w * point.p_w, &J);
      const Eigen::Matrix<double, 2, 3> J_w = J * T_c_w.R;
      information += J_w.transpose() * J_w;
    }
    return direction_w.dot(Ldlt<double, 3>(information).solve(direction_w));
  }
};

// The table and the text with three key frames, and points that are added one by one. The first hosts the text.
class TextOnATableTest : public TextSurfaceTest {
 protected:
  TextOnATableTest() {
    Frames& frames = points.frames;
    frames.camera = {525, 525, 319.5, 239.5};
    frames.all.resize(3);
    frames[1].T_w_c.t = Vec3(0.4, 0, 0);
    frames[2].T_w_c.t = Vec3(-0.4, 0, 0);
    text.host = 0;
    text.patch.camera = frames.camera;
    std::size_t corner = 0;
    for (const auto& [x, y] : {std::pair(-0.06, -0.015), {0.06, -0.015}, {0.06, 0.015}, {-0.06, 0.015}})
      text.patch.quad.corner[corner++] = frames.camera.project(Vec3(centre + x * right + y * below));
  }
  void add(double x, double y, double height, const std::vector<int>& seen_by) {
    points.all.push_back({centre + x * right + y * below + height * normal, seen_by});
  }
  void add_table(double height = 0, double rough = 0) {
    for (int i = 0; i < 121; ++i)
      add(0.025 * (i % 11 - 5), 0.025 * (i / 11 - 5), height + rough * (i % 3 - 1), {0, 1, 2});
  }
  void fit() { fit_to_surface(options, PointLookup(points), SE3d(), text); }
  bool plane_by_points() {
    std::vector<Vec3> seen;
    for (const auto& point : points.all)
      if (point.seen_by.front() == text.host) seen.push_back(point.p_w);
    return plane_from_surface(options, PointLookup(points), SE3d(), seen, text);
  }
  SeenPoints points;
  TextObject text;
};

TEST_F(TextOnATableTest, PointsBesideATextAreSurerTheNearerTheyAre) {
  text.theta = turned(0);
  add(0.05, 0, 0, {0, 1, 2});
  add(0.25, 0, 0, {0, 1, 2});
  add(0.1 + 0.12 * options.surface_reach, 0, 0, {0, 1, 2});  // too far beside it
  add(0.05, 0, -0.5, {0, 1, 2});                             // too far below it
  add(0.05, 0, 0, {1});                                      // at no known distance
  add(0.05, 0, 0, {0, 1, 2});
  points.all.back().bad = true;
  const std::vector<SurfacePoint> beside = points_beside(options, PointLookup(points), SE3d(), text);
  ASSERT_EQ(beside.size(), 2U);
  EXPECT_GT(beside[0].sigma, 1e-4);
  EXPECT_LT(beside[0].sigma, 5e-3);
  EXPECT_NEAR(beside[1].sigma, std::hypot(beside[0].sigma, options.surface_relief * 0.19), 2e-3);
}

// The table, or another one `height` above or below it, tells the slant of a text that lies on it alone.
TEST_F(TextOnATableTest, OnlyTheSurfaceThatATextLiesOnSpeaksForIt) {
  for (const double height : {0.0, -0.012, -0.03, 0.012}) {
    points.all.clear();
    add_table(height, 0.0005);
    text.theta = turned(4);
    text.covariance = known_to(0.0015);
    ASSERT_GT(normal_sigma(text), 2 * kDegree);
    const TextObject before = text;
    fit();
    if (height == 0) {
      EXPECT_LT(off(text.theta), 1);
      EXPECT_LT(normal_sigma(text), 0.5 * normal_sigma(before));
    } else {
      EXPECT_EQ(text.theta, before.theta) << height << ": it stands off the surface";
      EXPECT_EQ(text.covariance, before.covariance);
    }
  }
}

TEST_F(TextOnATableTest, ASurfaceThatIsTurnedFromAWellKnownTextIsAnother) {
  add_table();
  text.theta = turned(4);
  text.covariance = known_to(0.0003);
  ASSERT_LT(normal_sigma(text), 0.7 * kDegree);
  const TextObject before = text;
  fit();
  EXPECT_EQ(text.theta, before.theta);
}

// It could not contradict a wrong one.
TEST_F(TextOnATableTest, NoSurfaceSpeaksForATextThatHardlyKnowsItsSlant) {
  add_table();
  for (const double share : {0.75, 1.25}) {
    text.theta = turned(4);
    text.covariance = known_to(0.0015);
    const double ratio = share * options.surface_text_sigma * kDegree / normal_sigma(text);
    text.covariance *= ratio * ratio;
    const TextObject before = text;
    fit();
    if (share < 1) {
      EXPECT_LT(off(text.theta), 1);
      EXPECT_LT(normal_sigma(text), 0.2 * normal_sigma(before));
    } else {
      EXPECT_EQ(text.theta, before.theta);
      EXPECT_EQ(text.covariance, before.covariance);
    }
  }
}

// What lies beside the text has its slant; points in front of it are turned from it by many of its standard deviations.
TEST_F(TextOnATableTest, NoSurfaceTurnsATextBeyondItsOwnDoubt) {
  for (int i = 0; i < 8; ++i) add(0.02 * (i % 4 - 1.5), i < 4 ? -0.025 : 0.025, 0, {0, 1, 2});
  for (int i = 0; i < 400; ++i) {
    const double y = 0.0014 * (i % 21 - 10);
    add(0.005 * (i / 21 - 9.5), y, std::tan(24 * kDegree) * y, {0, 1, 2});
  }
  text.theta = turned(0);
  text.covariance = known_to(0.003);
  ASSERT_LT(normal_sigma(text), 6 * kDegree);
  const TextObject before = text;
  fit();
  EXPECT_EQ(text.theta, before.theta);
  EXPECT_EQ(text.covariance, before.covariance);
}

// A dozen points beside a text do not tell a slant to two degrees: that theirs differs is no reason to leave them out.
// Ten dozen do.
TEST_F(TextOnATableTest, ASurfaceIsAnotherOnlyWhereItsPointsTellItsSlant) {
  for (const int times : {1, 10}) {
    points.all.clear();
    for (int i = 0; i < 12 * times; ++i) {
      const double x = 0.025 * (i % 6 - 2.5), y = i % 12 < 6 ? -0.06 : 0.06;
      add(x, y, std::tan(2.3 * kDegree) * y, {0, 1, 2});
    }
    text.theta = turned(0);
    text.covariance = known_to(0.0002);
    ASSERT_LT(normal_sigma(text), 0.5 * kDegree);
    const TextObject before = text;
    fit();
    if (times == 1) {
      EXPECT_GT(off(text.theta), 0.05);
      EXPECT_LT(normal_sigma(text), normal_sigma(before));
    } else {
      EXPECT_EQ(text.theta, before.theta);
    }
  }
}

// A text of which nothing is known but where its host sees it.
TEST_F(TextOnATableTest, PointsAloneGiveATextItsPlane) {
  for (int i = 0; i < 49; ++i)
    add(0.03 * (i % 7 - 3), 0.03 * (i / 7 - 3), i % 5 == 0 ? 0.15 : 0.001 * (i % 3 - 1), {0, 1, 2});
  options.surface_max_sigma = 0.01;
  EXPECT_FALSE(plane_by_points()) << "not that sure";
  EXPECT_EQ(text.theta, Vec3::Zero());
  options = TextOptions();
  ASSERT_TRUE(plane_by_points());
  EXPECT_LT(off(text.theta), 1.5) << "though a fifth of the points are of other things";
  EXPECT_NEAR(inverse_depth<double>(text.theta, centre), 1, 0.01);
  EXPECT_LT(normal_sigma(text), options.surface_max_sigma * kDegree);
}

TEST_F(TextOnATableTest, AndNoneWhereItsHostSeesNothing) {
  for (int i = 0; i < 49; ++i) add(0.03 * (i % 7 - 3), 0.03 * (i / 7 - 3), 0, {1, 2});
  EXPECT_FALSE(plane_by_points());
  EXPECT_EQ(text.theta, Vec3::Zero());
}

}  // namespace landmarks_test
