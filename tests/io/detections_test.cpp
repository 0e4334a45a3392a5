#include "io/detections.hpp"

#include "io/io_support.hpp"
#include "io/text_file.hpp"

namespace textslam {
namespace io_detections_test {

class DetectionsTest : public testing::Test {
 protected:
  DetectionsTest() {
    sequence.folder = folder.path();
    sequence.camera.raw = RadialTangential<double>{{500, 510, 320, 240}};
    frame.stem = "12.5";
  }
  std::vector<Detection> read(const std::string& text) {
    folder.write("detections/12.5.txt", text);
    return read_detections(sequence, frame);
  }
  void expect_bad(const std::string& text, int line, const std::string& part) {
    expect_input_error([&] { read(text); }, folder.path("detections/12.5.txt"), line, part);
  }

  TemporaryFolder folder;
  Sequence sequence;
  FrameRef frame;
};

void expect_quad(const Quad<double>& quad, const std::array<double, 8>& v) {
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(quad.corner[i][0], v[2 * i]);
    EXPECT_EQ(quad.corner[i][1], v[2 * i + 1]);
  }
}

TEST_F(DetectionsTest, MissingFileMeansNoDetections) { EXPECT_TRUE(read_detections(sequence, frame).empty()); }

TEST_F(DetectionsTest, EmptyFileMeansNoDetections) {
  EXPECT_TRUE(read("").empty());
  EXPECT_TRUE(read("\n\r\n").empty());
}

TEST_F(DetectionsTest, Icdar) {
  const auto d = read(
      "\xEF\xBB\xBF"
      "1,2,30.5,2,30.5,-4e0,1,40,EXIT\r\n\n387.5, 171.7,501.2,171.7,501.2,247.0,387.5,247.0,###\n");
  ASSERT_EQ(d.size(), 2u);
  expect_quad(d[0].quad, {1, 2, 30.5, 2, 30.5, -4, 1, 40});
  EXPECT_EQ(d[0].text, "EXIT");
  EXPECT_EQ(d[0].score, 1.0);
  expect_quad(d[1].quad, {387.5, 171.7, 501.2, 171.7, 501.2, 247.0, 387.5, 247.0});
  EXPECT_EQ(d[1].text, "###");
}

TEST_F(DetectionsTest, TextIsKeptWhole) {
  EXPECT_EQ(read("0,0,1,0,1,1,0,1,Fish, chips, 12,50\n")[0].text, "Fish, chips, 12,50");
  EXPECT_EQ(read("0,0,1,0,1,1,0,1,#1 #\n")[0].text, "#1 #");
  EXPECT_EQ(read("0,0,1,0,1,1,0,1,caf\xC3\xA9 \xE5\x87\xBA\xE5\x8F\xA3\n")[0].text,
            "caf\xC3\xA9 \xE5\x87\xBA\xE5\x8F\xA3");
  EXPECT_EQ(read("0,0,1,0,1,1,0,1\n")[0].text, "###");
  EXPECT_EQ(read("0,0,1,0,1,1,0,1,\n")[0].text, "###");
  EXPECT_EQ(read("0,0,1,0,1,1,0,1,caf\xE9!\n")[0].text, "caf\xEF\xBF\xBD!") << "Latin-1 is not UTF-8";
}

TEST_F(DetectionsTest, BadLines) {
  expect_bad("0,0,1,0,1,1,0,1,A\n0,0,1,zero,1,1,0,1,B\n", 2, "y2 should be a finite number, not 'zero'");
  expect_bad("0,0,1,0,nan,1,0,1,A\n", 1, "x3 should be a finite number, not 'nan'");
  expect_bad("0,0,1,0,1,1,0,inf,A\n", 1, "y4 should be a finite number");
  expect_bad("0,0,1,0,1,1,0,EXIT\n", 1, "y4 should be a finite number, not 'EXIT'");
  expect_bad("0,0,1,,1,1,0,1,A\n", 1, "y2 should be a finite number, not ''");
  expect_bad("0,0,1,0\n", 1, "not 4");
  expect_bad("0 0 1 0 1 1 0 1 EXIT\n", 1, "x1 should be a finite number");
  expect_bad(std::string("0,0,1,0,1,1,0,1,A\n\0\1\2", 21), 2, "not a text file");
}

TEST_F(DetectionsTest, PublishedPair) {
  folder.write("text/12.5_dete.txt", "636.0,195.0,679.0,208.0,672.0,232.0,628.0,219.0\n1,2,3,4,5,6,7,8,\n");
  auto d = read_detections(sequence, frame);
  ASSERT_EQ(d.size(), 2u);
  EXPECT_EQ(d[0].text, "###") << "no file of words";
  folder.write("text/12.5_mean.txt", "arena,0.9879826307296753\nA, B,0.5\n");
  d = read_detections(sequence, frame);
  ASSERT_EQ(d.size(), 2u);
  expect_quad(d[0].quad, {636, 195, 679, 208, 672, 232, 628, 219});
  EXPECT_EQ(d[0].text, "arena");
  EXPECT_EQ(d[0].score, 0.9879826307296753);
  EXPECT_EQ(d[1].text, "A, B");
  EXPECT_EQ(d[1].score, 0.5);

  EXPECT_EQ(read("0,0,1,0,1,1,0,1,ICDAR first\n").size(), 1u);
}

TEST_F(DetectionsTest, PublishedPairIsMappedBackThroughTheLens) {
  sequence.camera.raw = RadialTangential<double>{{500, 510, 320, 240}, -0.2, 0.05, 1e-3, -2e-3, 0.01};
  folder.write("detections/12.5_dete.txt", "100,50,600,40,610,400,90,420\n");
  const auto d = read_detections(sequence, frame);
  ASSERT_EQ(d.size(), 1u);
  const double expected[8] = {100, 50, 600, 40, 610, 400, 90, 420};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2<double> raw = d[0].quad.corner[i];
    Vector3<double> m;
    ASSERT_EQ(sequence.camera.unproject(raw, &m), textplane::Status::ok);
    const Vector2<double> px = sequence.camera.pinhole().project(m);
    EXPECT_NEAR(px[0], expected[2 * i], 1e-8);
    EXPECT_NEAR(px[1], expected[2 * i + 1], 1e-8);
    EXPECT_GT((raw - px).norm(), 1.0);
  }
}

