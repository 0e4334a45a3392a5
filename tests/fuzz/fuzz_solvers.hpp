// What every solver promises of any input, checked by the fuzzers that call it.
#ifndef TEXTPLANE_TESTS_FUZZ_FUZZ_SOLVERS_HPP
#define TEXTPLANE_TESTS_FUZZ_FUZZ_SOLVERS_HPP

#include <cmath>

#include "fuzz.hpp"
#include "textplane/solver/pose.hpp"
#include "textplane/solver/window.hpp"

namespace textplane_fuzz {

/// Of refine_pose() from `start`.
inline void check_pose(const tp::PoseFit& fit, const tp::SE3d& start) {
  TEXTPLANE_FUZZ_REQUIRE(!tp::all_finite(start) || tp::all_finite(fit.T_t_w));
  if (tp::is_ok(fit.status))
    TEXTPLANE_FUZZ_REQUIRE(tp::all_finite(fit.T_t_w) && tp::is_finite(fit.cost) && fit.cost >= 0 &&
                           std::abs(fit.zncc) <= 1.0001);
}

/// Of solve_window() on `w` as it is now; `poses_finite`: all poses were, before.
inline void check_window(const tp::WindowSummary& summary, const tp::Window& w, bool poses_finite) {
  TEXTPLANE_FUZZ_REQUIRE(!std::isnan(summary.final_cost) || !tp::is_ok(summary.status));
  for (const tp::WindowFrame& frame : w.frames) {
    TEXTPLANE_FUZZ_REQUIRE(!poses_finite || tp::all_finite(frame.T_w_c));
    TEXTPLANE_FUZZ_REQUIRE(!tp::is_ok(summary.status) || tp::all_finite(frame.velocity));
  }
  if (tp::is_ok(summary.status) && w.texts.empty())
    TEXTPLANE_FUZZ_REQUIRE(summary.final_cost <= summary.initial_cost * (1 + 1e-9));
}

}  // namespace textplane_fuzz

#endif  // TEXTPLANE_TESTS_FUZZ_FUZZ_SOLVERS_HPP
