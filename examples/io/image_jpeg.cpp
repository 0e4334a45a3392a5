// JPEG by libjpeg. Its errors come back by longjmp, which skips destructors: every setjmp below is in a function
// that, like all that it calls, has nothing to destroy. Owners live in the callers.
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

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

  bool read_pixels(std::uint8_t* pixels) {
    if (setjmp(errors_.jump)) return false;
    codec_.out_color_space = JCS_GRAYSCALE;
    jpeg_start_decompress(&codec_);
    while (codec_.output_scanline < codec_.output_height) {
      JSAMPROW row = pixels + std::size_t(codec_.output_scanline) * codec_.output_width;
      jpeg_read_scanlines(&codec_, &row, 1);
    }
    jpeg_finish_decompress(&codec_);
    return true;
  }

 private:
  jpeg_decompress_struct codec_{};
  JpegErrors errors_{};
};

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
  if (!reader.read_pixels(image.data())) fail();
  return image;
}

std::string encode_jpeg(ImageView8 image, int quality) {
  if (!image.valid() || quality < 1 || quality > 100) throw std::invalid_argument("encode_jpeg: bad image or quality");
  JpegWriter writer;
  if (!writer.write(image, quality)) throw std::runtime_error(std::string("encode_jpeg: ") + writer.message());
  return writer.bytes();
}

}  // namespace textslam
