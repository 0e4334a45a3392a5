// A camera that walks up to a sign: the text gets a host that shows it better, and stays the sign that it was.
#include "textplane/landmarks/text_hosting.hpp"

#include "landmarks/walk_support.hpp"

namespace landmarks_test {

using TextHostingTest = WalkTest;

TEST_F(TextHostingTest, ATransportedPlaneIsTheSamePlane) {
  frames.all.resize(2);
  frames[0].T_w_c = {so3_exp<double>(Vec3(0.2, 0.1, -0.1)), Vec3(0.3, -0.2, 0.1)};
  frames[1].T_w_c = {so3_exp<double>(Vec3(-0.1, 0.4, 0.2)), Vec3(-0.5, 0.3, 0.9)};
  const Vec3 before(0.1, -0.05, 0.3);
  Eigen::Matrix3d L;
  L << 4, 0, 0, -1, 3, 0, 2, 1, 5;
  const Eigen::Matrix3d covariance = 1e-8 * L * L.transpose();
  Vec3 theta = before;
  Eigen::Matrix3d moved = covariance;
  ASSERT_TRUE(transport_plane(frames.between(1, 0), &theta, &moved));
  const SE3d T_1_0 = frames.between(1, 0);
  for (const Vec2& m : {Vec2(0, 0), Vec2(-0.3, 0.2), Vec2(0.4, 0.3)})
    EXPECT_NEAR(theta.dot(T_1_0 * plane_point<double>(before, m.homogeneous())), 1, 1e-12);

  // By differences along the columns of a root of the covariance.
  Eigen::Matrix3d by_differences = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vec3 step = 1e-4 * L.col(i) / 10;
    Vec3 up = before + step, down = before - step;
    Eigen::Matrix3d unused = Eigen::Matrix3d::Zero();
    ASSERT_TRUE(transport_plane(frames.between(1, 0), &up, &unused) &&
                transport_plane(frames.between(1, 0), &down, &unused));
    const Vec3 column = (up - down) / 2 * 10;
    by_differences += column * column.transpose();
  }
  EXPECT_LT((by_differences - moved).norm(), 1e-6 * moved.norm());
  EXPECT_GT((moved - covariance).norm(), 0.1 * covariance.norm()) << "the test moves nothing";

  ASSERT_TRUE(transport_plane(frames.between(0, 1), &theta, &moved));
  EXPECT_LT((theta - before).norm(), 1e-12);
  EXPECT_LT((moved - covariance).norm(), 1e-9 * covariance.norm());
}

TEST_F(TextHostingTest, APlaneThatTheCameraHasPassedIsNotTransported) {
  frames[1].T_w_c = {Eigen::Matrix3d::Identity(), Vec3(0, 0, 4)};
  Vec3 theta(0, 0, 1.0 / 3);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  EXPECT_FALSE(transport_plane(frames.between(1, 0), &theta, &covariance));
  EXPECT_EQ(theta, Vec3(0, 0, 1.0 / 3));
  EXPECT_EQ(covariance, Eigen::Matrix3d::Identity());
}

TEST_F(TextHostingTest, ItStaysTheSignThatItWas) {
  const int id = add_target(at(0.1, 1.6));
  const TextObject before = text;
  ASSERT_TRUE(rehosted(id));
  EXPECT_EQ(text.host, id);
  EXPECT_EQ(text.views, (std::vector<int>{0, 1, 2, 3, 4, 5})) << "the old host among them";
  EXPECT_EQ(text.state, TextState::mapped);
  EXPECT_EQ(text.votes, before.votes);
  EXPECT_EQ(text.detections, before.detections);
  EXPECT_GT(area(text.patch.quad), options.rehost_area * area(before.patch.quad));
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT((corner(text, i) - corner(before, i)).norm(), 0.5 * 3 / wall.camera.fx)
        << i << ": half a pixel of the first host";
  EXPECT_FALSE(rehosted(id)) << "it is the host";
  EXPECT_FALSE(rehosted(0)) << "the smaller view";
}

