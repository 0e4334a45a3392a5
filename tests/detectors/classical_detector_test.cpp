// The classical detector: its pieces on drawn images, and the whole on rendered rooms with exact truth.
#include "detectors/classical_detector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

#include "io/image_file.hpp"
#include "io/io_support.hpp"
#include "renderer/render_sequence.hpp"

namespace textslam {
namespace classical_detector_test {

using Point = Vector2<double>;

// Glyphs of 5 x 7 blocks: E, H, L, P, A, T. All strokes are one block wide, as in print.
const char* const kGlyphs[6][7] = {{"#####", "#....", "#....", "####.", "#....", "#....", "#####"},
                                   {"#...#", "#...#", "#...#", "#####", "#...#", "#...#", "#...#"},
                                   {"#....", "#....", "#....", "#....", "#....", "#....", "#####"},
                                   {"####.", "#...#", "#...#", "####.", "#....", "#....", "#...."},
                                   {".###.", "#...#", "#...#", "#####", "#...#", "#...#", "#...#"},
                                   {"#####", "..#..", "..#..", "..#..", "..#..", "..#..", "..#.."}};

struct Drawing {
  Image<std::uint8_t> image;
  Quad<double> text;  ///< the ink and the detector's margin around it
};

/// `letters` glyphs with their top left at `origin`, blocks of `block` px, on paper, sampled 4 x 4 a pixel.
Drawing draw_word(int letters, Point origin, double block, double angle, double ink, double paper, int width = 320,
                  int height = 240) {
  const Point along(std::cos(angle), std::sin(angle)), across(-along[1], along[0]);
  Drawing drawing{Image<std::uint8_t>(width, height), {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      int hits = 0;
      for (int k = 0; k < 16; ++k) {
        const Point p(x + (k % 4 - 1.5) / 4.0, y + (k / 4 - 1.5) / 4.0);
        const double u = (p - origin).dot(along) / block, v = (p - origin).dot(across) / block;
        if (u < 0 || v < 0 || v >= 7 || u >= 6.0 * letters) continue;
        const int letter = static_cast<int>(u / 6.0), column = static_cast<int>(u - 6.0 * letter);
        hits += column < 5 && kGlyphs[letter % 6][static_cast<int>(v)][column] == '#' ? 1 : 0;
      }
      drawing.image(x, y) = static_cast<std::uint8_t>(std::lround(paper + (ink - paper) * hits / 16.0));
    }
  const double w = (6.0 * letters - 1.0) * block, h = 7.0 * block;
  const double m = ClassicalParameters().margin * h;
  drawing.text.corner = {origin - m * along - m * across, origin + (w + m) * along - m * across,
                         origin + (w + m) * along + (h + m) * across, origin - m * along + (h + m) * across};
  return drawing;
}

std::vector<Detection> detect(const Image<std::uint8_t>& image) { return ClassicalDetector().detect({}, image.view()); }

void expect_word_found(const Drawing& drawing, const std::string& what) {
  const std::vector<Detection> found = detect(drawing.image);
  ASSERT_EQ(found.size(), 1u) << what;
  EXPECT_GE(textplane::iou(found[0].quad, drawing.text), 0.85) << what;
  // The first corner is the text's top left: this alone would not show in the overlap.
  const double height = (drawing.text.corner[3] - drawing.text.corner[0]).norm();
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_LT((found[0].quad.corner[k] - drawing.text.corner[k]).norm(), 0.2 * height) << what << ", corner " << k;
  EXPECT_GT(textplane::area(found[0].quad), 0) << what;
  EXPECT_EQ(found[0].text, kUnreadText);
  EXPECT_GT(found[0].score, 0);
  EXPECT_LE(found[0].score, 1);
}

TEST(ClassicalDetector, FindsAWordInBothPolarities) {
  expect_word_found(draw_word(6, {60, 100}, 3, 0, 30, 190), "dark on light");
  expect_word_found(draw_word(6, {60, 100}, 3, 0, 190, 30), "light on dark");
}

TEST(ClassicalDetector, FindsTurnedWords) {
  for (const int degrees : {-60, -50, -40, -25, -15, -5, 5, 15, 25, 40, 50, 60}) {
    const Point origin(degrees > 0 ? 90 : 70, degrees > 0 ? 50 : 170);
    expect_word_found(draw_word(6, origin, 3, degrees * 0.0174532925199433, 30, 190),
                      std::to_string(degrees) + " degrees");
  }
}

TEST(ClassicalDetector, FindsSmallAndLargeLetters) {
  for (const double block : {1.6, 2.0, 4.0, 7.0})
    expect_word_found(draw_word(6, {24, 60}, block, 0.03, 30, 190), std::to_string(block) + " px a block");
}

TEST(ClassicalDetector, DemandsThreeLetters) {
  EXPECT_TRUE(detect(draw_word(2, {60, 100}, 3, 0, 30, 190).image).empty());
  EXPECT_EQ(detect(draw_word(3, {60, 100}, 3, 0, 30, 190).image).size(), 1u);
}

TEST(ClassicalDetector, PassesOverBarsAndTiles) {
  Image<std::uint8_t> bars(320, 240, 190), tiles(320, 240, 190);
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) {
      if (y > 90 && y < 130 && x > 20 && x < 300 && x % 14 < 5) bars(x, y) = 40;
      if (y > 90 && y < 130 && x > 20 && x < 300 && x % 24 < 20 && (y % 26) < 20) tiles(x, y) = 40;
    }
  EXPECT_TRUE(detect(bars).empty());
  EXPECT_TRUE(detect(tiles).empty());
}

TEST(ClassicalDetector, HasNothingToSayAboutBlankTinyAndInvalidImages) {
  EXPECT_TRUE(detect(Image<std::uint8_t>(320, 240, 128)).empty());
  EXPECT_TRUE(detect(Image<std::uint8_t>(320, 240, 0)).empty());
  for (const int side : {1, 2, 3, 7, 16}) {
    EXPECT_TRUE(detect(Image<std::uint8_t>(side, side, 90)).empty());
    EXPECT_TRUE(detect(Image<std::uint8_t>(side, 1, 90)).empty());
    EXPECT_TRUE(detect(Image<std::uint8_t>(1, side, 90)).empty());
  }
  EXPECT_TRUE(ClassicalDetector().detect({}, {}).empty());
  const std::uint8_t pixel = 3;
  EXPECT_TRUE(ClassicalDetector().detect({}, ImageView8(&pixel, -4, 5)).empty());
}

TEST(ClassicalDetector, KeptMemoryLeavesNoTrace) {
  const Drawing word = draw_word(6, {60, 100}, 3, 0.1, 30, 190), other = draw_word(5, {9, 9}, 2, 0, 190, 30, 200, 90);
  const std::string fresh = format_detections(detect(word.image));
  ClassicalDetector used;
  used.detect({}, other.image.view());
  EXPECT_EQ(format_detections(used.detect({}, word.image.view())), fresh);
  EXPECT_EQ(format_detections(used.detect({}, word.image.view())), fresh);
  EXPECT_FALSE(fresh.empty());
}

TEST(ClassicalDetector, ReadsRowsOfAnyStride) {
  const Drawing word = draw_word(6, {60, 100}, 3, 0.1, 30, 190);
  const int stride = word.image.width() + 37;
  std::vector<std::uint8_t> padded(static_cast<std::size_t>(stride * word.image.height()), 255);
  for (int y = 0; y < word.image.height(); ++y)
    std::copy_n(word.image.row(y), word.image.width(), padded.begin() + y * stride);
  const ImageView8 view(padded.data(), word.image.width(), word.image.height(), stride);
  EXPECT_EQ(format_detections(ClassicalDetector().detect({}, view)), format_detections(detect(word.image)));
}

struct TrueSign {
  Quad<double> quad;
  double visible = 0;
};

std::vector<TrueSign> read_truth(const std::string& path) {
  std::vector<TrueSign> signs;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::vector<std::string> cells;
    std::istringstream cut(line);
    for (std::string cell; std::getline(cut, cell, ',');) cells.push_back(cell);
    if (cells.size() < 11) throw std::runtime_error("unexpected truth: " + line);
    TrueSign sign;
    for (std::size_t k = 0; k < 8; ++k)
      sign.quad.corner[k / 2][static_cast<int>(k % 2)] = std::strtod(cells[k].c_str(), nullptr);
    sign.visible = std::strtod(cells.back().c_str(), nullptr);
    signs.push_back(sign);
  }
  return signs;
}

TEST(ClassicalDetector, FindsTheSignsOfClearRooms) {
  // One frame each of several rooms: neighbouring frames of one room show the same signs and would count them again.
  // None of these seeds was looked at when the parameters were chosen.
  constexpr double kOverlap = 0.5, kSmallestHeight = 10.0;
  int signs = 0, found = 0, true_boxes = 0, false_boxes = 0;
  for (const std::uint64_t seed : {11u, 12u, 13u, 14u}) {
    const TemporaryFolder folder;
    RenderOptions options;
    options.output = folder.path("room");
    options.seed = seed;
    options.frames = 1;
    render_sequence(options);
    const std::vector<TrueSign> truth = read_truth(folder.path("room/truth/quads/000000.txt"));
    const std::vector<Detection> boxes = detect(load_grey(folder.path("room/images/000000.png")));

    for (const TrueSign& sign : truth) {
      const auto& c = sign.quad.corner;
      if (sign.visible < 0.99 || std::min((c[3] - c[0]).norm(), (c[2] - c[1]).norm()) < kSmallestHeight) continue;
      ++signs;
      found += std::any_of(boxes.begin(), boxes.end(),
                           [&](const Detection& b) { return textplane::iou(b.quad, sign.quad) >= kOverlap; });
    }
    for (const Detection& box : boxes) {
      bool hit = false, part_of_cut_sign = false;
      for (const TrueSign& sign : truth) {
        hit |= textplane::iou(box.quad, sign.quad) >= kOverlap;
        // Letters of a sign that is hidden in part or leaves the image are text, but no box for the whole sign.
        part_of_cut_sign |= sign.visible < 0.99 && textplane::area(textplane::intersection(box.quad, sign.quad)) >
                                                       kOverlap * textplane::area(box.quad);
      }
      true_boxes += hit;
      false_boxes += !hit && !part_of_cut_sign;
    }
  }
  RecordProperty("signs", signs);
  RecordProperty("found", found);
  RecordProperty("true_boxes", true_boxes);
  RecordProperty("false_boxes", false_boxes);
  ASSERT_GE(signs, 8);
  EXPECT_GE(found, 0.5 * signs);
  EXPECT_LE(false_boxes, 0.5 * true_boxes) << found << " of " << signs << " signs found";
}

}  // namespace classical_detector_test
}  // namespace textslam
