// What the report is made of: numbers, escapes, pictures, parameters; and the line of progress.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "cli/progress.hpp"
#include "io/data_uri.hpp"
#include "io/image_codecs.hpp"
#include "textslam/report/frame_line.hpp"
#include "textslam/report/report_data.hpp"
#include "textslam/report/report_frames.hpp"
#include "textslam/report/report_template.hpp"
#include "textslam/report/summary.hpp"

namespace textslam {
namespace report_test {

TEST(Report, NumbersAreShortAndFinite) {
  EXPECT_EQ(short_number(1.0 / 3).dump(), "0.333333");
  EXPECT_EQ(short_number(-1234567.8).dump(), "-1234570");
  EXPECT_EQ(short_number(2).dump(), "2");
  EXPECT_EQ(short_number(1e300).dump(), "1e+300");
  EXPECT_TRUE(short_number(std::nan("")).is_null());
  EXPECT_TRUE(short_number(-std::numeric_limits<double>::infinity()).is_null());
  std::vector<Vector2<double>> polygon(5, {1.26, 2});
  EXPECT_EQ(short_polygon(polygon).dump(), "[1.3,2,1.3,2,1.3,2,1.3,2,1.3,2]");
  polygon[2].x() = std::nan("");
  EXPECT_TRUE(short_polygon(polygon).is_null());
}

TEST(Report, NoWordEndsTheScript) {
  const std::string words[] = {"</script><img src=x onerror=alert(1)>", "<!--<script>", "]]>", "\"'\\\n",
                               "\xe2\x80\xa8"};
  for (const std::string& word : words) {
    const std::string text = script_text({{"word", word}});
    EXPECT_EQ(text.find('<'), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_EQ(Json::parse(text).at("word"), word);
  }
  EXPECT_EQ(Json::parse(script_text({{"word", "a\xff"}})).at("word"), "a\xef\xbf\xbd");
}

TEST(Report, Base64) {
  const std::string head = "data:image/jpeg;base64,";
  EXPECT_EQ(jpeg_uri(""), head);
  EXPECT_EQ(jpeg_uri("f"), head + "Zg==");
  EXPECT_EQ(jpeg_uri("fo"), head + "Zm8=");
  EXPECT_EQ(jpeg_uri("foo"), head + "Zm9v");
  EXPECT_EQ(jpeg_uri(std::string("\x00\xff\xfe\x80", 4)), head + "AP/+gA==");
}

TEST(Report, PicturesStaySmall) {
  std::mt19937 random(1);
  for (const auto& [width, height] :
       {std::pair(640, 480), std::pair(480, 640), std::pair(2000, 30), std::pair(20, 10)}) {
    Image<std::uint8_t> noise(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) noise.view()(x, y) = random() % 2 == 0 ? 0 : 255;
    const std::string jpeg = frame_jpeg(Pyramid(noise.view(), 4));
    EXPECT_LE(jpeg.size(), kFrameBytes) << width << " x " << height;
    const Image<std::uint8_t> picture = decode_jpeg(jpeg, "picture");
    EXPECT_EQ(std::max(picture.width(), picture.height()), std::min(kFrameSide, std::max(width, height)));
    EXPECT_NEAR(1.0 * picture.width() / picture.height(), 1.0 * width / height, 0.1 * width / height);
  }
  // 300 frames, with 10 kB of marks each, the textures, and 30 bytes a map point.
  EXPECT_LE(kReportFrames * (4 * kFrameBytes / 3 + (10 << 10)) + 4 * kTextureBytes / 3 + 30 * kReportPoints, 15000000u);
}

// A picture of a frame is the frame: dark left half, bright right half.
TEST(Report, PictureShowsTheFrame) {
  Image<std::uint8_t> halves(640, 480, 40);
  for (int y = 0; y < 480; ++y)
    for (int x = 320; x < 640; ++x) halves.view()(x, y) = 200;
  const Image<std::uint8_t> picture = decode_jpeg(frame_jpeg(Pyramid(halves.view(), 4)), "picture");
  ASSERT_EQ(picture.width(), 320);
  ASSERT_EQ(picture.height(), 240);
  for (const int y : {0, 100, 239}) {
    EXPECT_NEAR(picture.view()(140, y), 40, 4);
    EXPECT_NEAR(picture.view()(180, y), 200, 4);
  }
}

TEST(Report, EveryParameterIsThere) {
  Parameters parameters;
  parameters.mode = Mode::loose;
  parameters.real_time = true;
  parameters.text.min_zncc = 0.123;
  const Json list = parameters_json(parameters);
  const auto value_of = [&](const std::string& name) {
    for (const Json& row : list)
      if (row.at(1) == name) return row.at(2);
    ADD_FAILURE() << name;
    return Json();
  };
  EXPECT_EQ(value_of("mode"), "loose");
  EXPECT_EQ(value_of("real_time"), true);
  EXPECT_EQ(value_of("text_min_zncc"), 0.123);
  EXPECT_EQ(value_of("min_track_zncc"), 0.8);
  EXPECT_EQ(value_of("max_tracks"), parameters.max_tracks);
  // A field takes 8 bytes at most, so a list that is much too short does not cover the struct.
  EXPECT_GE(8 * list.size(), sizeof(Parameters));
}

// File, page and table say of a readout whether it was given or estimated; of rows read at once none of them does.
TEST(Report, SaysWhereAReadoutCameFrom) {
  RunSummary summary;
  EXPECT_FALSE(describe(summary).page.contains("readout_s"));
  for (const bool estimated : {false, true}) {
    summary.readout = 0.0298;
    summary.readout_estimated = estimated;
    const Fields fields = describe(summary);
    for (const Json& said : {fields.file, fields.page}) {
      EXPECT_EQ(said.at("readout_s"), 0.0298);
      EXPECT_EQ(said.at("readout_estimated"), estimated);
    }
    EXPECT_EQ(fields.table.find("29.8 ms, estimated") != std::string::npos, estimated) << fields.table;
    EXPECT_NE(fields.table.find("29.8 ms"), std::string::npos) << fields.table;
  }
}

TEST(Report, TemplateIsOnePage) {
  const std::string page(report_template());
  EXPECT_EQ(page.compare(0, 15, "<!DOCTYPE html>"), 0);
  for (const char* mark : {"@RUN@", "@DATA@"}) {
    EXPECT_NE(page.find(mark), std::string::npos);
    EXPECT_EQ(page.find(mark), page.rfind(mark)) << mark;
  }
  EXPECT_LT(page.find("@RUN@"), page.find("@DATA@"));
  for (const char* outside : {"<script src", "<link rel=\"stylesheet\"", "https:", "url("})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
}

TEST(FrameLine, IsAnObject) {
  Map map;
  FrameRecord record;
  record.timestamp = 1.5;
  const Json waiting = Json::parse(frame_line(0, record, map, {}));
  EXPECT_EQ(waiting.at("state"), "waiting");
  EXPECT_TRUE(waiting.at("pose").is_null());
  map.keyframes.resize(1);
  map.keyframes[0].frame.index = 3;
  record.state = FrameState::tracked;
  record.live = true;
  record.keyframe = 0;
  record.T_w_c_live.t = {1, 2, 3};
  const Json tracked = Json::parse(frame_line(4, record, map, {}));
  EXPECT_EQ(tracked.at("frame"), 4);
  EXPECT_EQ(tracked.at("timestamp"), 1.5);
  EXPECT_EQ(tracked.at("pose"), Json::array({1, 2, 3, 0, 0, 0, 1}));
  EXPECT_EQ(tracked.at("keyframe"), false);
  EXPECT_FALSE(tracked.contains("map"));
  map.points.push_back({{1, 0, 4}});
  map.keyframes[0].points = {0};
  Similarity doubled;
  doubled.scale = 2;
  const Json keyframe = Json::parse(frame_line(3, record, map, doubled));
  EXPECT_EQ(keyframe.at("keyframe"), true);
  EXPECT_EQ(keyframe.at("map").at("points"), Json::array({Json::array({0, 2, 0, 8})}));
  EXPECT_EQ(keyframe.at("map").at("texts"), Json::array());
  EXPECT_EQ(keyframe.at("map").at("number"), map.number);
  EXPECT_EQ(tracked.at("map_keyframes"), 1);
  map.keyframes.emplace_back().culled = true;
  EXPECT_EQ(Json::parse(frame_line(4, record, map, {})).at("map_keyframes"), 1);
}

TEST(Progress, OneIsNoPlural) {
  EXPECT_EQ(counted(0, "text"), "0 texts");
  EXPECT_EQ(counted(1, "text"), "1 text");
  EXPECT_EQ(counted(3, "point"), "3 points");
}

TEST(Progress, SaysHowLongItWillTake) {
  EXPECT_EQ(progress_line("tracking", 120, 240, 2000, "lost"), "tracking 120/240, 60 frames/s, 0:02 left  lost");
  EXPECT_EQ(progress_line("tracking", 1, 241, 500, "x"), "tracking 1/241, 2.0 frames/s, 2:00 left  x");
  EXPECT_EQ(progress_line("tracking", 3, 3, 3000, ""), "tracking 3/3, 1.0 frames/s, 0:00 left  ");
}

}  // namespace report_test
}  // namespace textslam
