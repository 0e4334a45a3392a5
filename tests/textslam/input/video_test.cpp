// A video as a sequence, grey and in colour, and one with a broken picture, where this build reads videos.
#include "io/detections.hpp"
#include "io/layouts_support.hpp"
#include "plugins/plugins.hpp"

namespace textslam {
namespace video_test {

TEST_F(LayoutTest, Video) {
  // Uncompressed: 5 frames of 8 x 6 at 25 a second, each of one grey.
  std::string bytes = "YUV4MPEG2 W8 H6 F25:1 Ip A1:1 Cmono\n";
  for (int i = 0; i < 5; ++i) bytes += "FRAME\n" + std::string(48, static_cast<char>(40 + 10 * i));
  const std::string video = folder.write("a film.y4m", bytes);
  register_plugins();
  if (!has_video()) {
    expect_input_error([&] { read_sequence(video, fov(60)); }, video, 0, "configure with -DTEXTSLAM_VIDEO=ON");
    return;
  }
  expect_input_error([&] { read_sequence(video); }, video, 0, "there is no calibration: give --camera FILE, or --fov");
  folder.write("detections/000000.txt", "1,1,5,1,5,3,1,3,of another sequence\n");
  const Sequence sequence = read_sequence(video, fov(90));
  ASSERT_EQ(sequence.frames.size(), 5u);
  EXPECT_NEAR(sequence.camera.pinhole().fx, 4, 1e-12);
  EXPECT_EQ(frame_name(sequence, 3), "a film.y4m#000003");
  EXPECT_FALSE(sequence.has_detections);
  EXPECT_TRUE(read_detections(sequence, sequence.frames[0]).empty());
  for (const std::size_t i : std::vector<std::size_t>{0, 1, 4, 3, 0, 2, 2, 4, 1}) {
    EXPECT_EQ(load_frame(sequence, i)(7, 5), 40 + 10 * i);
    EXPECT_DOUBLE_EQ(sequence.frames[i].timestamp, static_cast<double>(i) / 25);
  }
  // In colour, four of YCbCr 4:4:4: by BT.601 (81, 90, 240) is red, (145, 54, 34) green, (41, 240, 110) blue.
  bytes = "YUV4MPEG2 W8 H6 F25:1 Ip A1:1 C444\n";
  const int colours[4][3] = {{81, 90, 240}, {145, 54, 34}, {41, 240, 110}, {81, 90, 240}};
  const int expected[4][3] = {{0, 0, 255}, {0, 255, 0}, {255, 0, 0}, {0, 0, 255}};  // blue first
  for (const auto& colour : colours) {
    bytes += "FRAME\n";
    for (const int plane : colour) bytes += std::string(48, static_cast<char>(plane));
  }
  const Sequence coloured = read_sequence(folder.write("colours.y4m", bytes), fov(90));
  for (const std::size_t i : std::vector<std::size_t>{0, 1, 1, 3, 2, 0}) {
    const Image<std::uint8_t> grey = load_frame(coloured, i), colour = load_colour(coloured, i);
    ASSERT_EQ(colour.width(), 24);
    ASSERT_EQ(colour.height(), 6);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(colour(channel, 0), expected[i][channel], 4) << i;
      EXPECT_NEAR(colour(21 + channel, 5), expected[i][channel], 4) << i;
    }
    EXPECT_EQ(grey(7, 5), load_frame(coloured, i)(0, 0));
  }
  for (const char* text : {"", "no film", "YUV4MPEG2 W8 H6 F25:1 Ip A1:1 Cmono\n"}) {
    const std::string bad = folder.write("bad.y4m", text);
    expect_input_error([&] { read_sequence(bad, fov(60)); }, bad, 0, "video");
  }
}

// One broken picture does not end a video: it is left out, and counted.
TEST_F(LayoutTest, VideoWithABrokenPicture) {
  register_plugins();
  if (!has_video()) GTEST_SKIP() << "this build reads no videos";
  std::string bytes;
  for (int i = 0; i < 6; ++i) {
    std::string picture = encode_jpeg(Image<std::uint8_t>(64, 48, static_cast<std::uint8_t>(40 + 20 * i)).view(), 95);
    if (i == 2) picture[picture.find("\xFF\xC0") + 9] = 0;  // its colours
    bytes += picture;
  }
  const Sequence sequence = read_sequence(folder.write("film.mjpeg", bytes), fov(60));
  ASSERT_EQ(sequence.frames.size(), 5u);
  ASSERT_EQ(sequence.notes.size(), 1u);
  EXPECT_NE(sequence.notes[0].find("1 frame is damaged and left out"), std::string::npos) << sequence.notes[0];
  const int values[] = {40, 60, 100, 120, 140};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(load_frame(sequence, i)(5, 5), values[i], 2) << i;
}

}  // namespace video_test
}  // namespace textslam
