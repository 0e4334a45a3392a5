// The result of a plane fit, and common parts of the fits: weights, normal equations, rank and covariance.
#ifndef TEXTPLANE_GEOMETRY_PLANE_FIT_RESULT_HPP
#define TEXTPLANE_GEOMETRY_PLANE_FIT_RESULT_HPP

#include <cmath>
#include <limits>

#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A fitted plane. `value` holds theta where is_ok(status), the algebraic solution with behind_camera, else zero.
template <class S>
struct PlaneFit {
  using Scalar = S;                       ///< Type of the numbers.
  Vector3<S> value = Vector3<S>::Zero();  ///< theta in the host frame.
  /// Of theta: the inverse of the information sum w J^T J with w = 1 / variance. Without weights (or with relative
  /// ones) multiply it by sigma^2. Zero unless rank is 3.
  Matrix3<S> covariance = Matrix3<S>::Zero();
  int rank = 0;                                   ///< Of the weighted design matrix (0 to 3).
  S condition = (std::numeric_limits<S>::max)();  ///< Its largest over smallest singular value; max() unless rank is 3.
  S sigma = S(0);                                 ///< sqrt(sum w r^2 / degrees of freedom); 0 without redundancy.
  Status status = Status::too_few;                ///< Whether `value` can be used.
};

namespace detail {

/// Normal equations A theta = b of rows that are multiples of m~^T.
template <class W>
struct PlaneSums {
  Matrix3<W> A = Matrix3<W>::Zero();
  Vector3<W> b = Vector3<W>::Zero();

  void add(const Vector3<W>& m, const W& weight, const W& rhs) noexcept {
    const Vector3<W> wm = weight * m;
    A += wm * m.transpose();
    b += rhs * m;
  }
};

/// Eigenvalues below this ratio to the largest are rounding errors, of the input or of the sums.
template <class S>
Wide<S> rank_ratio() noexcept {
  using W = Wide<S>;
  const W input = W(16) * W(std::numeric_limits<S>::epsilon()), sums = W(64) * std::numeric_limits<W>::epsilon();
  return input * input > sums ? input * input : sums;
}

/// Rank and condition of a design matrix from its 3 x 3 normal matrix, for input rounded to S and sums in Wide<S>.
template <class S>
void set_rank(const Matrix3<Wide<S>>& A, PlaneFit<S>* fit) noexcept {
  using std::sqrt;
  using W = Wide<S>;
  const auto e = symmetric_eigen<W, 3>(A);
  const W ratio = rank_ratio<S>();
  fit->rank = 0;
  if (!all_finite(e.values) || !(e.values[2] > W(0))) return;
  for (int i = 0; i < 3; ++i) fit->rank += e.values[i] > ratio * e.values[2] ? 1 : 0;
  if (fit->rank == 3) fit->condition = S(sqrt(e.values[2] / e.values[0]));
}

/// weight[i], or 1; status of the weight in *status.
template <class S>
Wide<S> plane_weight(const S* weight, int i, Status* status) noexcept {
  if (!weight) return Wide<S>(1);
  if (!is_finite(weight[i]))
    *status = Status::non_finite;
  else if (weight[i] < S(0))
    *status = Status::invalid_argument;
  return Wide<S>(weight[i]);
}

/// The covariance scale * information^-1; false where the numbers left the range of S.
template <class S>
bool set_covariance(const Ldlt<Wide<S>, 3>& information, const Wide<S>& scale, PlaneFit<S>* fit) noexcept {
  const Matrix3<Wide<S>> c = information.inverse();
  fit->covariance = ((c + c.transpose()) * (scale / Wide<S>(2))).template cast<S>();
  return all_finite(fit->covariance) && all_finite(fit->value) && is_finite(fit->sigma);
}

/// False for pixels in the place of a normalised point: a ray more than 84 degrees off the axis, which no pinhole sees.
template <class S>
bool plausible_ray(const Vector3<S>& m) noexcept {
  return !(m[0] * m[0] + m[1] * m[1] > S(100) * m[2] * m[2]);
}

template <class S>
PlaneFit<S> with_status(PlaneFit<S> fit, Status status) noexcept {
  fit.status = status;
  return fit;
}
template <class S>
PlaneFit<S> failed_plane(Status status) noexcept {
  return with_status(PlaneFit<S>(), status);
}

}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_GEOMETRY_PLANE_FIT_RESULT_HPP
