// theta (see plane.hpp) fitted to inverse depths, to matches of two views of known pose, and to points.
//
// The fits solve 3 x 3 systems by Ldlt, report rank, condition and covariance, and divide by no coordinate. float input
// is summed in double. The fits do not handle outliers: run RANSAC around them.
#ifndef TEXTPLANE_GEOMETRY_PLANE_FIT_HPP
#define TEXTPLANE_GEOMETRY_PLANE_FIT_HPP

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "textplane/core/numeric.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/geometry/plane_fit_result.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// theta from n >= 3 inverse depths: weighted least squares of m~_i^T theta = rho_i (docs/equations.md).
///
/// m: homogeneous normalised points (third entry 1); rho: their inverse depths; weight: 1 / variance of each rho, or
/// null for ones; a weight of 0 leaves its row out. Degrees of freedom of sigma: n - 3. Status: too_few (n < 3, rank
/// still reported), rank_deficient (collinear or coincident points), behind_camera (the solution has rho <= 0 at one of
/// the points), non_finite, invalid_argument (null pointer, negative n or weight, a ray more than 84 degrees off the
/// axis: pixels in the place of m~ = camera.unproject(pixel)).
template <class S>
PlaneFit<S> plane_from_inverse_depths(const Vector3<S>* m, const S* rho, const typename PlaneFit<S>::Scalar* weight,
                                      int n) noexcept {
  using std::sqrt;
  using W = detail::Wide<S>;
  if (n < 0 || (n > 0 && (!m || !rho))) return detail::failed_plane<S>(Status::invalid_argument);
  detail::PlaneSums<W> sums;
  int used = 0;
  for (int i = 0; i < n; ++i) {
    Status status = Status::ok;
    const W w = detail::plane_weight(weight, i, &status);
    if (!all_finite(m[i]) || !is_finite(rho[i])) status = Status::non_finite;
    if (status == Status::ok && !detail::plausible_ray(m[i])) status = Status::invalid_argument;
    if (status != Status::ok) return detail::failed_plane<S>(status);
    sums.add(m[i].template cast<W>(), w, w * W(rho[i]));
    used += w > W(0) ? 1 : 0;
  }
  PlaneFit<S> fit;
  detail::set_rank(sums.A, &fit);
  if (used < 3) return fit;
  const Ldlt<W, 3> ldlt(sums.A);
  if (fit.rank != 3 || !ldlt.ok()) return detail::with_status(fit, Status::rank_deficient);
  Vector3<W> theta = ldlt.solve(sums.b);
  // One step of refinement on the residuals brings the normal equations to the accuracy of an orthogonal factorisation.
  Vector3<W> correction = Vector3<W>::Zero();
  for (int i = 0; i < n; ++i) {
    const Vector3<W> mi = m[i].template cast<W>();
    correction += (weight ? W(weight[i]) : W(1)) * (W(rho[i]) - mi.dot(theta)) * mi;
  }
  theta += ldlt.solve(correction);
  W chi2 = W(0);
  fit.status = Status::ok;
  for (int i = 0; i < n; ++i) {
    const W fitted = theta.dot(m[i].template cast<W>()), r = W(rho[i]) - fitted, w = weight ? W(weight[i]) : W(1);
    chi2 += w * r * r;
    if (w > W(0) && !(fitted > W(0))) fit.status = Status::behind_camera;
  }
  fit.value = theta.template cast<S>();
  if (used > 3 && chi2 > W(0)) fit.sigma = S(sqrt(chi2 / W(used - 3)));
  if (!detail::set_covariance(ldlt, W(1), &fit)) return detail::failed_plane<S>(Status::non_finite);
  return fit;
}

