// Common parts of the texts' Ceres cost functions (ceres.hpp): options, scratch memory, residuals and derivatives.
#ifndef TEXTPLANE_ADAPTERS_CERES_TEXT_ROWS_HPP
#define TEXTPLANE_ADAPTERS_CERES_TEXT_ROWS_HPP

#include <ceres/cost_function.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#ifndef TEXTPLANE_SINGLE_HEADER
#include "textplane/photometry/residual.hpp"
#include "textplane/solver/weighting.hpp"
#endif

TEXTPLANE_BEGIN_NAMESPACE

namespace adapters {

/// How a text observation becomes residuals: see ceres.hpp.
enum class TextRows { sums, pixels };

/// Settings of a text observation. It adds weight lambda_w c to the cost, lambda_w = text_weight() of its pixels.
struct TextCostOptions {
  PhotometricOptions photometric;             ///< Of every pixel, the robust cost included.
  Weighting weighting = Weighting::variance;  ///< How an object weighs against points: lambda_w.
  double sigma_rep = 1;                       ///< px.
  double sigma_photo = 0.3;                   ///< Per pixel, in units of 1/sqrt(N).
  double weight = 1;                          ///< Multiplies lambda_w.
  TextRows rows = TextRows::sums;             ///< Sums of the kernel, or a residual a pixel.
};

/// Scratch memory for cost functions on several threads: one workspace for each that runs. The costs of a problem
/// should share one pool; they keep it alive.
class WorkspacePool {
 public:
  /// Memory of one evaluation.
  struct Workspace {
    PhotometricWorkspace photometric;  ///< Of the kernels.
    std::vector<double> rows;          ///< Of TextRows::pixels.
  };

  /// A workspace for the caller alone until give_back(). On any thread.
  std::unique_ptr<Workspace> take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (idle_.empty()) return std::make_unique<Workspace>();
    std::unique_ptr<Workspace> out = std::move(idle_.back());
    idle_.pop_back();
    return out;
  }
  /// Returns a workspace of take().
  void give_back(std::unique_ptr<Workspace> workspace) {
    const std::lock_guard<std::mutex> lock(mutex_);
    idle_.push_back(std::move(workspace));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Workspace>> idle_;
};

namespace detail {

// J = L^T and r = L^-1 b of the semi-definite H = L L^T. A pivot within rounding of zero gives a row of zeros. With
// pose and plane one of the nine always does: they share a scale.
template <int P>
void square_root(const NormalEquations<P>& sums, FixedMatrix<double, P, P>* J,
                 Eigen::Matrix<double, P, 1>* r) noexcept {
  constexpr double kRounding = 1e-6;
  J->setZero();
  r->setZero();
  for (int k = 0; k < P; ++k) {
    double pivot = sums.H(k, k), rest = sums.b[k];
    for (int m = 0; m < k; ++m) {
      pivot -= (*J)(m, k) * (*J)(m, k);
      rest -= (*J)(m, k) * (*r)[m];
    }
    if (!(pivot > kRounding * sums.H(k, k))) continue;
    (*J)(k, k) = std::sqrt(pivot);
    (*r)[k] = rest / (*J)(k, k);
    for (int c = k + 1; c < P; ++c) {
      double s = sums.H(k, c);
      for (int m = 0; m < k; ++m) s -= (*J)(m, k) * (*J)(m, c);
      (*J)(k, c) = s / (*J)(k, k);
    }
  }
}

// Base of the texts' cost functions: residuals, and rows by the unknowns of T_t_h and theta.
template <Parameters Unknowns>
class TextRowsCost : public ceres::CostFunction {
 protected:
  static constexpr int P = dof(Unknowns);
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, P, Eigen::RowMajor>;

  TextRowsCost(const PhotometricInput& input, const TextCostOptions& options, std::shared_ptr<WorkspacePool> pool)
      : input_(input), options_(options), pool_(pool ? std::move(pool) : std::make_shared<WorkspacePool>()) {
    set_num_residuals(options.rows == TextRows::sums ? P + 1 : (std::max)(input.patch.n, 1));
  }

