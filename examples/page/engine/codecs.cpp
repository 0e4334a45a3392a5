// The image formats of io/image_codecs.hpp without libjpeg and libpng. The browser decodes; the report's pictures are
// encoded by stb_image_write, as a canvas would answer too late for a function that returns bytes.
#include <stdexcept>
#include <vector>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include "io/image_codecs.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "stb/stb_image_write.h"

namespace textslam {
namespace {

[[noreturn]] void refuse(const std::string& path) { throw InputError(path, 0, "images are decoded by the browser"); }

std::vector<std::uint8_t> packed(ImageView8 image) {
  if (!image.valid()) throw std::invalid_argument("encode: the view is not valid");
  std::vector<std::uint8_t> pixels;
  pixels.reserve(static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()));
  for (int y = 0; y < image.height(); ++y) pixels.insert(pixels.end(), image.row(y), image.row(y) + image.width());
  return pixels;
}

void append(void* out, void* bytes, int size) {
  static_cast<std::string*>(out)->append(static_cast<const char*>(bytes), static_cast<std::size_t>(size));
}

}  // namespace

Image<std::uint8_t> decode_jpeg(const std::string&, const std::string& path) { refuse(path); }
Image<std::uint8_t> decode_png(const std::string&, const std::string& path) { refuse(path); }

// The browser turns pictures as their EXIF data say.
int jpeg_orientation(std::string_view) { return 1; }
int jpeg_focal_length_35mm(std::string_view) { return 0; }

std::string encode_jpeg(ImageView8 image, int quality) {
  std::string out;
  if (!stbi_write_jpg_to_func(append, &out, image.width(), image.height(), 1, packed(image).data(), quality))
    throw std::runtime_error("encode_jpeg: out of memory");
  return out;
}

std::string encode_png(ImageView8 image) {
  std::string out;
  if (!stbi_write_png_to_func(append, &out, image.width(), image.height(), 1, packed(image).data(), image.width()))
    throw std::runtime_error("encode_png: out of memory");
  return out;
}

}  // namespace textslam
