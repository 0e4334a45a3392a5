// Dual<N>: forward-mode automatic differentiation with N partial derivatives, the oracle for analytic Jacobians.
#ifndef TEXTPLANE_TESTS_SUPPORT_DUAL_HPP
#define TEXTPLANE_TESTS_SUPPORT_DUAL_HPP

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace textplane_test {

template <int N>
struct Dual {
  double a = 0;
  Eigen::Matrix<double, N, 1> v = Eigen::Matrix<double, N, 1>::Zero();

  Dual() = default;
  Dual(double value) : a(value) {}  // NOLINT: implicit, as arithmetic types are
  Dual(double value, int index) : a(value) { v[index] = 1; }
  Dual(double value, const Eigen::Matrix<double, N, 1>& derivative) : a(value), v(derivative) {}

  explicit operator double() const { return a; }
  explicit operator int() const { return static_cast<int>(a); }

  Dual& operator+=(const Dual& o) { return *this = *this + o; }
  Dual& operator-=(const Dual& o) { return *this = *this - o; }
  Dual& operator*=(const Dual& o) { return *this = *this * o; }
  Dual& operator/=(const Dual& o) { return *this = *this / o; }

  friend Dual operator-(const Dual& x) { return {-x.a, -x.v}; }
  friend Dual operator+(const Dual& x, const Dual& y) { return {x.a + y.a, x.v + y.v}; }
  friend Dual operator-(const Dual& x, const Dual& y) { return {x.a - y.a, x.v - y.v}; }
  friend Dual operator*(const Dual& x, const Dual& y) { return {x.a * y.a, x.a * y.v + y.a * x.v}; }
  friend Dual operator/(const Dual& x, const Dual& y) {
    const double q = x.a / y.a;
    return {q, (x.v - q * y.v) / y.a};
  }
  friend bool operator<(const Dual& x, const Dual& y) { return x.a < y.a; }
  friend bool operator>(const Dual& x, const Dual& y) { return x.a > y.a; }
  friend bool operator<=(const Dual& x, const Dual& y) { return x.a <= y.a; }
  friend bool operator>=(const Dual& x, const Dual& y) { return x.a >= y.a; }
  friend bool operator==(const Dual& x, const Dual& y) { return x.a == y.a; }
  friend bool operator!=(const Dual& x, const Dual& y) { return x.a != y.a; }

  friend Dual sqrt(const Dual& x) {
    const double s = std::sqrt(x.a);
    return {s, x.v / (2 * s)};
  }
  friend Dual sin(const Dual& x) { return {std::sin(x.a), std::cos(x.a) * x.v}; }
  friend Dual cos(const Dual& x) { return {std::cos(x.a), -std::sin(x.a) * x.v}; }
  friend Dual acos(const Dual& x) { return {std::acos(x.a), -x.v / std::sqrt(1 - x.a * x.a)}; }
  friend Dual atan2(const Dual& y, const Dual& x) {
    return {std::atan2(y.a, x.a), (x.a * y.v - y.a * x.v) / (x.a * x.a + y.a * y.a)};
  }
  friend Dual abs(const Dual& x) { return x.a < 0 ? -x : x; }
  friend Dual floor(const Dual& x) { return {std::floor(x.a)}; }
};

}  // namespace textplane_test

namespace std {
template <int N>
class numeric_limits<textplane_test::Dual<N>> : public numeric_limits<double> {};
}  // namespace std

namespace Eigen {
template <int N>
struct NumTraits<textplane_test::Dual<N>> : NumTraits<double> {
  using Real = textplane_test::Dual<N>;
  using NonInteger = textplane_test::Dual<N>;
  using Nested = textplane_test::Dual<N>;
  using Literal = double;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 1,
    AddCost = 3,
    MulCost = 3
  };
};
template <int N, typename BinaryOp>
struct ScalarBinaryOpTraits<textplane_test::Dual<N>, double, BinaryOp> {
  using ReturnType = textplane_test::Dual<N>;
};
template <int N, typename BinaryOp>
struct ScalarBinaryOpTraits<double, textplane_test::Dual<N>, BinaryOp> {
  using ReturnType = textplane_test::Dual<N>;
};
}  // namespace Eigen

#endif  // TEXTPLANE_TESTS_SUPPORT_DUAL_HPP
