// SE3: rigid motions, their exponential and logarithm, and the adjoint.
//
// Convention of the whole library: T_a_b maps points of frame b to frame a; a perturbation xi = (v, omega), translation
// first, acts from the left, T <- Exp(xi) T. Everything is templated on the scalar (float, double, dual numbers).
#ifndef TEXTPLANE_CORE_SE3_HPP
#define TEXTPLANE_CORE_SE3_HPP

#include <cmath>
#include <type_traits>
#include <utility>

#include "textplane/core/numeric.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Skew-symmetric matrix [w]x with [w]x p = w x p.
template <class S>
Matrix3<S> hat(const Vector3<S>& w) noexcept {
  Matrix3<S> m;
  m << S(0), -w[2], w[1], w[2], S(0), -w[0], -w[1], w[0], S(0);
  return m;
}

/// A rigid motion p -> R p + t. An aggregate without alignment requirements: any container may hold it.
template <class S>
struct SE3 {
  static_assert(!std::is_integral<S>::value, "textplane: a pose of integers; use float, double or a dual number");

  Matrix3<S> R = Matrix3<S>::Identity();  ///< Rotation: source to destination frame.
  Vector3<S> t = Vector3<S>::Zero();      ///< Translation: the source's origin in the destination frame.

  /// A point of the source frame in the destination frame.
  Vector3<S> operator*(const Vector3<S>& p) const noexcept { return product(R, p) + t; }
  /// First `b`, then this: T_a_b T_b_c = T_a_c.
  SE3 operator*(const SE3& b) const noexcept { return {product(R, b.R), product(R, b.t) + t}; }
  SE3 inverse() const noexcept { return {transposed(R), -transposed_product(R, t)}; }  ///< Destination to source.

  /// The same of another scalar.
  template <class U>
  SE3<U> cast() const noexcept {
    return {R.template cast<U>(), t.template cast<U>()};
  }
};
using SE3d = SE3<double>;  ///< In double.
using SE3f = SE3<float>;   ///< In float.

/// Whether no entry of R and t is infinite or NaN.
template <class S>
bool all_finite(const SE3<S>& T) noexcept {
  return all_finite(T.R) && all_finite(T.t);
}

namespace detail {
// sin(x)/x, (1 - cos x)/x^2, (x - sin x)/x^3 as functions of x^2. The series cover the range where the quotients lose
// digits, and keep dual numbers differentiable at zero.
template <class S>
struct ExpCoefficients {
  S a, b, c;
};
template <class S>
ExpCoefficients<S> exp_coefficients(const S& x2) noexcept {
  using std::cos;
  using std::sin;
  using std::sqrt;
  if (x2 < S(0.25)) {
    S a = S(1), b = S(1), c = S(1);
    for (int k = 8; k >= 1; --k) {
      a = S(1) - x2 * a / S(2 * k * (2 * k + 1));
      b = S(1) - x2 * b / S((2 * k + 1) * (2 * k + 2));
      c = S(1) - x2 * c / S((2 * k + 2) * (2 * k + 3));
    }
    return {a, b / S(2), c / S(6)};
  }
  const S x = sqrt(x2), s = sin(x), co = cos(x);
  return {s / x, (S(1) - co) / x2, (x - s) / (x2 * x)};
}
}  // namespace detail

/// Rotation matrix of the rotation vector w: I + a [w]x + b [w]x^2 (Rodrigues).
template <class S>
Matrix3<S> so3_exp(const Vector3<S>& w) noexcept {
  const auto k = detail::exp_coefficients<S>(w.squaredNorm());
  const Matrix3<S> W = hat(w);
  return Matrix3<S>::Identity() + k.a * W + k.b * product(W, W);
}

/// Rotation vector of R, of length at most pi. R must be orthonormal with determinant 1. Near pi the sign of the axis
/// is arbitrary; everywhere else so3_exp(so3_log(R)) = R.
template <class S>
Vector3<S> so3_log(const Matrix3<S>& R) noexcept {
  using std::atan2;
  using std::sqrt;
  // Quaternion by the largest of the four candidates (Shepperd): no branch divides by a small number.
  S w, x, y, z;
  const S trace = R(0, 0) + R(1, 1) + R(2, 2);
  if (trace > S(0)) {
    const S s = sqrt(trace + S(1)) * S(2);
    w = s / S(4);
    x = (R(2, 1) - R(1, 2)) / s;
    y = (R(0, 2) - R(2, 0)) / s;
    z = (R(1, 0) - R(0, 1)) / s;
  } else {
    const int i = R(0, 0) > R(1, 1) ? (R(0, 0) > R(2, 2) ? 0 : 2) : (R(1, 1) > R(2, 2) ? 1 : 2);
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const S s = sqrt(S(1) + R(i, i) - R(j, j) - R(k, k)) * S(2);
    Vector3<S> v;
    v[i] = s / S(4);
    v[j] = (R(j, i) + R(i, j)) / s;
    v[k] = (R(k, i) + R(i, k)) / s;
    w = (R(k, j) - R(j, k)) / s;
    x = v[0];
    y = v[1];
    z = v[2];
  }
  const S sign = w < S(0) ? S(-1) : S(1);
  w = sign * w;
  const S n2 = x * x + y * y + z * z;
  S factor;
  if (n2 < S(1e-4)) {
    // 2 atan(q)/(q w) with q = n/w, as a series in q^2: n itself has no derivative at zero.
    const S q2 = n2 / (w * w);
    factor = S(2) / w * (S(1) - q2 * (S(1) / S(3) - q2 * (S(1) / S(5) - q2 * (S(1) / S(7) - q2 / S(9)))));
  } else {
    const S n = sqrt(n2);
    factor = S(2) * atan2(n, w) / n;
  }
  return (sign * factor) * Vector3<S>(x, y, z);
}