TEST_F(DetectionsTest, BadPair) {
  const std::string boxes = folder.write("text/12.5_dete.txt", "1,2,3,4,5,6,7,8\n1,2,3,4,5,6,7,8\n");
  const auto run = [&] { read_detections(sequence, frame); };
  const std::string words = folder.write("text/12.5_mean.txt", "one,0.5\n");
  expect_input_error(run, words, 0, "1 words for the 2 boxes");
  folder.write("text/12.5_mean.txt", "one,0.5\ntwo\n");
  expect_input_error(run, words, 2, "expected 'word,score'");
  folder.write("text/12.5_mean.txt", "one,0.5\ntwo,high\n");
  expect_input_error(run, words, 2, "the score should be a finite number, not 'high'");
  folder.write("text/12.5_dete.txt", "1,2,3,4,5,6,7,8\n1,2,3,4,5,6,7,8,9\n");
  expect_input_error(run, boxes, 2, "nothing after them");
}

TEST_F(DetectionsTest, RoundTripIsExact) {
  std::vector<Detection> written(2);
  written[0].quad.corner = {Vector2<double>(1.0 / 3, -0.0), Vector2<double>(1e-7, 640.125), Vector2<double>(5e5, 2),
                            Vector2<double>(-3.25, 4)};
  written[0].text = "a,b, c";
  written[1].quad.corner = {Vector2<double>(1, 2), Vector2<double>(3, 4), Vector2<double>(5, 6), Vector2<double>(7, 8)};
  written[1].text = "two\nlines";
  write_detections(folder.path("out.txt"), written);
  const auto read = read_icdar(folder.path("out.txt"));
  ASSERT_EQ(read.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(read[k].quad.corner[i], written[k].quad.corner[i]);
  EXPECT_EQ(read[0].text, "a,b, c");
  EXPECT_EQ(read[1].text, "two lines");
  EXPECT_EQ(format_detections({written[1]}), "1,2,3,4,5,6,7,8,two lines\n");
}

TEST(TextFile, Numbers) {
  const auto parses = [](const char* text, double expected) {
    double value = -99;
    return parse_number(text, &value) && value == expected;
  };
  EXPECT_TRUE(parses(" 1.5\t", 1.5));
  EXPECT_TRUE(parses("+2", 2));
  EXPECT_TRUE(parses("-.5e-3", -.5e-3));
  EXPECT_TRUE(parses("1764905949.522972656", 1764905949.522972656));
  double untouched = 7;
  for (const char* bad : {"", " ", "+", "+-1", "1,5", "1 2", "0x10", "1.5f", "nan", "-inf", "1e999", "--1", "e5"}) {
    EXPECT_FALSE(parse_number(bad, &untouched)) << bad;
  }
  EXPECT_EQ(untouched, 7);
}

TEST(TextFile, Utf8) {
  const std::string bad = "\xEF\xBF\xBD";
  EXPECT_EQ(well_formed_utf8("\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80"), "\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80");
  EXPECT_EQ(well_formed_utf8("a\x80z"), "a" + bad + "z");
  EXPECT_EQ(well_formed_utf8("\xC0\xAF"), bad + bad) << "overlong";
  EXPECT_EQ(well_formed_utf8("\xED\xA0\x80"), bad + bad + bad) << "surrogate";
  EXPECT_EQ(well_formed_utf8("\xF4\x90\x80\x80"), bad + bad + bad + bad) << "above U+10FFFF";
  EXPECT_EQ(well_formed_utf8("\xE2\x82"), bad + bad) << "cut off";
}

}  // namespace io_detections_test
}  // namespace textslam
