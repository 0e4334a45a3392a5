#include "io/image_file.hpp"

#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include <jpeglib.h>
#include <png.h>
#include <unistd.h>

#include "io/image_codecs.hpp"
#include "io/io_support.hpp"

namespace textslam {
namespace io_image_file_test {

Image<std::uint8_t> noise(int width, int height) {
  std::mt19937 random(7);
  Image<std::uint8_t> image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image(x, y) = static_cast<std::uint8_t>(random() >> 24);
  return image;
}

Image<std::uint8_t> ramp(int width, int height) {
  Image<std::uint8_t> image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image(x, y) = static_cast<std::uint8_t>(20 + 2 * x + y);
  return image;
}

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

// A grey PNG of any depth through libpng's full interface, packed rows given.
std::string packed_png(std::vector<std::vector<unsigned char>> rows, int width, int depth, int interlace) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &bytes,
      [](png_structp p, png_bytep data, png_size_t n) {
        static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<const char*>(data), n);
      },
      nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(rows.size()), depth,
               PNG_COLOR_TYPE_GRAY, interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  std::vector<png_bytep> pointers;
  for (auto& row : rows) pointers.push_back(row.data());
  png_write_image(png, pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

// A JPEG of one colour.
std::string colour_jpeg(int width, int height, int r, int g, int b, bool progressive) {
  jpeg_compress_struct codec{};
  jpeg_error_mgr errors;
  codec.err = jpeg_std_error(&errors);
  jpeg_create_compress(&codec);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&codec, &buffer, &size);
  codec.image_width = static_cast<JDIMENSION>(width);
  codec.image_height = static_cast<JDIMENSION>(height);
  codec.input_components = 3;
  codec.in_color_space = JCS_RGB;
  jpeg_set_defaults(&codec);
  jpeg_set_quality(&codec, 95, TRUE);
  if (progressive) jpeg_simple_progression(&codec);
  jpeg_start_compress(&codec, TRUE);
  std::vector<unsigned char> row;
  for (int x = 0; x < width; ++x)
    for (const int v : {r, g, b}) row.push_back(static_cast<unsigned char>(v));
  for (int y = 0; y < height; ++y) {
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&codec, &pointer, 1);
  }
  jpeg_finish_compress(&codec);
  jpeg_destroy_compress(&codec);
  std::string bytes(reinterpret_cast<const char*>(buffer), size);
  std::free(buffer);
  return bytes;
}

