// Order statistics, and an even choice of what is too much.
#ifndef TEXTPLANE_CORE_ORDER_HPP
#define TEXTPLANE_CORE_ORDER_HPP

#include <algorithm>
#include <cstddef>
#include <vector>

#include "textplane/config.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// The upper median, 0 of nothing; the values change places.
TEXTPLANE_DEFERRED
inline double median_in_place(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}
/// The upper median; 0 of nothing.
TEXTPLANE_DEFERRED
inline double median(std::vector<double> values) { return median_in_place(values); }

/// The standard deviation of each coordinate of errors in two dimensions, by their lengths: the median over that of a
/// Rayleigh distribution. Up to half of them may be outliers. The lengths change places.
TEXTPLANE_DEFERRED
inline double sigma_of_lengths(std::vector<double>& lengths) {
  constexpr double kRayleighMedian = 1.1774100225154747;
  return median_in_place(lengths) / kRayleighMedian;
}

/// At most `count` of the ids, evenly spaced, the first and the last among them.
TEXTPLANE_DEFERRED
inline std::vector<int> evenly_spaced(const std::vector<int>& ids, std::size_t count) {
  if (ids.size() <= count || count < 2) return ids;
  std::vector<int> picked;
  for (std::size_t i = 0; i < count; ++i) picked.push_back(ids[i * (ids.size() - 1) / (count - 1)]);
  return picked;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_ORDER_HPP
