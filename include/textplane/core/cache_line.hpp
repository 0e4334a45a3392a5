// Arrays of numbers that begin at a cache line, for vector instructions.
#ifndef TEXTPLANE_CORE_CACHE_LINE_HPP
#define TEXTPLANE_CORE_CACHE_LINE_HPP

#include <cstddef>
#include <vector>

#include "textplane/config.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// The numbers of a cache line of 64 bytes. A std::vector of lines begins at a line. A vector of plain numbers is only
/// aligned to 16 bytes: a load of 64 bytes would touch two lines.
template <class T>
struct alignas(64) CacheLine {
  static constexpr std::size_t kSize = 64 / sizeof(T);  ///< Numbers in a line.
  T of[kSize];                                          ///< The numbers.
};

/// `count` zeros, rounded up to whole lines.
template <class T>
std::vector<CacheLine<T>> cache_lines(std::size_t count) {
  return std::vector<CacheLine<T>>((count + CacheLine<T>::kSize - 1) / CacheLine<T>::kSize);
}

/// Number of numbers in the lines.
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
