// Order statistics, and an even choice of what is too much.
#ifndef TEXTPLANE_LANDMARKS_ORDER_HPP
#define TEXTPLANE_LANDMARKS_ORDER_HPP

#include <algorithm>
#include <cstddef>
#include <vector>

#include "textplane/config.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// The upper median, 0 of nothing; the values change places.
inline double median_in_place(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}
/// The upper median; 0 of nothing.
inline double median(std::vector<double> values) { return median_in_place(values); }

/// At most `count` of the ids, evenly spaced, the first and the last among them.
inline std::vector<int> evenly_spaced(const std::vector<int>& ids, std::size_t count) {
  if (ids.size() <= count || count < 2) return ids;
  std::vector<int> picked;
  for (std::size_t i = 0; i < count; ++i) picked.push_back(ids[i * (ids.size() - 1) / (count - 1)]);
  return picked;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_ORDER_HPP
