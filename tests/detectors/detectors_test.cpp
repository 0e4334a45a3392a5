// Detectors beside the classical one: EAST's boxes from drawn maps, and, where they were built, the plug-ins.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "detectors/boxes_support.hpp"
#include "detectors/east_boxes.hpp"
#include "detectors/line_picture.hpp"
#include "io/io_support.hpp"
#include "plugins/plugins.hpp"
#include "textslam/detect/text_detector.hpp"

#ifdef TEXTSLAM_WITH_DNN
#include "detectors/dnn_detector.hpp"
#include "detectors/dnn_reader.hpp"
#endif
#ifdef TEXTSLAM_WITH_TESSERACT
#include "detectors/tesseract_detector.hpp"
#endif

namespace textslam {
namespace {

using Point = Vector2<double>;

/// EAST's maps as a network would give them for boxes: of every cell inside one, its distances to the sides.
class DrawnMaps {
 public:
  DrawnMaps(int rows, int columns)
      : rows_(rows), columns_(columns), score_(size(), 0.01F), geometry_(5 * size(), 0.0F) {}

  void draw(const Quad<double>& box, float score) {
    const Point along = (box.corner[1] - box.corner[0]).normalized(),
                down = (box.corner[3] - box.corner[0]).normalized();
    for (std::size_t i = 0; i < size(); ++i) {
      const Point p(4.0 * static_cast<double>(static_cast<int>(i) % columns_),
                    4.0 * static_cast<double>(static_cast<int>(i) / columns_));
      if (!textplane::contains(box, p)) continue;
      const double sides[5] = {(p - box.corner[0]).dot(down), (box.corner[1] - p).dot(along),
                               (box.corner[2] - p).dot(down), (p - box.corner[0]).dot(along),
                               -std::atan2(along.y(), along.x())};
      score_[i] = score;
      for (std::size_t k = 0; k < 5; ++k) geometry_[k * size() + i] = static_cast<float>(sides[k]);
    }
  }
  std::size_t size() const { return static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_); }
  float& score(int row, int column) { return score_[static_cast<std::size_t>(row * columns_ + column)]; }
  float& geometry(int map, int row, int column) {
    return geometry_[static_cast<std::size_t>(map) * size() + static_cast<std::size_t>(row * columns_ + column)];
  }
  std::vector<Detection> decode() const {
    return decode_east({rows_, columns_, score_.data(), geometry_.data()}, EastParameters());
  }

 private:
  int rows_, columns_;
  std::vector<float> score_, geometry_;
};

TEST(EastBoxes, BoxesComeBackAtAnyAngle) {
  for (const int degrees : {-60, -30, -5, 0, 10, 45}) {
    const Quad<double> box = turned_box({161, 118}, 120, 30, degrees * M_PI / 180);
    DrawnMaps maps(60, 80);
    maps.draw(box, 0.9F);
    const std::vector<Detection> found = maps.decode();
    ASSERT_EQ(found.size(), 1u) << degrees;
    expect_quad(found[0].quad, box, 1e-3);
    EXPECT_NEAR(found[0].score, 0.9, 1e-6);
    EXPECT_EQ(found[0].text, kUnreadText);
  }
}

TEST(EastBoxes, OfBoxesThatOverlapTheBetterStays) {
  DrawnMaps maps(60, 80);
  maps.draw(turned_box({80, 60}, 100, 24, 0.1), 0.7F);
  maps.draw(turned_box({240, 180}, 100, 24, -0.2), 0.95F);
  maps.draw(turned_box({240, 60}, 60, 20, 0), 0.45F);  // too doubtful
  // One cell of the first box has another opinion of its width and is sure of it.
  maps.score(15, 20) = 0.8F;
  maps.geometry(1, 15, 20) += 10;
  const std::vector<Detection> found = maps.decode();
  ASSERT_EQ(found.size(), 2u);
  expect_quad(found[0].quad, turned_box({240, 180}, 100, 24, -0.2), 1e-3);
  EXPECT_NEAR(found[1].score, 0.8, 1e-6);
  EXPECT_NEAR((found[1].quad.corner[1] - found[1].quad.corner[0]).norm(), 110, 1e-3);
}

TEST(EastBoxes, WhatIsNoBoxIsPassedOver) {
  DrawnMaps maps(60, 80);
  EXPECT_TRUE(maps.decode().empty());
  maps.score(3, 3) = std::numeric_limits<float>::quiet_NaN();
  maps.score(3, 9) = 1;  // all its distances are 0
  maps.score(9, 9) = 1;
  for (int k = 0; k < 4; ++k) maps.geometry(k, 9, 9) = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(maps.decode().empty());
  EXPECT_TRUE(decode_east({}, EastParameters()).empty());
}

TEST(Detectors, ANameThatNobodyKnowsIsRefused) {
  register_plugins();
  DetectorOptions options;
  options.name = "mystery";
  try {
    make_detector(options, Sequence());
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()), "unknown detector 'mystery'; known: files, classical, dnn, tesseract");
  }
}

