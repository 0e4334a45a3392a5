// Images written and read again, in every format; broken ones: broken_image_test.cpp.
#include "io/image_file.hpp"

#include <cmath>
#include <cstdlib>
#include <vector>

#include <png.h>

#include "io/image_support.hpp"

namespace textslam {
namespace io_image_file_test {

int largest_difference(ImageView8 a, ImageView8 b) {
  if (a.width() != b.width() || a.height() != b.height()) return 256;
  int worst = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) worst = std::max(worst, std::abs(int(a(x, y)) - int(b(x, y))));
  return worst;
}

// Samples in any format of libpng's simplified interface as a PNG.
std::string png_of(const void* samples, int width, int height, png_uint_32 format, const void* colormap = nullptr,
                   png_uint_32 entries = 0) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(width);
  png.height = static_cast<png_uint_32>(height);
  png.format = format;
  png.colormap_entries = entries;
  png_alloc_size_t size = 1 << 16;
  std::string bytes(size, '\0');
  EXPECT_TRUE(png_image_write_to_memory(&png, &bytes[0], &size, 0, samples, 0, colormap)) << png.message;
  bytes.resize(size);
  return bytes;
}

TEST(ImageFile, PngKeepsEveryPixel) {
  const TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, {37, 23}, {640, 3}}) {
    const Image<std::uint8_t> image = noise(width, height);
    save_png(folder.path("a.png"), image.view());
    EXPECT_EQ(largest_difference(load_grey(folder.path("a.png")).view(), image.view()), 0);
  }
}

TEST(ImageFile, StrideIsRespectedWhenWriting) {
  const TemporaryFolder folder;
  const Image<std::uint8_t> image = ramp(50, 40);
  const ImageView8 part(image.data() + 7 + 5 * 50, 20, 30, 50);
  save_png(folder.path("a.png"), part);
  EXPECT_EQ(largest_difference(load_grey(folder.path("a.png")).view(), part), 0);
  save_jpeg(folder.path("a.jpg"), part, 95);
  EXPECT_LE(largest_difference(load_grey(folder.path("a.jpg")).view(), part), 2);
}

TEST(ImageFile, JpegIsCloseAndDeterministic) {
  const TemporaryFolder folder;
  const Image<std::uint8_t> image = ramp(61, 47);
  save_jpeg(folder.path("a.jpg"), image.view());
  EXPECT_LE(largest_difference(load_grey(folder.path("a.jpg")).view(), image.view()), 3);
  EXPECT_EQ(encode_jpeg(image.view(), 80), encode_jpeg(image.view(), 80));
  EXPECT_LT(encode_jpeg(image.view(), 10).size(), encode_jpeg(image.view(), 95).size());
}

TEST(ImageFile, GreyWeights) {
  EXPECT_EQ(grey_of(0, 0, 0), 0);
  EXPECT_EQ(grey_of(255, 255, 255), 255);
  EXPECT_EQ(grey_of(255, 0, 0), 76);     // 76.245
  EXPECT_EQ(grey_of(0, 255, 0), 150);    // 149.685
  EXPECT_EQ(grey_of(0, 0, 255), 29);     // 29.07
  EXPECT_EQ(grey_of(10, 200, 77), 129);  // 2.99 + 117.4 + 8.778 = 129.168
}

TEST(ImageFile, ColourAndDepthOfPng) {
  const TemporaryFolder folder;
  const unsigned char rgb[6] = {255, 0, 0, 10, 200, 77};
  Image<std::uint8_t> image = load_grey(folder.write("rgb.png", png_of(rgb, 2, 1, PNG_FORMAT_RGB)));
  EXPECT_EQ(image(0, 0), 76);
  EXPECT_EQ(image(1, 0), 129);

  const unsigned char rgba[8] = {0, 255, 0, 3, 10, 200, 77, 255};
  image = load_grey(folder.write("rgba.png", png_of(rgba, 2, 1, PNG_FORMAT_RGBA)));
  EXPECT_EQ(image(0, 0), 150) << "alpha is ignored";
  EXPECT_EQ(image(1, 0), 129);

  const unsigned char palette[6] = {0, 0, 255, 255, 255, 255}, indices[2] = {1, 0};
  image = load_grey(folder.write("map.png", png_of(indices, 2, 1, PNG_FORMAT_RGB_COLORMAP, palette, 2)));
  EXPECT_EQ(image(0, 0), 255);
  EXPECT_EQ(image(1, 0), 29);

  const std::uint16_t wide[2] = {0x8080, 0xFFFF};
  image = load_grey(folder.write("wide.png", png_of(wide, 2, 1, PNG_FORMAT_LINEAR_Y)));
  EXPECT_EQ(image(0, 0), 128) << "16 bits are scaled, the gamma chunk is ignored";
  EXPECT_EQ(image(1, 0), 255);

  image = load_grey(folder.write("bits.png", packed_png({{0b10100000}, {0b01000000}}, 3, 1, PNG_INTERLACE_NONE)));
  EXPECT_EQ(image(0, 0), 255);
  EXPECT_EQ(image(1, 0), 0);
  EXPECT_EQ(image(2, 1), 0);
  EXPECT_EQ(image(1, 1), 255);
}

TEST(ImageFile, InterlacedPng) {
  const TemporaryFolder folder;
  const Image<std::uint8_t> image = noise(21, 13);
  std::vector<std::vector<unsigned char>> rows;
  for (int y = 0; y < 13; ++y) rows.emplace_back(image.row(y), image.row(y) + 21);
  const std::string path = folder.write("i.png", packed_png(rows, 21, 8, PNG_INTERLACE_ADAM7));
  EXPECT_EQ(largest_difference(load_grey(path).view(), image.view()), 0);
}

