#include "io/data_uri.hpp"

#include <cstddef>

namespace textslam {

std::string jpeg_uri(std::string_view jpeg) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out = "data:image/jpeg;base64,";
  out.reserve(out.size() + (jpeg.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < jpeg.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < jpeg.size() ? static_cast<unsigned char>(jpeg[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > jpeg.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
  }
  return out;
}

}  // namespace textslam
