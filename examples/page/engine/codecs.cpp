// The image formats of io/image_codecs.hpp without libjpeg and libpng, by stb. The browser decodes the frames; the
// report's pictures are encoded here, and a map's images decoded, as a canvas would answer too late for a function that
// returns bytes.
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_STDIO
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include "exchange.hpp"
#include "io/image_codecs.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "stb/stb_image.h"
#include "stb/stb_image_write.h"

namespace textslam {
namespace {

Image<std::uint8_t> decode(const std::string& bytes, const std::string& path) {
  int width = 0, height = 0, channels = 0;
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  if (stbi_info_from_memory(data, static_cast<int>(bytes.size()), &width, &height, &channels) != 0)
    check_image_size(static_cast<std::size_t>(width), static_cast<std::size_t>(height), path);
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(data, static_cast<int>(bytes.size()), &width, &height, &channels, 1), stbi_image_free);
  if (!pixels) throw InputError(path, 0, std::string("does not decode: ") + stbi_failure_reason());
  Image<std::uint8_t> image(width, height);
  for (int y = 0; y < height; ++y)
    std::copy_n(pixels.get() + static_cast<std::ptrdiff_t>(y) * width, width, image.row(y));
  return image;
}

void append(void* out, void* bytes, int size) {
  static_cast<std::string*>(out)->append(static_cast<const char*>(bytes), static_cast<std::size_t>(size));
}

}  // namespace

Image<std::uint8_t> decode_jpeg(const std::string& bytes, const std::string& path) { return decode(bytes, path); }
Image<std::uint8_t> decode_png(const std::string& bytes, const std::string& path) { return decode(bytes, path); }

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
