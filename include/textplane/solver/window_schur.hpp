// The linear algebra of a window: normal equations in blocks, the Schur complement that eliminates the landmarks,
// back-substitution, and the covariance of landmarks.
//
//   [ H_cc  W  ] [x_c]     [g_c]
//   [ W^T   V  ] [x_l] = - [g_l],   S = H_cc - W V^-1 W^T,   S x_c = -(g_c - W V^-1 g_l),   x_l = -V^-1 (g_l + W^T x_c)
//
// V is block diagonal: 3 x 3 a landmark. All sums run in the order of the window's vectors.
#ifndef TEXTPLANE_SOLVER_WINDOW_SCHUR_HPP
#define TEXTPLANE_SOLVER_WINDOW_SCHUR_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "textplane/solver/block_cholesky.hpp"
#include "textplane/solver/window_structure.hpp"

TEXTPLANE_BEGIN_NAMESPACE
namespace detail {

/// S is double. It is a template so that files that do not call it do not compile it.
template <class S>
class BasicWindowSchur {
 public:
  using Matrix6 = FixedMatrix<S, 6, 6>;
  using Matrix63 = FixedMatrix<S, 6, 3>;
  using Matrix26 = FixedMatrix<S, 2, 6>;
  using Matrix23 = FixedMatrix<S, 2, 3>;

  /// Pivots of at most this share of their diagonal entry count as undetermined.
  static constexpr double kRankTolerance = 1e-11;

  /// Zeroes the sums for the pattern of `structure`, which must outlive the use.
  void begin(const BasicWindowStructure<S>& structure) {
    structure_ = &structure;
    const auto slots = structure.slot_camera.size(), landmarks = static_cast<std::size_t>(structure.landmarks());
    camera_.reset(structure.blocks());
    camera_gradient_.assign(6 * static_cast<std::size_t>(structure.blocks()), 0.0);
    coupling_.assign(slots, Matrix63::Zero());
    landmark_.assign(landmarks, Matrix3<S>::Zero());
    landmark_gradient_.assign(landmarks, Vector3<S>::Zero());
    scale_row_.clear();
  }

  /// The scale gauge: row_a . x_a + row_b . x_b = 0 for the translations of two cameras (-1: a fixed frame).
  void set_scale_row(int camera_a, const Vector3<S>& row_a, int camera_b, const Vector3<S>& row_b) {
    scale_row_.assign(camera_gradient_.size(), 0.0);
    for (int i = 0; i < 3; ++i) {
      if (camera_a >= 0) at(scale_row_, 6 * camera_a + i) = row_a[i];
      if (camera_b >= 0) at(scale_row_, 6 * camera_b + i) = row_b[i];
    }
    scale_cameras_[0] = (std::max)(camera_a, camera_b);
    scale_cameras_[1] = (std::min)(camera_a, camera_b);
  }

  void add_camera(int camera, const Matrix6& H, const Vector6<S>& g) noexcept {
    camera_.at(camera, camera) += H;
    for (int i = 0; i < 6; ++i) at(camera_gradient_, 6 * camera + i) += g[i];
  }
  /// The block d/d xi_a d/d xi_b, a != b.
  void add_cameras(int a, int b, const Matrix6& H) noexcept {
    if (a > b)
      camera_.at(a, b) += H;
    else
      camera_.at(b, a) += H.transpose();
  }
  /// Information and gradient of one unknown: of a prior, or 1 and 0 where its block is padded.
  void add_unknown(int block, int i, S information, S g) noexcept {
    camera_.at(block, block)(i, i) += information;
    at(camera_gradient_, 6 * block + i) += g;
  }
  void add_landmark(int landmark, const Matrix3<S>& H, const Vector3<S>& g) noexcept {
    at(landmark_, landmark) += H;
    at(landmark_gradient_, landmark) += g;
  }
  void add_coupling(int slot, const Matrix63& H) noexcept { at(coupling_, slot) += H; }

  /// The same from two residuals e with derivatives `rows`. `weighted`: derivatives times weight, by the camera for a
  /// coupling.
  void add_camera(int camera, const Matrix26& weighted, const Matrix26& rows, const Vector2<S>& e) noexcept {
    add_two_rows<6, 6>(weighted.data(), rows.data(), camera_.at(camera, camera).data());
    add_two_rows<6, 1>(weighted.data(), e.data(), camera_gradient_.data() + 6 * static_cast<std::ptrdiff_t>(camera));
  }
  /// a > b.
  void add_cameras(int a, int b, const Matrix26& weighted_a, const Matrix26& rows_b) noexcept {
    add_two_rows<6, 6>(weighted_a.data(), rows_b.data(), camera_.at(a, b).data());
  }
  void add_landmark(int landmark, const Matrix23& weighted, const Matrix23& rows, const Vector2<S>& e) noexcept {
    add_two_rows<3, 3>(weighted.data(), rows.data(), at(landmark_, landmark).data());
    add_two_rows<3, 1>(weighted.data(), e.data(), at(landmark_gradient_, landmark).data());
  }
  void add_coupling(int slot, const Matrix26& weighted, const Matrix23& rows) noexcept {
    add_two_rows<6, 3>(weighted.data(), rows.data(), at(coupling_, slot).data());
  }

