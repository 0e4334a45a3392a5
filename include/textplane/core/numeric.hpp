// Small numeric tools: finite checks that survive -ffast-math, and symmetric solvers of fixed size.
// They do not use Eigen's out-of-line algorithms: translation units with different instruction sets would share Eigen's
// weak symbols (see config.hpp).
#ifndef TEXTPLANE_CORE_NUMERIC_HPP
#define TEXTPLANE_CORE_NUMERIC_HPP

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "textplane/config.hpp"

TEXTPLANE_BEGIN_NAMESPACE

template <class S>
using Vector2 = Eigen::Matrix<S, 2, 1>;  ///< A point of an image.
template <class S>
using Vector3 = Eigen::Matrix<S, 3, 1>;  ///< A point, a direction, or a plane theta.
template <class S>
using Vector6 = Eigen::Matrix<S, 6, 1>;  ///< A twist xi = (v, omega).
/// A matrix of fixed size. Its numbers lie column by column, also with EIGEN_DEFAULT_TO_ROW_MAJOR: kernels read them
/// through pointers. (Eigen wants a single row to be stored by rows, which is the same.)
template <class S, int Rows, int Columns>
using FixedMatrix =
    Eigen::Matrix<S, Rows, Columns, Rows == 1 && Columns != 1 ? Eigen::RowMajor : Eigen::ColMajor, Rows, Columns>;
template <class S>
using Matrix3 = FixedMatrix<S, 3, 3>;  ///< A rotation or a homography.

namespace detail {
// The scalar of sums over measurements of type S: double for float, else S itself.
template <class S>
struct WideScalar {
  using type = S;
};
template <>
struct WideScalar<float> {
  using type = double;
};
template <class S>
using Wide = typename WideScalar<S>::type;
// The length of an array that a template names by an int: g++ calls the conversion one of signs.
template <int N>
constexpr std::size_t kLength = static_cast<std::size_t>(N);
}  // namespace detail

/// A B of fixed-size matrices, written out: Eigen's loop may become a weak symbol, and the linker may keep the copy
/// with another instruction set. Eigen's expressions also compile slowly.
template <class S, int Rows, int Inner, int Columns>
FixedMatrix<S, Rows, Columns> product(const FixedMatrix<S, Rows, Inner>& a,
                                      const FixedMatrix<S, Inner, Columns>& b) noexcept {
  FixedMatrix<S, Rows, Columns> c;
  for (int j = 0; j < Columns; ++j) {
    for (int i = 0; i < Rows; ++i) {
      S sum = a(i, 0) * b(0, j);
      for (int k = 1; k < Inner; ++k) sum += a(i, k) * b(k, j);
      c(i, j) = sum;
    }
  }
  return c;
}

/// A^T B, written out likewise. Long columns are summed in two chains, which halves the latency.
template <class S, int Inner, int Rows, int Columns>
FixedMatrix<S, Rows, Columns> transposed_product(const FixedMatrix<S, Inner, Rows>& a,
                                                 const FixedMatrix<S, Inner, Columns>& b) noexcept {
  FixedMatrix<S, Rows, Columns> c;
  for (int j = 0; j < Columns; ++j)
    for (int i = 0; i < Rows; ++i) {
      if constexpr (Inner > 2 && Inner % 2 == 0) {
        S even = a(Inner - 2, i) * b(Inner - 2, j), odd = a(Inner - 1, i) * b(Inner - 1, j);
        for (int k = Inner - 4; k >= 0; k -= 2) {
          even = a(k, i) * b(k, j) + even;
          odd = a(k + 1, i) * b(k + 1, j) + odd;
        }
        c(i, j) = even + odd;
      } else {
        S sum = a(0, i) * b(0, j);
        for (int k = 1; k < Inner; ++k) sum += a(k, i) * b(k, j);
        c(i, j) = sum;
      }
    }
  return c;
}

