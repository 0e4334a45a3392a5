// Derivatives by central differences and by dual numbers, and a seeded random source that is the same everywhere.
#ifndef TEXTPLANE_TESTS_SUPPORT_CALCULUS_HPP
#define TEXTPLANE_TESTS_SUPPORT_CALCULUS_HPP

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "support/dual.hpp"
#include "support/random.hpp"
#include "textplane/core/se3.hpp"

namespace textplane_test {

/// d f / d x at x by central differences of fourth order; f maps Matrix<double, N, 1> to Matrix<double, M, 1>.
template <int M, int N, class F>
Eigen::Matrix<double, M, N> central_difference(const F& f, const Eigen::Matrix<double, N, 1>& x, double h = 1e-4) {
  Eigen::Matrix<double, M, N> J;
  for (int i = 0; i < N; ++i) {
    const auto at = [&](double step) {
      Eigen::Matrix<double, N, 1> moved = x;
      moved[i] += step;
      return Eigen::Matrix<double, M, 1>(f(moved));
    };
    const Eigen::Matrix<double, M, 1> near[] = {at(h), at(-h)}, far[] = {at(2 * h), at(-2 * h)};
    for (int k = 0; k < M; ++k) J(k, i) = (8 * (near[0][k] - near[1][k]) - (far[0][k] - far[1][k])) / (12 * h);
  }
  return J;
}

/// x as N independent variables.
template <int N>
Eigen::Matrix<Dual<N>, N, 1> seed(const Eigen::Matrix<double, N, 1>& x) {
  Eigen::Matrix<Dual<N>, N, 1> d;
  for (int i = 0; i < N; ++i) d[i] = Dual<N>(x[i], i);
  return d;
}

/// The derivatives that a vector of dual numbers carries, one row an entry.
template <int N, int M>
Eigen::Matrix<double, M, N> derivative(const Eigen::Matrix<Dual<N>, M, 1>& y) {
  Eigen::Matrix<double, M, N> J;
  for (int i = 0; i < M; ++i)
    for (int j = 0; j < N; ++j) J(i, j) = y[i].v[static_cast<std::size_t>(j)];
  return J;
}

/// d f / d x at x by dual numbers; f maps Matrix<Dual<N>, N, 1> to Matrix<Dual<N>, M, 1>.
template <int M, int N, class F>
Eigen::Matrix<double, M, N> dual_derivative(const F& f, const Eigen::Matrix<double, N, 1>& x) {
  return derivative<N, M>(Eigen::Matrix<Dual<N>, M, 1>(f(seed<N>(x))));
}

/// Largest difference of two arrays over the largest entry of the second. NaN counts as infinite.
inline double relative_error(const double* a, const double* b, Eigen::Index size) {
  double difference = 0, scale = 0;
  for (Eigen::Index i = 0; i < size; ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) return std::numeric_limits<double>::infinity();
    difference = std::max(difference, std::abs(a[i] - b[i]));
    scale = std::max(scale, std::abs(b[i]));
  }
  return scale > 0 ? difference / scale : difference;
}

/// The same of matrices. Through arrays, as every size of them costs the compiler a second in Eigen's expressions.
template <class A, class B>
double relative_error(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  using Plain = Eigen::Matrix<double, A::RowsAtCompileTime, A::ColsAtCompileTime,
                              (A::RowsAtCompileTime == 1 ? Eigen::RowMajor : Eigen::ColMajor)>;
  const Plain left = a, right = b;
  if (left.rows() != right.rows() || left.cols() != right.cols()) return std::numeric_limits<double>::infinity();
  return relative_error(left.data(), right.data(), left.size());
}

/// The value of any of the scalars under test.
inline double value(float x) { return static_cast<double>(x); }
inline double value(double x) { return x; }
template <int N>
double value(const Dual<N>& x) {
  return x.a;
}
template <class Derived>
Eigen::Matrix<double, Derived::RowsAtCompileTime, Derived::ColsAtCompileTime> values(
    const Eigen::MatrixBase<Derived>& m) {
  Eigen::Matrix<double, Derived::RowsAtCompileTime, Derived::ColsAtCompileTime> out;
  for (Eigen::Index c = 0; c < m.cols(); ++c)
    for (Eigen::Index r = 0; r < m.rows(); ++r) out(r, c) = value(m(r, c));
  return out;
}

/// `in_float` for float, else `in_double`: tolerances that follow the scalar.
template <class S>
double tolerance(double in_float, double in_double) {
  return std::is_same<S, float>::value ? in_float : in_double;
}

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SUPPORT_CALCULUS_HPP