#ifndef TEXTSLAM_WITH_DNN
TEST(Detectors, APlugInThatWasNotBuiltTellsHowToBuildIt) {
  register_plugins();
  DetectorOptions options;
  options.name = "dnn";
  expect_input_error([&] { make_detector(options, Sequence()); }, "--detector dnn", 0, "-DTEXTSLAM_DNN=ON");
}
#else
TEST(DnnDetector, MissingAndWrongModelsAreNamed) {
  expect_input_error([] { DnnDetector("/nowhere/model.onnx"); }, "/nowhere/model.onnx", 0, "scripts/get-detector");
  const TemporaryFolder folder;
  for (const char* name : {"model.onnx", "model.pb", "model"}) {
    const std::string path = folder.write(name, "no network\n");
    expect_input_error([&] { DnnDetector{path}; }, path, 0, "not a text detector");
  }
}

TEST(DnnReader, MissingAndWrongModelsAreNamed) {
  expect_input_error([] { DnnReader("/nowhere/model.onnx"); }, "/nowhere/model.onnx", 0, "get-detector --reader");
  const TemporaryFolder folder;
  const std::string path = folder.write("model.onnx", "no network\n");
  expect_input_error([&] { DnnReader{path}; }, folder.path("model.txt"), 0, "");
  folder.write("model.txt", "a\nb\n");
  expect_input_error([&] { DnnReader{path}; }, path, 0, "not a text recogniser");
}
#endif

TEST(Readers, AWordHasTwoLettersAndNoMarksAroundIt) {
  EXPECT_EQ(word_of("\xE2\x80\x94\"Exit 2!\""), "Exit 2");
  EXPECT_EQ(word_of("(A)"), "");
  EXPECT_EQ(word_of("\xC3\xA9\xC3\xA9"), "\xC3\xA9\xC3\xA9");
  EXPECT_EQ(word_of("\xC3\xA9"), "") << "one letter of two bytes";
}

TEST(Readers, ALineIsCutOutSquarely) {
  Image<std::uint8_t> image(200, 100);
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 200; ++x) image(x, y) = static_cast<std::uint8_t>(x);
  const Quad<double> quad = turned_box({100, 50}, 80, 20, 0);
  const Image<std::uint8_t> picture = line_picture(image.view(), quad, 40, 0.25, 40);
  ASSERT_EQ(picture.width(), 180);
  ASSERT_EQ(picture.height(), 60);
  for (int x = 0; x < 180; ++x) EXPECT_NEAR(picture(x, 30), 60 - 5 + (x + 0.5) / 2, 0.6) << x;
  EXPECT_EQ(line_picture(image.view(), quad, 40, 0.25, 2).width(), 100) << "squeezed";
  EXPECT_EQ(line_picture(image.view(), turned_box({100, 50}, 80, 2, 0), 40, 0.25, 40).width(), 0);
}

#ifndef TEXTSLAM_WITH_TESSERACT
TEST(Detectors, AReaderThatWasNotBuiltTellsHowToBuildIt) {
  register_plugins();
  DetectorOptions options;
  options.name = "tesseract";
  expect_input_error([&] { make_detector(options, Sequence()); }, "--detector tesseract", 0, "-DTEXTSLAM_TESSERACT=ON");
  options.name = "classical";
  options.words = "tesseract";
  expect_input_error([&] { make_detector(options, Sequence()); }, "--words tesseract", 0, "-DTEXTSLAM_TESSERACT=ON");
}
#else
TEST(TesseractDetector, ALanguageWithoutDataIsNamed) {
  TesseractParameters parameters;
  parameters.language = "xyz";
  expect_input_error([&] { Tesseract{parameters}; }, "tesseract", 0, "tesseract-ocr-xyz");
}

TEST(TesseractDetector, HasNothingToSayAboutBlankAndInvalidImages) {
  Tesseract tesseract;
  EXPECT_TRUE(tesseract.detect({}, Image<std::uint8_t>(160, 120, 90).view()).empty());
  EXPECT_TRUE(tesseract.detect({}, {}).empty());
  const Quad<double> quad = turned_box({80, 60}, 100, 20, 0);
  EXPECT_EQ(tesseract.read(Image<std::uint8_t>(160, 120, 90).view(), quad).text, kUnreadText);
  EXPECT_EQ(tesseract.read({}, quad).text, kUnreadText);
  EXPECT_EQ(tesseract.read(Image<std::uint8_t>(160, 120, 90).view(), Quad<double>()).text, kUnreadText);
}
#endif

}  // namespace
}  // namespace textslam