/// A^T, written out likewise.
template <class S, int Rows, int Columns>
FixedMatrix<S, Columns, Rows> transposed(const FixedMatrix<S, Rows, Columns>& a) noexcept {
  FixedMatrix<S, Columns, Rows> c;
  for (int j = 0; j < Columns; ++j)
    for (int i = 0; i < Rows; ++i) c(j, i) = a(i, j);
  return c;
}

/// The block of Rows x Columns at (row, column), written out likewise.
template <int Rows, int Columns, class S, int AllRows, int AllColumns>
FixedMatrix<S, Rows, Columns> block(const FixedMatrix<S, AllRows, AllColumns>& a, int row, int column) noexcept {
  FixedMatrix<S, Rows, Columns> c;
  for (int j = 0; j < Columns; ++j)
    for (int i = 0; i < Rows; ++i) c(i, j) = a(row + i, column + j);
  return c;
}

/// factor A, written out likewise.
template <class S, int Rows, int Columns>
FixedMatrix<S, Rows, Columns> scaled(const S& factor, const FixedMatrix<S, Rows, Columns>& a) noexcept {
  FixedMatrix<S, Rows, Columns> c;
  for (int i = 0; i < Rows * Columns; ++i) c.data()[i] = factor * a.data()[i];
  return c;
}

/// Neither NaN nor infinite, decided on the bits so that -ffast-math cannot fold it away.
inline bool is_finite(double x) noexcept {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return (bits & 0x7ff0000000000000ULL) != 0x7ff0000000000000ULL;
}
/// \overload
inline bool is_finite(float x) noexcept {
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return (bits & 0x7f800000U) != 0x7f800000U;
}
/// Its top bit is set where x is not finite. To check many numbers without branches, OR the results.
inline std::uint64_t not_finite_bit(double x) noexcept {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return (bits & 0x7ff0000000000000ULL) + 0x0010000000000000ULL;
}
/// Other scalars (dual numbers): x - x is zero exactly for finite x. -ffast-math folds this one away.
template <class S>
bool is_finite(const S& x) noexcept {
  return x - x == S(0);
}
/// All coefficients of a dense Eigen expression are finite.
template <class Derived>
bool all_finite(const Eigen::DenseBase<Derived>& m) noexcept {
  for (Eigen::Index c = 0; c < m.cols(); ++c)
    for (Eigen::Index r = 0; r < m.rows(); ++r)
      if (!is_finite(m.derived().coeff(r, c))) return false;
  return true;
}

/// Cholesky factorisation A = L D L^T of a symmetric N x N matrix. Reads the lower triangle alone.
///
/// The matrix counts as not positive definite where a pivot is at most `tolerance` times its diagonal entry of A. Then
/// ok() is false, and solve() and inverse() must not be called.
template <class S, int N>
class Ldlt {
 public:
  using Matrix = FixedMatrix<S, N, N>;    ///< The matrix of the system.
  using Vector = Eigen::Matrix<S, N, 1>;  ///< Right side and solution.

  /// Factorises `a`.
  explicit Ldlt(const Matrix& a, S tolerance = S(16) * std::numeric_limits<S>::epsilon()) noexcept : l_(a) {
    for (int j = 0; j < N; ++j) {
      S d = l_(j, j);
      for (int k = 0; k < j; ++k) d -= l_(j, k) * l_(j, k) * d_[k];
      if (!(d > tolerance * a(j, j)) || !is_finite(d)) return;
      d_[j] = d;
      for (int i = j + 1; i < N; ++i) {
        S s = l_(i, j);
        for (int k = 0; k < j; ++k) s -= l_(i, k) * l_(j, k) * d_[k];
        l_(i, j) = s / d;
      }
    }
    ok_ = true;
  }

  bool ok() const noexcept { return ok_; }  ///< Positive definite.

