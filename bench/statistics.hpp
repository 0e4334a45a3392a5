// The least and the median of repeated measurements.
#ifndef TEXTPLANE_BENCH_STATISTICS_HPP
#define TEXTPLANE_BENCH_STATISTICS_HPP

#include <algorithm>
#include <vector>

namespace textplane_bench {

inline double least(const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()); }

inline double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return 0.5 * (v[(v.size() - 1) / 2] + v[v.size() / 2]);
}

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_STATISTICS_HPP
