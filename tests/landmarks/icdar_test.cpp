// Lines of ICDAR's files, and the detections of a raw image.
#include "textplane/landmarks/icdar.hpp"

#include <gtest/gtest.h>

#include <array>
#include <clocale>
#include <string>
#include <vector>

#include "textplane/core/cameras/radial_tangential.hpp"

namespace icdar_test {

using namespace textplane;

TextDetection parsed(std::string_view line, IcdarForm form = IcdarForm::word) {
  TextDetection out;
  EXPECT_EQ(parse_icdar_line(line, &out, form), Status::ok) << line;
  return out;
}

void expect_corners(const TextDetection& seen, const std::array<double, 8>& v) {
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(seen.quad.corner[i / 2][static_cast<int>(i % 2)], v[i]) << i;
}

TEST(IcdarLine, NumbersAndWord) {
  const TextDetection seen = parsed("1,2,30.5,2, 30.5 ,-4e0,+1,.1,EXIT");
  expect_corners(seen, {1, 2, 30.5, 2, 30.5, -4, 1, 0.1});
  EXPECT_EQ(seen.word, "EXIT");
  EXPECT_EQ(seen.score, 1);
  expect_corners(parsed("\xEF\xBB\xBF"
                        "7,2,3,4,5,6,7,8,A"),
                 {7, 2, 3, 4, 5, 6, 7, 8});
}

TEST(IcdarLine, TheWordIsAllThatFollows) {
  const std::string box = "0,0,1,0,1,1,0,1";
  EXPECT_EQ(parsed(box + ",Fish, chips, 12,50").word, "Fish, chips, 12,50");
  EXPECT_EQ(parsed(box + ", \"say \\\"hi\\\", Bob\"").word, " \"say \\\"hi\\\", Bob\"");
  EXPECT_EQ(parsed(box + ",caf\xC3\xA9").word, "caf\xC3\xA9");
  EXPECT_EQ(parsed(box + ",0.5").word, "0.5") << "a word unless the form says otherwise";
  for (const char* end : {"", ",", "\n", "\r\n", ",\r\n", ",###"}) EXPECT_EQ(parsed(box + end).word, kUnreadText);
  EXPECT_EQ(parsed(box + ",EXIT\r\n").word, "EXIT");
  EXPECT_EQ(parsed(box + ",EXIT\r").word, "EXIT");
}

TEST(IcdarLine, TheScoreComesBeforeTheWord) {
  const std::string box = "0,0,1,0,1,1,0,1";
  const TextDetection seen = parsed(box + ",0.75,A, B", IcdarForm::score_word);
  EXPECT_EQ(seen.score, 0.75);
  EXPECT_EQ(seen.word, "A, B");
  EXPECT_EQ(parsed(box + ",0.75", IcdarForm::score_word).word, kUnreadText);
}

TEST(IcdarLine, BadLinesSayWhere) {
  const auto expect_bad = [](std::string_view line, Status status, int field, std::string_view text,
                             IcdarForm form = IcdarForm::word) {
    TextDetection out({}, "before", 7);
    out.quad.corner[3] = {5, 6};
    IcdarFault fault{77, "other"};
    EXPECT_EQ(parse_icdar_line(line, &out, form, &fault), status) << line;
    EXPECT_EQ(fault.field, field) << line;
    EXPECT_EQ(fault.text, text) << line;
    EXPECT_EQ(out.word, "before");
    EXPECT_EQ(out.score, 7);
    EXPECT_EQ(out.quad.corner[3], Vector2<double>(5, 6));
    EXPECT_EQ(out.quad.corner[0], Vector2<double>(0, 0));
    EXPECT_EQ(parse_icdar_line(line, &out, form), status) << "without a place for the fault";
  };
  for (const char* blank : {"", "\n", "\r\n", " \t\r\n", "\xEF\xBB\xBF\n"}) expect_bad(blank, Status::too_few, 0, "");
  expect_bad("1,2,3", Status::too_few, 3, "");
  expect_bad("1,2,3,4,5,6,7\r\n", Status::too_few, 7, "");
  expect_bad("1,2,3,4,5,6,7,8", Status::too_few, 8, "", IcdarForm::score_word);
  expect_bad("1,2,3,zero,5,6,7,8,A", Status::invalid_argument, 3, "zero");
  expect_bad("1,2,3,4,5,6,7,EXIT", Status::invalid_argument, 7, "EXIT");
  expect_bad("1,2,3,4,5,6,7,8,high,A", Status::invalid_argument, 8, "high", IcdarForm::score_word);
  for (const char* field : {"", " ", "1 2", "1;2", "0x10", "1e999", "+-1", "--1", "1.5f"})
    expect_bad(std::string(field) + ",2,3,4,5,6,7,8", Status::invalid_argument, 0, field);
  for (const char* field : {"nan", "inf", "-inf", "infinity"})
    expect_bad(std::string("1,") + field + ",3,4,5,6,7,8", Status::non_finite, 1, field);
  expect_bad(std::string_view("1,2\0,3,4,5,6,7,8", 17), Status::invalid_argument, 1, std::string_view("2\0", 2));
}

// A decimal comma of the program's locale changes nothing.
TEST(IcdarLine, TheLocaleIsIgnored) {
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  const bool has_comma = std::setlocale(LC_NUMERIC, "de_DE.UTF-8") || std::setlocale(LC_NUMERIC, "de_DE.utf8");
  expect_corners(parsed("1.5,2.5,3,4,5,6,7,8"), {1.5, 2.5, 3, 4, 5, 6, 7, 8});
  std::setlocale(LC_NUMERIC, before.c_str());
  if (!has_comma) GTEST_SKIP() << "this machine has no such locale";
}

// The lens folds back 350 px from its centre: no ray reaches the far corner of B.
TEST(RawDetections, ThoseWithAPlaceAreKept) {
  const RadialTangential<double> lens{{458, 457, 367, 248}, -0.28, 0.02, 2e-4, 1.8e-5, 0};
  const Pinhole<double> pinhole(400, 410, 320, 240);
  std::vector<TextDetection> raw;
  for (const char* line : {"100,60,200,60,200,90,100,90,0.5,A", "100,60,200,60,200,1e5,100,90,0.6,B",
                           "300,200,400,200,400,240,300,240,0.7,C"})
    raw.push_back(parsed(line, IcdarForm::score_word));
  const std::vector<TextDetection> out = undistorted(raw, lens, pinhole);
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[0].word + out[1].word, "AC");
  EXPECT_EQ(out[1].score, 0.7);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((lens.project(pinhole.unproject(out[0].quad.corner[i])) - raw[0].quad.corner[i]).norm(), 1e-9);
    EXPECT_LT((lens.project(pinhole.unproject(out[1].quad.corner[i])) - raw[2].quad.corner[i]).norm(), 1e-9);
  }
}

}  // namespace icdar_test