namespace detail {

/// A Gauss-Newton step of plane_from_matches(): normal equations of theta's increment, chi^2 and the largest squared
/// parallax.
template <class W>
struct MatchSystem {
  PlaneSums<W> sums;
  W chi2 = W(0), parallax = W(0);
};

/// Sums the reprojection errors in the target at `theta`. False where a match is not in front of both cameras.
template <class S, class W>
bool match_system(const Vector3<S>* host_m, const Vector3<S>* target_m, const S* weight, int n, const SE3<W>& T,
                  const Vector3<W>& theta, MatchSystem<W>* system) noexcept {
  if (!all_finite(theta)) return false;
  for (int i = 0; i < n; ++i) {
    const W w = weight ? W(weight[i]) : W(1);
    if (w == W(0)) continue;
    const Vector3<W> m = host_m[i].template cast<W>(), mt = target_m[i].template cast<W>();
    const W rho = theta.dot(m);
    const Vector3<W> q = T.R * m + rho * T.t;
    if (!(rho > W(0) && q[2] > W(0))) return false;
    const W u = q[0] / q[2], v = q[1] / q[2], eu = u - mt[0], ev = v - mt[1];
    const W du = (T.t[0] - u * T.t[2]) / q[2], dv = (T.t[1] - v * T.t[2]) / q[2];  // d (u, v) / d rho
    system->sums.add(m, w * (du * du + dv * dv), -w * (du * eu + dv * ev));
    system->chi2 += w * (eu * eu + ev * ev);
    const W shift = (du * du + dv * dv) * rho * rho;
    if (shift > system->parallax) system->parallax = shift;
  }
  return true;
}

/// Up to three Gauss-Newton steps. *theta and *best end at the lowest error; behind_camera where the start is invalid.
template <class S, class W>
Status refine_matches(const Vector3<S>* host_m, const Vector3<S>* target_m, const S* weight, int n, const SE3<W>& T,
                      W weight_sum, Vector3<W>* theta, MatchSystem<W>* best) noexcept {
  const W epsilon = std::numeric_limits<W>::epsilon(), rounding = weight_sum * (W(64) * epsilon) * (W(64) * epsilon);
  Vector3<W> previous = *theta;
  for (int step = 0;; ++step) {
    MatchSystem<W> trial;
    const bool in_front = match_system(host_m, target_m, weight, n, T, *theta, &trial);
    const bool better = in_front && is_finite(trial.chi2) && (step == 0 || trial.chi2 <= best->chi2 + rounding);
    if (!better) {
      *theta = previous;
      return step > 0 ? Status::ok : Status::behind_camera;
    }
    *best = trial;
    const Ldlt<W, 3> ldlt(best->sums.A);
    if (step == 3 || !ldlt.ok()) return Status::ok;
    previous = *theta;
    *theta += ldlt.solve(best->sums.b);
  }
}

}  // namespace detail

