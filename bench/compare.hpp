// Options of the benchmarks of normal equations, and the difference of two results.
#ifndef TEXTPLANE_BENCH_COMPARE_HPP
#define TEXTPLANE_BENCH_COMPARE_HPP

#include <algorithm>
#include <cmath>

#include "registry.hpp"
#include "textplane/photometry/residual_request.hpp"
#include "textplane/photometry/residual_result.hpp"

namespace textplane_bench {

namespace tp = textplane;

/// Options that refuse no object, so that small ones are timed too.
inline tp::PhotometricOptions options(bool huber) {
  tp::PhotometricOptions o;
  o.min_visible = 1;
  o.min_contrast = 0;
  if (!huber) o.robust.kind = tp::RobustKind::l2;
  return o;
}

/// Largest difference from the double reference, over sqrt(H_ii H_jj) for H and over sqrt(H_ii) for b.
template <int P>
Errors errors(const tp::NormalEquations<P>& result, const tp::NormalEquations<P>& reference) {
  Errors e{{"error_H", 0}, {"error_b", 0}};
  for (int i = 0; i < P; ++i) {
    const double si = std::sqrt(reference.H(i, i));
    if (!(si > 0)) continue;
    e["error_b"] = std::max(e["error_b"], std::abs(result.b[i] - reference.b[i]) / si);
    for (int j = 0; j < P; ++j) {
      const double sj = std::sqrt(reference.H(j, j));
      if (sj > 0) e["error_H"] = std::max(e["error_H"], std::abs(result.H(i, j) - reference.H(i, j)) / (si * sj));
    }
  }
  return e;
}

/// Raises each error of `to` to that of `from`.
inline void largest(const Errors& from, Errors* to) {
  for (const auto& [key, value] : from) (*to)[key] = std::max((*to)[key], value);
}

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_COMPARE_HPP
