// Bad and unusual input, given to the program as a user would: one clear line, the right exit code, nothing computed is lost.
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "io/evaluate.hpp"
#include "io/image_file.hpp"
#include "programs/textslam_support.hpp"
#include "renderer/renderer_support.hpp"

namespace textslam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string image_name(int frame) {
  std::string digits = std::to_string(frame);
  return "images/" + std::string(6 - digits.size(), '0') + digits + ".png";
}

// A folder with a sequence `sequence` and room for the results.
class TextslamInput : public testing::Test {
 protected:
  // Flat grey images at 30 a second.
  void make_flat(int frames, int width = 64) {
    std::string list;
    for (int i = 0; i < frames; ++i) {
      write(image_name(i), encode_png(Image<std::uint8_t>(width, width * 3 / 4, 100).view()));
      list += std::to_string(i / 30.0) + " " + image_name(i) + "\n";
    }
    write("images.txt", list);
    write("camera.yaml", format_camera(test_camera(width)));
  }
  // The first frames of the room, small; rendered once for all tests.
  void make_room() {
    static const TemporaryFolder rendered;
    if (!fs::exists(rendered.path("room"))) render(rendered.path("room"), "room", kFrames, 320);
    fs::copy(rendered.path("room"), sequence(), fs::copy_options::recursive);
  }

  std::string line_of(int frame) const {
    const int line = read_sequence(sequence()).frames[static_cast<std::size_t>(frame)].line;
    return sequence("images.txt") + ":" + std::to_string(line) + ": ";
  }
  std::string sequence(const std::string& name = "") const {
    return folder_.path(name.empty() ? "seq" : "seq/" + name);
  }
  std::string output(const std::string& name = "") const { return folder_.path(name.empty() ? "out" : "out/" + name); }
  void write(const std::string& name, const std::string& bytes) const { folder_.write("seq/" + name, bytes); }
  void replace(const std::string& name, const std::string& from, const std::string& to) const {
    std::string text = bytes_of(sequence(name));
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from << " in " << name;
    write(name, text.replace(at, from.size(), to));
  }
  ProgramResult run(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {sequence(), "--output", output()});
    return textslam_program(more);
  }
  Json metrics() const { return Json::parse(bytes_of(output("metrics.json"))); }

  // The run ends at frame `broken`: everything before it is written, the same as if the sequence had ended there.
  void expect_kept_before(int broken) {
    expect_all_outputs(output());
    const ProgramResult shorter =
        textslam_program({sequence(), "--output", folder_.path("shorter"), "--last", std::to_string(broken - 1)});
    EXPECT_EQ(shorter.code, 0) << shorter.err;
    for (const char* name : {"trajectory.txt", "trajectory_live.txt", "keyframes.txt", "text_map.json", "text_map.ply"})
      EXPECT_EQ(bytes_of(output(name)), bytes_of(folder_.path("shorter") + "/" + name)) << name;
    EXPECT_EQ(read_tum(output("trajectory.txt")).size(), static_cast<std::size_t>(broken));
    EXPECT_EQ(metrics().at("frames"), kFrames) << "coverage counts the frames asked for";
    EXPECT_EQ(metrics().at("tracked"), broken);
  }

  static constexpr int kFrames = 24;
  TemporaryFolder folder_;
};

TEST_F(TextslamInput, MissingFolder) {
  expect_refused(run(), 2, sequence() + ": ", "no such folder");
  EXPECT_FALSE(fs::exists(output())) << "no empty results";
}

TEST_F(TextslamInput, FileInsteadOfFolder) {
  folder_.write("seq", "");
  expect_refused(run(), 2, sequence() + ": ", "not a folder");
}

TEST_F(TextslamInput, MissingList) {
  make_flat(1);
  fs::remove(sequence("images.txt"));
  expect_refused(run(), 2, sequence() + ": ", "neither images.txt nor rgb.txt");
}

