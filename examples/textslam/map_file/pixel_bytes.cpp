#include "textslam/map_file/pixel_bytes.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace textslam {
namespace {

// In the order of the file. Level is const or not.
template <class Level>
auto arrays_in_order(Level& level) {
  return std::array{&level.x, &level.y, &level.intensity, &level.gx, &level.gy, &level.taken_x, &level.taken_y};
}

void append(float value, std::string* bytes) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  for (int shift = 0; shift < 32; shift += 8) bytes->push_back(static_cast<char>((bits >> shift) & 0xff));
}

float float_at(std::string_view bytes, std::size_t at) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i)
    bits |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace

std::string to_bytes(const textplane::PatchLevel& level) {
  std::string bytes;
  const auto arrays = arrays_in_order(level);
  for (std::size_t k = 0; k < static_cast<std::size_t>(arrays_of(level)); ++k)
    for (const float value : *arrays[k]) append(value, &bytes);
  return bytes;
}

bool from_bytes(std::string_view bytes, int count, textplane::PatchLevel* level) {
  if (count != kPlainArrays && count != kLensArrays) return false;
  const std::size_t row = 4 * static_cast<std::size_t>(count);
  if (bytes.size() % row != 0) return false;
  const std::size_t n = bytes.size() / row;
  const auto arrays = arrays_in_order(*level);
  std::size_t at = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    arrays[k]->resize(n);
    for (float& value : *arrays[k]) {
      value = float_at(bytes, at);
      if (!std::isfinite(value)) return false;
      at += 4;
    }
  }
  level->find_bounds();
  return true;
}

}  // namespace textslam
