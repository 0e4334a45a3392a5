// BlockCholesky: Cholesky factorisation in place of a symmetric positive definite matrix of 6 x 6 blocks, one block row
// a camera. It skips the empty blocks before the first one of each row (a sequence without loops is a band), sums in
// one fixed order, and allocates only to grow. core/numeric.hpp says why it does not use Eigen's.
#ifndef TEXTPLANE_SOLVER_BLOCK_CHOLESKY_HPP
#define TEXTPLANE_SOLVER_BLOCK_CHOLESKY_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/core/numeric.hpp"

TEXTPLANE_BEGIN_NAMESPACE
namespace detail {

// c -= a b^T for column-major c (6 x 6), a and b (6 x n). Half of c at a time stays in registers.
template <class S>
void subtract_outer(const S* a, const S* b, int n, S* c) noexcept {
  using Column = Vector6<S>;
  for (int half = 0; half < 6; half += 3) {
    Column s0 = Column::Zero(), s1 = Column::Zero(), s2 = Column::Zero();
    for (int k = 0; k < 6 * n; k += 6) {
      const Eigen::Map<const Column> column(a + k);
      const S* row = b + k + half;
      s0 += row[0] * column;
      s1 += row[1] * column;
      s2 += row[2] * column;
    }
    S* out = c + 6 * half;
    Eigen::Map<Column>{out} -= s0;
    Eigen::Map<Column>{out + 6} -= s1;
    Eigen::Map<Column>{out + 12} -= s2;
  }
}

// c += a^T b for column-major a (2 x Rows), b (2 x Columns) and c (Rows x Columns), down the columns of c.
template <int Rows, int Columns, class S>
void add_two_rows(const S* a, const S* b, S* c) noexcept {
  S first[kLength<Rows>], second[kLength<Rows>];
  for (int r = 0; r < Rows; ++r) {
    first[r] = a[2 * r];
    second[r] = a[2 * r + 1];
  }
  for (int k = 0; k < Columns; ++k)
    for (int r = 0; r < Rows; ++r) c[Rows * k + r] += first[r] * b[2 * k] + second[r] * b[2 * k + 1];
}

/// Lower block triangle of an n x n block matrix, blocks column-major. S is double, see BasicWindowSchur.
template <class S>
class BasicBlockCholesky {
 public:
  using Block = FixedMatrix<S, 6, 6>;

  /// n block rows of zeros. Allocates where n exceeds every earlier one.
  void reset(int n) {
    n_ = n;
    blocks_.assign(index(n, 0), Block::Zero());
    deficient_.assign(static_cast<std::size_t>(n), 0);
    first_.resize(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) first_[static_cast<std::size_t>(i)] = i;
  }

  int size() const noexcept { return n_; }

  /// Block (i, j), i >= j, to add to. A diagonal block needs its lower triangle alone.
  Block& at(int i, int j) noexcept {
    int& first = first_[static_cast<std::size_t>(i)];
    first = (std::min)(first, j);
    return blocks_[index(i, j)];
  }
  const Block& at(int i, int j) const noexcept { return blocks_[index(i, j)]; }

  /// A = L L^T in place. `scale` has 6 n entries: a pivot of at most tolerance * scale counts as zero. Its parameter is
  /// then held, as with an infinite diagonal entry, and its block is marked deficient(). Returns the number of zero
  /// pivots, or -1 where a pivot is not finite; the factor is then useless.
  int factorise(const double* scale, double tolerance) noexcept {
    int zero_pivots = 0;
    for (int i = 0; i < n_; ++i) {
      const int first_i = first_[static_cast<std::size_t>(i)];
      for (int j = first_i; j <= i; ++j) {
        double* c = blocks_[index(i, j)].data();
        // The blocks of a row are contiguous: columns k to j are one 6 x 6 (j - k) matrix.
        const int k = (std::max)(first_i, first_[static_cast<std::size_t>(j)]);
        if (k < j) subtract_outer(blocks_[index(i, k)].data(), blocks_[index(j, k)].data(), 6 * (j - k), c);
        if (j < i) divide_by_transpose(blocks_[index(j, j)].data(), c);
      }
      const int zero = factorise_diagonal(scale + 6 * i, tolerance, blocks_[index(i, i)].data());
      if (zero < 0) return -1;
      if (zero > 0) deficient_[static_cast<std::size_t>(i)] = 1;
      zero_pivots += zero;
    }
    return zero_pivots;
  }

