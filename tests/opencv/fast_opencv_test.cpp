// detect_fast() gives exactly cv::FAST TYPE_9_16: positions, order and responses.
#include "textplane/features/fast.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "features/synthetic.hpp"

namespace {

using namespace textplane;
using namespace textplane_test;

// The first difference in words, or nothing. The number of corners is added to *total.
std::string difference(const cv::Mat& image, int threshold, bool suppress, std::size_t* total) {
  std::vector<cv::KeyPoint> expected;
  cv::FAST(image, expected, threshold, suppress, cv::FastFeatureDetector::TYPE_9_16);
  std::vector<Corner> found;
  const ImageView8 view(image.data, image.cols, image.rows, static_cast<std::ptrdiff_t>(image.step));
  if (!is_ok(detect_fast(view, threshold, suppress, found))) return "detect_fast failed";
  *total += expected.size();
  const std::string where = " (threshold " + std::to_string(threshold) + (suppress ? ", suppressed)" : ")");
  if (found.size() != expected.size())
    return std::to_string(found.size()) + " corners, not " + std::to_string(expected.size()) + where;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i].x != expected[i].pt.x || found[i].y != expected[i].pt.y || found[i].score != expected[i].response)
      return "corner " + std::to_string(i) + " differs" + where;
  return "";
}

// Thresholds within [0, 255] only: beyond, OpenCV 4.6 finds corners even at 300, where we clamp.
TEST(FastAgainstOpenCv, RandomImages) {
  Random random(7);
  std::size_t total = 0;
  for (int k = 0; k < 60; ++k) {
    const int width = random.integer(7, 90), height = random.integer(7, 90), levels = random.integer(2, 256);
    cv::Mat image(height, width, CV_8U);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random.integer(0, levels - 1) * 255 / (levels - 1));
    for (const int threshold : {0, 1, 10, 40, 120, 254, 255})
      for (const bool suppress : {false, true}) ASSERT_EQ(difference(image, threshold, suppress, &total), "") << k;
  }
  EXPECT_GT(total, 10000U);
}

TEST(FastAgainstOpenCv, RenderedImagesWithStride) {
  std::size_t total = 0;
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const Image<std::uint8_t> rendered =
        TexturedPlane(seed).render(Matrix3d::Identity(), 333, 241, {0.9, 5, 3e-4, 0, 2}, seed);
    const cv::Mat whole(rendered.height(), rendered.width(), CV_8U, const_cast<std::uint8_t*>(rendered.data()));
    const cv::Mat part = whole(cv::Rect(11, 7, 301, 222));
    for (const int threshold : {1, 5, 10, 20, 60})
      for (const bool suppress : {false, true}) {
        ASSERT_EQ(difference(whole, threshold, suppress, &total), "");
        ASSERT_EQ(difference(part, threshold, suppress, &total), "");
      }
  }
  EXPECT_GT(total, 10000U);
}

TEST(FastAgainstOpenCv, ImagesTooSmall) {
  std::size_t total = 0;
  for (const int width : {1, 3, 6, 7, 8})
    for (const int height : {1, 5, 6, 7, 9}) {
      cv::Mat image(height, width, CV_8U, cv::Scalar(10));
      image.at<std::uint8_t>(height / 2, width / 2) = 200;
      for (const bool suppress : {false, true}) ASSERT_EQ(difference(image, 20, suppress, &total), "");
    }
}

TEST(FastAgainstOpenCv, ImagesAtHand) {
  namespace fs = std::filesystem;
  const fs::path repository = fs::absolute(__FILE__).parent_path().parent_path().parent_path();
  const fs::path data = repository.parent_path() / "shared" / "data";
  if (!fs::is_directory(data)) GTEST_SKIP() << "no real images: ../shared/data is absent";
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(data)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".png" || extension == ".jpg" || extension == ".ppm") files.push_back(entry.path());
  }
  if (files.empty()) GTEST_SKIP() << "no real images: ../shared/data holds none";
  std::sort(files.begin(), files.end());
  std::size_t total = 0, images = 0;
  for (const fs::path& file : files) {
    const cv::Mat image = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
    if (image.empty()) continue;
    ++images;
    for (const int threshold : {7, 20})
      for (const bool suppress : {false, true})
        EXPECT_EQ(difference(image, threshold, suppress, &total), "") << fs::relative(file, data).string();
  }
  EXPECT_GT(images, 0U);
  RecordProperty("images", static_cast<int>(images));
  std::printf("%zu images, %zu corners compared\n", images, total);
}

}  // namespace
