// One text object in one target image as plain data, for libraries built with other flags: no Eigen type may pass
// between them.
#ifndef TEXTPLANE_BENCH_PROBLEM_HPP
#define TEXTPLANE_BENCH_PROBLEM_HPP

#include <cstddef>
#include <cstdint>

namespace textplane_bench {

/// Names and meanings as in textplane::PhotometricInput; one camera for host and target.
struct Problem {
  const std::uint8_t* target = nullptr;
  int width = 0, height = 0;
  std::ptrdiff_t stride = 0;
  const float *x = nullptr, *y = nullptr, *intensity = nullptr;
  int n = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  double R[9] = {}, t[3] = {};  ///< T_t_h, R row-major.
  double theta[3] = {};
  double delta = 0;  ///< Huber's threshold in units of 1 / sqrt(N).
};

/// H (P x P, row-major) and b of P parameters, of which the first P * P and P are used, and the cost.
struct Equations {
  double H[15 * 15] = {};
  double b[15] = {};
  double cost = 0;
  int visible = 0;
};

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_PROBLEM_HPP
