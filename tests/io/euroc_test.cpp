// Sequences in EuRoC's layout, and what is wrong with each, in one line.
#include "io/euroc.hpp"

#include "io/layouts_support.hpp"

namespace textslam {
namespace io_euroc_test {

TEST_F(LayoutTest, Euroc) {
  make_euroc();
  folder.write("mav0/state_groundtruth_estimate0/data.csv",
               "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], v\r\n"
               "1403636579763555584,4.5,-1.5,0.75,0,1,0,0,9\r\n");
  for (const char* name : {"", "mav0"}) {
    const Sequence sequence = read_sequence(folder.path(name));
    ASSERT_EQ(sequence.frames.size(), 2u);
    EXPECT_EQ(sequence.frames[0].timestamp, 1403636579.763555584);
    EXPECT_EQ(sequence.frames[1].line, 3);
    EXPECT_EQ(sequence.frames[1].stem, "1403636579813555456");
    EXPECT_EQ(load_frame(sequence, 1)(0, 0), 2);
    EXPECT_EQ(sequence.camera.width, 8);
    EXPECT_EQ(sequence.camera.height, 6);
    EXPECT_EQ(sequence.camera.fps, 20);
    EXPECT_EQ(sequence.camera.pinhole().fx, 458.654);
    EXPECT_EQ(sequence.camera.pinhole().fy, 457.296);
    EXPECT_EQ(sequence.camera.pinhole().cx, 367.215);
    EXPECT_EQ(sequence.camera.pinhole().cy, 248.375);
    EXPECT_EQ(lens_of(sequence.camera).k1, -0.28340811);
    EXPECT_EQ(lens_of(sequence.camera).k2, 0.07395907);
    EXPECT_EQ(lens_of(sequence.camera).p1, 0.00019359);
    EXPECT_EQ(lens_of(sequence.camera).p2, 1.76187114e-05);
    EXPECT_EQ(lens_of(sequence.camera).k3, 0);
    // The body is turned by half a turn about x: (x, y, z) -> (x, -y, -z), and the camera sits at (0.5, -0.25, 0.125)
    // in it.
    ASSERT_EQ(sequence.groundtruth.size(), 1u);
    EXPECT_EQ(sequence.groundtruth[0].timestamp, sequence.frames[0].timestamp);
    const SE3d& T_w_c = sequence.groundtruth[0].T_w_c;
    EXPECT_LT((T_w_c.t - Vector3<double>(5, -1.25, 0.625)).norm(), 1e-12) << T_w_c.t;
    // The camera's x axis is the body's y: the world's -y.
    EXPECT_LT((T_w_c.R.col(0) - Vector3<double>(0, -1, 0)).norm(), 1e-12) << T_w_c.R;
  }
}

TEST_F(LayoutTest, EurocListThatIsWrong) {
  make_euroc();
  const std::string list = "mav0/cam0/data.csv";
  const auto expect_list = [&](const std::string& text, int line, const std::string& part) {
    folder.write(list, text);
    expect_bad(list, line, part);
  };
  expect_list("#t\n1000,a.png\n1.5e3,b.png\n", 3, "a whole number of nanoseconds, not '1.5e3'");
  expect_list("#t\n1000,a.png\n1000,b.png\n", 3, "times must increase: '1000'");
  expect_list("99999999999999999999,a.png\n", 1, "a whole number of nanoseconds");
  expect_list("1000\n", 1, "expected 'timestamp,file name'");
  expect_list("1000,\n", 1, "expected 'timestamp,file name'");
  expect_list("1000,a.png,b.png\n", 1, "expected 'timestamp,file name'");
  expect_list("#t\n", 0, "names no image");
  folder.write(list, "1000,a.png\n2000,1403636579813555456.png\n");
  const Sequence sequence = read_sequence(folder.path());
  expect_input_error([&] { load_frame(sequence, 0); }, folder.path(list), 1, "No such file");
  EXPECT_NO_THROW(load_frame(sequence, 1));
  image("mav0/cam0/data/a.png", 1, 9, 6);
  expect_input_error([&] { load_frame(sequence, 0); }, folder.path(list), 1, "is 9 x 6 px, sensor.yaml says 8 x 6");
  std::filesystem::remove(folder.path(list));
  expect_bad(list, 0, "No such file");
}

TEST_F(LayoutTest, EurocTruthThatIsWrong) {
  make_euroc();
  const std::string truth = "mav0/state_groundtruth_estimate0/data.csv";
  folder.write(truth, "#t\n1000,0,0,0,1,0,0\n");
  expect_bad(truth, 2, "a pose has 8 columns");
  folder.write(truth, "1000,0,0,0,1,0,0,0\n1000,0,0,0,1,0,0,0\n");
  expect_bad(truth, 2, "times must increase");
  folder.write(truth, "1000,0,0,0,1,1,0,0\n");
  expect_bad(truth, 1, "unit length");
  folder.write(truth, "1000,0,zero,0,1,0,0,0\n");
  expect_bad(truth, 1, "y should be a finite number, not 'zero'");
  // Without a sensor.yaml the camera has no place in the body.
  std::filesystem::remove(folder.path("mav0/cam0/sensor.yaml"));
  EXPECT_TRUE(read_sequence(folder.path(), fov(60)).groundtruth.empty());
  expect_bad("mav0/cam0/sensor.yaml", 0, "No such file: give --camera FILE");
}

}  // namespace io_euroc_test
}  // namespace textslam
