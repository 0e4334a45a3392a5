// Images of noise and ramps, and files of them in formats that the writers of io do not write.
#ifndef TESTS_IO_IMAGE_SUPPORT_HPP
#define TESTS_IO_IMAGE_SUPPORT_HPP

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <jpeglib.h>
#include <png.h>

#include "io/image_codecs.hpp"
#include "io/image_file.hpp"
#include "io/io_support.hpp"

namespace textslam {

inline Image<std::uint8_t> noise(int width, int height) {
  std::mt19937 random(7);
  Image<std::uint8_t> image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image(x, y) = static_cast<std::uint8_t>(random() >> 24);
  return image;
}

inline Image<std::uint8_t> ramp(int width, int height) {
  Image<std::uint8_t> image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image(x, y) = static_cast<std::uint8_t>(20 + 2 * x + y);
  return image;
}

// A grey PNG of any depth through libpng's full interface, packed rows given.
inline std::string packed_png(std::vector<std::vector<unsigned char>> rows, int width, int depth, int interlace) {
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

// A JPEG of one colour: a byte of each of its channels. `set` changes what libjpeg's defaults are.
template <typename Set>
std::string jpeg_of(int width, int height, J_COLOR_SPACE space, const std::vector<int>& colour, const Set& set) {
  jpeg_compress_struct codec{};
  jpeg_error_mgr errors;
  codec.err = jpeg_std_error(&errors);
  jpeg_create_compress(&codec);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&codec, &buffer, &size);
  codec.image_width = static_cast<JDIMENSION>(width);
  codec.image_height = static_cast<JDIMENSION>(height);
  codec.input_components = static_cast<int>(colour.size());
  codec.in_color_space = space;
  jpeg_set_defaults(&codec);
  jpeg_set_quality(&codec, 95, TRUE);
  set(codec);
  jpeg_start_compress(&codec, TRUE);
  std::vector<unsigned char> row;
  for (int x = 0; x < width; ++x)
    for (const int v : colour) row.push_back(static_cast<unsigned char>(v));
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

inline std::string colour_jpeg(int width, int height, int r, int g, int b, bool progressive) {
  return jpeg_of(width, height, JCS_RGB, {r, g, b}, [&](jpeg_compress_struct& codec) {
    if (progressive) jpeg_simple_progression(&codec);
  });
}

// Four inks, 0 to 255 each. With Adobe's marker, what they leave of the light is stored.
inline std::string cmyk_jpeg(int width, int height, int c, int m, int y, int k, bool adobe) {
  const std::vector<int> inks = {c, m, y, k}, light = {255 - c, 255 - m, 255 - y, 255 - k};
  return jpeg_of(width, height, JCS_CMYK, adobe ? light : inks,
                 [&](jpeg_compress_struct& codec) { codec.write_Adobe_marker = adobe ? TRUE : FALSE; });
}

// TIFF data that EXIF holds, number by number.
class TiffWriter {
 public:
  explicit TiffWriter(bool high_first) : bytes_(high_first ? "MM" : "II"), high_first_(high_first) {
    add(42, 2);
    add(8, 4);  // where the first directory is
  }
  void add(std::int64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes_ += static_cast<char>(value >> 8 * (high_first_ ? size - 1 - i : i) & 0xFF);
  }
  // A directory of one entry of 16 (type 3) or 32 bits (type 4).
  void add_directory(int tag, int type, std::int64_t value) {
    add(1, 2);
    add(tag, 2);
    add(type, 2);
    add(1, 4);
    add(value, type == 3 ? 2 : 4);
    if (type == 3) add(0, 2);
    add(0, 4);
  }
  std::string segment() const {
    const std::string exif = std::string("Exif\0\0", 6) + bytes_;
    return std::string("\xFF\xE1\0", 3) + static_cast<char>(exif.size() + 2) + exif;
  }

 private:
  std::string bytes_;
  bool high_first_;
};

// EXIF data that holds an orientation and nothing else, as it stands after the first two bytes of a JPEG.
inline std::string exif_segment(int orientation, bool high_first) {
  TiffWriter tiff(high_first);
  tiff.add_directory(0x0112, 3, orientation);
  return tiff.segment();
}

// The same with a focal length, mm on 35 mm film, in the directory of its own where EXIF has it.
inline std::string exif_focal_segment(int mm, bool high_first) {
  TiffWriter tiff(high_first);
  tiff.add_directory(0x8769, 4, 8 + 18);
  tiff.add_directory(0xA405, 3, mm);
  return tiff.segment();
}

inline void expect_broken(const TemporaryFolder& folder, const std::string& bytes, const std::string& part) {
  const std::string path = folder.write("image", bytes);
  expect_input_error([&] { load_grey(path); }, path, 0, part);
}

}  // namespace textslam

#endif  // TESTS_IO_IMAGE_SUPPORT_HPP
