// What the program says: of a run that found nothing, of its time, of frames passed over, of a wrong command line.
#include <regex>

#include "io/image_support.hpp"
#include "programs/textslam_input.hpp"

namespace textslam {
namespace {

TEST_F(TextslamInput, NamesTheDetectorThatFoundNothing) {
  make_flat(3);
  const ProgramResult classical = run({"--detector", "classical"});
  EXPECT_TRUE(says(classical.out, "the detector classical found no text")) << classical.out;
  EXPECT_FALSE(says(classical.out, "no detections")) << classical.out;
  EXPECT_TRUE(says(run().out, "the sequence has no detections, see --detector"));
  EXPECT_FALSE(says(run({"--mode", "points"}).out, "detect")) << "it asks for none";
  write("detections/000000.txt", "");
  EXPECT_TRUE(says(run().out, "0: the sequence's detections hold none"));
  write("detections/000000.txt", "10,10,40,10,40,30,10,30,A\n10,10,40,10,40,30,10,30,B\n");
  EXPECT_TRUE(says(run().out, "0, of 2 detected boxes"));
}

TEST_F(TextslamInput, TimeCountsDetectionToo) {
  make_room();
  const std::regex both("time +[0-9.]+ ms a frame, detection ([0-9.]+) ms");
  const ProgramResult result = run({"--detector", "classical"});
  std::smatch found;
  ASSERT_TRUE(std::regex_search(result.out, found, both)) << result.out;
  EXPECT_GT(std::stod(found[1]), 0);
  const Json on_page = Json::parse(report_block(bytes_of(output("report.html")), "run"));
  EXPECT_GT(on_page.at("detect_ms").get<double>(), 0);
  EXPECT_GT(on_page.at("frame_ms").get<double>(), 0);
  const std::string points = run({"--mode", "points"}).out;
  EXPECT_FALSE(says(points, "detection")) << points;
  EXPECT_TRUE(says(points, "ms a frame")) << points;
}

// The angle that explains the images best is the right one: 62.7 degrees.
TEST_F(TextslamInput, ReprojectionErrorTellsARightAngleFromAWrongOne) {
  make_room();
  fs::remove(sequence("camera.yaml"));
  const auto error = [&](const std::string& fov) {
    const ProgramResult result = run({"--no-calibrate", "--fov", fov});
    EXPECT_TRUE(says(result.out, "reprojection error")) << result.out;
    const double px = metrics().at("reprojection_px").get<double>();
    std::smatch found;
    EXPECT_TRUE(std::regex_search(result.out, found, std::regex("reprojection error +([0-9.]+) px rms")));
    EXPECT_NEAR(std::stod(found[1]), px, 5e-4) << "as printed";
    return px;
  };
  const double right = error("62.7");
  EXPECT_GT(right, 0);
  EXPECT_LT(right, error("52"));
  EXPECT_LT(right, error("75"));
}

TEST_F(TextslamInput, FramesThatCannotBeReadArePassedOver) {
  make_room();
  write(image_name(14), bytes_of(sequence(image_name(14))).substr(0, 1000));
  fs::remove(sequence(image_name(15)));
  write(image_name(20), encode_png(Image<std::uint8_t>(64, 48, 100).view()));
  expect_refused(run(), 2, line_of(14), image_name(14));
  EXPECT_EQ(metrics().at("tracked"), 14);
  const ProgramResult on = run({"--skip-broken"});
  expect_refused(on, 0, "warning: ", "3 of 24 frames cannot be read and were passed over");
  expect_all_outputs(output());
  EXPECT_EQ(metrics().at("frames"), kFrames);
  EXPECT_EQ(metrics().at("broken"), 3);
  EXPECT_EQ(metrics().at("tracked"), kFrames - 3);
  const std::vector<double> times = times_of(read_tum(output("trajectory.txt")));
  ASSERT_EQ(times.size(), static_cast<std::size_t>(kFrames - 3));
  EXPECT_NEAR(times[14], 16 / 30.0, 1e-6) << "each pose at the time of its frame";
  for (int i = 0; i < kFrames; ++i) write(image_name(i), "");
  const ProgramResult none = run({"--skip-broken"});
  EXPECT_EQ(none.code, 3) << none.err;
  EXPECT_TRUE(says(none.err, "24 of 24 frames cannot be read")) << none.err;
}

TEST_F(TextslamInput, AVideoGoesOnPastAFrameOfAnotherSize) {
  std::string film;
  for (int i = 0; i < 6; ++i)
    film += encode_jpeg(Image<std::uint8_t>(i == 2 ? 32 : 64, i == 2 ? 24 : 48, 100).view(), 90);
  folder_.write("film.mjpeg", film);
  const auto watch = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {folder_.path("film.mjpeg"), "--fov", "60", "--output", output()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return textslam_program(arguments);
  };
  const ProgramResult stops = watch({});
  EXPECT_EQ(stops.code, 2);
  if (says(stops.err, "TEXTSLAM_VIDEO")) GTEST_SKIP() << "this build reads no videos";
  EXPECT_TRUE(says(stops.err, "32 x 24 px")) << stops.err;
  EXPECT_EQ(Json::parse(report_block(bytes_of(output("report.html")), "data")).at("frames").size(), 2u);
  const ProgramResult goes_on = watch({"--skip-broken"});
  EXPECT_TRUE(says(goes_on.err, "1 of 6 frames cannot be read and were passed over")) << goes_on.err;
  EXPECT_EQ(Json::parse(report_block(bytes_of(output("report.html")), "data")).at("frames").size(), 5u);
}

// The same as a sequence of these frames alone.
TEST_F(TextslamInput, OneFrameOfSeveral) {
  make_room();
  expect_success(run({"--first", "1", "--every", "2"}));
  EXPECT_EQ(metrics().at("frames"), kFrames / 2);
  const Json on_page = Json::parse(report_block(bytes_of(output("report.html")), "run"));
  EXPECT_EQ(on_page.at("first"), 1);
  EXPECT_EQ(on_page.at("last"), kFrames - 1);
  EXPECT_EQ(on_page.at("every"), 2);
  const std::string trajectory = bytes_of(output("trajectory.txt")), map = bytes_of(output("text_map.json"));
  std::istringstream lines(bytes_of(sequence("images.txt")));
  std::string list, line;
  for (int i = -1; std::getline(lines, line); ++i)
    if (i >= 0 && i % 2 == 1) list += line + "\n";
  write("images.txt", list);
  expect_success(run());
  EXPECT_EQ(bytes_of(output("trajectory.txt")), trajectory);
  EXPECT_EQ(bytes_of(output("text_map.json")), map);
}

TEST_F(TextslamInput, OrientationOfImagesIsNotIgnoredInSilence) {
  make_flat(2);
  const std::string jpeg = encode_jpeg(Image<std::uint8_t>(64, 48, 100).view(), 90);
  fs::remove_all(sequence());
  write("a.jpg", jpeg.substr(0, 2) + exif_segment(6, true) + jpeg.substr(2));
  write("b.jpg", jpeg);
  const ProgramResult turned = run({"--fov", "60"});
  EXPECT_TRUE(says(turned.err, "EXIF data (orientation 6)")) << turned.err;
  write("a.jpg", jpeg);
  const ProgramResult upright = run({"--fov", "60"});
  EXPECT_FALSE(says(upright.err, "EXIF")) << upright.err;
}

TEST_F(TextslamInput, NoFrameTracked) {
  make_flat(5, 320);
  const ProgramResult result = run();
  expect_refused(result, 3, "", "none of the 5 frames could be tracked, so there is no map");
  EXPECT_TRUE(says(result.out, "0 of 5")) << "the table all the same";
  expect_all_outputs(output());
  expect_refused(run({"--json-lines"}), 3, "", "none of the 5 frames");
}

TEST_F(TextslamInput, CommandLinesThatAreWrong) {
  make_flat(1);
  fs::remove(sequence("camera.yaml"));
  for (const char* fov : {"nan", "inf", "-nan", "0", "180", "wide"})
    expect_refused(run({"--fov", fov}), 2, "--fov", "should be 1 to 170");
  for (const char* fps : {"nan", "0", "-1"}) expect_refused(run({"--fps", fps}), 2, "--fps", "should be 0.001 to");
  expect_refused(textslam_program({sequence(), "--ouput", output()}), 2, "", "no option --ouput");
  expect_refused(run_program(TEXTSLAM_MAP_PROGRAM, {"query", sequence(), "--jsn"}), 2, "", "no option --jsn",
                 "textslam-map");
  expect_refused(run_program(TEXTSLAM_MAP_PROGRAM, {"angles", sequence(), "--within", "nan"}), 2, "", "--within",
                 "textslam-map");
  expect_refused(run_program(TEXTSLAM_EVAL_PROGRAM, {"--cvs"}), 2, "", "no option --cvs", "textslam-eval");
  EXPECT_FALSE(fs::exists(output()));
}

TEST_F(TextslamInput, Version) {
  const std::vector<std::string> programs = {TEXTSLAM_PROGRAM, TEXTSLAM_EVAL_PROGRAM, TEXTSLAM_MAP_PROGRAM};
  for (const std::string& program : programs) {
    const ProgramResult version = run_program(program, {"--version"});
    expect_success(version);
    EXPECT_TRUE(std::regex_match(version.out, std::regex("textslam(-eval|-map)? [0-9]+\\.[0-9]+\\.[0-9]+[^\n]*\n")))
        << version.out;
  }
}

TEST_F(TextslamInput, RenderingSaysHowFarItIs) {
  const ProgramResult result =
      textslam_program({"--render", "notext", "--frames", "8", "--render-only", "--output", output()});
  expect_success(result);
  for (const char* line :
       {"rendering notext: 2 of 8 frames\n", "rendering notext: 6 of 8 frames\n", "rendering notext: 8 of 8 frames\n"})
    EXPECT_TRUE(says(result.out, line)) << result.out;
}

}  // namespace
}  // namespace textslam
