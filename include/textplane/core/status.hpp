// Status: what every fallible function of the library returns instead of throwing.
#ifndef TEXTPLANE_CORE_STATUS_HPP
#define TEXTPLANE_CORE_STATUS_HPP

#include <cstdint>

#include "textplane/config.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Outcome of a kernel or a solve. The first three come with a usable result, all others with a documented fallback: a
/// solver's input state, zeros for sums.
enum class Status : std::uint8_t {
  ok,                ///< A single evaluation succeeded.
  converged,         ///< An iteration met its step or cost tolerance.
  iteration_limit,   ///< The iteration stopped at its limit; the result is the best state seen.
  too_few,           ///< Fewer visible pixels, points or views than the minimum.
  no_contrast,       ///< The standard deviation of the intensities is (nearly) zero: no normalisation exists.
  behind_camera,     ///< The point, patch or plane lies behind a camera or passes through its centre.
  out_of_view,       ///< The projection falls outside the image.
  rank_deficient,    ///< The linear system does not determine all unknowns.
  degenerate,        ///< The geometry is degenerate: zero area, zero baseline, coincident points.
  non_finite,        ///< A NaN or an infinity in the input or in the result.
  invalid_argument,  ///< Null pointer, negative size, stride below the width, unknown option.
  diverged,          ///< No step lowered the cost although the gradient does not vanish; or what was found is no match.
  unsupported,       ///< This form of the computation cannot take the case; another one can.
};

/// True when the result that comes with `status` may be used.
constexpr bool is_ok(Status status) noexcept {
  return status == Status::ok || status == Status::converged || status == Status::iteration_limit;
}

/// The enumerator's name, never null.
constexpr const char* to_string(Status status) noexcept {
  switch (status) {
    case Status::ok: return "ok";
    case Status::converged: return "converged";
    case Status::iteration_limit: return "iteration_limit";
    case Status::too_few: return "too_few";
    case Status::no_contrast: return "no_contrast";
    case Status::behind_camera: return "behind_camera";
    case Status::out_of_view: return "out_of_view";
    case Status::rank_deficient: return "rank_deficient";
    case Status::degenerate: return "degenerate";
    case Status::non_finite: return "non_finite";
    case Status::invalid_argument: return "invalid_argument";
    case Status::diverged: return "diverged";
    case Status::unsupported: return "unsupported";
  }
  return "unknown";
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_STATUS_HPP
