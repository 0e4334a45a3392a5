#include "textplane/core/image_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace tp = textplane;

template class textplane::ImageView<std::uint8_t>;
template class textplane::ImageView<const std::uint8_t>;
template class textplane::ImageView<float>;
template class textplane::ImageView<const float>;
template class textplane::Image<std::uint8_t>;
template class textplane::Image<float>;

namespace image_view_test {

TEST(ImageViewTest, WalksRowsByStride) {
  std::vector<std::uint8_t> bytes(4 * 7);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i);
  const tp::ImageView8 view(bytes.data(), 5, 4, 7);
  ASSERT_TRUE(view.valid());
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x) EXPECT_EQ(view(x, y), 7 * y + x);
  EXPECT_EQ(view.row(2), bytes.data() + 14);
}

TEST(ImageViewTest, StrideIsInBytesForFloatsToo) {
  std::vector<float> pixels(3 * 4);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<float>(i);
  const tp::ImageViewF view(pixels.data(), 3, 3, 4 * static_cast<std::ptrdiff_t>(sizeof(float)));
  EXPECT_EQ(view(2, 1), 6.0f);
  EXPECT_EQ(view(0, 2), 8.0f);
}

TEST(ImageViewTest, MutableConvertsToConstant) {
  std::uint8_t pixel[6] = {};
  const tp::ImageView<std::uint8_t> writable(pixel, 3, 2);
  writable(1, 1) = 42;
  const tp::ImageView8 readable = writable;
  EXPECT_EQ(readable(1, 1), 42);
  EXPECT_EQ(readable.stride(), 3);
  EXPECT_EQ(pixel[4], 42);
  static_assert(!std::is_convertible<tp::ImageView8, tp::ImageView<std::uint8_t>>::value, "const must stay");
}

TEST(ImageViewTest, ValidNamesEveryDefect) {
  std::uint8_t pixel[6] = {};
  EXPECT_FALSE(tp::ImageView8().valid());
  EXPECT_FALSE(tp::ImageView8(nullptr, 3, 2).valid());
  EXPECT_FALSE(tp::ImageView8(pixel, 0, 2).valid());
  EXPECT_FALSE(tp::ImageView8(pixel, 3, -2).valid());
  EXPECT_FALSE(tp::ImageView8(pixel, 3, 2, 2).valid());
  EXPECT_FALSE(tp::ImageViewF(reinterpret_cast<const float*>(0x1000), 3, 2, 11).valid());
  EXPECT_TRUE(tp::ImageView8(pixel, 3, 2).valid());
}

TEST(ImageViewTest, ContainsIsTheInterpolationDomain) {
  std::uint8_t pixel[12] = {};
  const tp::ImageView8 view(pixel, 4, 3);
  EXPECT_TRUE(view.contains(0.0, 0.0));
  EXPECT_TRUE(view.contains(3.0, 2.0));
  EXPECT_TRUE(view.contains(2.5f, 0.1f));
  EXPECT_FALSE(view.contains(-1e-9, 0.0));
  EXPECT_FALSE(view.contains(3.0001, 1.0));
  EXPECT_FALSE(view.contains(1.0, 2.0001));
  EXPECT_FALSE(view.contains(std::nan(""), 1.0));
  EXPECT_FALSE(view.contains(1.0, std::nan("")));
}

TEST(ImageTest, OwnsItsPixels) {
  tp::Image<float> image(4, 3, 2.5f);
  EXPECT_EQ(image.width(), 4);
  EXPECT_EQ(image.height(), 3);
  image(3, 2) = 7;
  EXPECT_EQ(image.view()(3, 2), 7.0f);
  EXPECT_EQ(image.row(2)[3], 7.0f);
  const tp::Image<float> copy = image;
  image(3, 2) = 8;
  EXPECT_EQ(copy(3, 2), 7.0f);
  EXPECT_EQ(copy.view()(0, 0), 2.5f);
  image.resize(-1, 5);
  EXPECT_TRUE(image.empty());
  EXPECT_FALSE(image.view().valid());
}

}  // namespace image_view_test