/// Exp of the twist xi = (v, omega): rotation so3_exp(omega), translation V v with V = I + b [w]x + c [w]x^2.
template <class S>
SE3<S> se3_exp(const Vector6<S>& xi) noexcept {
  const Vector3<S> v = xi.template head<3>(), w = xi.template tail<3>();
  const auto k = detail::exp_coefficients<S>(w.squaredNorm());
  const Matrix3<S> W = hat(w), W2 = product(W, W);
  return {Matrix3<S>::Identity() + k.a * W + k.b * W2, v + k.b * product(W, v) + k.c * product(W2, v)};
}

/// Twist xi = (v, omega) with se3_exp(xi) = T, for rotations by less than pi.
template <class S>
Vector6<S> se3_log(const SE3<S>& T) noexcept {
  const Vector3<S> w = so3_log(T.R);
  const S x2 = w.squaredNorm();
  const auto k = detail::exp_coefficients<S>(x2);
  // V^-1 = I - [w]x / 2 + e [w]x^2 with e = (1 - a / (2 b)) / x^2; the series starts 1/12 + x^2/720.
  S e;
  if (x2 < S(1e-2)) {
    e = S(1) / S(12) + x2 * (S(1) / S(720) + x2 * (S(1) / S(30240) + x2 / S(1209600)));
  } else {
    e = (S(1) - k.a / (S(2) * k.b)) / x2;
  }
  const Vector3<S> wt = w.cross(T.t);
  Vector6<S> xi;
  xi.template head<3>() = T.t - wt / S(2) + e * w.cross(wt);
  xi.template tail<3>() = w;
  return xi;
}

/// Ad_T with T Exp(xi) = Exp(Ad_T xi) T, for xi = (v, omega): [R, [t]x R; 0, R].
template <class S>
FixedMatrix<S, 6, 6> adjoint(const SE3<S>& T) noexcept {
  FixedMatrix<S, 6, 6> a;
  a.template block<3, 3>(0, 0) = T.R;
  a.template block<3, 3>(0, 3) = product(hat(T.t), T.R);
  a.template block<3, 3>(3, 0).setZero();
  a.template block<3, 3>(3, 3) = T.R;
  return a;
}

/// T with its rotation made orthonormal (Gram-Schmidt), for poses from text files or long products.
template <class S>
SE3<S> renormalised(const SE3<S>& T) noexcept {
  Vector3<S> x = T.R.col(0).normalized();
  Vector3<S> y = (T.R.col(1) - x.dot(T.R.col(1)) * x).normalized();
  SE3<S> out{T.R, T.t};
  out.R.col(0) = x;
  out.R.col(1) = y;
  out.R.col(2) = x.cross(y);
  return out;
}

namespace detail {
template <class T, class = void>
struct HasRotationMatrix : std::false_type {};
template <class T>
struct HasRotationMatrix<T, std::void_t<decltype(std::declval<const T&>().rotationMatrix())>> : std::true_type {};
}  // namespace detail

/// Any pose type as SE3: SE3 itself, a Sophus-like type (rotationMatrix(), translation()) or an Eigen::Transform
/// (linear(), translation()).
template <class S>
const SE3<S>& to_se3(const SE3<S>& T) noexcept {
  return T;
}
/// \overload
template <class S, int Mode, int Options>
SE3<S> to_se3(const Eigen::Transform<S, 3, Mode, Options>& T) noexcept {
  return {T.linear(), T.translation()};
}
/// \overload
template <class Pose, std::enable_if_t<detail::HasRotationMatrix<Pose>::value, int> = 0>
auto to_se3(const Pose& T) noexcept
    -> SE3<typename std::decay_t<decltype(std::declval<const Pose&>().rotationMatrix())>::Scalar> {
  return {T.rotationMatrix(), T.translation()};
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_SE3_HPP
