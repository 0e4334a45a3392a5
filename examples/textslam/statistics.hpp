// The order statistics that several steps decide by.
#ifndef TEXTSLAM_STATISTICS_HPP
#define TEXTSLAM_STATISTICS_HPP

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

}  // namespace textslam

#endif  // TEXTSLAM_STATISTICS_HPP