  /// After factorise(): whether the block row had a zero pivot.
  bool deficient(int i) const noexcept { return deficient_[static_cast<std::size_t>(i)] != 0; }

  /// x <- A^-1 x for 6 n entries, after factorise().
  void solve(double* x) const noexcept {
    for (int i = 0; i < n_; ++i) {
      double* xi = x + 6 * i;
      for (int k = first_[static_cast<std::size_t>(i)]; k < i; ++k) {
        const double* l = blocks_[index(i, k)].data();
        for (int c = 0; c < 6; ++c)
          for (int r = 0; r < 6; ++r) xi[r] -= l[6 * c + r] * x[6 * k + c];
      }
      const double* l = blocks_[index(i, i)].data();
      for (int r = 0; r < 6; ++r) {
        for (int c = 0; c < r; ++c) xi[r] -= l[6 * c + r] * xi[c];
        xi[r] /= l[7 * r];
      }
    }
    for (int i = n_ - 1; i >= 0; --i) {
      double* xi = x + 6 * i;
      const double* l = blocks_[index(i, i)].data();
      for (int r = 5; r >= 0; --r) {
        for (int c = r + 1; c < 6; ++c) xi[r] -= l[6 * r + c] * xi[c];
        xi[r] /= l[7 * r];
      }
      for (int k = first_[static_cast<std::size_t>(i)]; k < i; ++k) {
        const double* b = blocks_[index(i, k)].data();
        for (int c = 0; c < 6; ++c)
          for (int r = 0; r < 6; ++r) x[6 * k + c] -= b[6 * c + r] * xi[r];
      }
    }
  }

 private:
  static std::size_t index(int i, int j) noexcept {
    return static_cast<std::size_t>(i) * (static_cast<std::size_t>(i) + 1) / 2 + static_cast<std::size_t>(j);
  }

  // c <- c L^-T.
  static void divide_by_transpose(const double* l, double* c) noexcept {
    for (int col = 0; col < 6; ++col) {
      for (int k = 0; k < col; ++k)
        for (int r = 0; r < 6; ++r) c[6 * col + r] -= c[6 * k + r] * l[6 * k + col];
      const double inverse = 1 / l[7 * col];
      for (int r = 0; r < 6; ++r) c[6 * col + r] *= inverse;
    }
  }

  static int factorise_diagonal(const double* scale, double tolerance, double* a) noexcept {
    int zero_pivots = 0;
    for (int c = 0; c < 6; ++c) {
      double d = a[7 * c];
      for (int k = 0; k < c; ++k) d -= a[6 * k + c] * a[6 * k + c];
      if (!is_finite(d)) return -1;
      if (!(d > tolerance * scale[c])) {
        ++zero_pivots;
        a[7 * c] = kHeld;
        for (int r = c + 1; r < 6; ++r) a[6 * c + r] = 0;
        continue;
      }
      const double root = std::sqrt(d);
      a[7 * c] = root;
      for (int r = c + 1; r < 6; ++r) {
        double s = a[6 * c + r];
        for (int k = 0; k < c; ++k) s -= a[6 * k + r] * a[6 * k + c];
        a[6 * c + r] = s / root;
      }
    }
    return zero_pivots;
  }

  // Diagonal of L for a held parameter, large enough that it neither moves nor couples to others.
  static constexpr double kHeld = 1e100;

  int n_ = 0;
  std::vector<Block> blocks_;
  std::vector<int> first_;
  std::vector<std::uint8_t> deficient_;
};

using BlockCholesky = BasicBlockCholesky<double>;

}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_BLOCK_CHOLESKY_HPP
