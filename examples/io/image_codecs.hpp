// The image formats of io/image_file.hpp: bytes to pixels and back. `path` appears in messages only.
#ifndef TEXTSLAM_IO_IMAGE_CODECS_HPP
#define TEXTSLAM_IO_IMAGE_CODECS_HPP

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/names.hpp"

namespace textslam {

/// Each throws InputError unless the whole image decodes.
Image<std::uint8_t> decode_jpeg(const std::string& bytes, const std::string& path);
Image<std::uint8_t> decode_png(const std::string& bytes, const std::string& path);
Image<std::uint8_t> decode_pnm(const std::string& bytes, const std::string& path);

/// EXIF's number of how a JPEG is to be turned; 1 where none is found.
int jpeg_orientation(std::string_view bytes);
/// EXIF's FocalLengthIn35mmFilm, mm; 0 where none is found.
int jpeg_focal_length_35mm(std::string_view bytes);

/// Throws InputError for an empty or too large image, before its pixels are allocated.
void check_image_size(std::size_t width, std::size_t height, const std::string& path);

/// Grey value of a colour.
inline std::uint8_t grey_of(int r, int g, int b) {
  return static_cast<std::uint8_t>((299 * r + 587 * g + 114 * b + 500) / 1000);
}

}  // namespace textslam

#endif  // TEXTSLAM_IO_IMAGE_CODECS_HPP