  // After a success, and where `rows` is true, calls write() with the num_residuals() x P rows.
  template <class Write>
  bool evaluate(const Vector3<double>& theta, const SE3d& T_t_h, double* residuals, bool rows,
                const Write& write) const {
    std::unique_ptr<WorkspacePool::Workspace> workspace = pool_->take();
    workspace->photometric.reserve(input_.patch.n);
    workspace->rows.resize(static_cast<std::size_t>(num_residuals()) * P);
    const ResidualRequest<std::uint8_t> request{input_, theta, T_t_h, options_.photometric};
    const bool ok = options_.rows == TextRows::sums ? sums(request, residuals, rows, *workspace)
                                                    : pixels(request, residuals, rows, *workspace);
    if (ok && rows) write(Eigen::Map<const Rows>(workspace->rows.data(), num_residuals(), P));
    pool_->give_back(std::move(workspace));
    return ok;
  }

 private:
  double factor(int visible) const noexcept {
    return std::sqrt(options_.weight *
                     text_weight(options_.weighting, options_.sigma_rep, options_.sigma_photo, visible));
  }

  bool sums(const ResidualRequest<std::uint8_t>& request, double* residuals, bool rows,
            WorkspacePool::Workspace& workspace) const {
    Eigen::Map<Eigen::Matrix<double, P + 1, 1>> out(residuals);
    out.setZero();
    if (!rows) {
      const PhotometricCost cost = textplane::evaluate(request, workspace.photometric);
      out[P] = factor(cost.visible) * std::sqrt(cost.cost);
      return is_ok(cost.status);
    }
    const NormalEquations<P> sums = linearise<Unknowns>(request, workspace.photometric);
    if (!is_ok(sums.status)) return false;
    FixedMatrix<double, P, P> J;
    Eigen::Matrix<double, P, 1> r;
    square_root<P>(sums, &J, &r);
    const double scale = factor(sums.visible);
    out.template head<P>() = scale * r;
    out[P] = scale * std::sqrt((std::max)(sums.cost - r.squaredNorm(), 0.0));
    Eigen::Map<Eigen::Matrix<double, P + 1, P, Eigen::RowMajor>> to(workspace.rows.data());
    to.template topRows<P>() = scale * J;
    to.template bottomRows<1>().setZero();
    return true;
  }

  bool pixels(const ResidualRequest<std::uint8_t>& request, double* residuals, bool rows,
              WorkspacePool::Workspace& workspace) const {
    const ResidualSummary sum = reference::residuals<Unknowns>(request, workspace.photometric, residuals,
                                                               rows ? workspace.rows.data() : nullptr);
    if (!is_ok(sum.status)) return false;
    const double root = std::sqrt(static_cast<double>(sum.visible)), scale = factor(sum.visible) / root;
    for (int i = 0; i < input_.patch.n; ++i) {
      const double e = root * residuals[i], rho = options_.photometric.robust.rho(e * e);
      const bool zero = !(rho > 0);
      residuals[i] = zero ? 0.0 : std::copysign(scale * std::sqrt(rho), e);
      // d sqrt(rho(e^2)) / de = w e / sqrt(rho), 1 at e = 0.
      const double slope = zero ? 1.0 : options_.photometric.robust.weight(e * e) * std::abs(e) / std::sqrt(rho);
      if (rows)
        for (int p = 0; p < P; ++p) workspace.rows[static_cast<std::size_t>(i * P + p)] *= scale * slope * root;
    }
    return true;
  }

  const PhotometricInput input_;
  const TextCostOptions options_;
  const std::shared_ptr<WorkspacePool> pool_;
};

}  // namespace detail

}  // namespace adapters

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_ADAPTERS_CERES_TEXT_ROWS_HPP
