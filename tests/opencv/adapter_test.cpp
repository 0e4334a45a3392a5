// adapters/opencv.hpp: what is the same memory, what is refused, and which corner comes first.
#include "textplane/adapters/opencv.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/core/affine.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace {

namespace tp = textplane;
namespace ad = textplane::adapters;

TEST(OpencvAdapter, ViewsAreTheSameMemory) {
  cv::Mat image(40, 50, CV_8UC1, cv::Scalar(0));
  const cv::Mat part = image(cv::Rect(7, 5, 20, 10));  // Rows with gaps.
  tp::ImageView8 view;
  ASSERT_EQ(ad::view(part, &view), tp::Status::ok);
  EXPECT_EQ(view.data(), image.ptr(5, 7));
  EXPECT_EQ(view.width(), 20);
  EXPECT_EQ(view.height(), 10);
  EXPECT_EQ(view.stride(), 50);
  image.at<std::uint8_t>(5 + 3, 7 + 2) = 99;
  EXPECT_EQ(view(2, 3), 99);

  cv::Mat back = ad::to_mat(view);
  EXPECT_EQ(back.data, part.data);
  EXPECT_EQ(back.step[0], part.step[0]);
  EXPECT_EQ(cv::countNonZero(back != part), 0);

  cv::Mat real(4, 6, CV_32FC1, cv::Scalar(1.5));
  tp::ImageView<float> writable;
  ASSERT_EQ(ad::view(real, &writable), tp::Status::ok);
  writable(5, 3) = 2.5F;
  EXPECT_EQ(real.at<float>(3, 5), 2.5F);
  EXPECT_EQ(ad::to_mat(writable).type(), CV_32FC1);
}

TEST(OpencvAdapter, OtherImagesAreRefused) {
  const int sizes[3] = {4, 5, 6};
  const std::vector<cv::Mat> bad = {cv::Mat(),
                                    cv::Mat(9, 9, CV_8UC3),
                                    cv::Mat(9, 9, CV_8SC1),
                                    cv::Mat(9, 9, CV_16UC1),
                                    cv::Mat(9, 9, CV_32FC1),
                                    cv::Mat(3, sizes, CV_8UC1)};
  std::uint8_t pixels[4] = {};
  for (const cv::Mat& image : bad) {
    tp::ImageView8 view(pixels, 2, 2);
    EXPECT_EQ(ad::view(image, &view), tp::Status::invalid_argument);
    EXPECT_FALSE(view.valid());
  }
  tp::ImageViewF view;
  EXPECT_EQ(ad::view(cv::Mat(9, 9, CV_8UC1), &view), tp::Status::invalid_argument);
  EXPECT_TRUE(ad::to_mat(tp::ImageView8()).empty());
}

void expect_level_0(const tp::Pyramid& pyramid, const cv::Mat& grey) {
  ASSERT_GT(pyramid.levels(), 0);
  EXPECT_EQ(cv::countNonZero(ad::to_mat(pyramid.level(0)) != grey), 0);
}

TEST(OpencvAdapter, PyramidsOfGreyAndColour) {
  cv::Mat colour(40, 51, CV_8UC3), with_alpha, grey;
  cv::randu(colour, 0, 256);
  cv::cvtColor(colour, with_alpha, cv::COLOR_BGR2BGRA);
  cv::cvtColor(colour, grey, cv::COLOR_BGR2GRAY);
  expect_level_0(ad::pyramid_from_cv(colour), grey);
  expect_level_0(ad::pyramid_from_cv(with_alpha), grey);
  expect_level_0(ad::pyramid_from_cv(grey), grey);
  const cv::Rect part(7, 5, 21, 17);  // Rows with gaps.
  expect_level_0(ad::pyramid_from_cv(colour(part)), grey(part));
  expect_level_0(ad::pyramid_from_cv(with_alpha(part)), grey(part));
  tp::Pyramid pyramid;
  EXPECT_EQ(ad::pyramid_from_cv(grey(part), &pyramid, 2), tp::Status::ok);
  expect_level_0(pyramid, grey(part));
  EXPECT_EQ(pyramid.levels(), 2);
  EXPECT_EQ(ad::pyramid_from_cv(grey).levels(), 4);
  EXPECT_EQ(pyramid.level(1)(3, 2), tp::Pyramid(pyramid.level(0), 2).level(1)(3, 2));
}

TEST(OpencvAdapter, PyramidsOfOtherImagesAreRefused) {
  const int sizes[3] = {4, 5, 6};
  for (const cv::Mat& image :
       {cv::Mat(), cv::Mat(9, 9, CV_16UC1), cv::Mat(9, 9, CV_8SC1), cv::Mat(9, 9, CV_32FC1), cv::Mat(9, 9, CV_8UC2),
        cv::Mat(9, 9, CV_16UC3), cv::Mat(3, sizes, CV_8UC1), cv::Mat(3, sizes, CV_8UC3)}) {
    tp::Pyramid pyramid = ad::pyramid_from_cv(cv::Mat(9, 9, CV_8UC1, cv::Scalar(5)));
    EXPECT_EQ(ad::pyramid_from_cv(image, &pyramid), tp::Status::invalid_argument);
    EXPECT_EQ(pyramid.levels(), 0);
    EXPECT_EQ(ad::pyramid_from_cv(image).levels(), 0);
  }
  tp::Pyramid pyramid;
  EXPECT_EQ(ad::pyramid_from_cv(cv::Mat::zeros(9, 9, CV_8UC3), &pyramid, 0), tp::Status::invalid_argument);
}

