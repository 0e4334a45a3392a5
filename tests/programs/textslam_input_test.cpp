// Broken input, given to the program as a user would: one clear line, the right exit code, nothing computed is lost.
#include <functional>

#include "programs/textslam_input.hpp"

namespace textslam {
namespace {

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
  expect_refused(run({"--no-calibrate"}), 2, sequence("camera.yaml") + ": ", "No such file: give --camera");
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
  expect_no_map(run());
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

}  // namespace
}  // namespace textslam