void expect_broken(const TemporaryFolder& folder, const std::string& bytes, const std::string& part) {
  const std::string path = folder.write("image", bytes);
  expect_input_error([&] { load_grey(path); }, path, 0, part);
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

TEST(ImageFile, BrokenPgm) {
  const TemporaryFolder folder;
  expect_broken(folder, "P5 4 4 255\n0123456789", "ends too early");
  expect_broken(folder, "P5 4 4 255", "bad header");
  expect_broken(folder, "P5 4", "ends too early");
  expect_broken(folder, "P5 # only a comment", "ends too early");
  expect_broken(folder, "P5 -4 4 255\n", "expected a number");
  expect_broken(folder, "P2 2 1 255 12 x", "expected a number");
  expect_broken(folder, "P2 2 1 255 1234 5", "exceeds 255");
  expect_broken(folder, std::string("P5 1 1 9\n") + "\x0A", "exceeds 9");
  expect_broken(folder, "P2 2 1 0 0 0", "largest sample");
  expect_broken(folder, "P5 0 7 255\n", "empty");
  expect_broken(folder, "P5 99999999999999999999 7 255\n", "exceeds");
  expect_broken(folder, "P2 2 2 255\n1 2 3 ", "ends too early");
}

TEST(ImageFile, MissingEmptyFolderAndGarbage) {
  const TemporaryFolder folder;
  expect_input_error([&] { load_grey(folder.path("none.png")); }, folder.path("none.png"), 0, "No such file");
  expect_input_error([&] { load_grey(folder.path()); }, folder.path(), 0, "Is a directory");
  expect_broken(folder, "", "empty");
  expect_broken(folder, "P", "not a JPEG");
  expect_broken(folder, std::string("\0\x01\xFE garbage", 11), "not a JPEG");
  expect_broken(folder, "\xFF\xD8\xFF", "broken JPEG");
  expect_broken(folder, "\xFF\xD8\xFF\xE0 what follows is no JPEG at all", "broken JPEG");
  expect_broken(folder, "\x89PNG\r\n\x1A\n", "broken PNG");
  expect_broken(folder, "\x89PNG\r\n\x1A\n and nothing that a PNG would hold", "broken PNG");
}

TEST(ImageFile, Unreadable) {
  if (geteuid() == 0) GTEST_SKIP() << "root reads everything";
  const TemporaryFolder folder;
  const std::string path = folder.write("secret.pgm", "P2 1 1 255 7");
  std::filesystem::permissions(path, std::filesystem::perms::none);
  expect_input_error([&] { load_grey(path); }, path, 0, "Permission denied");
}

// No prefix of an image is an image, however little is missing.
TEST(ImageFile, EveryTruncationIsRefused) {
  const Image<std::uint8_t> image = noise(24, 18);
  const std::string png = encode_png(image.view()), jpeg = encode_jpeg(image.view(), 90);
  const std::string progressive = colour_jpeg(24, 18, 10, 200, 77, true);
  for (const std::string& whole : {png, jpeg, progressive}) {
    const auto decode = whole == png ? decode_png : decode_jpeg;
    ASSERT_NO_THROW(decode(whole, "whole"));
    for (std::size_t n = 0; n < whole.size(); ++n) {
      EXPECT_THROW(decode(whole.substr(0, n), "part"), InputError) << n << " of " << whole.size() << " bytes";
    }
  }
}

// A flipped byte is either noticed or harmless, never a crash. (The sanitisers watch.)
TEST(ImageFile, EveryFlippedByteIsSurvived) {
  const Image<std::uint8_t> image = noise(24, 18);
  const std::string png = encode_png(image.view()), jpeg = encode_jpeg(image.view(), 90);
  for (const std::string& whole : {png, jpeg}) {
    const auto decode = whole == png ? decode_png : decode_jpeg;
    std::size_t refused = 0;
    for (std::size_t n = 0; n < whole.size(); ++n) {
      for (const int flip : {0x01, 0x80, 0xFF}) {
        std::string damaged = whole;
        damaged[n] = static_cast<char>(damaged[n] ^ flip);
        try {
          decode(damaged, "damaged");
        } catch (const InputError&) {
          ++refused;
        }
      }
    }
    // Most of a PNG is under checksums; a JPEG has none.
    EXPECT_GT(refused, whole == png ? 2 * whole.size() : whole.size() / 10);
  }
}

TEST(ImageFile, HugeImagesAreRefusedBeforeAllocation) {
  const TemporaryFolder folder;
  expect_broken(folder, "P5 99999999 99999999 255\n", "too large");
  expect_broken(folder, "P5 16384 16384 255\n", "too large");
  expect_broken(folder, "P5 16384 8192 255\n", "ends too early");

  std::string jpeg = encode_jpeg(ramp(16, 16).view(), 90);
  const std::size_t frame = jpeg.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  for (std::size_t i = 5; i < 9; ++i) jpeg[frame + i] = '\xF0';
  expect_broken(folder, jpeg, "too large: 61680 x 61680");

  // A bit a pixel: a file that is small and right, of a width beyond the bound.
  const int width = kMaxImageSide + 1;
  const std::string png =
      packed_png({std::vector<unsigned char>(static_cast<std::size_t>(width / 8 + 1))}, width, 1, 0);
  expect_broken(folder, png, "too large: 16385 x 1");
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