TEST(ImageFile, ColourJpegGivesItsLuma) {
  const TemporaryFolder folder;
  for (const bool progressive : {false, true}) {
    const Image<std::uint8_t> image = load_grey(folder.write("c.jpg", colour_jpeg(17, 9, 10, 200, 77, progressive)));
    ASSERT_EQ(image.width(), 17);
    ASSERT_EQ(image.height(), 9);
    EXPECT_NEAR(image(0, 0), 129, 1);
    EXPECT_NEAR(image(16, 8), 129, 1);
  }
}

// By hand: 60 % cyan, no magenta, 20 % yellow and 40 % black leave (.4, 1, .8) * .6 of the light.
TEST(ImageFile, InksOfACmykJpegGiveItsGrey) {
  const TemporaryFolder folder;
  const int expected = grey_of(61, 153, 122);
  for (const bool adobe : {false, true}) {
    const Image<std::uint8_t> image = load_grey(folder.write("c.jpg", cmyk_jpeg(17, 9, 153, 0, 51, 102, adobe)));
    ASSERT_EQ(image.width(), 17);
    ASSERT_EQ(image.height(), 9);
    EXPECT_NEAR(image(0, 0), expected, 2) << adobe;
    EXPECT_NEAR(image(16, 8), expected, 2) << adobe;
  }
}

TEST(ImageFile, OrientationByExif) {
  const std::string jpeg = encode_jpeg(ramp(8, 6).view(), 90);
  EXPECT_EQ(jpeg_orientation(jpeg), 1);
  for (const bool high_first : {true, false})
    for (int value = 0; value < 10; ++value) {
      const std::string turned = jpeg.substr(0, 2) + exif_segment(value, high_first) + jpeg.substr(2);
      EXPECT_EQ(jpeg_orientation(turned), value >= 1 && value <= 8 ? value : 1);
      EXPECT_EQ(decode_jpeg(turned, "turned").width(), 8) << "as it is stored";
      for (std::size_t size = 0; size < 28; ++size)
        EXPECT_EQ(jpeg_orientation(turned.substr(0, size)), 1) << "cut off before it";
    }
  EXPECT_EQ(image_orientation("/no/such/file.jpg"), 1);
}

TEST(ImageFile, FocalLengthByExif) {
  const std::string jpeg = encode_jpeg(ramp(8, 6).view(), 90);
  EXPECT_EQ(jpeg_focal_length_35mm(jpeg), 0);
  EXPECT_EQ(jpeg_focal_length_35mm(jpeg.substr(0, 2) + exif_segment(1, true) + jpeg.substr(2)), 0);
  for (const bool high_first : {true, false})
    for (const int mm : {0, 26, 300}) {
      const std::string segment = exif_focal_segment(mm, high_first);
      const std::string taken = jpeg.substr(0, 2) + segment + jpeg.substr(2);
      EXPECT_EQ(jpeg_focal_length_35mm(taken), mm);
      EXPECT_EQ(jpeg_orientation(taken), 1);
      for (std::size_t size = 0; size + 6 < 2 + segment.size(); ++size)  // 6 bytes follow the number
        EXPECT_EQ(jpeg_focal_length_35mm(taken.substr(0, size)), 0) << "cut off before it";
    }
  EXPECT_EQ(image_focal_length_35mm("/no/such/file.jpg"), 0);
}

TEST(ImageFile, PgmAndPpm) {
  const TemporaryFolder folder;
  Image<std::uint8_t> image =
      load_grey(folder.write("a", std::string("P5\n# a comment\n2 2 # another\n255\n") + "\x01\x02\xFE\xFF"));
  EXPECT_EQ(image(0, 0), 1);
  EXPECT_EQ(image(1, 0), 2);
  EXPECT_EQ(image(0, 1), 254);
  EXPECT_EQ(image(1, 1), 255);

  image = load_grey(folder.write("a", "P2 3 1 4\n0 2 4\n"));
  EXPECT_EQ(image(0, 0), 0);
  EXPECT_EQ(image(1, 0), 128);  // 127.5
  EXPECT_EQ(image(2, 0), 255);

  image = load_grey(folder.write("a", std::string("P5 2 1 65535\n") + std::string("\x80\x80\xFF\xFF", 4)));
  EXPECT_EQ(image(0, 0), 128);
  EXPECT_EQ(image(1, 0), 255);

  image = load_grey(folder.write("a", std::string("P6 1 1 255\n") + std::string("\x0A\xC8\x4D", 3)));
  EXPECT_EQ(image(0, 0), 129);
  image = load_grey(folder.write("a", "P3 1 1 255 10 200 77"));
  EXPECT_EQ(image(0, 0), 129);
}

TEST(ImageFile, BadArguments) {
  EXPECT_THROW(encode_png(ImageView8()), std::invalid_argument);
  EXPECT_THROW(encode_jpeg(ImageView8(), 90), std::invalid_argument);
  EXPECT_THROW(encode_jpeg(ramp(4, 4).view(), 0), std::invalid_argument);
  EXPECT_THROW(encode_jpeg(ramp(4, 4).view(), 101), std::invalid_argument);
  EXPECT_THROW(save_png("/dev/null/x.png", ramp(4, 4).view()), std::runtime_error);
}

}  // namespace io_image_file_test
}  // namespace textslam
