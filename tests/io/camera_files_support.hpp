// What the tests of camera files share: one camera's text read, and what is wrong with a text.
#ifndef TESTS_IO_CAMERA_FILES_SUPPORT_HPP
#define TESTS_IO_CAMERA_FILES_SUPPORT_HPP

#include <string>

#include "io/io_support.hpp"

namespace textslam {

/// Of 640 x 480 px.
inline const Pinhole<double> kFilesPinhole(400.5, 401.25, 319.75, 240.125);

class CameraFilesTest : public testing::Test {
 protected:
  CameraModel read(const std::string& text) const { return read_camera(folder.write("camera", text)); }
  /// The text is this camera's, number by number.
  void expect(const std::string& text, const textplane::AnyCamera<double>& camera) const {
    const CameraModel model = read(text);
    EXPECT_STREQ(model.raw.name(), camera.name()) << text;
    const auto expected = camera.parameters(), found = model.raw.parameters();
    ASSERT_EQ(found.size(), expected.size());
    for (int i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], expected[i]) << i << "\n" << text;
    EXPECT_EQ(model.width, 640);
    EXPECT_EQ(model.height, 480);
  }
  void expect_bad(const std::string& text, int line, const std::string& part) const {
    const std::string path = folder.write("camera", text);
    expect_input_error([&] { read_camera(path); }, path, line, part);
  }

  TemporaryFolder folder;
};

}  // namespace textslam

#endif  // TESTS_IO_CAMERA_FILES_SUPPORT_HPP
