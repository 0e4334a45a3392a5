// camera_from_cv() with a lens: pixels as cv::projectPoints and cv::fisheye give them.
#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <vector>

#include "support/random.hpp"
#include "textplane/adapters/opencv.hpp"
#include "textplane/core/cameras/camera_view.hpp"

namespace lens_camera_test {
namespace tp = textplane;

const cv::Mat kK = (cv::Mat_<double>(3, 3) << 458, 0, 367, 0, 457, 248, 0, 0, 1);

void expect_same_pixels(const cv::Mat& D, bool fisheye, const char* name) {
  tp::AnyCamera<double> camera;
  ASSERT_EQ(tp::adapters::camera_from_cv(kK, D, fisheye, &camera), tp::Status::ok);
  EXPECT_STREQ(camera.name(), name);
  const tp::LensMap lens(camera);
  const tp::CameraView view(camera.pinhole(), &lens);
  textplane_test::Random random(4);
  for (int trial = 0; trial < 100; ++trial) {
    const double x = random.uniform(-0.8, 0.8), y = random.uniform(-0.6, 0.6), z = random.uniform(1, 3);
    const std::vector<cv::Point3d> p = {{x * z, y * z, z}};
    std::vector<cv::Point2d> px;
    if (fisheye)
      cv::fisheye::projectPoints(p, px, cv::Vec3d(), cv::Vec3d(), kK, D);
    else
      cv::projectPoints(p, cv::Vec3d(), cv::Vec3d(), kK, D, px);
    ASSERT_TRUE(view.in_domain({p[0].x, p[0].y, p[0].z}));
    const tp::Vector2<double> ours = view.project({p[0].x, p[0].y, p[0].z});
    EXPECT_NEAR(ours[0], px[0].x, 1e-9);
    EXPECT_NEAR(ours[1], px[0].y, 1e-9);
  }
}

TEST(OpencvCamera, ProjectsAsOpencv) {
  expect_same_pixels(cv::Mat(), false, tp::Pinhole<double>::kName);
  expect_same_pixels((cv::Mat_<double>(1, 4) << -0.28, 0.07, 2e-4, 1.8e-5), false, "radial_tangential");
  expect_same_pixels((cv::Mat_<double>(5, 1) << -0.28, 0.07, 2e-4, 1.8e-5, 0.001), false, "radial_tangential");
  expect_same_pixels((cv::Mat_<double>(1, 8) << 0.4, 0.1, 1e-3, -5e-4, 0.01, 0.7, 0.15, 0.02), false, "rational");
  expect_same_pixels((cv::Mat_<double>(1, 4) << 0.0034, 0.0007, -0.002, 0.0002), true, "kannala_brandt");
}

TEST(OpencvCamera, RefusesWhatItDoesNotHave) {
  tp::AnyCamera<double> camera;
  const cv::Mat none;
  EXPECT_EQ(tp::adapters::camera_from_cv(kK, cv::Mat_<double>::zeros(1, 3), false, &camera),
            tp::Status::invalid_argument);
  EXPECT_EQ(tp::adapters::camera_from_cv(kK, none, true, &camera), tp::Status::invalid_argument);
  EXPECT_EQ(tp::adapters::camera_from_cv(none, none, false, &camera), tp::Status::invalid_argument);
  cv::Mat_<double> prism(1, 12, 0.0);
  EXPECT_EQ(tp::adapters::camera_from_cv(kK, prism, false, &camera), tp::Status::ok);
  prism(0, 9) = 1e-3;
  EXPECT_EQ(tp::adapters::camera_from_cv(kK, prism, false, &camera), tp::Status::invalid_argument);
  cv::Mat_<float> broken(1, 5, 0.0F);
  broken(0, 0) = std::nanf("");
  EXPECT_EQ(tp::adapters::camera_from_cv(kK, broken, false, &camera), tp::Status::invalid_argument);
  EXPECT_TRUE(camera.is_pinhole());
}

}  // namespace lens_camera_test