// What it is for.
TEST_F(TextHostingTest, AViewNearbyKnowsThePlaneBetter) {
  double first_error = 0, near_error = 0;
  constexpr int kNoises = 6;
  for (int i = 0; i < kNoises; ++i) {
    if (i > 0) begin();
    const int id = add_target(at(0.1, 1.6));
    TextObject first = text;
    ASSERT_TRUE(refine_text_plane(options, KeyframeLookup(frames), first.views, first.theta, 0.5, first))
        << "it has the view, too";
    ASSERT_TRUE(rehosted(id));
    first_error += angle_error(first) / kNoises;
    near_error += angle_error(text) / kNoises;
    EXPECT_LT(normal_sigma(text), 0.7 * normal_sigma(first));
  }
  EXPECT_LT(near_error, 0.7 * first_error);
}

TEST_F(TextHostingTest, OnlyMappedTextsAndOnlyWhereTheyWereSeen) {
  const int id = add_target(at(0.1, 1.6));
  text.state = TextState::tentative;
  expect_refused(id, "not mapped");
  text.state = TextState::mapped;
  text.views.pop_back();
  expect_refused(id, "no target");
  text.views = {id};
  expect_refused(id, "nothing else to compare it with");
  text.views = {1, 2, id};
  EXPECT_TRUE(rehosted(id));
}

TEST_F(TextHostingTest, AViewThatIsNotClearlyLargerIsNoHost) {
  const double ratio = std::sqrt(options.rehost_area);
  const int smaller = add_target(at(0, 3 - 3.1 / ratio)), larger = add_target(at(0, 3 - 2.9 / ratio));
  expect_refused(smaller, "too small");
  EXPECT_TRUE(rehosted(larger));
}

TEST_F(TextHostingTest, AViewThatLosesAPartIsNoHost) {
  SE3d T_w_c = at(0.1, 1.6);
  const auto left = wall.quad_in(T_w_c).corner;
  const auto angle = [&](double x) { return std::atan((x - wall.camera.cx) / wall.camera.fx); };
  const double turn = angle(std::min(left[0].x(), left[3].x())) - angle(2);  // two pixels from the border
  T_w_c.R = T_w_c.R * so3_exp<double>(Vec3(0, turn, 0));
  const int id = add_target(T_w_c);
  expect_refused(id, "over the border");
  options.border = 0;
  EXPECT_TRUE(rehosted(id)) << "nothing else is wrong with it";
}

TEST_F(TextHostingTest, AMoreSlantedViewIsNoHost) {
  const double far = 3 / std::sqrt(options.rehost_area) / 1.1;
  const auto from = [&](double slant) {
    return at(far * std::sin(slant * kDegree), 3 - far * std::cos(slant * kDegree));
  };
  const double host = std::atan(std::hypot(0.5, 0.05) / 3) / kDegree;
  const int id = add_target(from(host + options.rehost_slant + 3));
  expect_refused(id, "slanted");
  options.rehost_slant += 4;
  EXPECT_TRUE(rehosted(id)) << "nothing else is wrong with it";
}

TEST_F(TextHostingTest, ABlurredViewIsNoHost) {
  const int blurred = add_target(at(0.1, 1.6), 4), sharp = add_target(at(0.1, 1.6));
  expect_refused(blurred, "blurred");
  TextObject anyhow = text;
  options.rehost_max_dissimilarity = 100;
  EXPECT_TRUE(rehosted(blurred, anyhow)) << "nothing else is wrong with it";
  options.rehost_max_dissimilarity = TextOptions().rehost_max_dissimilarity;
  EXPECT_TRUE(rehosted(sharp));
}

TEST_F(TextHostingTest, AKeyFrameThatGaveUpItsImageIsNoHost) {
  const int id = add_target(at(0.1, 1.6));
  frames[id].image.reset();
  expect_refused(id, "no image");
}

}  // namespace landmarks_test