TEST(OpencvAdapter, PointsAndCameras) {
  EXPECT_EQ(ad::from_cv(cv::Point2f(1.5F, -2)), tp::Vector2<float>(1.5F, -2));
  EXPECT_EQ(ad::from_cv(cv::Point3d(1, 2, 3)), tp::Vector3<double>(1, 2, 3));
  EXPECT_EQ(ad::to_cv(tp::Vector2<double>(4, 5)), cv::Point2d(4, 5));
  EXPECT_EQ(ad::from_cv(cv::KeyPoint(7.25F, 8.5F, 31)), tp::Vector2<double>(7.25, 8.5));

  cv::Mat K = (cv::Mat_<double>(3, 3) << 500, 0, 320, 0, 510, 240, 0, 0, 1);
  tp::Pinhole<double> camera;
  ASSERT_EQ(ad::camera_from_cv(K, &camera), tp::Status::ok);
  EXPECT_EQ(camera.fy, 510);
  EXPECT_EQ(camera.cx, 320);
  cv::Mat single;
  K.convertTo(single, CV_32F);
  ASSERT_EQ(ad::camera_from_cv(single, &camera), tp::Status::ok);
  EXPECT_EQ(camera.fx, 500);
  K.at<double>(0, 1) = 0.1;
  EXPECT_EQ(ad::camera_from_cv(K, &camera), tp::Status::invalid_argument);
  EXPECT_EQ(ad::camera_from_cv(cv::Mat(), &camera), tp::Status::invalid_argument);
  EXPECT_EQ(ad::camera_from_cv(cv::Mat::zeros(3, 3, CV_64F), &camera), tp::Status::invalid_argument);
}

// A pose of ours moves points as OpenCV's does with its rotation vector.
TEST(OpencvAdapter, PosesMoveAlike) {
  const cv::Vec3d rotation(0.3, -0.2, 0.5), translation(0.1, 0.2, 3);
  const tp::SE3d T = ad::pose_from_cv(rotation, translation);
  const cv::Point3d p = cv::Affine3d(rotation, translation) * cv::Point3d(0.4, -0.3, 0.2);
  EXPECT_LT((T * tp::Vector3<double>(0.4, -0.3, 0.2) - ad::from_cv(p)).norm(), 1e-14);
  cv::Vec3d r, t;
  ad::pose_to_cv(T, &r, &t);
  EXPECT_LT(cv::norm(r - rotation) + cv::norm(t - translation), 1e-14);
}

// Whatever corner a detector begins with and however it turns, the word's top left comes first, clockwise.
TEST(OpencvAdapter, QuadsComeInReadingOrder) {
  for (int degrees : {-80, -30, 0, 1, 45, 89, 90}) {
    const double a = degrees * 3.14159265358979 / 180;
    const tp::Vector2<double> x(std::cos(a), std::sin(a)), y(-x[1], x[0]), middle(200, 150);
    tp::Quad<double> word;  // 80 x 20, reads along x.
    word.corner = {middle - 40 * x - 10 * y, middle + 40 * x - 10 * y, middle + 40 * x + 10 * y,
                   middle - 40 * x + 10 * y};
    for (int first = 0; first < 4; ++first)
      for (int turn : {1, 3}) {
        std::vector<cv::Point2d> points;
        for (int i = 0; i < 4; ++i)
          points.push_back(ad::to_cv(word.corner[static_cast<std::size_t>(first + turn * i) % 4]));
        tp::Quad<double> out;
        ASSERT_EQ(ad::quad_from_cv(points, &out), tp::Status::ok);
        for (std::size_t i = 0; i < 4; ++i)
          EXPECT_LT((out.corner[i] - word.corner[i]).norm(), 1e-9) << degrees << " " << first;
      }
    for (const cv::RotatedRect& box : {cv::RotatedRect({200, 150}, {80, 20}, static_cast<float>(degrees)),
                                       cv::RotatedRect({200, 150}, {20, 80}, static_cast<float>(degrees - 90))}) {
      tp::Quad<double> out;
      ASSERT_EQ(ad::quad_from_cv(box, &out), tp::Status::ok);
      // Floats: at exactly 90 degrees which way is up is a matter of their rounding.
      if (degrees == 90) continue;
      for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((out.corner[i] - word.corner[i]).norm(), 1e-4) << degrees;
    }
  }
}

TEST(OpencvAdapter, BadQuadsAreRefused) {
  tp::Quad<double> out;
  out.corner[0] = {5, 5};
  EXPECT_EQ(ad::quad_from_cv(std::vector<cv::Point>{{0, 0}, {9, 0}, {9, 9}}, &out), tp::Status::invalid_argument);
  EXPECT_EQ(ad::quad_from_cv(std::vector<cv::Point>{{0, 0}, {9, 9}, {9, 0}, {0, 9}}, &out), tp::Status::degenerate);
  EXPECT_EQ(ad::quad_from_cv(cv::RotatedRect({5, 5}, {0, 8}, 0), &out), tp::Status::degenerate);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(ad::quad_from_cv(std::vector<cv::Point2f>{{nan, 0}, {9, 0}, {9, 9}, {0, 9}}, &out), tp::Status::non_finite);
  EXPECT_EQ(out.corner[0], tp::Vector2<double>(5, 5));
  EXPECT_EQ(ad::to_cv(out)[0], cv::Point2f(5, 5));
}

}  // namespace
