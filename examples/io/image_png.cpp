// PNG by libpng. Its errors come back by longjmp, which skips destructors: every setjmp below is in a function
// that, like all that it calls, has nothing to destroy. Owners live in the callers.
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <vector>

#include <png.h>
#include <zlib.h>

#include "io/image_codecs.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"

namespace textslam {

namespace {

struct PngErrors {
  std::jmp_buf jump;
  char message[200];
};

[[noreturn]] void leave(png_structp png, png_const_charp message) {
  auto* errors = static_cast<PngErrors*>(png_get_error_ptr(png));
  std::snprintf(errors->message, sizeof errors->message, "%s", message);
  std::longjmp(errors->jump, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

struct PngSource {
  const unsigned char* bytes;
  std::size_t left;
};

void read_bytes(png_structp png, png_bytep out, std::size_t n) {
  auto* source = static_cast<PngSource*>(png_get_io_ptr(png));
  if (n > source->left) png_error(png, "the file ends too early");
  std::memcpy(out, source->bytes, n);
  source->bytes += n;
  source->left -= n;
}

class PngReader {
 public:
  explicit PngReader(const std::string& bytes)
      : source_{reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()},
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &errors_, leave, ignore_warning)),
        info_(png_ ? png_create_info_struct(png_) : nullptr) {}
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  const char* message() const { return errors_.message; }
  std::size_t width() const { return png_get_image_width(png_, info_); }
  std::size_t height() const { return png_get_image_height(png_, info_); }
  std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }
  int channels() const { return png_get_channels(png_, info_); }

  // After it, channels() is 1 or 3, of 8 bits each.
  bool read_header() {
    if (!png_ || !info_) return false;
    if (setjmp(errors_.jump)) return false;
    png_set_read_fn(png_, &source_, read_bytes);
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // check_image_size() has the clearer message
    png_read_info(png_, info_);
    png_set_scale_16(png_);
    png_set_expand(png_);
    png_set_strip_alpha(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }

  bool read_rows(png_bytepp rows) {
    if (setjmp(errors_.jump)) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

 private:
  PngErrors errors_{};
  PngSource source_;
  png_structp png_;
  png_infop info_;
};

struct PngTarget {
  char* bytes;
  std::size_t left, size;
};

void write_bytes(png_structp png, png_bytep from, std::size_t n) {
  auto* target = static_cast<PngTarget*>(png_get_io_ptr(png));
  if (n > target->left) png_error(png, "larger than an image can be");
  std::memcpy(target->bytes + target->size, from, n);
  target->size += n;
  target->left -= n;
}

void flush_nothing(png_structp) {}

class PngWriter {
 public:
  explicit PngWriter(std::string* bytes)
      : target_{&(*bytes)[0], bytes->size(), 0},
        png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &errors_, leave, ignore_warning)),
        info_(png_ ? png_create_info_struct(png_) : nullptr) {}
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }

  const char* message() const { return errors_.message; }
  std::size_t size() const { return target_.size; }

  // A camera's noise repeats nothing: to look for longer matches takes five times as long and saves no byte.
  bool write(const ImageView8& image) {
    if (!png_ || !info_) return false;
    if (setjmp(errors_.jump)) return false;
    png_set_write_fn(png_, &target_, write_bytes, flush_nothing);
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(image.width()), static_cast<png_uint_32>(image.height()), 8,
                 PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_strategy(png_, Z_RLE);
    png_write_info(png_, info_);
    for (int y = 0; y < image.height(); ++y) png_write_row(png_, image.row(y));
    png_write_end(png_, nullptr);
    return true;
  }

 private:
  PngErrors errors_{};
  PngTarget target_;
  png_structp png_;
  png_infop info_;
};

}  // namespace

Image<std::uint8_t> decode_png(const std::string& bytes, const std::string& path) {
  PngReader reader(bytes);
  const auto fail = [&] { throw InputError(path, 0, std::string("broken PNG: ") + reader.message()); };
  if (!reader.read_header()) fail();
  const std::size_t width = reader.width(), height = reader.height(), row_bytes = reader.row_bytes();
  check_image_size(width, height, path);
  std::vector<unsigned char> samples(row_bytes * height);
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y) rows[y] = samples.data() + y * row_bytes;
  if (!reader.read_rows(rows.data())) fail();

  Image<std::uint8_t> image(static_cast<int>(width), static_cast<int>(height));
  const bool is_colour = reader.channels() == 3;
  for (std::size_t y = 0; y < height; ++y) {
    std::uint8_t* out = image.row(static_cast<int>(y));
    if (is_colour) {
      for (std::size_t x = 0; x < width; ++x) out[x] = grey_of(rows[y][3 * x], rows[y][3 * x + 1], rows[y][3 * x + 2]);
    } else {
      std::memcpy(out, rows[y], width);
    }
  }
  return image;
}

std::string encode_png(ImageView8 image) {
  if (!image.valid()) throw std::invalid_argument("encode_png: bad image");
  png_image bound{};  // for its size alone
  bound.width = static_cast<png_uint_32>(image.width());
  bound.height = static_cast<png_uint_32>(image.height());
  bound.format = PNG_FORMAT_GRAY;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(bound), '\0');
  PngWriter writer(&bytes);
  if (!writer.write(image)) throw std::runtime_error(std::string("encode_png: ") + writer.message());
  bytes.resize(writer.size());
  return bytes;
}

}  // namespace textslam
