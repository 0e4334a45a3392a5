// What the camera models with a lens share: the chain from the lens to the pixel, the inverse of a lens on the plane,
// and functions of angles that are smooth on the axis, where an angle itself is not.
#ifndef TEXTPLANE_CORE_CAMERAS_LENS_HPP
#define TEXTPLANE_CORE_CAMERAS_LENS_HPP

#include <cmath>
#include <limits>

#include "textplane/core/cameras/pinhole.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {

// fx fy cx cy, then the coefficients of the lens.
template <class S, class... Coefficients>
Eigen::Matrix<S, 4 + static_cast<int>(sizeof...(Coefficients)), 1> camera_parameters(
    const Pinhole<S>& pinhole, const Coefficients&... coefficients) noexcept {
  const S all[] = {pinhole.fx, pinhole.fy, pinhole.cx, pinhole.cy, coefficients...};
  Eigen::Matrix<S, 4 + static_cast<int>(sizeof...(Coefficients)), 1> p;
  for (int i = 0; i < p.size(); ++i) p[i] = all[i];
  return p;
}

// project() of a model with m_d = lens(p, D_p, D_k), which gives its derivatives by p and by the coefficients together.
template <class Camera, class S>
Vector2<S> project_through(const Camera& camera, const Vector3<S>& p, FixedMatrix<S, 2, 3>* J_p,
                           FixedMatrix<S, 2, Camera::kParameters>* J_parameters) noexcept {
  const Pinhole<S>& pinhole = camera.pinhole();
  if (!J_p && !J_parameters) return pinhole.pixel(camera.lens(p));
  FixedMatrix<S, 2, 3> D_p;
  FixedMatrix<S, 2, Camera::kParameters - 4> D_k;
  const Vector2<S> m = camera.lens(p, &D_p, &D_k);
  for (int i = 0; i < 2; ++i) {
    const S f = i == 0 ? pinhole.fx : pinhole.fy;
    for (int j = 0; J_p && j < 3; ++j) (*J_p)(i, j) = f * D_p(i, j);
    if (!J_parameters) continue;
    for (int j = 0; j < 2; ++j) {
      (*J_parameters)(i, j) = i == j ? m[i] : S(0);
      (*J_parameters)(i, 2 + j) = S(i == j ? 1 : 0);
    }
    for (int k = 0; k < Camera::kParameters - 4; ++k) (*J_parameters)(i, 4 + k) = f * D_k(i, k);
  }
  return pinhole.pixel(m);
}

// distort() of such a model.
template <class Camera, class S>
Vector2<S> distort_through(const Camera& camera, const Vector2<S>& m, FixedMatrix<S, 2, 2>* J) noexcept {
  const Vector3<S> p(m[0], m[1], S(1));
  if (!J) return camera.lens(p);
  FixedMatrix<S, 2, 3> D_p;
  FixedMatrix<S, 2, Camera::kParameters - 4> D_k;
  const Vector2<S> distorted = camera.lens(p, &D_p, &D_k);
  *J = block<2, 2>(D_p, 0, 0);
  return distorted;
}

// m_d = (x, y) / w of a point p and a divisor w, with the derivatives that follow from those of w.
template <int K, class S>
Vector2<S> divide_point(const Vector3<S>& p, const S& w, const Vector3<S>& w_by_p, const Eigen::Matrix<S, K, 1>& w_by_k,
                        FixedMatrix<S, 2, 3>* D_p, FixedMatrix<S, 2, K>* D_k) noexcept {
  const S inverse = S(1) / w;
  const Vector2<S> m(p[0] * inverse, p[1] * inverse);
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; D_p && j < 3; ++j) (*D_p)(i, j) = inverse * (S(i == j ? 1 : 0) - m[i] * w_by_p[j]);
    for (int k = 0; D_k && k < K; ++k) (*D_k)(i, k) = -inverse * m[i] * w_by_k[k];
  }
  return m;
}