TEST_F(TextslamInput, MissingCamera) {
  make_flat(1);
  fs::remove(sequence("camera.yaml"));
  expect_refused(run(), 2, sequence("camera.yaml") + ": ", "No such file: give --camera");
}

TEST_F(TextslamInput, EmptyList) {
  make_flat(1);
  write("images.txt", "# nothing\n");
  expect_refused(run(), 2, sequence("images.txt") + ": ", "names no image");
}

TEST_F(TextslamInput, BadNumbers) {
  make_flat(3);
  const std::string list = bytes_of(sequence("images.txt")), camera = bytes_of(sequence("camera.yaml"));
  write("images.txt", "0.0 " + image_name(0) + "\n0,1 " + image_name(1) + "\n");
  expect_refused(run(), 2, sequence("images.txt") + ":2: ", "'0,1'");
  write("images.txt", "nan " + image_name(0) + "\n");
  expect_refused(run(), 2, sequence("images.txt") + ":1: ", "'nan'");
  write("images.txt", list);

  write("camera.yaml", camera + "Camera.RGB: 1\n");
  expect_success(run());
  replace("camera.yaml", "Camera.width: 64", "Camera.width: wide");
  expect_refused(run(), 2, sequence("camera.yaml") + ":1: ", "'wide'");
  write("camera.yaml", camera);

  write("groundtruth.txt", "# TUM\n0 0 0 0 0 0 0 1\n1 0 0 zero 0 0 0 1\n");
  expect_refused(run(), 2, sequence("groundtruth.txt") + ":3: ", "'zero'");
}

TEST_F(TextslamInput, IntrinsicsThatAreNotNumbers) {
  make_flat(1);
  const std::string camera = bytes_of(sequence("camera.yaml"));
  int line = 0;
  for (const char* key : {"width", "height", "fps", "fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"}) {
    ++line;
    for (const char* value : {"nan", ".nan", "-inf", "1e999"}) {
      const std::size_t at = camera.find(std::string("Camera.") + key + ": ");
      ASSERT_NE(at, std::string::npos) << key;
      std::string broken = camera;
      broken.replace(at, camera.find('\n', at) - at, std::string("Camera.") + key + ": " + value);
      write("camera.yaml", broken);
      SCOPED_TRACE(std::string(key) + " " + value);
      expect_refused(run(), 2, sequence("camera.yaml") + ":" + std::to_string(line) + ": ", value);
    }
  }
}

TEST_F(TextslamInput, UnsortedTime) {
  make_flat(3);
  write("images.txt", "0.5 " + image_name(0) + "\n# comment\n0.4 " + image_name(1) + "\n");
  expect_refused(run(), 2, sequence("images.txt") + ":3: ", "times must increase");
  write("images.txt", "0.5 " + image_name(0) + "\n0.5 " + image_name(1) + "\n");
  expect_refused(run(), 2, sequence("images.txt") + ":2: ", "times must increase");
}

TEST_F(TextslamInput, MissingImageInTheMiddle) {
  make_room();
  fs::remove(sequence(image_name(14)));
  expect_refused(run(), 2, line_of(14), image_name(14));
  expect_kept_before(14);
}

TEST_F(TextslamInput, TruncatedImageInTheMiddle) {
  make_room();
  const std::string bytes = bytes_of(sequence(image_name(14)));
  write(image_name(14), bytes.substr(0, bytes.size() / 2));
  expect_refused(run(), 2, line_of(14), image_name(14));
  expect_kept_before(14);
}

TEST_F(TextslamInput, BrokenDetectionsInTheMiddle) {
  make_room();
  write("detections/000014.txt", "1,2,3,4,5,6,7,8,GOOD\n10,10,90,ten,90,40,10,40,EXIT\n");
  expect_refused(run(), 2, sequence("detections/000014.txt") + ":2: ", "'ten'");
  expect_kept_before(14);
  expect_success(run({"--mode", "points"}));
  expect_success(run({"--detector", "classical"}));
}

