// Dual<N>: forward-mode automatic differentiation with N partial derivatives, the oracle for analytic Jacobians.
#ifndef TEXTPLANE_TESTS_SUPPORT_DUAL_HPP
#define TEXTPLANE_TESTS_SUPPORT_DUAL_HPP

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace textplane_test {

// Eigen unrolls products of Duals into hundreds of operations: calls to functions with plain loops spare the compiler
// inlining an expression of Eigen for each.
#if defined(__GNUC__) || defined(__clang__)
#define TEXTPLANE_TEST_CALLED __attribute__((noinline))
#else
#define TEXTPLANE_TEST_CALLED
#endif

template <int N>
struct Dual {
  double a = 0;
  std::array<double, static_cast<std::size_t>(N)> v{};

  Dual() = default;
  Dual(double value) : a(value) {}  // NOLINT: implicit, as arithmetic types are
  Dual(double value, int index) : a(value) { v[static_cast<std::size_t>(index)] = 1; }
  /// A function of x whose derivative is dx.
  TEXTPLANE_TEST_CALLED Dual(double value, double dx, const Dual& x) : a(value) {
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = dx * x.v[i];
  }
  /// A function of x and y whose derivatives are dx and dy.
  TEXTPLANE_TEST_CALLED Dual(double value, double dx, const Dual& x, double dy, const Dual& y) : a(value) {
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = dx * x.v[i] + dy * y.v[i];
  }

  explicit operator double() const { return a; }
  explicit operator int() const { return static_cast<int>(a); }

  Dual& operator+=(const Dual& o) { return *this = *this + o; }
  Dual& operator-=(const Dual& o) { return *this = *this - o; }
  Dual& operator*=(const Dual& o) { return *this = *this * o; }
  Dual& operator/=(const Dual& o) { return *this = *this / o; }

  friend Dual operator-(const Dual& x) { return {-x.a, -1, x}; }
  friend Dual operator+(const Dual& x, const Dual& y) { return {x.a + y.a, 1, x, 1, y}; }
  friend Dual operator-(const Dual& x, const Dual& y) { return {x.a - y.a, 1, x, -1, y}; }
  friend Dual operator*(const Dual& x, const Dual& y) { return {x.a * y.a, y.a, x, x.a, y}; }
  friend TEXTPLANE_TEST_CALLED Dual operator/(const Dual& x, const Dual& y) {
    const double q = x.a / y.a;
    return {q, 1 / y.a, x, -q / y.a, y};
  }
  friend bool operator<(const Dual& x, const Dual& y) { return x.a < y.a; }
  friend bool operator>(const Dual& x, const Dual& y) { return x.a > y.a; }
  friend bool operator<=(const Dual& x, const Dual& y) { return x.a <= y.a; }
  friend bool operator>=(const Dual& x, const Dual& y) { return x.a >= y.a; }
  friend bool operator==(const Dual& x, const Dual& y) { return x.a == y.a; }
  friend bool operator!=(const Dual& x, const Dual& y) { return x.a != y.a; }

  friend TEXTPLANE_TEST_CALLED Dual sqrt(const Dual& x) {
    const double s = std::sqrt(x.a);
    return {s, 1 / (2 * s), x};
  }
  friend TEXTPLANE_TEST_CALLED Dual sin(const Dual& x) { return {std::sin(x.a), std::cos(x.a), x}; }
  friend TEXTPLANE_TEST_CALLED Dual cos(const Dual& x) { return {std::cos(x.a), -std::sin(x.a), x}; }
  friend TEXTPLANE_TEST_CALLED Dual acos(const Dual& x) { return {std::acos(x.a), -1 / std::sqrt(1 - x.a * x.a), x}; }
  friend TEXTPLANE_TEST_CALLED Dual atan2(const Dual& y, const Dual& x) {
    const double n = x.a * x.a + y.a * y.a;
    return {std::atan2(y.a, x.a), x.a / n, y, -y.a / n, x};
  }
  friend Dual abs(const Dual& x) { return x.a < 0 ? -x : x; }
  friend Dual floor(const Dual& x) { return {std::floor(x.a)}; }
};

#undef TEXTPLANE_TEST_CALLED

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
