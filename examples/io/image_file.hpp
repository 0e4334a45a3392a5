// Image files: JPEG (libjpeg), PNG (libpng) and the PGM/PPM family into 8-bit grey images, and back.
//
// The file's first bytes decide the format, not its name. Colour becomes grey by (299 R + 587 G + 114 B + 500) / 1000;
// a YCbCr JPEG gives its luma, which has the same weights; CMYK is white light less its inks. Samples of more than 8
// bits are scaled down. Alpha, gamma and colour profiles are ignored. A file that decodes only in part counts as
// broken: half a frame must not be tracked.
#ifndef TEXTSLAM_IO_IMAGE_FILE_HPP
#define TEXTSLAM_IO_IMAGE_FILE_HPP

#include <cstdint>
#include <string>

#include "io/names.hpp"

namespace textslam {

/// Larger images are refused before their pixels are allocated.
constexpr int kMaxImageSide = 16384;
constexpr int kMaxImagePixels = 1 << 27;

/// Whether the file can be read and begins as an image of these formats.
bool is_image_file(const std::string& path);

/// How the image is to be turned for people, by its EXIF data: 1 as it is, 2 to 8 as EXIF numbers rotations and
/// mirrorings. 1 for any other file. load_grey() takes images as they are stored.
int image_orientation(const std::string& path);

/// The focal length that gives the same view on 35 mm film (36 x 24 mm), mm, by its EXIF data; 0: not known.
int image_focal_length_35mm(const std::string& path);

/// The image as grey values. Throws InputError (file, no line) when the file is missing, unreadable, of an unknown
/// kind, corrupt, truncated or too large. Safe to call from several threads.
Image<std::uint8_t> load_grey(const std::string& path);

/// The bytes of a grey PNG. Throws std::invalid_argument for an invalid view.
std::string encode_png(ImageView8 image);
/// The bytes of a grey JPEG of the given quality, 1 to 100. Throws std::invalid_argument for an invalid view.
std::string encode_jpeg(ImageView8 image, int quality);

/// Writes the file as write_file() does: whole or not at all; std::runtime_error with the path on failure.
void save_png(const std::string& path, ImageView8 image);
void save_jpeg(const std::string& path, ImageView8 image, int quality = 92);

}  // namespace textslam

#endif  // TEXTSLAM_IO_IMAGE_FILE_HPP
