// Files of cameras in all formats: what is read, written and read again, and what is wrong with each, in one line.
#include "io/camera_model.hpp"

#include <cmath>

#include "io/camera_files_support.hpp"
#include "io/layouts_support.hpp"

namespace textslam {
namespace io_camera_files_test {

using textplane::DoubleSphere;
using textplane::ExtendedUnified;
using textplane::Fov;
using textplane::KannalaBrandt;
using textplane::Rational;

using CameraFiles = CameraFilesTest;

const Pinhole<double>& kPinhole = kFilesPinhole;
const char* const kSettings =
    "Camera.width: 640\nCamera.height: 480\nCamera.fps: 20\nCamera.fx: 400.5\nCamera.fy: 401.25\nCamera.cx: 319.75\n"
    "Camera.cy: 240.125\n";

TEST_F(CameraFiles, SettingsNameEachModel) {
  const std::string base = kSettings;
  const std::string radtan = "Camera.k1: 0.1\nCamera.k2: 0.2\nCamera.p1: 0.01\nCamera.p2: 0.02\n";
  expect(base, kPinhole);
  expect(base + "Camera.type: PinHole\n", kPinhole);
  expect(base + "Camera.type: Rectified\n", kPinhole);
  expect(base + radtan, RadialTangential<double>{kPinhole, 0.1, 0.2, 0.01, 0.02, 0});
  expect(base + radtan + "Camera.k3: 0.3\nCamera.type: 'PinHole'\n",
         RadialTangential<double>{kPinhole, 0.1, 0.2, 0.01, 0.02, 0.3});
  expect(base + radtan + "Camera.k3: 0.3\nCamera.k4: 0.4\nCamera.k5: 0.5\nCamera.k6: 0.6\nCamera.type: Rational\n",
         Rational<double>{kPinhole, 0.1, 0.2, 0.01, 0.02, 0.3, 0.4, 0.5, 0.6});
  expect(base + "Camera.type: DoubleSphere\nCamera.xi: -0.2\nCamera.alpha: 0.6\n",
         DoubleSphere<double>{kPinhole, -0.2, 0.6});
  expect(base + "Camera.type: EUCM\nCamera.alpha: 0.6\nCamera.beta: 1.1\n",
         ExtendedUnified<double>{kPinhole, 0.6, 1.1});
  expect(base + "Camera.type: FOV\nCamera.omega: 0.9\n", Fov<double>{kPinhole, 0.9});
  const std::string fisheye = "Camera.k1: 0.003\nCamera.k2: 0.001\nCamera.k3: -0.002\nCamera.k4: 0.0002\n";
  const KannalaBrandt<double> lens{kPinhole, 0.003, 0.001, -0.002, 0.0002};
  expect(base + fisheye + "Camera.type: \"KannalaBrandt8\"\n", lens);
  expect_bad(base + fisheye, 0, "the key Camera.p1 is missing");
  expect_bad(base + "Camera.type: FOV\nCamera.omega: 4\n", 9, "out of the range of the model fov");
  EXPECT_EQ(read(base).fps, 20);
  EXPECT_EQ(read(replaced(base, "Camera.fps: 20\n", "")).fps, 0);
}

TEST_F(CameraFiles, SettingsOfOrbSlam3) {
  const KannalaBrandt<double> lens{kPinhole, 0.003, 0.001, -0.002, 0.0002};
  expect(
      "%YAML:1.0\n\n# Camera Parameters\nFile.version: \"1.0\"\n\nCamera.type: \"KannalaBrandt8\"\n\nCamera1.fx: "
      "400.5\n"
      "Camera1.fy: 401.25\nCamera1.cx: 319.75\nCamera1.cy: 240.125\nCamera1.k1: 0.003\nCamera1.k2: 0.001\n"
      "Camera1.k3: -0.002\nCamera1.k4: 0.0002\nCamera2.fx: 9\nCamera.width: 640\nCamera.height: 480\nCamera.newWidth: "
      "320\nCamera.fps: 20\nIMU.T_b_c1: !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: f\n   data: [-0.99, 0.00,\n"
      "         0.1, 1.0]\n",
      lens);
}

const char* const kChain =
    "cam0:\n"
    "  T_cam_imu:\n"
    "  - [0.0, 1.0, 0.0, 0.25]\n"
    "  - [-1.0, 0.0, 0.0, 0.5]\n"
    "  - [0.0, 0.0, 1.0, -0.125]\n"
    "  - [0.0, 0.0, 0.0, 1.0]\n"
    "  cam_overlaps: [1]\n"
    "  camera_model: pinhole\n"
    "  distortion_coeffs: [0.003, 0.001, -0.002, 0.0002]\n"
    "  distortion_model: equidistant\n"
    "  intrinsics: [400.5, 401.25, 319.75, 240.125]\n"
    "  resolution: [640, 480]\n"
    "  rostopic: /cam0/image_raw\n"
    "cam1:\n"
    "  camera_model: other\n";

TEST_F(CameraFiles, SettingsOfARollingShutter) {
  const std::string text =
      "Camera.width: 640\nCamera.height: 480\nCamera.fx: 400.5\nCamera.fy: 401.25\nCamera.cx: 319.75\n"
      "Camera.cy: 240.125\n";
  EXPECT_FALSE(read(text).shutter.active());
  EXPECT_EQ(read(text).shutter.rows, 480);
  const CameraModel at_once = read(text + "Camera.readout: 0\n"), unsaid = read(text);
  EXPECT_TRUE(at_once.knows_readout);
  EXPECT_FALSE(unsaid.knows_readout);
  EXPECT_TRUE(read(format_camera(at_once)).knows_readout);
  EXPECT_FALSE(read(format_camera(unsaid)).knows_readout);
  const CameraModel middle = read(text + "Camera.readout: 0.025\n"),
                    first = read(text + "Camera.readout: -0.025\nCamera.readout_row: 0\n");
  EXPECT_EQ(middle.shutter.readout, 0.025);
  EXPECT_EQ(middle.shutter.row0, 239.5);
  EXPECT_EQ(first.shutter.readout, -0.025);
  EXPECT_EQ(first.shutter.row0, 0);
  for (const CameraModel& camera : {middle, first}) {
    const CameraModel again = read(format_camera(camera));
    EXPECT_EQ(again.shutter.readout, camera.shutter.readout);
    EXPECT_EQ(again.shutter.row0, camera.shutter.row0);
  }
  expect_bad(text + "Camera.readout: long\n", 7, "'long'");
  expect_bad(text + "Camera.readout: 0.02\nCamera.readout_row: nan\n", 8, "nan");
}

TEST_F(CameraFiles, Camchain) {
  const std::string chain = kChain, k = "[0.003, 0.001, -0.002, 0.0002]";
  expect(chain, KannalaBrandt<double>{kPinhole, 0.003, 0.001, -0.002, 0.0002});
  expect(replaced(chain, "equidistant", "radtan"), RadialTangential<double>{kPinhole, 0.003, 0.001, -0.002, 0.0002, 0});
  expect(replaced(replaced(chain, "equidistant", "none"), k, "[]"), kPinhole);
  expect(replaced(replaced(chain, "equidistant", "fov"), k, "[0.9]"), Fov<double>{kPinhole, 0.9});
  // The intrinsics of the others begin with the coefficients.
  const std::string none = replaced(replaced(chain, "equidistant", "none"), k, "[]");
  const auto with = [&](const std::string& model, const std::string& first) {
    return replaced(replaced(none, "pinhole", model), "[400.5", "[" + first + ", 400.5");
  };
  expect(with("ds", "-0.2, 0.6"), DoubleSphere<double>{kPinhole, -0.2, 0.6});
  expect(with("eucm", "0.6, 1.1"), ExtendedUnified<double>{kPinhole, 0.6, 1.1});

  const SE3d T_b_c = read_camera_file(folder.write("chain", chain)).T_b_c;
  EXPECT_LT((T_b_c * Vector3<double>(0.25, 0.5, -0.125)).norm(), 1e-15) << "the IMU, which the camera sees there";
  EXPECT_LT((T_b_c.R.col(0) - Vector3<double>(0, 1, 0)).norm(), 1e-15);
}

// By Mei's formula: x / (z + xi |p|).
TEST_F(CameraFiles, OmniIsExtendedUnified) {
  const CameraModel camera = read(
      replaced(replaced(replaced(replaced(kChain, "pinhole", "omni"), "[400.5", "[1.5, 400.5"), "equidistant", "none"),
               "[0.003, 0.001, -0.002, 0.0002]", "[]"));
  const Vector3<double> p(0.5, -0.25, -0.125);
  const double w = p[2] + 1.5 * p.norm();
  EXPECT_LT((camera.project(p) - kPinhole.pixel({p[0] / w, p[1] / w})).norm(), 1e-10);
  EXPECT_STREQ(camera.raw.name(), "extended_unified");
}

TEST_F(CameraFiles, CamchainThatIsWrong) {
  const std::string chain = kChain, k = "[0.003, 0.001, -0.002, 0.0002]";
  expect_bad(replaced(chain, "pinhole", "omni"), 10, "distortion_model should be none for the camera_model omni");
  expect_bad(replaced(chain, "pinhole", "mono"), 8, "camera_model should be pinhole or ds or eucm or omni, not 'mono'");
  expect_bad(replaced(chain, "equidistant", "thin"), 10, "or equidistant or fov, not 'thin'");
  expect_bad(replaced(chain, k, "[1, 2, 3]"), 9, "distortion_coeffs should be 4 numbers");
  expect_bad(replaced(chain, "[400.5", "[0.1, 400.5"), 11, "intrinsics should be 4 numbers");
  expect_bad(replaced(chain, "[0.0, 0.0, 0.0, 1.0]", "[0.0, 0.0, 1.0]"), 6, "a row of T_cam_imu should be 4 numbers");
  expect_bad(replaced(chain, "  - [0.0, 0.0, 0.0, 1.0]\n", ""), 3, "T_cam_imu should have 4 rows");
  expect_bad(replaced(chain, "  - [0.0, 1.0", "  - [0.0, 2.0"), 3, "T_cam_imu should be a rotation and a translation");
  const std::string none = replaced(replaced(chain, "equidistant", "none"), k, "[]");
  expect_bad(replaced(replaced(none, "pinhole", "ds"), "[400.5", "[0.2, 1.5, 400.5"), 11,
             "out of the range of the model");
  expect_bad(replaced(replaced(none, "pinhole", "ds"), "[400.5", "[0.2, 0.5, -400.5"), 11, "focal lengths");
  expect_bad(replaced(replaced(none, "pinhole", "omni"), "[400.5", "[-0.2, 400.5"), 11,
             "xi, the first of the intrinsics");
  expect_bad("cam0: 5\n", 1, "cam0 should have keys of its own");
  expect_bad("%YAML:1.0\n", 0, "expected 'key: value' lines");
  expect_bad("a: 1\n", 0, "no camera is described here");
}

TEST_F(CameraFiles, SensorThatIsWrong) {
  const std::string sensor = kSensor;
  expect_bad("intrinsics: [1, 2\nb: 3\n", 2, "this is no YAML");
  expect_bad("a: \"\\\x01\"\n", 1, "this is no YAML: 'unknown escape character: ?'");
  expect_bad("- intrinsics\n", 1, "expected 'key: value' lines");
  expect_bad(replaced(sensor, "resolution: [8, 6]\n", ""), 0, "the key resolution is missing");
  expect_bad(replaced(sensor, "[8, 6]", "[8, 6.5]"), 12, "whole numbers of at most 16384");
  expect_bad(replaced(sensor, "[8, 6]", "8"), 12, "resolution should be 2 numbers in brackets");
  expect_bad(replaced(sensor, "458.654", "-458.654"), 14, "the focal lengths of the intrinsics should be positive");
  expect_bad(replaced(sensor, "458.654", "nan"), 14, "intrinsics should be a finite number, not 'nan'");
  expect_bad(replaced(sensor, "458.654", "[1, 2]"), 14, "intrinsics should be a number");
  expect_bad(replaced(sensor, ", 248.375", ""), 14, "intrinsics should be 4 numbers");
  expect_bad(replaced(sensor, "pinhole", "mono"), 13,
             "camera_model should be pinhole or ds or eucm or omni, not 'mono'");
  expect_bad(replaced(sensor, "radial-tangential", "thin"), 15,
             "should be radial-tangential or none or equidistant or fov, not 'thin'");
  expect_bad(replaced(sensor, "-0.28340811, ", ""), 16, "distortion_coefficients should be 4 to 5 numbers");
  expect_bad(replaced(sensor, "rate_hz: 20", "rate_hz: 0"), 11, "rate_hz should be positive, not '0'");
  expect_bad(replaced(sensor, "0.0, 0.0, 1.0, 0.125", "0.0, 0.0, 2.0, 0.125"), 7, "a rotation and a translation");
  expect_bad(replaced(sensor, "0.0, 0.0, 1.0, 0.125", "0.0, 0.0, -1.0, 0.125"), 7, "a rotation and a translation");
  expect_bad(replaced(sensor, "data: [", "date: ["), 5, "T_BS should have rows, cols and data");
  const std::string none = replaced(replaced(sensor, "radial-tangential", "none"), "distortion_coefficients", "unused");
  EXPECT_TRUE(read(none).is_pinhole());
  // TUM-VI's.
  EXPECT_STREQ(read(replaced(sensor, "radial-tangential", "equidistant")).raw.name(), "kannala_brandt");
}

}  // namespace io_camera_files_test
}  // namespace textslam
