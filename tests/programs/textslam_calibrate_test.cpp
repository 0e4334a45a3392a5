// Runs on sequences without a camera file, or with one that is off, as a user would start them.
#include <algorithm>

#include "programs/textslam_input.hpp"
#include "support/long_test.hpp"

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

// `camera`, but for a part of its lens.
CameraModel without_a_part(const CameraModel& camera) {
  CameraModel off = camera;
  auto values = camera.raw.parameters();
  values[4] += 0.03;
  EXPECT_TRUE(textplane::is_ok(textplane::AnyCamera<double>::make(camera.raw.name(), values, &off.raw)));
  return off;
}

// The map says that the calibration is off, and is made again. It keeps the mended camera, and takes later sessions
// with the file that it mended.
TEST_F(TextslamInput, ACalibrationThatIsOffIsMended) {
  TEXTPLANE_LONG_TEST();
  render(sequence(), "uncalibrated", 120, 320);
  write("camera.yaml", format_camera(without_a_part(read_camera(sequence("true_camera.yaml")))));
  expect_success(run({"--no-calibrate"}));
  const double before = metrics().at("trajectory").at("ate_rmse").get<double>();
  EXPECT_FALSE(fs::exists(output("camera.yaml")));

  const std::string map = folder_.path("map.db"), second = folder_.path("second");
  const ProgramResult result = run({"--save-map", map});
  expect_success(result);
  EXPECT_TRUE(says(result.out, "begun with the camera file")) << result.out;
  const Json found = metrics().at("calibration");
  EXPECT_LT(found.at("largest_error_px").get<double>(), 0.3);
  EXPECT_EQ(found.at("focal_error_percent").get<double>(), 0);
  EXPECT_LT(metrics().at("trajectory").at("ate_rmse").get<double>(), 0.7 * before);

  // With the camera that it wrote there is nothing to mend, and the map is the same.
  const std::string trajectory = bytes_of(output("trajectory.txt"));
  const std::string again = folder_.path("again");
  const ProgramResult with_it =
      textslam_program({sequence(), "--camera", output("camera.yaml"), "--output", again, "--no-report"});
  EXPECT_EQ(with_it.code, 0) << with_it.err;
  EXPECT_EQ(bytes_of(again + "/trajectory.txt"), trajectory);
  EXPECT_FALSE(fs::exists(again + "/camera.yaml"));

  const auto localise = [&] {
    return textslam_program({sequence(), "--first", "60", "--map", map, "--localise", "--output", second});
  };
  const ProgramResult later = localise();
  EXPECT_EQ(later.code, 0) << later.err;
  EXPECT_TRUE(says(later.err, "its camera is better than that of the camera file")) << later.err;
  const auto poses = read_tum(output("trajectory.txt")), localised = read_tum(second + "/trajectory.txt");
  ASSERT_EQ(localised.size(), 60u);
  double most = 0;
  for (const PosePair& pair : associate(localised, poses, 1e-6))
    most = std::max(most, (localised[pair.estimate].T_w_c.t - poses[pair.truth].T_w_c.t).norm());
  EXPECT_LT(most, 0.01);

  fs::copy_file(output("camera.yaml"), sequence("camera.yaml"), fs::copy_options::overwrite_existing);
  EXPECT_EQ(localise().code, 0) << "the better camera itself";
  write("camera.yaml", format_camera(read_camera(sequence("true_camera.yaml"))));
  const ProgramResult refused = localise();
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(says(refused.err, "its camera is not that of")) << refused.err;
}

}  // namespace
}  // namespace textslam
