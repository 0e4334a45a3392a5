// What a sequence can be besides a folder with a list: a folder of images; cameras from an angle; ICDAR's
// names of detections. And what is wrong with each, in one line. EuRoC's layout: euroc_test.cpp; videos:
// textslam/input/video_test.cpp.
#include <cmath>

#include "io/detections.hpp"
#include "io/layouts_support.hpp"

namespace textslam {
namespace io_layouts_test {

TEST(NaturalOrder, IsThatOfPersons) {
  // 01.png and 1.png have the same value: the bytes decide.
  const std::vector<std::string> ordered = {"",
                                            "01.png",
                                            "1.png",
                                            "2.png",
                                            "09.png",
                                            "10.png",
                                            "a",
                                            "a1b2",
                                            "a1b10",
                                            "a01b11",
                                            "a2",
                                            "a18446744073709551616",
                                            "a18446744073709551617",
                                            "b"};
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    for (std::size_t k = 0; k < ordered.size(); ++k)
      EXPECT_EQ(natural_less(ordered[i], ordered[k]), i < k) << ordered[i] << " " << ordered[k];
  }
}

TEST_F(LayoutTest, FolderOfImagesInNaturalOrder) {
  image("img_10.png", 10);
  image("img_9.png", 9);
  image("img_100.PNG", 100);
  folder.write("img_8.pgm", "P5 8 6 255\n" + std::string(48, '\x08'));
  folder.write(".img_0.png", "");
  folder.write("notes.txt", "");
  std::filesystem::create_directory(folder.path("img_1.png"));
  const Sequence sequence = read_sequence(folder.path(), fov(90));
  ASSERT_EQ(sequence.frames.size(), 4u);
  const int values[] = {8, 9, 10, 100};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(load_frame(sequence, i)(7, 5), values[i]);
    EXPECT_EQ(sequence.frames[i].stem, "img_" + std::to_string(values[i]));
    EXPECT_EQ(sequence.frames[i].timestamp, static_cast<double>(i) / 30);
  }
  EXPECT_EQ(frame_name(sequence, 3), "img_100.PNG");

  SequenceOptions options = fov(90);
  options.fps = 12.5;
  EXPECT_EQ(read_sequence(folder.path(), options).frames[3].timestamp, 3 / 12.5);
}

// By hand: half the image's width, 4 px, is seen under half the angle; the outermost edges lie half a pixel outside the
// centres.
TEST_F(LayoutTest, CameraFromAnAngle) {
  image("a.png");
  const Sequence sequence = read_sequence(folder.path(), fov(90));
  EXPECT_EQ(sequence.approximate_fov, 90);
  const CameraModel& camera = sequence.camera;
  EXPECT_EQ(camera.width, 8);
  EXPECT_EQ(camera.height, 6);
  EXPECT_NEAR(camera.pinhole().fx, 4, 1e-12);
  EXPECT_NEAR(camera.pinhole().fy, 4, 1e-12);
  EXPECT_EQ(camera.pinhole().cx, 3.5);
  EXPECT_EQ(camera.pinhole().cy, 2.5);
  EXPECT_TRUE(camera.is_pinhole());
  const auto left = camera.pinhole().unproject(Vector2<double>(-0.5, 2.5)),
             right = camera.pinhole().unproject(Vector2<double>(7.5, 2.5));
  EXPECT_NEAR(std::acos(left.normalized().dot(right.normalized())) * 180 / M_PI, 90, 1e-9);
  EXPECT_NEAR(camera_from_fov(60, 640, 480).pinhole().fx, 320 * std::sqrt(3.0), 1e-9);
}