  /// Builds and factorises S of the system, damped by lambda times its diagonal. False where numbers overflow. With
  /// lambda 0 it marks undetermined landmarks and cameras (landmark_deficient(), camera_deficient()) and holds them in
  /// those directions.
  bool reduce(double lambda) {
    const BasicWindowStructure<S>& s = *structure_;
    const int blocks = s.blocks(), landmarks = s.landmarks();
    lambda_ = lambda;
    reduced_ = camera_;
    read_diagonal(blocks);
    for (int c = 0; c < blocks; ++c)
      for (int i = 0; i < 6; ++i) reduced_.at(c, c)(i, i) += lambda * at(diagonal_, 6 * c + i);
    camera_step_.resize(camera_gradient_.size());
    for (std::size_t i = 0; i < camera_step_.size(); ++i) camera_step_[i] = -camera_gradient_[i];
    inverse_.assign(landmark_.size(), Matrix3<S>::Zero());
    landmark_deficient_.assign(landmark_.size(), 0);
    eliminated_.resize(coupling_.size());
    landmark_step_.resize(landmark_.size());

    for (int l = 0; l < landmarks; ++l) {
      if (!at(s.landmark_free, l)) continue;
      invert(l);
      const int begin = at(s.slot_begin, l), end = at(s.slot_begin, l + 1);
      for (int i = begin; i < end; ++i) {
        at(eliminated_, i) = product(at(coupling_, i), at(inverse_, l));
        const int ci = at(s.slot_camera, i);
        const Vector6<S> g = product(at(eliminated_, i), at(landmark_gradient_, l));
        for (int k = 0; k < 6; ++k) at(camera_step_, 6 * ci + k) += g[k];
        for (int j = begin; j <= i; ++j)
          subtract_outer(at(eliminated_, i).data(), at(coupling_, j).data(), 3,
                         reduced_.at(ci, at(s.slot_camera, j)).data());
      }
    }
    add_scale_weight();
    return reduced_.factorise(diagonal_.data(), lambda > 0 ? 0 : kRankTolerance) >= 0;
  }

  /// After reduce(): the step of all parameters. False where it is not finite.
  bool solve() {
    const BasicWindowStructure<S>& s = *structure_;
    reduced_.solve(camera_step_.data());
    solve_scale();
    apply_scale_row(camera_step_.data());
    for (double x : camera_step_)
      if (!is_finite(x)) return false;
    for (int l = 0; l < s.landmarks(); ++l) {
      Vector3<S> g = at(landmark_gradient_, l);
      for (int i = at(s.slot_begin, l); i < at(s.slot_begin, l + 1); ++i)
        g += transposed_product(at(coupling_, i), camera_step(at(s.slot_camera, i)));
      at(landmark_step_, l) = -(at(inverse_, l) * g);
      if (!all_finite(at(landmark_step_, l))) return false;
    }
    return true;
  }

  Vector6<S> camera_step(int camera) const noexcept { return six(camera_step_, camera); }
  const Vector3<S>& landmark_step(int landmark) const noexcept { return at(landmark_step_, landmark); }

