#include "io/sequence.hpp"

#include "io/image_file.hpp"
#include "io/io_support.hpp"

namespace textslam {
namespace io_sequence_test {

const char* const kCamera =
    "Camera.width: 8\n"
    "Camera.height: 6\n"
    "Camera.fps: 30.0\n"
    "Camera.fx: 527.36\n"
    "Camera.fy: 527.5\n"
    "Camera.cx: 319.5\n"
    "Camera.cy: 239.25\n"
    "Camera.k1: -0.025592\n"
    "Camera.k2: 0.01\n"
    "Camera.p1: 1e-3\n"
    "Camera.p2: -2e-4\n";

class SequenceTest : public testing::Test {
 protected:
  SequenceTest() {
    folder.write("camera.yaml", kCamera);
    folder.write("images.txt", "# timestamp path\n0.0 images/a.0.png\n\n0.5 images/b.png\n1.25 images/c.png\n");
    for (const char* name : {"images/a.0.png", "images/b.png", "images/c.png"}) {
      folder.write(name, encode_png(Image<std::uint8_t>(8, 6, 100).view()));
    }
  }
  void expect_bad_camera(const std::string& text, int line, const std::string& part) {
    const std::string path = folder.write("camera.yaml", text);
    expect_input_error([&] { read_sequence(folder.path()); }, path, line, part);
  }
  void expect_bad_images(const std::string& text, int line, const std::string& part) {
    const std::string path = folder.write("images.txt", text);
    expect_input_error([&] { read_sequence(folder.path()); }, path, line, part);
  }