TEST_F(LayoutTest, ACameraIsAssumedWhereItMay) {
  SequenceOptions options;
  options.assumes_camera = true;
  const std::string jpeg = encode_jpeg(Image<std::uint8_t>(120, 90, 100).view(), 90);
  folder.write("a.jpg", jpeg);
  Sequence sequence = read_sequence(folder.path(), options);
  EXPECT_EQ(sequence.camera_origin, CameraOrigin::assumed);
  EXPECT_EQ(sequence.approximate_fov, kAssumedFov);
  EXPECT_FALSE(sequence.true_camera);

  // 43.27 mm on film are the image's diagonal.
  folder.write("a.jpg", jpeg.substr(0, 2) + exif_focal_segment(26, true) + jpeg.substr(2));
  sequence = read_sequence(folder.path(), options);
  EXPECT_EQ(sequence.camera_origin, CameraOrigin::exif);
  EXPECT_NEAR(sequence.camera.pinhole().fx, 150 * 26 / 43.2666, 1e-9);
  EXPECT_NEAR(sequence.approximate_fov, std::atan(60 / (150 * 26 / 43.2666)) * 360 / M_PI, 1e-9);

  options.fov = 80;
  EXPECT_EQ(read_sequence(folder.path(), options).camera_origin, CameraOrigin::fov);
  options.fov = 0;
  folder.write("true_camera.yaml", format_camera(camera_from_fov(50, 120, 90)));
  sequence = read_sequence(folder.path(), options);
  EXPECT_EQ(sequence.camera_origin, CameraOrigin::exif) << "the true camera is not the sequence's";
  EXPECT_EQ(sequence.true_camera->width, 120);
  folder.write("camera.yaml", format_camera(camera_from_fov(55, 120, 90)));
  EXPECT_EQ(read_sequence(folder.path(), options).camera_origin, CameraOrigin::file);
}

TEST_F(LayoutTest, CalibrationGoesBeforeTheAngle) {
  image("a.png");
  expect_bad("", 0, "there is no calibration: give --camera FILE, or --fov DEGREES");
  CameraModel camera = camera_from_fov(80, 8, 6);
  camera.fps = 10;
  SequenceOptions options;
  options.camera = folder.write("my/camera.txt", format_camera(camera));
  Sequence sequence = read_sequence(folder.path(), options);
  EXPECT_EQ(sequence.camera.pinhole().fx, camera.pinhole().fx);
  EXPECT_EQ(sequence.approximate_fov, 0);

  folder.write("camera.yaml", format_camera(camera));
  image("b.png");
  EXPECT_EQ(read_sequence(folder.path()).frames[1].timestamp, 0.1) << "as the calibration says";
  expect_bad("camera.yaml", 0, "calibrated here: leave out --fov", fov(80));
  options.camera = folder.write("my/sensor.yaml", kSensor);
  EXPECT_EQ(read_sequence(folder.path(), options).camera.pinhole().fx, 458.654);
  options.camera = folder.write("my/vi.yaml", kSensor);
  EXPECT_EQ(lens_of(read_sequence(folder.path(), options).camera).k1, -0.28340811);
  options.camera = folder.path("none.yaml");
  expect_bad("none.yaml", 0, "No such file", options);

  options = {};
  options.needs_camera = false;
  std::filesystem::remove(folder.path("camera.yaml"));
  EXPECT_EQ(load_image(read_sequence(folder.path(), options), 1).width(), 8);
}

TEST_F(LayoutTest, FolderOfImagesThatIsWrong) {
  expect_bad("", 0, "neither images.txt nor rgb.txt, no mav0/cam0, and no images", fov(60));
  folder.write("a.txt", "");
  expect_bad("", 0, "no images", fov(60));
  folder.write("a.webp", "");
  expect_bad("", 0, "no images that are read: JPEG, PNG, PGM, PPM; 1 *.webp is to be converted first", fov(60));
  folder.write("b.WebP", "");
  folder.write("IMG_1.HEIC", "");
  expect_bad("", 0, "; 1 *.heic is to be converted first; 2 *.webp are to be converted first", fov(60));
  image("a.png");
  image("b.png", 1, 6, 8);
  folder.write("c.png", "GIF89a");
  const Sequence sequence = read_sequence(folder.path(), fov(60));
  EXPECT_NO_THROW(load_frame(sequence, 0));
  expect_input_error([&] { load_frame(sequence, 1); }, folder.path("b.png"), 0,
                     "the image is 6 x 8 px, the first one is 8 x 6");
  expect_input_error([&] { load_frame(sequence, 2); }, folder.path("c.png"), 0, "not a JPEG, PNG");
  std::filesystem::remove(folder.path("b.png"));
  expect_input_error([&] { load_frame(sequence, 1); }, folder.path("b.png"), 0, "No such file");
  folder.write("a.png", "");
  expect_bad("a.png", 0, "empty", fov(60));
}