/// theta from n >= 3 matches between two views of known relative pose (paper, eq. 5; docs/equations.md).
///
/// The start solves the linear system [m'_i]x t m~_i^T theta = -[m'_i]x R m~_i. Up to three Gauss-Newton steps on the
/// target's reprojection error then give the maximum-likelihood estimate for isotropic noise on the target points.
/// host_m, target_m: homogeneous normalised points (third entry 1); T_t_h: host to target; weight: 1 / variance of one
/// normalised target coordinate, or null for ones; 0 leaves its match out. `rank` and `condition` describe the
/// linear system; degrees of freedom of sigma: 2 n - 3. Status: too_few, rank_deficient (collinear), degenerate (no
/// baseline, or parallax below the rounding error, as after a pure rotation), behind_camera (a match ends behind a
/// camera), non_finite, invalid_argument (also for a ray more than 84 degrees off the axis, as pixels would be).
template <class S>
PlaneFit<S> plane_from_matches(const Vector3<S>* host_m, const Vector3<S>* target_m, int n, const SE3<S>& T_t_h,
                               const typename PlaneFit<S>::Scalar* weight = nullptr) noexcept {
  using std::sqrt;
  using W = detail::Wide<S>;
  if (n < 0 || (n > 0 && (!host_m || !target_m))) return detail::failed_plane<S>(Status::invalid_argument);
  if (!all_finite(T_t_h)) return detail::failed_plane<S>(Status::non_finite);
  const SE3<W> T = T_t_h.template cast<W>();
  detail::PlaneSums<W> linear;
  W weight_sum = W(0);
  int used = 0;
  for (int i = 0; i < n; ++i) {
    Status status = Status::ok;
    const W w = detail::plane_weight(weight, i, &status);
    if (!all_finite(host_m[i]) || !all_finite(target_m[i])) status = Status::non_finite;
    if (status == Status::ok && !(detail::plausible_ray(host_m[i]) && detail::plausible_ray(target_m[i])))
      status = Status::invalid_argument;
    if (status != Status::ok) return detail::failed_plane<S>(status);
    const Vector3<W> m = host_m[i].template cast<W>(), mt = target_m[i].template cast<W>(), Rm = T.R * m;
    const Vector3<W> e = mt.cross(T.t);
    linear.add(m, w * e.squaredNorm(), -w * e.dot(mt.cross(Rm)));
    weight_sum += w;
    used += w > W(0) ? 1 : 0;
  }
  PlaneFit<S> fit;
  detail::set_rank(linear.A, &fit);
  if (used < 3) return fit;
  if (fit.rank == 0) return detail::with_status(fit, Status::degenerate);
  const Ldlt<W, 3> start(linear.A);
  if (fit.rank != 3 || !start.ok()) return detail::with_status(fit, Status::rank_deficient);

  Vector3<W> theta = start.solve(linear.b);
  detail::MatchSystem<W> system;
  fit.status = detail::refine_matches(host_m, target_m, weight, n, T, weight_sum, &theta, &system);
  if (!all_finite(theta)) return detail::failed_plane<S>(Status::non_finite);
  fit.value = theta.template cast<S>();
  if (fit.status != Status::ok) return fit;
  const W smallest = W(64) * W(std::numeric_limits<S>::epsilon());
  const Ldlt<W, 3> ldlt(system.sums.A);
  if (!(system.parallax > smallest * smallest))
    fit.status = Status::degenerate;
  else if (!ldlt.ok())
    fit.status = Status::rank_deficient;
  if (fit.status != Status::ok) {
    fit.value.setZero();
    return fit;
  }
  if (system.chi2 > W(0)) fit.sigma = S(sqrt(system.chi2 / W(2 * used - 3)));
  if (!detail::set_covariance(ldlt, W(1), &fit)) return detail::failed_plane<S>(Status::non_finite);
  return fit;
}

