// JPEG by libjpeg. Its errors come back by longjmp, which skips destructors: every setjmp below is in a function
// that, like all that it calls, has nothing to destroy. Owners live in the callers.
#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include <jpeglib.h>

#include <jerror.h>

#include "io/image_codecs.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"

namespace textslam {

namespace {

struct JpegErrors {
  jpeg_error_mgr base;  // first: libjpeg hands back a pointer to it
  std::jmp_buf jump;
  char message[JMSG_LENGTH_MAX];
};

[[noreturn]] void leave(j_common_ptr codec) {
  auto* errors = reinterpret_cast<JpegErrors*>(codec->err);
  codec->err->format_message(codec, errors->message);
  std::longjmp(errors->jump, 1);
}

// libjpeg fills what it cannot decode with grey and only warns. Warnings that leave all pixels right are ignored.
void on_message(j_common_ptr codec, int level) {
  if (level >= 0) return;
  const int code = codec->err->msg_code;
  if (code != JWRN_EXTRANEOUS_DATA && code != JWRN_ADOBE_XFORM && code != JWRN_JFIF_MAJOR) leave(codec);
}

jpeg_error_mgr* install(JpegErrors* errors) {
  jpeg_std_error(&errors->base);
  errors->base.error_exit = leave;
  errors->base.emit_message = on_message;
  return &errors->base;
}

class JpegReader {
 public:
  JpegReader() { codec_.err = install(&errors_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  ~JpegReader() { jpeg_destroy_decompress(&codec_); }

  const char* message() const { return errors_.message; }
  std::size_t width() const { return codec_.image_width; }
  std::size_t height() const { return codec_.image_height; }

  bool read_header(const unsigned char* bytes, std::size_t size) {
    if (setjmp(errors_.jump)) return false;
    jpeg_create_decompress(&codec_);
    jpeg_mem_src(&codec_, bytes, size);
    jpeg_read_header(&codec_, TRUE);
    return true;
  }

  /// Of four inks; libjpeg makes no grey of them.
  bool is_cmyk() const { return codec_.jpeg_color_space == JCS_CMYK || codec_.jpeg_color_space == JCS_YCCK; }

  /// `inks`: of a row, four a pixel; used for CMYK alone.
  bool read_pixels(std::uint8_t* pixels, std::uint8_t* inks) {
    if (setjmp(errors_.jump)) return false;
    codec_.out_color_space = is_cmyk() ? JCS_CMYK : JCS_GRAYSCALE;
    jpeg_start_decompress(&codec_);
    while (codec_.output_scanline < codec_.output_height) {
      JSAMPROW row = pixels + std::size_t(codec_.output_scanline) * codec_.output_width;
      jpeg_read_scanlines(&codec_, is_cmyk() ? &inks : &row, 1);
      if (is_cmyk()) grey_of_inks(inks, row);
    }
    jpeg_finish_decompress(&codec_);
    return true;
  }

 private:
  // Adobe, whose marker tells it, stores what an ink leaves of the light in place of the ink.
  void grey_of_inks(const std::uint8_t* inks, std::uint8_t* row) const {
    for (JDIMENSION x = 0; x < codec_.output_width; ++x, inks += 4) {
      const auto left = [&](int ink) { return codec_.saw_Adobe_marker ? inks[ink] : 255 - inks[ink]; };
      const auto light = [&](int ink) { return (left(ink) * left(3) + 127) / 255; };
      row[x] = grey_of(light(0), light(1), light(2));
    }
  }

  jpeg_decompress_struct codec_{};
  JpegErrors errors_{};
};

// A number of `size` bytes at `at`, the high byte first or last; -1 beyond the end.
long number_at(std::string_view bytes, std::size_t at, std::size_t size, bool high_first) {
  if (at > bytes.size() || bytes.size() - at < size) return -1;
  long value = 0;
  for (std::size_t i = 0; i < size; ++i)
    value = 256 * value + static_cast<unsigned char>(bytes[at + (high_first ? i : size - 1 - i)]);
  return value;
}

// EXIF's TIFF data.
class Tiff {
 public:
  explicit Tiff(std::string_view bytes)
      : bytes_(bytes),
        high_first_(bytes.substr(0, 4) == std::string_view("MM\0*", 4)),
        valid_(high_first_ || bytes.substr(0, 4) == std::string_view("II*\0", 4)) {}

  /// Where the first directory is; -1: nowhere.
  long first_directory() const { return valid_ ? number_at(bytes_, 4, 4, high_first_) : -1; }
  /// The first `size` bytes of a tag's value as a number; -1: the directory has no such tag.
  long value(long directory, long tag, std::size_t size) const {
    if (directory < 0) return -1;
    const auto first = static_cast<std::size_t>(directory);
    const long entries = number_at(bytes_, first, 2, high_first_);
    for (long i = 0; i < entries; ++i) {
      const std::size_t entry = first + 2 + 12 * static_cast<std::size_t>(i);
      if (number_at(bytes_, entry, 2, high_first_) == tag) return number_at(bytes_, entry + 8, size, high_first_);
    }
    return -1;
  }

 private:
  std::string_view bytes_;
  bool high_first_, valid_;
};

// Empty where a JPEG has none.
std::string_view exif_of(std::string_view bytes) {
  constexpr std::string_view kExif("Exif\0\0", 6);
  if (bytes.substr(0, 2) != "\xFF\xD8") return {};
  for (std::size_t at = 2; number_at(bytes, at, 1, true) == 0xFF;) {
    const long kind = number_at(bytes, at + 1, 1, true), length = number_at(bytes, at + 2, 2, true);
    if (length < 2 || kind == 0xDA) break;  // the picture begins
    const std::string_view segment = bytes.substr(at + 4, static_cast<std::size_t>(length - 2));
    if (kind == 0xE1 && segment.substr(0, kExif.size()) == kExif) return segment.substr(kExif.size());
    at += 2 + static_cast<std::size_t>(length);
  }
  return {};
}

class JpegWriter {
 public:
  JpegWriter() { codec_.err = install(&errors_); }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;
  ~JpegWriter() {
    jpeg_destroy_compress(&codec_);
    std::free(buffer_);
  }

  const char* message() const { return errors_.message; }
  std::string bytes() const { return std::string(reinterpret_cast<const char*>(buffer_), size_); }

  bool write(const ImageView8& image, int quality) {
    if (setjmp(errors_.jump)) return false;
    jpeg_create_compress(&codec_);
    jpeg_mem_dest(&codec_, &buffer_, &size_);
    codec_.image_width = static_cast<JDIMENSION>(image.width());
    codec_.image_height = static_cast<JDIMENSION>(image.height());
    codec_.input_components = 1;
    codec_.in_color_space = JCS_GRAYSCALE;
    jpeg_set_defaults(&codec_);
    jpeg_set_quality(&codec_, quality, TRUE);
    jpeg_start_compress(&codec_, TRUE);
    while (codec_.next_scanline < codec_.image_height) {
      JSAMPROW row = const_cast<JSAMPROW>(image.row(static_cast<int>(codec_.next_scanline)));
      jpeg_write_scanlines(&codec_, &row, 1);
    }
    jpeg_finish_compress(&codec_);
    return true;
  }

 private:
  jpeg_compress_struct codec_{};
  JpegErrors errors_{};
  unsigned char* buffer_ = nullptr;
  unsigned long size_ = 0;
};

}  // namespace

Image<std::uint8_t> decode_jpeg(const std::string& bytes, const std::string& path) {
  JpegReader reader;
  const auto fail = [&] { throw InputError(path, 0, std::string("broken JPEG: ") + reader.message()); };
  if (!reader.read_header(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size())) fail();
  check_image_size(reader.width(), reader.height(), path);
  Image<std::uint8_t> image(static_cast<int>(reader.width()), static_cast<int>(reader.height()));
  std::vector<std::uint8_t> inks(reader.is_cmyk() ? 4 * reader.width() : 0);
  if (!reader.read_pixels(image.data(), inks.data())) fail();
  return image;
}

int jpeg_orientation(std::string_view bytes) {
  const Tiff tiff(exif_of(bytes));
  const long value = tiff.value(tiff.first_directory(), 0x0112, 2);
  return value >= 1 && value <= 8 ? static_cast<int>(value) : 1;
}

int jpeg_focal_length_35mm(std::string_view bytes) {
  const Tiff tiff(exif_of(bytes));
  const long value = tiff.value(tiff.value(tiff.first_directory(), 0x8769, 4), 0xA405, 2);
  return value > 0 ? static_cast<int>(value) : 0;
}

std::string encode_jpeg(ImageView8 image, int quality) {
  if (!image.valid() || quality < 1 || quality > 100) throw std::invalid_argument("encode_jpeg: bad image or quality");
  JpegWriter writer;
  if (!writer.write(image, quality)) throw std::runtime_error(std::string("encode_jpeg: ") + writer.message());
  return writer.bytes();
}

}  // namespace textslam
