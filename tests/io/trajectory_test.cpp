#include "io/trajectory.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "io/io_support.hpp"
#include "io/text_file.hpp"

namespace textslam {
namespace io_trajectory_test {

SE3d random_pose(std::mt19937& random) {
  const auto unit = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  textplane::Vector6<double> xi;
  for (int i = 0; i < 6; ++i) xi[i] = 3 * unit();
  return textplane::se3_exp(xi);
}

TEST(Trajectory, ReadsByHand) {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("t.txt", "# c\r\n1.5 1 -2 3e0 0 0 0.70710678 0.70710678\r\n\r\n  2 0 0 0\t1 0 0 0\n");
  const auto poses = read_tum(path);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].timestamp, 1.5);
  EXPECT_EQ(poses[0].T_w_c.t, Vector3<double>(1, -2, 3));
  Matrix3<double> quarter;  // about z: x to y
  quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_LT((poses[0].T_w_c.R - quarter).cwiseAbs().maxCoeff(), 1e-15) << "normalised, though the file has 8 digits";
  Matrix3<double> half = Vector3<double>(1, -1, -1).asDiagonal();
  EXPECT_LT((poses[1].T_w_c.R - half).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Trajectory, RoundTrip) {
  const TemporaryFolder folder;
  std::mt19937 random(3);
  std::vector<StampedPose> poses;
  for (int i = 0; i < 200; ++i) poses.push_back({1764905949.5 + i / 30.0, random_pose(random)});
  write_tum(folder.path("t.txt"), poses);
  const auto again = read_tum(folder.path("t.txt"));
  ASSERT_EQ(again.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(again[i].timestamp, poses[i].timestamp);
    EXPECT_LT((again[i].T_w_c.t - poses[i].T_w_c.t).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((again[i].T_w_c.R - poses[i].T_w_c.R).cwiseAbs().maxCoeff(), 1e-11);
  }
  EXPECT_TRUE(format_tum(poses) == read_file(folder.path("t.txt"))) << "the same poses give the same bytes";
}

TEST(Trajectory, FormatIsFixed) {
  StampedPose pose;
  pose.timestamp = 0.1;
  pose.T_w_c.t = {-1e-17, 2.5, -3};
  EXPECT_EQ(format_tum({pose}),
            "# timestamp tx ty tz qx qy qz qw (camera to world)\n"
            "0.100000000 0.000000000000 2.500000000000 -3.000000000000 "
            "0.000000000000 0.000000000000 0.000000000000 1.000000000000\n");
  pose.T_w_c.R = textplane::so3_exp<double>({0, 0, 3.5});  // qw = cos 1.75 < 0 before the sign is fixed
  const std::string line = format_tum({pose}).substr(format_tum({}).size());
  const auto words = split_blanks(std::string_view(line).substr(0, line.size() - 1));
  double qw = 0;
  ASSERT_TRUE(parse_number(words[7], &qw));
  EXPECT_NEAR(qw, -std::cos(1.75), 1e-12);
}

TEST(Trajectory, EmptyFilesAreEmptyTrajectories) {
  const TemporaryFolder folder;
  EXPECT_TRUE(read_tum(folder.write("t.txt", "")).empty());
  EXPECT_TRUE(read_tum(folder.write("t.txt", format_tum({}))).empty());
}

TEST(Trajectory, BadLines) {
  const TemporaryFolder folder;
  const auto expect_bad = [&](const std::string& text, int line, const std::string& part) {
    const std::string path = folder.write("t.txt", text);
    expect_input_error([&] { read_tum(path); }, path, line, part);
  };
  const std::string good = "0 0 0 0 0 0 0 1\n";
  expect_bad(good + "1 0 0 0 0 0 1\n", 2, "8 columns (timestamp tx ty tz qx qy qz qw), not 7");
  expect_bad(good + "1 0 0 0 0 0 0 1 2\n", 2, "not 9");
  expect_bad(good + "1 0 nought 0 0 0 0 1\n", 2, "ty should be a finite number, not 'nought'");
  expect_bad(good + "1 0 0 nan 0 0 0 1\n", 2, "tz should be a finite number, not 'nan'");
  expect_bad(good + "1 0 0 0 0 0 0 0\n", 2, "not of unit length");
  expect_bad(good + "1 0 0 0 0 0 0 1.1\n", 2, "not of unit length");
  expect_bad(good + "0 0 0 0 0 0 0 1\n", 2, "times must increase");
  expect_bad("1 0 0 0 0 0 0 1\n" + good, 2, "times must increase");
  expect_bad(std::string("\x1F\x8B\0\0", 4), 1, "not a text file");
  expect_input_error([&] { read_tum(folder.path("none")); }, folder.path("none"), 0, "No such file");
}

TEST(Trajectory, RefusesToWriteNaN) {
  const TemporaryFolder folder;
  std::vector<StampedPose> poses(1);
  poses[0].T_w_c.t[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_tum(folder.path("t.txt"), poses), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder.path("t.txt")));
}

}  // namespace io_trajectory_test
}  // namespace textslam
