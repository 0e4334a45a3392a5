// Broken images: refused in one line that names the file, never a crash.
#include <gtest/gtest.h>

#include <filesystem>

#include <unistd.h>

#include "io/image_support.hpp"

namespace textslam {
namespace io_broken_image_test {

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

}  // namespace io_broken_image_test
}  // namespace textslam
