// A folder for sequences of any layout, and what is wrong with them.
#ifndef TESTS_IO_LAYOUTS_SUPPORT_HPP
#define TESTS_IO_LAYOUTS_SUPPORT_HPP

#include <string>

#include "io/image_file.hpp"
#include "io/io_support.hpp"
#include "io/sequence.hpp"

namespace textslam {

inline const char* const kSensor =
    "# General sensor definitions.\n"
    "sensor_type: camera\n"
    "comment: VI-Sensor cam0\n"
    "T_BS:\n"
    "  cols: 4\n"
    "  rows: 4\n"
    "  data: [0.0, -1.0, 0.0, 0.5,\n"
    "         1.0, 0.0, 0.0, -0.25,\n"
    "         0.0, 0.0, 1.0, 0.125,\n"
    "         0.0, 0.0, 0.0, 1.0]\n"
    "rate_hz: 20\n"
    "resolution: [8, 6]\n"
    "camera_model: pinhole\n"
    "intrinsics: [458.654, 457.296, 367.215, 248.375] #fu, fv, cu, cv\n"
    "distortion_model: radial-tangential\n"
    "distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]\n";

class LayoutTest : public testing::Test {
 protected:
  std::string image(const std::string& name, std::uint8_t value = 100, int width = 8, int height = 6) {
    return folder.write(name, encode_png(Image<std::uint8_t>(width, height, value).view()));
  }
  void make_euroc() {
    folder.write("mav0/cam0/sensor.yaml", kSensor);
    folder.write("mav0/cam0/data.csv",
                 "#timestamp [ns],filename\r\n1403636579763555584,1403636579763555584.png\r\n"
                 "1403636579813555456,1403636579813555456.png\r\n");
    image("mav0/cam0/data/1403636579763555584.png", 1);
    image("mav0/cam0/data/1403636579813555456.png", 2);
  }
  // An error in reading the folder, at this file and line.
  void expect_bad(const std::string& file, int line, const std::string& part, const SequenceOptions& options = {}) {
    expect_input_error([&] { read_sequence(folder.path(), options); }, file.empty() ? folder.path() : folder.path(file),
                       line, part);
  }
  static SequenceOptions fov(double degrees) {
    SequenceOptions options;
    options.fov = degrees;
    return options;
  }

  TemporaryFolder folder;
};

}  // namespace textslam

#endif  // TESTS_IO_LAYOUTS_SUPPORT_HPP