  TemporaryFolder folder;
};

TEST_F(SequenceTest, Reads) {
  const Sequence sequence = read_sequence(folder.path());
  EXPECT_EQ(sequence.folder, folder.path());
  EXPECT_EQ(sequence.images_file, folder.path("images.txt"));
  ASSERT_EQ(sequence.frames.size(), 3u);
  EXPECT_EQ(sequence.frames[0].timestamp, 0.0);
  EXPECT_EQ(sequence.frames[2].timestamp, 1.25);
  EXPECT_EQ(sequence.frames[0].stem, "a.0");
  EXPECT_EQ(sequence.frames[1].path, folder.path("images/b.png"));
  EXPECT_EQ(sequence.frames[0].line, 2);
  EXPECT_EQ(sequence.frames[1].line, 4);
  EXPECT_EQ(sequence.camera.width, 8);
  EXPECT_EQ(sequence.camera.height, 6);
  EXPECT_EQ(sequence.camera.fps, 30.0);
  EXPECT_EQ(sequence.camera.pinhole().fx, 527.36);
  EXPECT_EQ(sequence.camera.pinhole().fy, 527.5);
  EXPECT_EQ(sequence.camera.pinhole().cx, 319.5);
  EXPECT_EQ(sequence.camera.pinhole().cy, 239.25);
  EXPECT_EQ(lens_of(sequence.camera).k1, -0.025592);
  EXPECT_EQ(lens_of(sequence.camera).k2, 0.01);
  EXPECT_EQ(lens_of(sequence.camera).p1, 1e-3);
  EXPECT_EQ(lens_of(sequence.camera).p2, -2e-4);
  EXPECT_EQ(lens_of(sequence.camera).k3, 0.0);
  EXPECT_TRUE(sequence.groundtruth.empty());
  EXPECT_FALSE(sequence.has_detections);
  EXPECT_EQ(load_frame(sequence, 2)(7, 5), 100);
  EXPECT_THROW(load_frame(sequence, 3), std::out_of_range);
}

TEST_F(SequenceTest, RgbListGroundTruthAndDetections) {
  std::filesystem::rename(folder.path("images.txt"), folder.path("rgb.txt"));
  folder.write("groundtruth.txt", "# TUM\n0.0 1 2 3 0 0 0 1\n");
  std::filesystem::create_directory(folder.path("detections"));
  const Sequence sequence = read_sequence(folder.path());
  EXPECT_EQ(sequence.images_file, folder.path("rgb.txt"));
  EXPECT_EQ(sequence.groundtruth.size(), 1u);
  EXPECT_TRUE(sequence.has_detections);
}

TEST_F(SequenceTest, CrLfByteOrderMarkBlanksInPathAndOneImage) {
  folder.write("my images/one image.png", encode_png(Image<std::uint8_t>(8, 6, 9).view()));
  folder.write("images.txt", "\xEF\xBB\xBF# list\r\n\r\n  3.5 \t my images/one image.png \r\n");
  const Sequence sequence = read_sequence(folder.path());
  ASSERT_EQ(sequence.frames.size(), 1u);
  EXPECT_EQ(sequence.frames[0].stem, "one image");
  EXPECT_EQ(load_frame(sequence, 0)(0, 0), 9);
}

TEST_F(SequenceTest, CameraAsOrbSlamWritesIt) {
  const std::string path = folder.write(
      "camera.yaml",
      "%YAML:1.0\n---\n# Camera\nCamera.type: \"PinHole\"\nCamera.fx: 384.25 # px\nCamera.fy: 382.5\nCamera.cx: 315.5\n"
      "Camera.cy: 249\nCamera.k1: 0.1\nCamera.k2: 0.0\nCamera.p1: 0.0\nCamera.p2: 0.0\nCamera.k3: +0.5\nCamera.fps: "
      "60.0\n"
      "Camera.RGB: 0\nCamera.height: 480\nCamera.width: 640.0\nExp read path: ./dataset/\nTbc: !!opencv-matrix\n   "
      "rows: 4\n"
      "   data: [1.0, 0.0,\n          0.0]\nORBextractor.nFeatures: 1000\n...\n");
  const CameraModel camera = read_camera(path);
  EXPECT_EQ(camera.pinhole().fx, 384.25);
  EXPECT_EQ(lens_of(camera).k3, 0.5);
  EXPECT_EQ(camera.width, 640);
}

TEST_F(SequenceTest, CameraSurvivesTheRoundTrip) {
  CameraModel camera = read_camera(folder.path("camera.yaml"));
  RadialTangential<double> raw = lens_of(camera);
  raw.intrinsics.fx = 1000.0 / 3.0;
  raw.k3 = -1.0 / 7.0;
  camera.raw = raw;
  const CameraModel again = read_camera(folder.write("again.yaml", format_camera(camera)));
  EXPECT_EQ(lens_of(again).parameters(), raw.parameters());
  EXPECT_EQ(again.width, camera.width);
  EXPECT_EQ(again.height, camera.height);
  EXPECT_EQ(again.fps, camera.fps);
}

TEST_F(SequenceTest, BadCamera) {
  expect_bad_camera(replaced(kCamera, "Camera.cy: 239.25\n", ""), 0, "the key Camera.cy is missing");
  expect_bad_camera(replaced(kCamera, "Camera.p2: -2e-4\n", ""), 0, "the key Camera.p2 is missing");
  expect_bad_camera(replaced(kCamera, "527.36", "nan"), 4, "Camera.fx should be a finite number, not 'nan'");
  expect_bad_camera(replaced(kCamera, "527.36", ".nan"), 4, "Camera.fx should be a finite number");
  expect_bad_camera(replaced(kCamera, "239.25", "inf"), 7, "Camera.cy should be a finite number");
  expect_bad_camera(replaced(kCamera, "239.25", "1e999"), 7, "Camera.cy should be a finite number");
  expect_bad_camera(replaced(kCamera, "527.36", "0"), 4, "Camera.fx should be positive");
  expect_bad_camera(replaced(kCamera, "527.5", "-527.5"), 5, "Camera.fy should be positive");
  expect_bad_camera(replaced(kCamera, "30.0", "-1"), 3, "Camera.fps should be positive");
  expect_bad_camera(replaced(kCamera, "319.5", "319,5"), 6, "Camera.cx should be a finite number, not '319,5'");
  expect_bad_camera(replaced(kCamera, "319.5", ""), 6, "Camera.cx should be a finite number, not ''");
  expect_bad_camera(replaced(kCamera, "319.5", "# nothing"), 6, "Camera.cx should be a finite number, not ''");
  expect_bad_camera(replaced(kCamera, "width: 8", "width: 8.5"), 1, "Camera.width should be a whole number");
  expect_bad_camera(replaced(kCamera, "width: 8", "width: 0"), 1, "Camera.width should be positive");
  expect_bad_camera(replaced(kCamera, "height: 6", "height: 1000000"), 2, "Camera.height should be a whole number");
  expect_bad_camera(kCamera + std::string("Camera.fx: 1\n"), 12, "'Camera.fx' is given twice, first in line 4");
  expect_bad_camera(kCamera + std::string("Camera.type: KannalaBrandt8\n"), 0, "the key Camera.k3 is missing");
  expect_bad_camera(kCamera + std::string("Camera.type: Fisheye\n"), 12,
                    "should be PinHole or Rectified or Rational or KannalaBrandt8 or DoubleSphere or EUCM or FOV, not "
                    "'Fisheye'");
  expect_bad_camera(kCamera + std::string("what: is: this\n"), 12, "this is no YAML: 'illegal map value'");
  expect_bad_camera("", 0, "expected 'key: value' lines");
  expect_bad_camera(std::string("\x7F"
                                "ELF\0\0\x01",
                                7),
                    1, "not a text file");
}

TEST_F(SequenceTest, BadImageList) {
  expect_bad_images("0 a.png\n0.5 b.png\n0.25 c.png\n", 3, "times must increase: '0.25' does not follow line 2");
  expect_bad_images("0 a.png\n# c\n\n0 b.png\n", 4, "times must increase: '0' does not follow line 1");
  expect_bad_images("0 a.png\nzero b.png\n", 2, "the timestamp should be a finite number, not 'zero'");
  expect_bad_images("0 a.png\nnan b.png\n", 2, "the timestamp should be a finite number, not 'nan'");
  expect_bad_images("0 a.png\n1e400 b.png\n", 2, "the timestamp should be a finite number");
  expect_bad_images("0 a.png\n1.0x b.png\n", 2, "the timestamp should be a finite number");
  expect_bad_images("0 a.png\n1.5\n", 2, "path is missing");
  expect_bad_images("images/a.png\n", 1, "the timestamp should be a finite number");
  expect_bad_images("", 0, "names no image");
  expect_bad_images("# nothing but comments\n\n", 0, "names no image");
  expect_bad_images(std::string("0 a.png\n\x89PNG\0\0", 14), 2, "not a text file");
  expect_bad_images("\xFF\xFE\x80\x81 garbage\n", 1, "not '\?\?\?\?'");
}

TEST_F(SequenceTest, MissingParts) {
  std::filesystem::remove(folder.path("camera.yaml"));
  expect_input_error([&] { read_sequence(folder.path()); }, folder.path("camera.yaml"), 0, "No such file");
  std::filesystem::remove(folder.path("images.txt"));
  expect_input_error([&] { read_sequence(folder.path()); }, folder.path(), 0, "neither images.txt nor rgb.txt");
  expect_input_error([&] { read_sequence(folder.path("none")); }, folder.path("none"), 0, "no such folder");
  const std::string file = folder.path("images/a.0.png");
  expect_input_error([&] { read_sequence(file); }, file, 0, "not a folder");
}

TEST_F(SequenceTest, BadGroundTruthIsReportedAtOnce) {
  const std::string path = folder.write("groundtruth.txt", "0 0 0 0 0 0 0 1\n1 0 0 x 0 0 0 1\n");
  expect_input_error([&] { read_sequence(folder.path()); }, path, 2, "tz should be a finite number, not 'x'");
}

// A broken frame costs itself alone: the ones around it load, and the message names its line in the list.
TEST_F(SequenceTest, BrokenFrames) {
  const Sequence sequence = read_sequence(folder.path());
  const std::string list = folder.path("images.txt"), image = folder.path("images/b.png");

  std::filesystem::remove(image);
  expect_input_error([&] { load_frame(sequence, 1); }, list, 4, image + ": No such file");
  EXPECT_NO_THROW(load_frame(sequence, 0));
  EXPECT_NO_THROW(load_frame(sequence, 2));

  const std::string whole = encode_png(Image<std::uint8_t>(8, 6, 1).view());
  folder.write("images/b.png", whole.substr(0, whole.size() / 2));
  expect_input_error([&] { load_frame(sequence, 1); }, list, 4, "broken PNG");
  folder.write("images/b.png", encode_jpeg(Image<std::uint8_t>(8, 6, 1).view(), 90).substr(0, 200));
  expect_input_error([&] { load_frame(sequence, 1); }, list, 4, "broken JPEG");
  folder.write("images/b.png", "");
  expect_input_error([&] { load_frame(sequence, 1); }, list, 4, "empty");
  folder.write("images/b.png", encode_png(Image<std::uint8_t>(6, 8, 1).view()));
  expect_input_error([&] { load_frame(sequence, 1); }, list, 4, "the image is 6 x 8 px, camera.yaml says 8 x 6");
}

}  // namespace io_sequence_test
}  // namespace textslam