// The unified projection m_d = (x, y) / (alpha d + (1 - alpha) z), d^2 = beta (x^2 + y^2) + z^2: what -z/d has to stay
// below, and the direction, of any length, of m_d's point.
template <class S>
S unified_limit(const S& alpha) noexcept {
  return alpha <= S(0.5) ? S(alpha / (S(1) - alpha)) : S((S(1) - alpha) / alpha);
}
template <class S>
Status unified_ray(const Vector3<S>& m, const S& alpha, const S& beta, Vector3<S>* ray) noexcept {
  using std::sqrt;
  const S r2 = beta * (m[0] * m[0] + m[1] * m[1]), root2 = S(1) - (S(2) * alpha - S(1)) * r2;
  if (!all_finite(m)) return Status::non_finite;
  if (!is_finite(r2) || !(root2 > S(0))) return Status::degenerate;
  const S w = alpha * sqrt(root2) + S(1) - alpha;
  if (!(w > S(0))) return Status::degenerate;
  *ray = {m[0], m[1], (S(1) - alpha * alpha * r2) / w};
  return Status::ok;
}

// Whether the polynomial with the Bernstein coefficients b is positive on [0, 1]. The least of them is a lower bound,
// the first and the last are values: what they leave open the two halves decide. Where it touches zero the halving
// ends, with "no".
template <int N, class S>
bool positive_bernstein(const S (&b)[kLength<N + 1>], int halvings) noexcept {
  bool all = true;
  for (const S& coefficient : b) all = all && coefficient > S(0);
  if (all || halvings == 0 || !(b[0] > S(0)) || !(b[N] > S(0))) return all;
  S left[kLength<N + 1>], right[kLength<N + 1>];
  for (int i = 0; i <= N; ++i) right[i] = b[i];
  for (int i = 0; i <= N; ++i) {
    left[i] = right[0];
    for (int j = 0; j < N - i; ++j) right[j] = S(0.5) * (right[j] + right[j + 1]);
  }
  return positive_bernstein<N>(left, halvings - 1) && positive_bernstein<N>(right, halvings - 1);
}

// Whether c0 + c1 s + ... + cN s^N is positive on all of [0, end].
template <int N, class S>
bool positive_up_to(const S (&c)[kLength<N + 1>], const S& end) noexcept {
  S b[kLength<N + 1>];
  S power = S(1);
  double binomial = 1;
  for (int i = 0; i <= N; ++i) {
    b[i] = c[i] * power / S(binomial);
    power *= end;
    binomial *= static_cast<double>(N - i) / (i + 1);
  }
  for (int i = N; i > 0; --i)
    for (int j = i; j <= N; ++j) b[j] += b[j - 1];
  return is_finite(b[N]) && positive_bernstein<N>(b, 40);
}

// m radial + (2 p1 x y + p2 (r^2 + 2 x^2), p1 (r^2 + 2 y^2) + 2 p2 x y), where radial is a function of r^2 and `slope`
// twice its derivative. J, unless null, receives the derivative by m.
template <class S>
Vector2<S> bend(const Vector2<S>& m, const S& radial, const S& slope, const S& p1, const S& p2,
                FixedMatrix<S, 2, 2>* J) noexcept {
  const S x = m[0], y = m[1], r2 = x * x + y * y;
  if (J) {
    const S cross = x * y * slope + S(2) * (p1 * x + p2 * y);
    *J << radial + x * x * slope + S(2) * p1 * y + S(6) * p2 * x, cross,  //
        cross, radial + y * y * slope + S(6) * p1 * y + S(2) * p2 * x;
  }
  return {x * radial + S(2) * p1 * x * y + p2 * (r2 + S(2) * x * x),
          y * radial + p1 * (r2 + S(2) * y * y) + S(2) * p2 * x * y};
}

// d m_d / d p of J = d m_d / d m, m = (x/z, y/z).
template <class S>
void chain_to_point(const Vector3<S>& p, const FixedMatrix<S, 2, 2>& J, FixedMatrix<S, 2, 3>* D_p) noexcept {
  FixedMatrix<S, 2, 3> m_by_p;
  Pinhole<S>().project(p, &m_by_p);
  *D_p = product(J, m_by_p);
}
// The derivatives of bend() by p1 and p2: the columns of D_k from `column` on.
template <class S, int K>
void tangential_columns(const Vector2<S>& m, int column, FixedMatrix<S, 2, K>* D_k) noexcept {
  const S x = m[0], y = m[1], r2 = x * x + y * y;
  (*D_k)(0, column) = (*D_k)(1, column + 1) = S(2) * x * y;
  (*D_k)(1, column) = r2 + S(2) * y * y;
  (*D_k)(0, column + 1) = r2 + S(2) * x * x;
}

