// What goes into networks and what their outputs mean, without a network: pieces, boxes of DB, inputs, CTC.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "detectors/boxes_support.hpp"
#include "detectors/db_boxes.hpp"
#include "detectors/line_recogniser.hpp"
#include "detectors/network_input.hpp"
#include "detectors/pieces.hpp"
#include "textplane/geometry/quad.hpp"

namespace textslam {
namespace {

Image<std::uint8_t> drawn(const std::vector<std::string>& rows) {
  Image<std::uint8_t> image(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()));
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const char c = rows[at(y)][at(x)];
      image(x, y) = static_cast<std::uint8_t>(c == '.' ? 0 : c - '0');
    }
  return image;
}

TEST(Pieces, TouchBySidesOrByCorners) {
  const Image<std::uint8_t> image = drawn({"11..1", "..1.1", ".2.1.", "22.11"});
  Pieces pieces;
  pieces.find(image.view(), Touch::sides);
  EXPECT_EQ(pieces.size(), 5);
  pieces.find(image.view(), Touch::corners);
  ASSERT_EQ(pieces.size(), 2);
  EXPECT_EQ(pieces[0].area, 8);
  EXPECT_EQ(pieces[0][0].value, 1);
  EXPECT_EQ(pieces[0].x0, 0);
  EXPECT_EQ(pieces[0].x1, 4);
  EXPECT_EQ(pieces[1].area, 3);
  EXPECT_EQ(pieces[1].y0, 2);
  EXPECT_EQ(pieces[1].y1, 3);
  EXPECT_EQ(pieces[1].x1, 1);
}

TEST(Pieces, TheOutlineIsTheConvexHull) {
  std::mt19937 random(3);
  std::vector<Vector2<double>> outline;
  for (int trial = 0; trial < 200; ++trial) {
    Image<std::uint8_t> image(9, 7);
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 9; ++x) image(x, y) = random() % 2;
    Pieces pieces;
    pieces.find(image.view(), Touch::corners);
    for (int p = 0; p < pieces.size(); ++p)
      for (const double half : {0.0, 0.5}) {
        const Piece piece = pieces[p];
        trace_outline(piece, half, outline);
        for (double turn = 0; turn < 2 * M_PI;
             turn += 0.1) {  // the hull reaches as far as the pixels, in any direction
          const Vector2<double> direction(std::cos(turn), std::sin(turn));
          double farthest = -1e9, hull = -1e9;
          for (int i = 0; i < piece.count; ++i)
            for (const double x : {piece[i].x0 - half, piece[i].x1 + half})
              for (const double y : {piece[i].y - half, piece[i].y + half})
                farthest = std::max(farthest, direction.dot(Vector2<double>(x, y)));
          for (const Vector2<double>& corner : outline) hull = std::max(hull, direction.dot(corner));
          ASSERT_NEAR(hull, farthest, 1e-12);
        }
      }
  }
}

/// A map as a network would give it for boxes.
class DrawnMap {
 public:
  DrawnMap(int rows, int columns) : rows_(rows), columns_(columns), values_(at(rows * columns), 0.02F) {}
  float& operator()(int x, int y) { return values_[at(y * columns_ + x)]; }
  void draw(const Quad<double>& box, float value) {
    for (int y = 0; y < rows_; ++y)
      for (int x = 0; x < columns_; ++x)
        if (textplane::contains(box, Vector2<double>(x, y))) (*this)(x, y) = value;
  }
  std::vector<Detection> decode() const { return decode_db({rows_, columns_, values_.data()}, DbParameters()); }

 private:
  int rows_, columns_;
  std::vector<float> values_;
};

Quad<double> grown(Vector2<double> centre, double wide, double high, double turn) {
  const double by = 2 * 1.5 * wide * high / (2 * (wide + high));
  return turned_box(centre, wide + by, high + by, turn);
}

TEST(DbBoxes, BoxesOfTheCoresGrow) {
  DrawnMap map(200, 300);
  map.draw(turned_box({100, 50}, 120, 16, 0.2), 0.9F);
  map.draw(turned_box({240, 120}, 14, 90, 0), 0.8F);  // tall: the text runs downwards
  map.draw(turned_box({80, 150}, 60, 12, 0), 0.4F);   // too doubtful as a whole
  map.draw(turned_box({150, 120}, 1, 1, 0), 1);       // too small
  const std::vector<Detection> found = map.decode();
  ASSERT_EQ(found.size(), 2u);
  expect_quad(found[0].quad, grown({100, 50}, 120, 16, 0.2), 2);
  EXPECT_NEAR(found[0].score, 0.9, 1e-3);
  const Quad<double> tall = grown({240, 120}, 14, 90, 0);
  expect_quad(found[1].quad, {{tall.corner[1], tall.corner[2], tall.corner[3], tall.corner[0]}}, 2);
}

TEST(DbBoxes, NoTurnGivesALesserRectangle) {
  for (int degrees = -40; degrees <= 40; degrees += 7) {
    const double turn = degrees * M_PI / 180;
    DrawnMap map(160, 200);
    map.draw(turned_box({100, 80}, 90, 21, turn), 0.9F);
    const std::vector<Detection> found = map.decode();
    ASSERT_EQ(found.size(), 1u) << degrees;
    expect_quad(found[0].quad, grown({100, 80}, 90, 21, turn), 2.5);
    const Vector2<double> along = found[0].quad.corner[1] - found[0].quad.corner[0];
    EXPECT_NEAR(std::atan2(along.y(), along.x()), turn, 0.03) << degrees;
  }
}

