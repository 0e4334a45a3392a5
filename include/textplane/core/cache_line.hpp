// Memory for vector instructions: numbers in whole cache lines.
#ifndef TEXTPLANE_CORE_CACHE_LINE_HPP
#define TEXTPLANE_CORE_CACHE_LINE_HPP

#include <cstddef>
#include <vector>

#include "textplane/config.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// As many numbers as a cache line of 64 bytes holds. A vector of these begins at a line, where one of plain numbers begins at 16
/// bytes: loads of 64 bytes would take two lines each.
template <class T>
struct alignas(64) CacheLine {
  static constexpr std::size_t kSize = 64 / sizeof(T);  ///< Numbers in a line.
  T of[kSize];                                          ///< The numbers.
};

/// Room for `count` numbers, zero, rounded up to lines.
template <class T>
std::vector<CacheLine<T>> cache_lines(std::size_t count) {
  return std::vector<CacheLine<T>>((count + CacheLine<T>::kSize - 1) / CacheLine<T>::kSize);
}

/// Numbers that there is room for.
template <class T>
std::size_t number_count(const std::vector<CacheLine<T>>& lines) noexcept {
  return lines.size() * CacheLine<T>::kSize;
}

/// The first of the numbers.
template <class T>
T* numbers(std::vector<CacheLine<T>>& lines) noexcept {
  return reinterpret_cast<T*>(lines.data());
}
/// \overload
template <class T>
const T* numbers(const std::vector<CacheLine<T>>& lines) noexcept {
  return reinterpret_cast<const T*>(lines.data());
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CACHE_LINE_HPP