// The steps of invert_lens(), from *x. Whether they lead to a point that is accepted.
template <bool Careful, class Lens, class S>
bool newton_lens(const Lens& lens, const Vector2<S>& distorted, int iterations, Vector2<S>* x) noexcept {
  using std::abs;
  const S tolerance = std::numeric_limits<S>::epsilon() < S(1e-10) ? S(1e-12) : S(1e-6);
  const auto is_small = [&](const Vector2<S>& v) { return abs(v[0]) < tolerance && abs(v[1]) < tolerance; };
  FixedMatrix<S, 2, 2> J;
  Vector2<S> e = lens.distort(*x, &J) - distorted;
  for (int i = 0; i < iterations; ++i) {
    const S det = J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);
    if (!(det > S(0)) || !all_finite(e)) return false;
    const Vector2<S> step((J(1, 1) * e[0] - J(0, 1) * e[1]) / det, (J(0, 0) * e[1] - J(1, 0) * e[0]) / det);
    const Vector2<S> start = *x;
    *x -= step;
    if (is_small(e) || (Careful && is_small(step))) {
      if (!Careful) lens.distort(*x, &J);
      return all_finite(*x) && (Careful || lens.one_to_one(*x, J));
    }
    const S square = e[0] * e[0] + e[1] * e[1];
    e = lens.distort(*x, &J) - distorted;
    S share = S(1);
    while (Careful && !(e[0] * e[0] + e[1] * e[1] < square && lens.one_to_one(*x, J))) {
      share *= S(0.5);
      if (share < tolerance) return false;
      *x = {start[0] - share * step[0], start[1] - share * step[1]};
      e = lens.distort(*x, &J) - distorted;
    }
  }
  return false;
}

// Inverse of lens.distort() by Newton's method, among the points x that lens.one_to_one(x, J) accepts, where J is
// d lens.distort() / d x; the origin is one. It starts from m_d, and where this does not lead to such a point, from the
// origin with steps that are halved until they stay among them and come closer. It ends one step after the residual (or
// such a step) falls below 1e-12 (float: 1e-6), so that the derivative of a dual number has settled too.
// Status::degenerate where no point is found, non_finite for NaN; then `m` is untouched.
template <class Lens, class S>
Status invert_lens(const Lens& lens, const Vector2<S>& distorted, Vector2<S>* m) noexcept {
  if (!all_finite(distorted)) return Status::non_finite;
  Vector2<S> x = distorted;
  if (!newton_lens<false>(lens, distorted, 20, &x)) {
    x = {S(0), S(0)};
    if (!newton_lens<true>(lens, distorted, 60, &x)) return Status::degenerate;
  }
  *m = x;
  return Status::ok;
}

// theta / R and its derivative by R^2, where theta = atan2(R, z) is the angle between a point and the axis.
template <class S>
struct AngleRatio {
  S value, slope;
};
template <class S>
AngleRatio<S> angle_ratio(const S& R2, const S& z) noexcept {
  using std::atan2;
  using std::sqrt;
  if (z > S(0) && R2 < S(1e-5) * z * z) {
    const S inverse = S(1) / z, u = R2 * inverse * inverse;
    return {inverse * (S(1) - u * (S(1. / 3) - u * S(0.2))),
            inverse * inverse * inverse * (S(-1. / 3) + u * (S(0.4) - u * S(3. / 7)))};
  }
  const S R = sqrt(R2), value = atan2(R, z) / R;
  return {value, (z / (R2 + z * z) - value) / (S(2) * R2)};
}

// sin(theta) / theta and cos(theta) of theta^2.
template <class S>
struct SincCos {
  S sinc, cosine;
};
template <class S>
SincCos<S> sinc_cos(const S& theta2) noexcept {
  using std::cos;
  using std::sin;
  using std::sqrt;
  if (theta2 < S(1e-3)) {
    return {S(1) - theta2 / S(6) * (S(1) - theta2 / S(20) * (S(1) - theta2 / S(42))),
            S(1) - theta2 / S(2) * (S(1) - theta2 / S(12) * (S(1) - theta2 / S(30) * (S(1) - theta2 / S(56))))};
  }
  const S theta = sqrt(theta2);
  return {sin(theta) / theta, cos(theta)};
}

}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_CAMERAS_LENS_HPP
