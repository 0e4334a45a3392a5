// Robust costs as functions of the squared residual. simd/kernels/robust.inl has them as vectors.
#ifndef TEXTPLANE_CORE_ROBUST_HPP
#define TEXTPLANE_CORE_ROBUST_HPP

#include <cmath>
#include <cstdint>

#include "textplane/core/numeric.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// The shape of a robust cost: see Robust.
enum class RobustKind : std::uint8_t { l2, huber, cauchy, tukey };

/// True where all pixels have weights other than 1: L2 has none, and Huber's cost for outliers alone.
constexpr bool weighs_all(RobustKind kind) noexcept { return kind != RobustKind::l2 && kind != RobustKind::huber; }

/// A robust cost rho(r^2) that is r^2 near zero, and its derivative, the weight of iteratively re-weighted least
/// squares.
///
/// With d = delta, in the unit of the residual r, and r2 = r^2 >= 0:
///   l2      rho = r2                                           weight = 1
///   huber   rho = r2 for |r| <= d, else 2 d |r| - d^2          weight = min(1, d / |r|);   rho = w r2 (2 - w)
///   cauchy  rho = d^2 log(1 + r2 / d^2)                        weight = 1 / (1 + r2 / d^2)
///   tukey   rho = d^2 / 3 (1 - (1 - r2 / d^2)^3), else d^2/3   weight = (1 - r2 / d^2)^2, 0 for |r| > d
struct Robust {
  RobustKind kind = RobustKind::huber;  ///< Which cost.
  double delta = 1.0;                   ///< Where it leaves the quadratic, in the unit of |r|.

  /// A known kind with a delta in [1e-100, 1e100], so that its square and ratios to it are numbers (l2 ignores it).
  bool valid() const noexcept {
    if (kind == RobustKind::l2) return true;
    return (kind == RobustKind::huber || kind == RobustKind::cauchy || kind == RobustKind::tukey) && is_finite(delta) &&
           delta >= 1e-100 && delta <= 1e100;
  }

  /// The cost of the squared residual r2.
  double rho(double r2) const noexcept {
    const double d2 = delta * delta;
    switch (kind) {
      case RobustKind::l2: return r2;
      case RobustKind::huber: return r2 <= d2 ? r2 : 2.0 * delta * std::sqrt(r2) - d2;
      case RobustKind::cauchy: return d2 * std::log1p(r2 / d2);
      case RobustKind::tukey: {
        if (r2 >= d2) return d2 / 3.0;
        const double u = r2 / d2;  // multiplied out: the form above cancels near zero
        return r2 * (1.0 - u + u * u / 3.0);
      }
    }
    return r2;
  }

  /// d rho / d r2, in [0, 1].
  double weight(double r2) const noexcept {
    const double d2 = delta * delta;
    switch (kind) {
      case RobustKind::l2: return 1.0;
      case RobustKind::huber: return r2 <= d2 ? 1.0 : delta / std::sqrt(r2);
      case RobustKind::cauchy: return 1.0 / (1.0 + r2 / d2);
      case RobustKind::tukey: {
        if (r2 >= d2) return 0.0;
        const double u = 1.0 - r2 / d2;
        return u * u;
      }
    }
    return 1.0;
  }

  /// d weight / d r2, at most 0: with rho and weight what a loss function of Ceres returns.
  double curvature(double r2) const noexcept {
    const double d2 = delta * delta, w = weight(r2);
    switch (kind) {
      case RobustKind::l2: return 0.0;
      case RobustKind::huber: return r2 <= d2 ? 0.0 : -0.5 * w / r2;
      case RobustKind::cauchy: return -w * w / d2;
      case RobustKind::tukey: return r2 >= d2 ? 0.0 : -2.0 * (1.0 - r2 / d2) / d2;
    }
    return 0.0;
  }
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_ROBUST_HPP