TEST_F(TextslamInput, ImageThatIsNone) {
  make_flat(3);
  for (const char* bytes : {"", "GIF89a", "\x89PNG\r\n\x1A\n", "P5\n64 48\n255\nshort"}) {
    write(image_name(1), bytes);
    expect_refused(run(), 2, sequence("images.txt") + ":2: ", image_name(1));
    expect_all_outputs(output());
  }
  fs::remove(sequence(image_name(1)));
  fs::create_directory(sequence(image_name(1)));
  expect_refused(run(), 2, sequence("images.txt") + ":2: ", image_name(1));
}

TEST_F(TextslamInput, WrongImageSize) {
  make_flat(3);
  write(image_name(1), encode_png(Image<std::uint8_t>(48, 64, 100).view()));
  expect_refused(run(), 2, sequence("images.txt") + ":2: ", "48 x 64 px, camera.yaml says 64 x 48");
  expect_all_outputs(output());
  write(image_name(0), encode_png(Image<std::uint8_t>(65, 48, 100).view()));
  expect_refused(run(), 2, sequence("images.txt") + ":1: ", "65 x 48 px");
}

TEST_F(TextslamInput, BrokenTruthCostsNoResult) {
  make_room();
  write("truth/signs.json", "{\"signs\": [");
  expect_refused(run(), 2, sequence("truth/signs.json") + ":1: ", "parse error");
  expect_all_outputs(output());
  EXPECT_EQ(read_tum(output("trajectory.txt")).size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(metrics().at("trajectory").at("status"), "ok");
}

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
    expect_success(run({"--mode", mode}));
    expect_all_outputs(output());
    EXPECT_EQ(metrics().at("tracked"), 0);
    EXPECT_EQ(metrics().at("map_began_at_frame"), -1);
    EXPECT_TRUE(read_tum(output("trajectory.txt")).empty());
  }
  expect_success(run({"--detector", "classical"}));
}

TEST_F(TextslamInput, OneImage) {
  make_room();
  const std::string list = bytes_of(sequence("images.txt"));
  write("images.txt", list.substr(0, list.find(".png\n") + 5));
  expect_success(run());
  expect_all_outputs(output());
  EXPECT_EQ(metrics().at("frames"), 1);
  EXPECT_EQ(metrics().at("tracked"), 0);
}

TEST_F(TextslamInput, ImagesOfAFewPixels) {
  for (const int width : {4, 8, 20}) {
    fs::remove_all(sequence());
    make_flat(3, width);
    for (const char* detector : {"files", "classical"}) {
      expect_success(run({"--detector", detector}));
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

// Without calibration: refused, or with an angle in its place, and then the outputs say so.
TEST_F(TextslamInput, CameraFromAnAngle) {
  make_room();
  fs::remove(sequence("camera.yaml"));
  expect_refused(run(), 2, sequence("camera.yaml") + ": ", "--fov DEGREES");
  expect_refused(run({"--fov", "180"}), 2, "", "--fov");
  expect_refused(run({"--fov", "60", "--camera", "x.yaml"}), 2, "", "--fov");
  const ProgramResult result = run({"--fov", "60.5"});
  expect_refused(result, 0, "warning: ", "approximate, a pinhole of 60.5 degrees");
  EXPECT_EQ(metrics().at("approximate_camera").at("fov_deg"), 60.5);
  const Json data = Json::parse(report_block(bytes_of(output("report.html")), "data"));
  EXPECT_EQ(data.at("camera").at("approximate_fov_deg"), 60.5);

  // The same images by their names alone, at the same rate.
  const ProgramResult by_name = textslam_program({sequence("images"), "--detections", sequence("detections"), "--fov",
                                                  "60.5", "--fps", "30", "--output", folder_.path("names")});
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
  expect_success(run({"--first", "2", "--last", "4"}));
  EXPECT_EQ(metrics().at("frames"), 3);
  expect_success(run({"--first", "4"}));
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
  expect_success(textslam_program({odd, "--output", odd + "/my results"}));
  expect_all_outputs(odd + "/my results");
}

}  // namespace
}  // namespace textslam
