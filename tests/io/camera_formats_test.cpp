// Camera files of OpenCV and COLMAP, and cameras of each model written and read again in each format.
#include <cmath>

#include "io/camera_files_support.hpp"
#include "io/layouts_support.hpp"

namespace textslam {
namespace io_camera_formats_test {

using Any = textplane::AnyCamera<double>;
using textplane::DoubleSphere;
using textplane::ExtendedUnified;
using textplane::Fov;
using textplane::KannalaBrandt;
using textplane::Rational;

using CameraFormats = CameraFilesTest;

const Pinhole<double>& kPinhole = kFilesPinhole;

const char* const kOpencv =
    "%YAML:1.0\n"
    "---\n"
    "calibration_time: \"Mon 02 Nov 2026 10:21:35\"\n"
    "image_width: 640\n"
    "image_height: 480\n"
    "camera_matrix: !!opencv-matrix\n"
    "   rows: 3\n"
    "   cols: 3\n"
    "   dt: d\n"
    "   data: [ 4.005e+02, 0., 319.75, 0.,\n"
    "       401.25, 240.125, 0., 0., 1. ]\n"
    "distortion_coefficients: !!opencv-matrix\n"
    "   rows: 5\n"
    "   cols: 1\n"
    "   dt: d\n"
    "   data: [ 0.1, 0.2, 0.01, 0.02, 0.3 ]\n"
    "avg_reprojection_error: .Nan\n";

TEST_F(CameraFormats, Opencv) {
  const std::string file = kOpencv, k = "0.1, 0.2, 0.01, 0.02, 0.3";
  const RadialTangential<double> lens{kPinhole, 0.1, 0.2, 0.01, 0.02, 0.3};
  expect(file, lens);
  expect(replaced(file, ", 0.3", ""), RadialTangential<double>{kPinhole, 0.1, 0.2, 0.01, 0.02, 0});
  const std::string eight = replaced(file, k, k + ", 0.4, 0.5, 0.6");
  const Rational<double> rational{kPinhole, 0.1, 0.2, 0.01, 0.02, 0.3, 0.4, 0.5, 0.6};
  expect(eight, rational);
  expect(replaced(eight, "0.6", "0.6, 0, 0, 0, 0, 0, 0"), rational);
  expect(replaced(file, k, ""), kPinhole);
  const KannalaBrandt<double> fisheye{kPinhole, 0.1, 0.2, 0.01, 0.02};
  expect(replaced(file, ", 0.3", "") + "fisheye_model: 1\n", fisheye);
  expect(replaced(replaced(replaced(file, "camera_matrix", "Camera_Matrix"), "distortion_", "Distortion_"),
                  "_coefficients", "_Coefficients"),
         lens);
  // ROS's camera_info.
  expect(replaced(
             replaced(replaced(replaced(file, "%YAML:1.0\n---\n", ""), " !!opencv-matrix", ""), " !!opencv-matrix", ""),
             ", 0.3", "") +
             "distortion_model: equidistant\n",
         fisheye);
}

const char* const kXml =
    "<?xml version=\"1.0\"?>\n"
    "<opencv_storage>\n"
    "<!-- it's\na comment -->\n"
    "<calibration_time>\"Mon 'x' 2026\"</calibration_time>\n"
    "<image_width>640</image_width>\n"
    "<image_height>\n  480</image_height>\n"
    "<camera_matrix type_id=\"opencv-matrix\">\n"
    "  <rows>3</rows>\n"
    "  <cols>3</cols>\n"
    "  <dt>d</dt>\n"
    "  <data>\n"
    "    4.005e+02 0. 319.75 0.\n"
    "    401.25 240.125 0. 0. 1.</data></camera_matrix>\n"
    "<distortion_coefficients type_id=\"opencv-matrix\"><data>0.1 0.2 0.01 0.02 0.3</data></distortion_coefficients>\n"
    "<nothing/>\n"
    "<empty></empty>\n"
    "</opencv_storage>\n";

TEST_F(CameraFormats, OpencvXml) {
  const std::string xml = kXml;
  expect(xml, RadialTangential<double>{kPinhole, 0.1, 0.2, 0.01, 0.02, 0.3});
  expect(replaced(xml, "\n", "\r\n"), RadialTangential<double>{kPinhole, 0.1, 0.2, 0.01, 0.02, 0.3});
  expect_bad(replaced(xml, "401.25", "4x"), 15, "the data of camera_matrix should be a finite number, not '4x'");
  expect_bad(replaced(xml, "640<", "640.5<"), 6, "image_width should be a whole number");
  expect_bad(replaced(xml, "</opencv_storage>", ""), 18, "this is no XML: the element 'opencv_storage' has no end");
  expect_bad(replaced(xml, "</dt>", "</td>"), 12, "this is no XML: '</td>' closes nothing");
  expect_bad(replaced(xml, "a comment -->", ""), 3, "this is no XML: '-->' is missing");
  expect_bad(replaced(xml, "<dt>", "text <dt>"), 12, "this is no XML: text outside of an element");
  expect_bad(replaced(xml, "<dt>d", "<dt>d<a>"), 12, "text and the element 'a' beside each other");
  expect_bad("<a", 1, "this is no XML: a name is missing");
  expect_bad("<a><b></b></a>", 0, "no camera is described here");
}

TEST_F(CameraFormats, OpencvThatIsWrong) {
  const std::string file = kOpencv, k = "0.1, 0.2, 0.01, 0.02, 0.3";
  expect_bad(replaced(file, "image_width", "width"), 0, "the key image_width is missing");
  expect_bad(replaced(file, "240.125, 0.,", "240.125,"), 10, "the data of camera_matrix should be 9 numbers");
  expect_bad(replaced(file, "4.005e+02, 0.,", "4.005e+02, 0.5,"), 6, "should be [fx, 0, cx; 0, fy, cy; 0, 0, 1]");
  expect_bad(replaced(file, "4.005e+02", "-4.005e+02"), 6, "the focal lengths of camera_matrix should be positive");
  expect_bad(replaced(file, k, "0.1, 0.2, 0.3"), 12, "distortion_coefficients should be 4, 5 or 8 numbers");
  expect_bad(replaced(file, k, k + ", 0, 0, 0, 0.1"), 12, "distortion_coefficients should be 4, 5 or 8 numbers");
  expect_bad(file + "fisheye_model: 1\n", 16, "the data of distortion_coefficients should be 4 numbers");
  expect_bad(replaced(file, "0.02", ".Inf"), 16, "should be a finite number, not '.Inf'");
  expect_bad(replaced(file, "camera_matrix: !!opencv-matrix", "camera_matrix: 5\nx: !!opencv-matrix"), 6,
             "camera_matrix should have keys of its own");
}

TEST_F(CameraFormats, Colmap) {
  const std::string head = "# Camera list with one line of data per camera:\n# Number of cameras: 1\n1 ";
  const Pinhole<double> square(400.5, 400.5, 319.75, 240.125);
  expect(head + "SIMPLE_PINHOLE 640 480 400.5 320.25 240.625\n", square);
  expect(head + "PINHOLE 640 480 400.5 401.25 320.25 240.625\n", kPinhole);
  expect(head + "SIMPLE_RADIAL 640 480 400.5 320.25 240.625 0.1\n", RadialTangential<double>{square, 0.1, 0, 0, 0, 0});
  expect(head + "RADIAL 640 480 400.5 320.25 240.625 0.1 0.2\n", RadialTangential<double>{square, 0.1, 0.2, 0, 0, 0});
  expect(head + "OPENCV 640 480 400.5 401.25 320.25 240.625 0.1 0.2 0.01 0.02\n",
         RadialTangential<double>{kPinhole, 0.1, 0.2, 0.01, 0.02, 0});
  expect(head + "FULL_OPENCV 640 480 400.5 401.25 320.25 240.625 0.1 0.2 0.01 0.02 0.3 0.4 0.5 0.6\n",
         Rational<double>{kPinhole, 0.1, 0.2, 0.01, 0.02, 0.3, 0.4, 0.5, 0.6});
  expect(head + "OPENCV_FISHEYE 640 480 400.5 401.25 320.25 240.625 0.1 0.2 0.01 0.02\n",
         KannalaBrandt<double>{kPinhole, 0.1, 0.2, 0.01, 0.02});
  expect(head + "SIMPLE_RADIAL_FISHEYE 640 480 400.5 320.25 240.625 0.1\n",
         KannalaBrandt<double>{square, 0.1, 0, 0, 0});
  expect(head + "RADIAL_FISHEYE 640 480 400.5 320.25 240.625 0.1 0.2\n", KannalaBrandt<double>{square, 0.1, 0.2, 0, 0});
  expect(head + "FOV 640 480 400.5 401.25 320.25 240.625 0.9\n", Fov<double>{kPinhole, 0.9});

  const std::string pinhole = "1 PINHOLE 640 480 400.5 401.25 320.25 240.625\n";
  expect_bad(pinhole + "\n2 PINHOLE 640 480 1 1 2 3\n", 3, "a second camera, after that of line 1");
  expect_bad("1 PINHOLE 640\n", 1, "expected 'id MODEL width height parameters'");
  expect_bad(head + "THIN_PRISM_FISHEYE 640 480 1\n", 3, "FOV, not 'THIN_PRISM_FISHEYE'");
  expect_bad(replaced(pinhole, "640", "640.5"), 1, "the width should be a whole number of at most 16384, not '640.5'");
  expect_bad(replaced(pinhole, " 240.625", ""), 1, "PINHOLE has 4 parameters, not 3");
  expect_bad(replaced(pinhole, "401.25", "fy"), 1, "fy should be a finite number, not 'fy'");
  expect_bad(replaced(pinhole, "401.25", "-1"), 1, "the parameters are out of the range of PINHOLE");
}

// Each model in each format; what comes back has the same numbers, 0 where the format's model has more.
TEST_F(CameraFormats, SurviveTheRoundTrip) {
  const Pinhole<double> k(1000.0 / 3, 2000.0 / 7, 319.0 + 1.0 / 3, 240.0 + 2.0 / 7);
  const double s = 1.0 / 7;
  struct Case {
    Any camera;
    const char* sensor;
    const char* camchain;
    const char* opencv;
    const char* colmap;
  };
  const Case cases[] = {
      {k, "pinhole", "pinhole", "radial_tangential", "pinhole"},
      {RadialTangential<double>{k, s, -s, s / 9, -s / 9, 0}, "radial_tangential", "radial_tangential",
       "radial_tangential", "radial_tangential"},
      {RadialTangential<double>{k, s, -s, s / 9, -s / 9, s / 5}, "radial_tangential", nullptr, "radial_tangential",
       "rational"},
      {Rational<double>{k, s, -s, s / 9, -s / 9, s / 5, s / 2, s / 3, s / 4}, nullptr, nullptr, "rational", "rational"},
      {KannalaBrandt<double>{k, s, -s, s / 2, -s / 3}, "kannala_brandt", "kannala_brandt", "kannala_brandt",
       "kannala_brandt"},
      {DoubleSphere<double>{k, -s, 1 - s}, "double_sphere", "double_sphere", nullptr, nullptr},
      {ExtendedUnified<double>{k, 1 - s, 1 + s}, "extended_unified", "extended_unified", nullptr, nullptr},
      {Fov<double>{k, 1 - s}, "fov", "fov", nullptr, "fov"},
  };
  for (const Case& c : cases) {
    const std::pair<CameraFormat, const char*> expected[] = {{CameraFormat::settings, c.camera.name()},
                                                             {CameraFormat::sensor, c.sensor},
                                                             {CameraFormat::camchain, c.camchain},
                                                             {CameraFormat::opencv, c.opencv},
                                                             {CameraFormat::colmap, c.colmap}};
    for (const auto& [format, name] : expected) {
      CameraModel camera;
      camera.raw = c.camera;
      camera.width = 640;
      camera.height = 480;
      camera.fps = 100.0 / 3;
      const std::string text = format_camera(camera, format);
      ASSERT_EQ(text.empty(), name == nullptr) << c.camera.name() << " " << static_cast<int>(format);
      if (!name) continue;
      SCOPED_TRACE(text);
      const CameraModel again = read(text);
      EXPECT_STREQ(again.raw.name(), name);
      const auto written = c.camera.parameters(), found = again.raw.parameters();
      for (int i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], i < written.size() ? written[i] : 0) << i;
      EXPECT_EQ(again.width, 640);
      EXPECT_EQ(again.height, 480);
      EXPECT_EQ(again.fps, format == CameraFormat::settings || format == CameraFormat::sensor ? camera.fps : 0);
    }
  }
}

TEST_F(CameraFormats, SettingsOfAPinholeKeepTheirBytes) {
  CameraModel camera;
  camera.raw = RadialTangential<double>{kPinhole};
  camera.width = 640;
  camera.height = 480;
  camera.fps = 30;
  EXPECT_EQ(format_camera(camera),
            "Camera.width: 640\nCamera.height: 480\nCamera.fps: 30\nCamera.fx: 400.5\nCamera.fy: 401.25\n"
            "Camera.cx: 319.75\nCamera.cy: 240.125\nCamera.k1: 0\nCamera.k2: 0\nCamera.p1: 0\nCamera.p2: 0\n"
            "Camera.k3: 0\n");
}

using CameraOfAFolder = LayoutTest;

TEST_F(CameraOfAFolder, IsTheFirstOfTheKnownNames) {
  image("a.png");
  EXPECT_EQ(find_camera(folder.path()), "");
  EXPECT_EQ(find_camera(folder.path("none")), "");
  const auto fx = [&] { return read_sequence(folder.path()).camera.pinhole().fx; };
  folder.write("cameras.txt", "1 PINHOLE 8 6 1 1 4 3\n");
  EXPECT_EQ(fx(), 1);
  const std::string chain =
      "cam0:\n  camera_model: pinhole\n  intrinsics: [2, 2, 4, 3]\n  distortion_model: none\n"
      "  resolution: [8, 6]\n";
  folder.write("b-camchain.yaml", chain);
  EXPECT_EQ(fx(), 2);
  folder.write("a-camchain.yaml", chain);
  expect_bad("b-camchain.yaml", 0, "a second camera file beside a-camchain.yaml: give the right one by --camera");
  SequenceOptions options;
  options.camera = folder.path("cameras.txt");
  EXPECT_EQ(read_sequence(folder.path(), options).camera.pinhole().fx, 1);
  folder.write("camchain.yaml", replaced(chain, "[2, 2", "[3, 3"));
  EXPECT_EQ(fx(), 3);
  folder.write("sensor.yaml", kSensor);
  EXPECT_EQ(fx(), 458.654);
  folder.write("camera.yaml",
               "Camera.width: 8\nCamera.height: 6\nCamera.fps: 10\nCamera.fx: 5\nCamera.fy: 5\nCamera.cx: 4\n"
               "Camera.cy: 3\n");
  EXPECT_EQ(fx(), 5);
}

TEST_F(CameraOfAFolder, EurocFolderWithAChain) {
  make_euroc();
  folder.write("camchain.yaml",
               "cam0:\n  camera_model: pinhole\n  intrinsics: [2, 2, 4, 3]\n  distortion_model: none\n"
               "  resolution: [8, 6]\n");
  EXPECT_EQ(read_sequence(folder.path()).camera.pinhole().fx, 458.654);
  std::filesystem::remove(folder.path("mav0/cam0/sensor.yaml"));
  EXPECT_EQ(read_sequence(folder.path()).camera.pinhole().fx, 2);
}

}  // namespace io_camera_formats_test
}  // namespace textslam