TEST(DbBoxes, WhatIsNoCoreIsPassedOver) {
  DrawnMap map(60, 80);
  EXPECT_TRUE(map.decode().empty());
  map.draw(turned_box({40, 30}, 50, 10, 0), std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(map.decode().empty());
  map.draw(turned_box({40, 30}, 50, 10, 0), std::numeric_limits<float>::infinity());
  EXPECT_TRUE(map.decode().empty());
  EXPECT_TRUE(decode_db({}, DbParameters()).empty());
}

TEST(NetworkInput, SizesAreInStepsAndQuadsComeBack) {
  const NetworkSize size = network_size(1280, 720, 640);
  EXPECT_EQ(size.width, 640);
  EXPECT_EQ(size.height, 352);  // of 360, in steps of 32
  EXPECT_EQ(network_size(20, 2000, 640).width, 32);
  Quad<double> quad = turned_box({319.5, 175.5}, 640, 352, 0);
  to_image(size, 1280, 720, &quad);
  expect_quad(quad, turned_box({639.5, 359.5}, 1280, 720, 0), 1e-9);
}

TEST(NetworkInput, ColoursAreInTheNetworksOrderAndRange) {
  std::vector<std::uint8_t> pixels;  // red, green, blue, alpha: a plane each
  const int width = 40, height = 20;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int value : {4 * x, 8 * y, 100, 7}) pixels.push_back(static_cast<std::uint8_t>(value));
  const NetworkSize size{80, 60};
  const std::size_t plane = 80 * 60;
  std::vector<float> out(3 * plane), swapped(3 * plane);
  network_input({pixels.data(), width, height, 4, true}, kDbColours, size, out.data());
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const std::size_t i = at(y * size.width + x);
      const double red = 4 * std::clamp((x + 0.5) / 2 - 0.5, 0.0, width - 1.0);
      const double green = 8 * std::clamp((y + 0.5) / 3 - 0.5, 0.0, height - 1.0);
      ASSERT_NEAR(out[i], (100 / 255.0 - 0.485) / 0.229, 1e-5) << "blue is first";
      ASSERT_NEAR(out[plane + i], (green / 255 - 0.456) / 0.224, 1e-4);
      ASSERT_NEAR(out[2 * plane + i], (red / 255 - 0.406) / 0.225, 1e-4);
    }
  network_input({pixels.data(), width, height, 4, false}, kEastColours, size, swapped.data());
  EXPECT_NEAR(swapped[0], 100 - 123.68, 1e-4) << "what was blue is red now";
}

TEST(LineRecogniser, ThePictureStandsInTheTopLeftCorner) {
  Image<std::uint8_t> picture(3, 2, 255);
  std::vector<float> out(at(3 * 5 * 4), 9.0F);
  recogniser_input(picture, 5, 4, out.data());
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 5; ++x) EXPECT_EQ(out[at((c * 4 + y) * 5 + x)], x < 3 && y < 2 ? 1.0F : 0.0F);
}

TEST(LineRecogniser, LongLinesAreSqueezedIntoTheInput) {
  const Image<std::uint8_t> image(1000, 60, 128);
  const RecogniserParameters parameters;
  const Image<std::uint8_t> picture = recogniser_picture(image.view(), turned_box({500, 30}, 900, 20, 0), parameters);
  EXPECT_LE(picture.width(), parameters.width);
  EXPECT_GT(picture.width(), parameters.width - 8);
  EXPECT_EQ(picture.height(), parameters.height);
}

TEST(LineRecogniser, TheBestPathOfCtc) {
  const std::vector<std::string> letters = {"a", "b"};  // classes: blank, a, b, space
  const auto with = [&](const std::vector<int>& classes, auto decode) {
    std::vector<float> probability(4 * classes.size(), 0.1F);
    for (std::size_t i = 0; i < classes.size(); ++i)
      probability[4 * i + at(classes[i])] = classes[i] == 2 ? 0.5F : 0.7F;
    return decode(probability.data(), static_cast<int>(classes.size()));
  };
  const auto said = [&](const std::vector<int>& classes) {
    return with(classes, [&](const float* p, int steps) { return decode_ctc(p, steps, 4, letters); });
  };
  EXPECT_EQ(said({0, 1, 1, 0, 1, 3, 2, 2}).text, "aa b") << "twice the same letter only with a blank between";
  EXPECT_NEAR(said({0, 1, 1, 0, 1, 3, 2, 2}).score, (3 * 0.7 + 0.5) / 4, 1e-6);
  EXPECT_EQ(said({0, 0}).text, "");
  EXPECT_EQ(said({0, 0}).score, 0);
  RecogniserParameters parameters;
  const auto read = [&](const std::vector<int>& classes) {
    return with(classes, [&](const float* p, int steps) { return read_word(p, steps, 4, letters, parameters); });
  };
  EXPECT_EQ(read({1, 0, 1, 2}).text, "aab");
  EXPECT_EQ(read({0, 1, 0}).text, kUnreadText) << "one letter is no word";
  parameters.min_confidence = 0.65;
  EXPECT_EQ(read({1, 0, 1, 2}).text, kUnreadText) << "it is not sure";
}

}  // namespace
}  // namespace textslam
