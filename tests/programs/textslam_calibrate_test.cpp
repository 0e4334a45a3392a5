// Runs on sequences without a camera file, as a user would start them.
#include "programs/textslam_input.hpp"

namespace textslam {
namespace {

// A wide lens of which nothing is given.
TEST_F(TextslamInput, TheCameraIsEstimatedWhereThereIsNone) {
  render(sequence(), "uncalibrated", 120, 320);
  ASSERT_FALSE(fs::exists(sequence("camera.yaml")));
  const ProgramResult result = run();
  expect_success(result);
  EXPECT_TRUE(says(result.out, "camera estimated")) << result.out;
  const Json found = metrics().at("calibration");
  EXPECT_TRUE(found.at("determined").get<bool>());
  EXPECT_LT(found.at("largest_error_px").get<double>(), 1);
  EXPECT_NEAR(found.at("focal_error_percent").get<double>(), 0, 0.5);
  EXPECT_GT(found.at("sigma").at("fx").get<double>(), 0);
  EXPECT_FALSE(metrics().contains("approximate_camera"));

  // The file is a camera, and the run with it needs no calibration.
  const CameraModel camera = read_camera(output("camera.yaml"));
  EXPECT_EQ(camera.pinhole().fx, found.at("parameters").at("fx").get<double>());
  const Json data = Json::parse(report_block(bytes_of(output("report.html")), "data"));
  EXPECT_TRUE(says(data.at("summary").at("calibration"), "estimated from the images"));
  const std::string trajectory = bytes_of(output("trajectory.txt"));
  const ProgramResult again = textslam_program(
      {sequence(), "--camera", output("camera.yaml"), "--output", folder_.path("again"), "--no-report"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(bytes_of(folder_.path("again/trajectory.txt")), trajectory);
  EXPECT_FALSE(fs::exists(folder_.path("again/camera.yaml")));
}

// Images that never move tell nothing.
TEST_F(TextslamInput, WhatTheImagesDoNotTellIsAssumed) {
  make_flat(6, 320);
  fs::remove(sequence("camera.yaml"));
  const ProgramResult result = run();
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_TRUE(says(result.err, "do not tell the camera")) << result.err;
  EXPECT_TRUE(says(result.err, "a pinhole of 60 degrees")) << result.err;
  EXPECT_FALSE(metrics().at("calibration").at("determined").get<bool>());
  EXPECT_EQ(read_camera(output("camera.yaml")).pinhole().fx, camera_from_fov(60, 320, 240).pinhole().fx);
}

}  // namespace
}  // namespace textslam
