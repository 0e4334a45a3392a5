// Unusual input, given to the program as a user would: senseless detections, blank and tiny images, options, places to
// write to.
#include <cmath>

#include "programs/textslam_input.hpp"

namespace textslam {
namespace {

TEST_F(TextslamInput, NoTextAtAll) {
  make_room();
  fs::remove_all(sequence("detections"));
  expect_success(run());
  expect_all_outputs(output());
  EXPECT_EQ(metrics().at("tracked"), kFrames);
  EXPECT_EQ(metrics().at("texts"), 0);
  EXPECT_TRUE(Json::parse(bytes_of(output("text_map.json"))).at("texts").empty());
}

// Detectors have bad days: quads that are lines, points, twisted, mirrored, outside, huge.
TEST_F(TextslamInput, SenselessDetections) {
  make_room();
  for (int i = 0; i < kFrames; ++i) {
    write("detections/" + image_name(i).substr(7, 6) + ".txt",
          "10,10,90,10,90,10,10,10,LINE\n50,50,50,50,50,50,50,50,POINT\n10,10,90,40,90,10,10,40,TWIST\n"
          "90,10,10,10,10,40,90,40,MIRROR\n-900,-900,-800,-900,-800,-880,-900,-880,OUTSIDE\n"
          "-1e9,-1e9,1e9,-1e9,1e9,1e9,-1e9,1e9,HUGE\n1e300,0,1e308,1,1e308,2e300,-1e308,1e299,HUGER\n\n"
          "0,0,319,0,319,239,0,239,ALL\n100.5,100.5,101,100.5,101,101,100.5,101,TINY\n20,20,60,20,60,40,20,40\n");
  }
  expect_success(run());
  expect_all_outputs(output());
  EXPECT_EQ(metrics().at("tracked"), kFrames);
}

TEST_F(TextslamInput, BlankImages) {
  make_flat(12, 320);
  write("detections/000003.txt", "10,10,90,10,90,40,10,40,GHOST\n");
  for (const char* mode : {"text", "points", "loose"}) {
    expect_no_map(run({"--mode", mode}));
    expect_all_outputs(output());
    EXPECT_EQ(metrics().at("tracked"), 0);
    EXPECT_EQ(metrics().at("map_began_at_frame"), -1);
    EXPECT_TRUE(read_tum(output("trajectory.txt")).empty());
  }
  expect_no_map(run({"--detector", "classical"}));
}

TEST_F(TextslamInput, OneImage) {
  make_room();
  const std::string list = bytes_of(sequence("images.txt"));
  write("images.txt", list.substr(0, list.find(".png\n") + 5));
  expect_no_map(run());
  expect_all_outputs(output());
  EXPECT_EQ(metrics().at("frames"), 1);
  EXPECT_EQ(metrics().at("tracked"), 0);
}

TEST_F(TextslamInput, ImagesOfAFewPixels) {
  for (const int width : {4, 8, 20}) {
    fs::remove_all(sequence());
    make_flat(3, width);
    for (const char* detector : {"files", "classical"}) {
      expect_no_map(run({"--detector", detector}));
      EXPECT_EQ(metrics().at("tracked"), 0) << width;
    }
  }
}

// The lens cap is on for a moment: the frames are lost, and the same map goes on after them.
TEST_F(TextslamInput, BlackFramesInTheMiddle) {
  make_room();
  const std::string black = encode_png(Image<std::uint8_t>(320, 240, 0).view());
  for (int i = 12; i < 15; ++i) write(image_name(i), black);
  for (const char* mode : {"text", "points"}) {
    SCOPED_TRACE(mode);
    expect_success(run({"--mode", mode}));
    const Sequence seq = read_sequence(sequence());
    const std::vector<StampedPose> poses = read_tum(output("trajectory.txt"));
    const std::vector<double> times = times_of(poses);
    for (int i = 0; i < kFrames; ++i) {
      const double time = seq.frames[static_cast<std::size_t>(i)].timestamp;
      const bool tracked = std::any_of(times.begin(), times.end(), [&](double t) { return std::abs(t - time) < 1e-6; });
      EXPECT_EQ(tracked, i < 12 || i >= 15) << "frame " << i;
    }
    // One similarity fits both parts only where both are in one map.
    const TrajectoryEvaluation errors = evaluate_trajectory(poses, seq.groundtruth, seq.frames.size());
    ASSERT_EQ(errors.status, Status::ok);
    EXPECT_LT(errors.ate.rmse, 0.02 * errors.path_length);
  }
}

// Without calibration, and not to be calibrated: refused, or with an angle in its place, and then the outputs say so.
TEST_F(TextslamInput, CameraFromAnAngle) {
  make_room();
  fs::remove(sequence("camera.yaml"));
  expect_refused(run({"--no-calibrate"}), 2, sequence("camera.yaml") + ": ", "--fov DEGREES");
  expect_refused(run({"--no-calibrate", "--calibrate"}), 2, "", "calibrate");
  expect_refused(run({"--fov", "180"}), 2, "", "--fov");
  expect_refused(run({"--fov", "60", "--camera", "x.yaml"}), 2, "", "--fov");
  const ProgramResult result = run({"--no-calibrate", "--fov", "60.5"});
  expect_refused(result, 0, "warning: ", "approximate, a pinhole of 60.5 degrees");
  EXPECT_EQ(metrics().at("approximate_camera").at("fov_deg"), 60.5);
  const Json data = Json::parse(report_block(bytes_of(output("report.html")), "data"));
  EXPECT_EQ(data.at("camera").at("approximate_fov_deg"), 60.5);

  // The same images by their names alone, at the same rate.
  const ProgramResult by_name =
      textslam_program({sequence("images"), "--detections", sequence("detections"), "--no-calibrate", "--fov", "60.5",
                        "--fps", "30", "--output", folder_.path("names")});
  EXPECT_EQ(by_name.code, 0) << by_name.err;
  EXPECT_EQ(bytes_of(folder_.path("names/text_map.json")), bytes_of(output("text_map.json")));
  EXPECT_EQ(bytes_of(folder_.path("names/trajectory.txt")), bytes_of(output("trajectory.txt")));
}

TEST_F(TextslamInput, UnknownOptionsAndNames) {
  make_flat(1);
  expect_refused(run({"--fast"}), 2, "", "--fast");
  expect_refused(run({"--mode", "lines"}), 2, "", "lines");
  expect_refused(run({"--detector", "magic"}), 2, "", "magic");
  expect_refused(run({"--first", "two"}), 2, "", "two");
  expect_refused(run({"--first", "-1"}), 2, "", "--first");
  expect_refused(run({"another"}), 2, "", "another");
  expect_refused(textslam_program({"--render", "castle", "--output", output()}), 2, "", "castle");
  expect_refused(textslam_program({"--output", output()}), 2, "", "SEQUENCE or --render");
  expect_refused(run({"--noise", "3"}), 2, "", "--render");
  expect_refused(textslam_program({"--render", "room", "--missed", "1.5", "--output", output()}), 2, "", "missed");
  expect_refused(textslam_program({sequence(), "--render", "room", "--output", output()}), 2, "",
                 "SEQUENCE or --render");
  expect_refused(textslam_program({sequence()}), 2, "", "--output");
  EXPECT_FALSE(fs::exists(output()));
  const ProgramResult help = textslam_program({"--help"});
  expect_success(help);
  EXPECT_NE(help.out.find("--detector"), std::string::npos);
}

TEST_F(TextslamInput, RangeOfFrames) {
  make_flat(5);
  expect_no_map(run({"--first", "2", "--last", "4"}));
  EXPECT_EQ(metrics().at("frames"), 3);
  expect_no_map(run({"--first", "4"}));
  EXPECT_EQ(metrics().at("frames"), 1);
  const std::string place = sequence("images.txt") + ": ";
  expect_refused(run({"--last", "5"}), 2, place, "frames 0 to 5 asked for, but it has 0 to 4");
  expect_refused(run({"--first", "5"}), 2, place, "0 to 4");
  expect_refused(run({"--first", "3", "--last", "2"}), 2, place, "frames 3 to 2");
  expect_refused(run({"--last", "99999999999999999999"}), 2, "", "99999999999999999999");
}

TEST_F(TextslamInput, OutputThatCannotBeMade) {
  make_flat(1);
  folder_.write("out", "a file in the way");
  expect_refused(run(), 1, output() + ": ", "cannot make the folder");
  EXPECT_EQ(bytes_of(output()), "a file in the way");
  expect_refused(textslam_program({sequence(), "--output", output("below")}), 1, output("below") + ": ", "cannot make");
}

TEST_F(TextslamInput, OutputThatCannotBeWritten) {
  make_flat(1);
  fs::create_directories(output("trajectory.txt/in the way"));
  expect_refused(run(), 1, output("trajectory.txt") + ": ", "cannot write");
}

TEST_F(TextslamInput, NamesWithBlanksAndQuotes) {
  make_flat(2);
  const std::string odd = folder_.path("it's a \"sequence\"");
  fs::rename(sequence(), odd);
  expect_no_map(textslam_program({odd, "--output", odd + "/my results"}));
  expect_all_outputs(odd + "/my results");
}

}  // namespace
}  // namespace textslam