TEST_F(LayoutTest, ListWithoutCalibration) {
  image("images/a.png");
  folder.write("rgb.txt", "0.5 images/a.png\n");
  expect_bad("camera.yaml", 0, "No such file: give --camera FILE, or --fov DEGREES");
  EXPECT_EQ(read_sequence(folder.path(), fov(60)).frames[0].timestamp, 0.5);
  SequenceOptions options = fov(60);
  options.fps = 30;
  expect_bad("rgb.txt", 0, "its frames have times: leave out --fps", options);
}

TEST_F(LayoutTest, DetectionsByTheNamesOfIcdar) {
  const std::string box = "1,1,5,1,5,3,1,3,";
  image("img_1.png");
  image("img_2.png");
  image("img_3.png");
  folder.write("gt_img_1.txt", "\xEF\xBB\xBF" + box + "EXIT\r\n" + box + "###\r\n");
  folder.write("res_img_2.txt", "1,1,5,1,5,3,1,3\r\n" + box + "###\n");
  folder.write("img_3.txt", "0 0.5 0.5 0.1 0.1\n");  // another program's labels
  Sequence sequence = read_sequence(folder.path(), fov(60));
  EXPECT_TRUE(sequence.has_detections);
  std::vector<Detection> found = read_detections(sequence, sequence.frames[0]);
  ASSERT_EQ(found.size(), 1u) << "### of the truth is to be ignored";
  EXPECT_EQ(found[0].text, "EXIT");
  EXPECT_EQ(read_detections(sequence, sequence.frames[1]).size(), 2u);
  EXPECT_TRUE(read_detections(sequence, sequence.frames[2]).empty());

  // A folder of them goes before what lies beside the images, and a chosen one before everything.
  folder.write("detections/gt_img_2.txt", box + "OPEN\n");
  folder.write("mine/img_2.txt", box + "MINE\n" + box + "###\n");
  folder.write("mine/img_3_dete.txt", "1,1,5,1,5,3,1,3\n");
  EXPECT_EQ(read_detections(sequence, sequence.frames[1]).at(0).text, "OPEN");
  SequenceOptions options = fov(60);
  options.detections = folder.path("mine");
  sequence = read_sequence(folder.path(), options);
  EXPECT_TRUE(read_detections(sequence, sequence.frames[0]).empty());
  EXPECT_EQ(read_detections(sequence, sequence.frames[1]).size(), 2u);
  EXPECT_EQ(read_detections(sequence, sequence.frames[2]).size(), 1u);
  folder.write("mine/img_2.txt", box + "A\n1,1,5,1\n");
  expect_input_error([&] { read_detections(sequence, sequence.frames[1]); }, folder.path("mine/img_2.txt"), 2,
                     "8 numbers");
  options.detections = folder.path("none");
  expect_input_error([&] { read_sequence(folder.path(), options); }, options.detections, 0, "no such folder");
}

// An image named gt_1.png, and files for it as for any other.
TEST_F(LayoutTest, NamesThatLookLikeIcdars) {
  image("gt_1.png");
  folder.write("detections/gt_1.txt", "1,1,5,1,5,3,1,3,###\n");
  const Sequence sequence = read_sequence(folder.path(), fov(60));
  EXPECT_EQ(read_detections(sequence, sequence.frames[0]).size(), 1u);
}

}  // namespace io_layouts_test
}  // namespace textslam
