// PGM and PPM, plain (P2, P3) and raw (P5, P6), with up to 16 bits a sample.
#include <string_view>

#include "io/image_codecs.hpp"
#include "io/input_error.hpp"

namespace textslam {

namespace {

class PnmReader {
 public:
  PnmReader(const std::string& bytes, const std::string& path) : rest_(bytes), path_(path) { rest_.remove_prefix(2); }

  // A decimal number after blanks and comments. `limit` keeps it far from overflow.
  int number(int limit) {
    skip_blanks();
    if (rest_.empty()) throw InputError(path_, 0, "broken PGM/PPM: the file ends too early");
    if (!is_digit(rest_.front())) throw InputError(path_, 0, "broken PGM/PPM: expected a number");
    int value = 0;
    for (; !rest_.empty() && is_digit(rest_.front()); rest_.remove_prefix(1)) {
      value = 10 * value + (rest_.front() - '0');
      if (value > limit) throw InputError(path_, 0, "broken PGM/PPM: a number exceeds " + std::to_string(limit));
    }
    return value;
  }

  // The one blank between header and raw samples.
  void end_header() {
    if (rest_.empty() || !is_blank(rest_.front())) throw InputError(path_, 0, "broken PGM/PPM: bad header");
    rest_.remove_prefix(1);
  }

  void require(std::size_t bytes) const {
    if (rest_.size() < bytes) throw InputError(path_, 0, "broken PGM/PPM: the file ends too early");
  }
  int byte() {
    const int value = static_cast<unsigned char>(rest_.front());
    rest_.remove_prefix(1);
    return value;
  }

 private:
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  void skip_blanks() {
    while (!rest_.empty() && (is_blank(rest_.front()) || rest_.front() == '#')) {
      const std::size_t n = rest_.front() == '#' ? rest_.find('\n') : 1;
      rest_.remove_prefix(n == std::string_view::npos ? rest_.size() : n);
    }
  }

  std::string_view rest_;
  const std::string& path_;
};

}  // namespace

Image<std::uint8_t> decode_pnm(const std::string& bytes, const std::string& path) {
  constexpr int kAnySide = 99999999;
  const bool is_raw = bytes[1] == '5' || bytes[1] == '6', is_colour = bytes[1] == '3' || bytes[1] == '6';
  PnmReader reader(bytes, path);
  const int width = reader.number(kAnySide), height = reader.number(kAnySide), full = reader.number(65535);
  check_image_size(static_cast<std::size_t>(width), static_cast<std::size_t>(height), path);
  if (full == 0) throw InputError(path, 0, "broken PGM/PPM: the largest sample is 0");
  const std::size_t samples = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * (is_colour ? 3 : 1);
  if (is_raw) reader.end_header();
  reader.require(is_raw ? samples * (full > 255 ? 2 : 1) : samples);

  const auto sample = [&] {
    int value = is_raw ? reader.byte() : reader.number(full);
    if (is_raw && full > 255) value = 256 * value + reader.byte();
    if (value > full) throw InputError(path, 0, "broken PGM/PPM: a sample exceeds " + std::to_string(full));
    return full == 255 ? value : (value * 255 + full / 2) / full;
  };
  Image<std::uint8_t> image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int r = sample();
      const int g = is_colour ? sample() : r;
      const int b = is_colour ? sample() : r;
      image(x, y) = is_colour ? grey_of(r, g, b) : static_cast<std::uint8_t>(r);
    }
  }
  return image;
}

}  // namespace textslam
