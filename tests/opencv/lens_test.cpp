// Our lenses beside OpenCV's; adapters/opencv_lens.hpp: quads through OpenCV's lenses, and what they refuse.
#include "textplane/adapters/opencv_lens.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/camera_support.hpp"
#include "textplane/core/cameras/kannala_brandt.hpp"
#include "textplane/core/cameras/radial_tangential.hpp"
#include "textplane/core/cameras/rational.hpp"
#include "textplane/geometry/undistorted.hpp"

namespace {

namespace tp = textplane;
using tp::adapters::CvLens;

const cv::Mat kK = (cv::Mat_<double>(3, 3) << 458, 0, 367, 0, 457, 248, 0, 0, 1);
const cv::Mat kD = (cv::Mat_<double>(1, 5) << -0.28, 0.07, 2e-4, 1.8e-5, 0.001);
const tp::Pinhole<double> kStraight(400, 410, 320, 240);

tp::Quad<double> raw_quad() {
  tp::Quad<double> quad;
  quad.corner = {tp::Vector2<double>(60, 50), tp::Vector2<double>(680, 40), tp::Vector2<double>(700, 430),
                 tp::Vector2<double>(90, 440)};
  return quad;
}

TEST(OpencvLens, SeesAsOurRadialTangential) {
  const tp::RadialTangential<double> ours{{458, 457, 367, 248}, -0.28, 0.07, 2e-4, 1.8e-5, 0.001};
  tp::Quad<double> expected, out;
  ASSERT_EQ(tp::undistorted(raw_quad(), ours, kStraight, &expected), tp::Status::ok);
  EXPECT_GT((expected.corner[0] - raw_quad().corner[0]).norm(), 20);
  ASSERT_EQ(tp::undistorted(raw_quad(), CvLens{kK, kD}, kStraight, &out), tp::Status::ok);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((out.corner[i] - expected.corner[i]).norm(), 1e-6);

  cv::Mat K, D;
  kK.convertTo(K, CV_32F);
  kD.reshape(1, 5).convertTo(D, CV_32F);
  ASSERT_EQ(tp::undistorted(raw_quad(), CvLens{K, D}, kStraight, &out), tp::Status::ok);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((out.corner[i] - expected.corner[i]).norm(), 1e-2);

  ASSERT_EQ(tp::undistorted(raw_quad(), CvLens{kK, {}}, tp::Pinhole<double>(458, 457, 367, 248), &out), tp::Status::ok);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((out.corner[i] - raw_quad().corner[i]).norm(), 1e-9);
}

cv::Mat intrinsics(const tp::Pinhole<double>& k) {
  return (cv::Mat_<double>(3, 3) << k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1);
}
cv::Mat coefficients(const std::vector<double>& k) { return cv::Mat(k, true).reshape(1, 1); }

// Pixel and derivatives, by the point and by the parameters that OpenCV has: f, c, k.
template <class Model>
void expect_projection(const Model& ours, const std::vector<double>& k, bool fisheye, const Eigen::Vector3d& p) {
  const cv::Mat K = intrinsics(ours.pinhole()), D = coefficients(k);
  const std::vector<cv::Point3d> points = {{p[0], p[1], p[2]}};
  std::vector<cv::Point2d> px;
  cv::Mat J;
  if (fisheye) {
    cv::fisheye::projectPoints(points, px, cv::Vec3d(), cv::Vec3d(), K, D, 0, J);
  } else {
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), K, D, px, J);
  }
  Eigen::Matrix<double, 2, 3> J_p;
  tp::FixedMatrix<double, 2, Model::kParameters> J_parameters;
  const Eigen::Vector2d expected(px[0].x, px[0].y);
  EXPECT_LT((ours.project(p, &J_p, &J_parameters) - expected).norm(), 1e-9) << p.transpose();
  // OpenCV's columns: rotation, translation, f, c, k (fisheye: f, c, k, rotation, translation, alpha).
  const int translation = fisheye ? 11 : 3, own = fisheye ? 0 : 6;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(J_p(i, j), J.at<double>(i, translation + j), 1e-8) << i << j;
    for (int j = 0; j < Model::kParameters; ++j)
      EXPECT_NEAR(J_parameters(i, j), J.at<double>(i, own + j), 1e-8) << i << j;
  }
}