  /// The decrease of the quadratic model's cost: -g.x + lambda x.D x.
  double predicted_decrease() const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < camera_step_.size(); ++i)
      sum += camera_step_[i] * (lambda_ * diagonal_[i] * camera_step_[i] - camera_gradient_[i]);
    for (int l = 0; l < structure_->landmarks(); ++l) {
      if (!at(structure_->landmark_free, l)) continue;
      const Vector3<S>&x = at(landmark_step_, l), &g = at(landmark_gradient_, l), d = damping(l);
      double landmark = 0;
      for (int i = 0; i < 3; ++i) landmark += x[i] * (lambda_ * (d[i] * x[i]) - g[i]);
      sum += landmark;
    }
    return sum;
  }

  /// After reduce(0).
  bool camera_deficient(int camera) const noexcept { return reduced_.deficient(camera); }
  bool landmark_deficient(int landmark) const noexcept { return at(landmark_deficient_, landmark) != 0; }

  /// Half the gradient of the cost, J^T W r.
  Vector6<S> camera_gradient(int camera) const noexcept { return six(camera_gradient_, camera); }
  const Vector3<S>& landmark_gradient(int landmark) const noexcept { return at(landmark_gradient_, landmark); }

  const Matrix3<S>& information(int landmark) const noexcept { return at(landmark_, landmark); }

  /// After reduce(0): the landmark's 3 x 3 block of the system's inverse, V^-1 + V^-1 W^T S^-1 W V^-1, under the scale
  /// gauge.
  Matrix3<S> covariance(int landmark) {
    const BasicWindowStructure<S>& s = *structure_;
    const int begin = at(s.slot_begin, landmark), end = at(s.slot_begin, landmark + 1);
    Matrix3<S> out = at(inverse_, landmark);
    solve_scale();
    for (int c = 0; c < 3; ++c) {
      column_.assign(camera_gradient_.size(), 0.0);
      for (int i = begin; i < end; ++i)
        for (int k = 0; k < 6; ++k) at(column_, 6 * at(s.slot_camera, i) + k) = at(eliminated_, i)(k, c);
      reduced_.solve(column_.data());
      apply_scale_row(column_.data());
      for (int i = begin; i < end; ++i) {
        const Vector3<S> part = transposed_product(at(eliminated_, i), six(column_, at(s.slot_camera, i)));
        for (int r = 0; r < 3; ++r) out(r, c) += part[r];
      }
    }
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < c; ++r) out(r, c) = out(c, r) = 0.5 * (out(r, c) + out(c, r));
    return out;
  }

  /// After reduce(0): the column of the blocks' covariance that belongs to unknown i of `block`, under the scale gauge.
  const std::vector<double>& covariance_column(int block, int i) {
    solve_scale();
    column_.assign(camera_gradient_.size(), 0.0);
    at(column_, 6 * block + i) = 1;
    reduced_.solve(column_.data());
    apply_scale_row(column_.data());
    return column_;
  }

 private:
  static Vector6<S> six(const std::vector<double>& all, int camera) noexcept {
    Vector6<S> v;
    for (int i = 0; i < 6; ++i) v[i] = at(all, 6 * camera + i);
    return v;
  }

  // The cameras' Marquardt diagonal, never zero.
  void read_diagonal(int blocks) {
    diagonal_.resize(6 * static_cast<std::size_t>(blocks));
    double largest = 0;
    for (int c = 0; c < blocks; ++c)
      for (int i = 0; i < 6; ++i) {
        at(diagonal_, 6 * c + i) = reduced_.at(c, c)(i, i);
        largest = (std::max)(largest, at(diagonal_, 6 * c + i));
      }
    const double floor = largest > 0 ? 1e-12 * largest : 1;
    for (double& d : diagonal_) d = (std::max)(d, floor);
  }

  Vector3<S> damping(int l) const noexcept {
    const Vector3<S> d = at(landmark_, l).diagonal();
    return d.cwiseMax(1e-9 * d.sum());
  }

  // (V + lambda D)^-1. A landmark without parallax is damped a little even where lambda is 0. One without information
  // does not move.
  void invert(int l) noexcept {
    Matrix3<S> v = at(landmark_, l);
    v.diagonal() += lambda_ * damping(l);
    const Ldlt<S, 3> plain(v, lambda_ > 0 ? 1e-15 : kRankTolerance);
    if (plain.ok()) {
      at(inverse_, l) = plain.inverse();
      return;
    }
    at(landmark_deficient_, l) = 1;
    v.diagonal() += 1e-9 * damping(l);
    const Ldlt<S, 3> damped(v);
    if (damped.ok()) at(inverse_, l) = damped.inverse();
  }

  // S <- S + w n n^T, n the scale row. Solutions with n.x = 0 stay, and the missing direction n is filled.
  void add_scale_weight() noexcept {
    if (scale_row_.empty()) return;
    double weight = 0;
    for (std::size_t i = 0; i < scale_row_.size(); ++i)
      if (scale_row_[i] != 0) weight = (std::max)(weight, diagonal_[i]);
    for (int a : scale_cameras_)
      for (int b : scale_cameras_)
        if (a >= b && b >= 0)
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
              reduced_.at(a, b)(i, j) += weight * at(scale_row_, 6 * a + i) * at(scale_row_, 6 * b + j);
  }

  void solve_scale() {
    scale_solution_ = scale_row_;
    if (!scale_row_.empty()) reduced_.solve(scale_solution_.data());
  }
  // x <- x - S^-1 n (n.x) / (n.S^-1 n), so that n.x = 0, where there is a scale gauge.
  void apply_scale_row(double* x) const noexcept {
    double nx = 0, nn = 0;
    for (std::size_t i = 0; i < scale_row_.size(); ++i) {
      nx += scale_row_[i] * x[i];
      nn += scale_row_[i] * scale_solution_[i];
    }
    if (!(nn > 0)) return;
    for (std::size_t i = 0; i < scale_row_.size(); ++i) x[i] -= scale_solution_[i] * (nx / nn);
  }

  const BasicWindowStructure<S>* structure_ = nullptr;
  double lambda_ = 0;
  BasicBlockCholesky<S> camera_, reduced_;
  std::vector<double> camera_gradient_, camera_step_, diagonal_, column_;
  std::vector<double> scale_row_, scale_solution_;
  int scale_cameras_[2] = {-1, -1};
  std::vector<Matrix63> coupling_, eliminated_;
  std::vector<Matrix3<S>> landmark_, inverse_;
  std::vector<Vector3<S>> landmark_gradient_, landmark_step_;
  std::vector<std::uint8_t> landmark_deficient_;
};

using WindowSchur = BasicWindowSchur<double>;

}  // namespace detail
TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_SOLVER_WINDOW_SCHUR_HPP
