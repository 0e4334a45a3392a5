// A camera that was given, by the map that was made with it.
#include "textslam/calibrate/camera_check.hpp"

#include <gtest/gtest.h>

#include "textslam/calibrate/calibration_map.hpp"

namespace textslam {
namespace camera_check_test {

using namespace calibration_map;

constexpr int kFrames = 36;
const CameraModel kGiven = model_of(textplane::Pinhole<double>{525, 525, 319.5, 239.5});

std::optional<SelfCalibration> checked(const std::vector<CameraModel>& cameras) {
  const CalibrationMap scene(cameras);
  return better_camera(scene.map, kGiven, Parameters());
}

TEST(CameraCheck, TheCameraThatTookTheImagesStays) {
  EXPECT_FALSE(checked({kFrames, kGiven}));
  EXPECT_FALSE(better_camera(Map(), kGiven, Parameters()));
}

TEST(CameraCheck, FindsWhatIsLeftOfALens) {
  const CameraModel truth = lens(525, 0.03, -0.06);
  ASSERT_GT(camera_distance(truth, kGiven), 1);
  const std::optional<SelfCalibration> found = checked({kFrames, truth});
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->determined);
  EXPECT_LT(camera_distance(truth, found->camera), 0.3);
  EXPECT_NEAR(found->camera.raw.parameters()[4], 0.03, 5 * found->sigma[4]);
  EXPECT_EQ(found->start.raw.parameters(), kGiven.raw.parameters());
  EXPECT_EQ(found->frames, kFrames);
}

TEST(CameraCheck, FindsThePrincipalPoint) {
  const std::optional<SelfCalibration> found = checked({kFrames, lens(525, 0.03, 0, 323)});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->camera.pinhole().cx, 323, 0.5);
}

// Errors of a shutter pass for another focal length.
TEST(CameraCheck, HoldsTheFocalLength) {
  const std::optional<SelfCalibration> found = checked({kFrames, lens(530, 0.03, -0.06)});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->camera.pinhole().fx, 525);
  EXPECT_EQ(found->sigma[0], 0);
}

// The share by which a lens that all frames tell lowers the cost, by cross-validation.
double gain_of(const std::vector<CameraModel>& cameras, const CalibrationExtent& extent, double* k1) {
  const CalibrationMap scene(cameras);
  CalibrationWindow window(scene.map, Parameters(), extent);
  textplane::WindowCalibration lens;
  lens.camera = with_lens(kGiven).raw;
  lens.mean = lens.camera.parameters();
  lens.hold();
  lens.sigma[4] = 1;
  EXPECT_TRUE(window.solve(&lens));
  *k1 = lens.camera.parameters()[4];
  return window.gain(window.leave_out(lens), with_lens(kGiven).raw);
}

TEST(CameraCheck, ALensOfOnePartOnlyLowersNoCost) {
  double k1 = 0;
  EXPECT_GT(gain_of({kFrames, lens(525, 0.05, 0)}, {}, &k1), 0.1);
  EXPECT_NEAR(k1, 0.05, 0.002);
  std::vector<CameraModel> cameras(kFrames, kGiven);
  std::fill(cameras.begin() + 12, cameras.begin() + 18, lens(525, 0.1, 0));
  EXPECT_LT(gain_of(cameras, {}, &k1), 0.01);
  EXPECT_GT(k1, 0.002) << "all frames together have it";
}

// Whose points do not fit the lens of all others, and cost more than these.
TEST(CameraCheck, OnePartDoesNotDecide) {
  std::vector<CameraModel> cameras(kFrames, lens(525, 0.05, 0));
  std::fill(cameras.begin() + 12, cameras.begin() + 18, lens(525, -0.5, 0));
  double k1 = 0;
  EXPECT_GT(gain_of(cameras, {}, &k1), 0.01);
}

TEST(CameraCheck, ExtentCountsTheFirstKeyFramesAndSomeOfThePoints) {
  std::vector<CameraModel> cameras(kFrames, lens(525, 0.05, 0));
  std::fill(cameras.begin() + 24, cameras.end(), lens(525, -0.05, 0));
  double k1 = 0;
  gain_of(cameras, {24, 0}, &k1);
  EXPECT_NEAR(k1, 0.05, 0.002);
  const CalibrationMap scene(cameras);
  const CalibrationWindow whole(scene.map, Parameters(), {}), some(scene.map, Parameters(), {0, 40});
  const double share = static_cast<double>(some.fit().first) / static_cast<double>(whole.fit().first);
  EXPECT_LE(static_cast<double>(some.fit().first), 40.0 * kFrames * 1.1);
  EXPECT_GT(share, 0.1);
}

}  // namespace camera_check_test
}  // namespace textslam