TEST(OpencvLens, RationalProjectsAsProjectPoints) {
  const auto ours = camera_test::example<tp::Rational<double>>();
  const auto plain = camera_test::example<tp::RadialTangential<double>>();
  for (double y = -0.4; y <= 0.4; y += 0.1)
    for (double x = -0.55; x <= 0.56; x += 0.1) {
      const Eigen::Vector3d p = 1.5 * Eigen::Vector3d(x, y, 1);
      const auto k = ours.parameters();
      const auto few = plain.parameters();
      expect_projection(ours, {k.data() + 4, k.data() + 12}, false, p);
      expect_projection(plain, {few.data() + 4, few.data() + 9}, false, p);
    }
}

TEST(OpencvLens, KannalaBrandtProjectsAsFisheye) {
  const auto ours = camera_test::example<tp::KannalaBrandt<double>>();
  const auto all = ours.parameters();
  const std::vector<double> k(all.data() + 4, all.data() + 8);
  for (double angle = 0.05; angle < 1.5; angle += 0.1)
    for (double azimuth = 0; azimuth < 6; azimuth += 0.5) {
      const Eigen::Vector3d p = 2 * camera_test::direction(angle, azimuth);
      expect_projection(ours, k, true, p);
      const Eigen::Vector2d px = ours.project(p);
      std::vector<cv::Point2d> m;
      cv::fisheye::undistortPoints(std::vector<cv::Point2d>{{px[0], px[1]}}, m, intrinsics(ours.pinhole()),
                                   coefficients(k));
      tp::Vector3<double> ray = tp::Vector3<double>::Zero();
      ASSERT_EQ(ours.unproject(px, &ray), tp::Status::ok);
      const double scale = ray.squaredNorm();
      EXPECT_NEAR(m[0].x, ray[0], 1e-6 * scale) << angle;
      EXPECT_NEAR(m[0].y, ray[1], 1e-6 * scale) << angle;
    }
}

TEST(OpencvLens, EquidistantFisheye) {
  const CvLens lens{kK, cv::Mat::zeros(4, 1, CV_64F), true};
  tp::Vector3<double> ray;
  ASSERT_EQ(lens.unproject({367 + 458 * 0.5, 248}, &ray), tp::Status::ok);
  EXPECT_NEAR(ray.x(), std::tan(0.5), 1e-7) << "the angle is the distance from the centre by the focal length";
  EXPECT_NEAR(ray.y(), 0, 1e-9);
  EXPECT_EQ(ray.z(), 1);
  EXPECT_EQ(lens.unproject({367 + 458 * 1.7, 248}, &ray), tp::Status::degenerate) << "from behind";
}

TEST(OpencvLens, RefusesWhatItCannotMap) {
  const tp::Vector3<double> before(7, 8, 9);
  const auto expect_status = [&](const CvLens& lens, const tp::Vector2<double>& px, tp::Status status) {
    tp::Vector3<double> ray = before;
    EXPECT_EQ(lens.unproject(px, &ray), status);
    EXPECT_EQ(ray, before);
  };
  expect_status({kK, kD}, {std::nan(""), 0}, tp::Status::non_finite);
  expect_status({kK, kD}, {1500, 248}, tp::Status::degenerate);  // where this lens has folded over
  for (const CvLens& bad : {CvLens{}, CvLens{kK, cv::Mat::zeros(1, 6, CV_64F)}, CvLens{kK, cv::Mat::zeros(1, 5, CV_8U)},
                            CvLens{kK, cv::Mat::zeros(2, 2, CV_64F)}, CvLens{kK, kD, true},
                            CvLens{kK.rowRange(0, 2), kD}, CvLens{kK * std::nan(""), kD}})
    expect_status(bad, {300, 200}, tp::Status::invalid_argument);
}

}  // namespace
