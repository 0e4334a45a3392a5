// Small algorithms on vectors: order statistics, an even choice of what is too much, removal.
#ifndef TEXTSLAM_COMMON_ALGORITHMS_HPP
#define TEXTSLAM_COMMON_ALGORITHMS_HPP

#include <algorithm>
#include <cstddef>
#include <vector>

namespace textslam {

/// The upper median; 0 of nothing.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The value that 95 of 100 do not exceed; 0 of nothing.
inline double percentile95(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, values.size() * 95 / 100)];
}

/// At most `count` of the ids, evenly spaced, the first and the last among them.
inline std::vector<int> evenly_spaced(const std::vector<int>& ids, std::size_t count) {
  if (ids.size() <= count || count < 2) return ids;
  std::vector<int> picked;
  for (std::size_t i = 0; i < count; ++i) picked.push_back(ids[i * (ids.size() - 1) / (count - 1)]);
  return picked;
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
