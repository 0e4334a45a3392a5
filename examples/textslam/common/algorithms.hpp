// Small algorithms on vectors: order statistics (others are in textplane/core/order.hpp) and removal.
#ifndef TEXTSLAM_COMMON_ALGORITHMS_HPP
#define TEXTSLAM_COMMON_ALGORITHMS_HPP

#include <algorithm>
#include <cstddef>
#include <vector>

#include "textplane/core/order.hpp"

namespace textslam {

using textplane::evenly_spaced;
using textplane::median;

/// The value that `percent` of 100 do not exceed; 0 of nothing.
inline double percentile(std::vector<double> values, std::size_t percent) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, values.size() * percent / 100)];
}

/// As std::erase_if of C++20.
template <class T, class Predicate>
void erase_if(std::vector<T>& values, Predicate predicate) {
  values.erase(std::remove_if(values.begin(), values.end(), predicate), values.end());
}
/// As std::erase of C++20.
template <class T>
void erase(std::vector<T>& values, const T& value) {
  values.erase(std::remove(values.begin(), values.end(), value), values.end());
}

}  // namespace textslam

#endif  // TEXTSLAM_COMMON_ALGORITHMS_HPP