  /// a^-1 b.
  Vector solve(const Vector& b) const noexcept {
    Vector x = b;
    for (int i = 0; i < N; ++i)
      for (int k = 0; k < i; ++k) x[i] -= l_(i, k) * x[k];
    for (int i = 0; i < N; ++i) x[i] /= d_[i];
    for (int i = N - 1; i >= 0; --i)
      for (int k = i + 1; k < N; ++k) x[i] -= l_(k, i) * x[k];
    return x;
  }

  /// a^-1.
  Matrix inverse() const noexcept {
    Matrix inv;
    for (int c = 0; c < N; ++c) {
      Vector e;
      for (int i = 0; i < N; ++i) e[i] = S(i == c ? 1 : 0);
      const Vector x = solve(e);
      for (int i = 0; i < N; ++i) inv(i, c) = x[i];
    }
    return inv;
  }

 private:
  Matrix l_;
  S d_[detail::kLength<N>] = {};
  bool ok_ = false;
};

/// Eigenvalues (ascending) and eigenvectors (columns) of a symmetric N x N matrix by cyclic Jacobi rotations.
template <class S, int N>
struct SymmetricEigen {
  Eigen::Matrix<S, N, 1> values;  ///< Eigenvalues.
  FixedMatrix<S, N, N> vectors;   ///< Eigenvectors of unit length: columns, in the order of the values.
};

/// Eigenvalues and eigenvectors of a symmetric matrix, by Jacobi rotations.
template <class S, int N>
SymmetricEigen<S, N> symmetric_eigen(const FixedMatrix<S, N, N>& matrix) noexcept {
  using std::abs;
  using std::sqrt;
  FixedMatrix<S, N, N> a = matrix;
  SymmetricEigen<S, N> e;
  e.vectors.setIdentity();
  for (int sweep = 0; sweep < 30; ++sweep) {
    S off = S(0), diagonal = S(0);
    for (int i = 0; i < N; ++i) {
      diagonal += a(i, i) * a(i, i);
      for (int j = 0; j < i; ++j) off += a(i, j) * a(i, j);
    }
    const S epsilon = std::numeric_limits<S>::epsilon();
    // The first sweep always runs: an off-diagonal zero of a dual number may carry a derivative.
    if (sweep > 0 && !(off > epsilon * epsilon * diagonal)) break;
    for (int p = 0; p < N; ++p)
      for (int q = p + 1; q < N; ++q) {
        const S gap = a(q, q) - a(p, p), twice = S(2) * a(p, q);
        const S length = abs(gap) + sqrt(gap * gap + twice * twice);
        if (!(length > S(0))) continue;
        const S t = (gap >= S(0) ? twice : S(-twice)) / length;
        const S c = S(1) / sqrt(S(1) + t * t), s = t * c;
        for (int k = 0; k < N; ++k) {
          const S akp = a(k, p), akq = a(k, q);
          a(k, p) = c * akp - s * akq;
          a(k, q) = s * akp + c * akq;
        }
        for (int k = 0; k < N; ++k) {
          const S apk = a(p, k), aqk = a(q, k);
          a(p, k) = c * apk - s * aqk;
          a(q, k) = s * apk + c * aqk;
          const S vkp = e.vectors(k, p), vkq = e.vectors(k, q);
          e.vectors(k, p) = c * vkp - s * vkq;
          e.vectors(k, q) = s * vkp + c * vkq;
        }
      }
  }
  const auto swap = [](S& x, S& y) noexcept {
    const S old = x;
    x = y;
    y = old;
  };
  for (int i = 0; i < N; ++i) e.values[i] = a(i, i);
  for (int i = 0; i < N; ++i)
    for (int j = i + 1; j < N; ++j) {
      if (!(e.values[j] < e.values[i])) continue;
      swap(e.values[i], e.values[j]);
      for (int k = 0; k < N; ++k) swap(e.vectors(k, i), e.vectors(k, j));
    }
  return e;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_NUMERIC_HPP
