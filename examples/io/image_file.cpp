#include "io/image_file.hpp"

#include <fstream>
#include <string_view>

#include "io/image_codecs.hpp"
#include "io/input_error.hpp"
#include "io/output_file.hpp"
#include "io/text_file.hpp"

namespace textslam {

void check_image_size(std::size_t width, std::size_t height, const std::string& path) {
  if (width == 0 || height == 0) throw InputError(path, 0, "the image is empty");
  constexpr std::size_t kSide = kMaxImageSide, kPixels = kMaxImagePixels;
  if (width > kSide || height > kSide || width * height > kPixels) {
    throw InputError(path, 0,
                     "the image is too large: " + std::to_string(width) + " x " + std::to_string(height) + " px");
  }
}

namespace {

constexpr std::size_t kExifBytes = 1 << 17;  // it comes first, in a segment of at most half as many

using Decoder = Image<std::uint8_t> (*)(const std::string& bytes, const std::string& path);

// By the first bytes; null for an unknown format.
Decoder decoder_of(std::string_view bytes) {
  const auto starts_with = [&](std::string_view magic) { return bytes.substr(0, magic.size()) == magic; };
  if (starts_with("\xFF\xD8\xFF")) return decode_jpeg;
  if (starts_with("\x89PNG\r\n\x1A\n")) return decode_png;
  if (bytes.size() > 2 && bytes[0] == 'P' &&
      (bytes[1] == '2' || bytes[1] == '3' || bytes[1] == '5' || bytes[1] == '6')) {
    return decode_pnm;
  }
  return nullptr;
}

std::string head_of(const std::string& path) {
  std::string bytes(kExifBytes, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

}  // namespace

bool is_image_file(const std::string& path) {
  char bytes[8] = {};
  std::ifstream file(path, std::ios::binary);
  file.read(bytes, sizeof bytes);
  return decoder_of(std::string_view(bytes, static_cast<std::size_t>(file.gcount()))) != nullptr;
}

int image_orientation(const std::string& path) { return jpeg_orientation(head_of(path)); }
int image_focal_length_35mm(const std::string& path) { return jpeg_focal_length_35mm(head_of(path)); }

Image<std::uint8_t> load_grey(const std::string& path) {
  const std::string bytes = read_file(path);
  if (bytes.empty()) throw InputError(path, 0, "the file is empty");
  if (const Decoder decode = decoder_of(bytes)) return decode(bytes, path);
  throw InputError(path, 0, "this is not a JPEG, PNG, PGM or PPM image");
}

void save_png(const std::string& path, ImageView8 image) { write_file(path, encode_png(image)); }

void save_jpeg(const std::string& path, ImageView8 image, int quality) {
  write_file(path, encode_jpeg(image, quality));
}

}  // namespace textslam