/// theta of n >= 3 points of the host frame by total least squares: the plane that minimises the weighted sum of
/// squared distances. weight: 1 / variance of a point along each axis (isotropic), or null for ones; 0 leaves its point
/// out.
///
/// covariance to first order: |theta|^2 (sum w p p^T)^-1. Degrees of freedom of sigma (a length): n - 3. Status:
/// too_few, rank_deficient (collinear or coincident), behind_camera (the plane passes through the camera centre),
/// non_finite, invalid_argument.
template <class S>
PlaneFit<S> plane_from_points(const Vector3<S>* p, int n,
                              const typename PlaneFit<S>::Scalar* weight = nullptr) noexcept {
  using std::sqrt;
  using W = detail::Wide<S>;
  if (n < 0 || (n > 0 && !p)) return detail::failed_plane<S>(Status::invalid_argument);
  detail::PlaneSums<W> sums;
  W weight_sum = W(0);
  int used = 0;
  for (int i = 0; i < n; ++i) {
    Status status = Status::ok;
    const W w = detail::plane_weight(weight, i, &status);
    if (!all_finite(p[i])) status = Status::non_finite;
    if (status != Status::ok) return detail::failed_plane<S>(status);
    sums.add(p[i].template cast<W>(), w, w);
    weight_sum += w;
    used += w > W(0) ? 1 : 0;
  }
  PlaneFit<S> fit;
  detail::set_rank(sums.A, &fit);
  if (used < 3) return fit;
  const Vector3<W> centre = sums.b / weight_sum;
  Matrix3<W> scatter = Matrix3<W>::Zero();
  for (int i = 0; i < n; ++i) {
    const Vector3<W> r = p[i].template cast<W>() - centre;
    scatter += (weight ? W(weight[i]) : W(1)) * r * r.transpose();
  }
  const auto e = symmetric_eigen<W, 3>(scatter);
  const Ldlt<W, 3> ldlt(sums.A);
  const W rounding = detail::rank_ratio<S>() * sums.A.trace();  // of the coordinates, not of their differences
  if (!(e.values[1] > rounding)) {
    fit.rank = (std::min)(fit.rank, 2);
    fit.condition = (std::numeric_limits<S>::max)();
    return detail::with_status(fit, Status::rank_deficient);
  }
  if (fit.rank != 3 || !ldlt.ok()) return detail::with_status(fit, Status::behind_camera);
  const Vector3<W> normal = e.vectors.col(0);
  const W distance = normal.dot(centre);
  if (distance == W(0)) return detail::with_status(fit, Status::behind_camera);
  const Vector3<W> theta = normal / distance;
  if (!all_finite(theta)) return detail::with_status(fit, Status::behind_camera);
  W chi2 = W(0);
  for (int i = 0; i < n; ++i) {
    const W r = normal.dot(p[i].template cast<W>() - centre);
    chi2 += (weight ? W(weight[i]) : W(1)) * r * r;
  }
  fit.value = theta.template cast<S>();
  if (used > 3 && chi2 > W(0)) fit.sigma = S(sqrt(chi2 / W(used - 3)));
  if (!detail::set_covariance(ldlt, theta.squaredNorm(), &fit)) return detail::failed_plane<S>(Status::non_finite);
  fit.status = Status::ok;
  return fit;
}

namespace detail {
/// Scalar of a container of Vector3: anything with data() and size().
template <class Points>
using PointScalar = typename std::decay_t<decltype(*std::declval<const Points&>().data())>::Scalar;
}  // namespace detail

/// The three fits of containers, without weights. Containers of different sizes give invalid_argument.
template <class Points, class Depths, class S = detail::PointScalar<Points>>
PlaneFit<S> plane_from_inverse_depths(const Points& m, const Depths& rho) noexcept {
  if (m.size() != rho.size()) return detail::failed_plane<S>(Status::invalid_argument);
  return plane_from_inverse_depths<S>(m.data(), rho.data(), nullptr, static_cast<int>(m.size()));
}
/// \overload
template <class HostPoints, class TargetPoints, class Pose, class S = detail::PointScalar<HostPoints>>
PlaneFit<S> plane_from_matches(const HostPoints& host_m, const TargetPoints& target_m, const Pose& T_t_h) noexcept {
  if (host_m.size() != target_m.size()) return detail::failed_plane<S>(Status::invalid_argument);
  return plane_from_matches<S>(host_m.data(), target_m.data(), static_cast<int>(host_m.size()), to_se3(T_t_h));
}
/// \overload
template <class Points, class S = detail::PointScalar<Points>>
PlaneFit<S> plane_from_points(const Points& p) noexcept {
  return plane_from_points<S>(p.data(), static_cast<int>(p.size()));
}

TEXTPLANE_INSTANCE(PlaneFit<double> plane_from_matches<double>(const Vector3<double>*, const Vector3<double>*, int,
                                                               const SE3<double>&, const double*) noexcept);
TEXTPLANE_INSTANCE(PlaneFit<double> plane_from_points<double>(const Vector3<double>*, int, const double*) noexcept);

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_GEOMETRY_PLANE_FIT_HPP
