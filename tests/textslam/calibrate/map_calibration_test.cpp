// Calibration from maps of a known camera.
#include "textslam/calibrate/map_calibration.hpp"

#include <gtest/gtest.h>

#include "textslam/calibrate/calibration_map.hpp"

namespace textslam {
namespace map_calibration_test {

using namespace calibration_map;
using scene_support::camera;

MapCalibration calibrated(const CameraModel& truth, const CameraModel& guess, bool turning = true) {
  const CalibrationMap scene({12, truth}, turning);
  return calibrate(scene.map, guess, guess, Parameters(), CalibrationPriors());
}

TEST(MapCalibration, FindsTheLensAndTheFocalLength) {
  for (const double factor : {0.9, 1.0, 1.1}) {
    const CameraModel truth = lens(525, -0.28, 0.07);
    const MapCalibration found = calibrated(truth, lens(525 * factor, 0, 0));
    ASSERT_TRUE(found.determined);
    EXPECT_LT(camera_distance(truth, found.camera), 1);
    EXPECT_LT(std::abs(found.camera.pinhole().fx - 525), 4 * found.sigma[0]);
    EXPECT_GT(found.sigma[4], 0);
    EXPECT_EQ(found.sigma[2], 0) << "the principal point is where the guess has it";
    EXPECT_EQ(found.camera.pinhole().cx, 319.5);
    EXPECT_NEAR(found.reprojection_px, 0.2 * std::sqrt(2.0 / 3), 0.03);
  }
}

TEST(MapCalibration, WhatIsNotThereStaysOut) {
  const MapCalibration found = calibrated(lens(525, 0, 0), lens(480, 0, 0));
  ASSERT_TRUE(found.determined);
  EXPECT_NEAR(found.camera.pinhole().fx, 525, 1);
  for (int i = 4; i < 9; ++i) {
    EXPECT_EQ(found.camera.raw.parameters()[i], 0);
    EXPECT_EQ(found.sigma[static_cast<std::size_t>(i)], 0);
  }
}

TEST(MapCalibration, FindsThePrincipalPointWhereItIsElsewhere) {
  const MapCalibration found = calibrated(lens(525, -0.1, 0, 330), lens(525, 0, 0));
  ASSERT_TRUE(found.determined);
  EXPECT_NEAR(found.camera.pinhole().cx, 330, 1);
  EXPECT_GT(found.sigma[2], 0);
}

// Without rotation a longer focal length is a deeper scene.
TEST(MapCalibration, WithoutRotationNothingIsDetermined) {
  const CameraModel guess = lens(480, 0, 0);
  const MapCalibration found = calibrated(lens(525, 0, 0), guess, false);
  EXPECT_FALSE(found.determined);
  EXPECT_EQ(found.camera.raw.parameters(), guess.raw.parameters());
  EXPECT_FALSE(calibrate(Map(), guess, guess, Parameters(), CalibrationPriors()).determined);
}

TEST(MapCalibration, DistanceOfCameras) {
  const CameraModel a = lens(525, -0.28, 0.07);
  EXPECT_LT(camera_distance(a, a), 1e-9);
  // A principal point that is off by a px is a camera that is turned, but for the lens.
  EXPECT_LT(camera_distance(lens(525, 0, 0), lens(525, 0, 0, 320.5)), 0.4);
  EXPECT_NEAR(camera_distance(lens(525, 0, 0), lens(525 * 1.01, 0, 0)), 4, 0.2);
  EXPECT_EQ(with_lens(model_of(camera())).raw.parameters().size(), 9);
  EXPECT_EQ(with_lens(a).raw.parameters(), a.raw.parameters());
}

}  // namespace map_calibration_test
}  // namespace textslam
