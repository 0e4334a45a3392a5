// Samples value and gradient and chains them into the Jet by hand, the cheapest way for automatic differentiation.
// All pixels must be visible. Built -O3 -march=native.
#include "peers/ceres.hpp"

#include <ceres/autodiff_cost_function.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace textplane_bench {

namespace {

// The pixel's value as a function of its position.
inline double sample(double value, double, double, double, double) { return value; }
template <class T, int N>
ceres::Jet<T, N> sample(double value, double gx, double gy, const ceres::Jet<T, N>& x, const ceres::Jet<T, N>& y) {
  ceres::Jet<T, N> out(value);
  out.v = gx * x.v + gy * y.v;
  return out;
}
inline double value_of(double x) { return x; }
template <class T, int N>
double value_of(const ceres::Jet<T, N>& x) {
  return x.a;
}

struct Residual {
  explicit Residual(const Problem& problem) : p(problem) {}

  template <class T>
  bool operator()(const T* pose, const T* plane, T* r) const {
    // H = Exp(xi) (R | t) theta at xi = 0, to first order: (I + [omega]x) R and t + omega x t + v.
    T H[9];
    const T theta[3] = {p.theta[0] + plane[0], p.theta[1] + plane[1], p.theta[2] + plane[2]};
    T t[3];
    const T* w = pose + 3;
    const auto turned = [&w](const double* a, int row) {  // (I + [omega]x) a
      const int i = (row + 1) % 3, j = (row + 2) % 3;
      return w[i] * a[j] - w[j] * a[i] + a[row];
    };
    for (int i = 0; i < 3; ++i) t[i] = turned(p.t, i) + pose[i];
    for (int c = 0; c < 3; ++c) {
      const double column[3] = {p.R[c], p.R[3 + c], p.R[6 + c]};
      for (int i = 0; i < 3; ++i) H[3 * i + c] = turned(column, i) + t[i] * theta[c];
    }
    const double ifx = 1 / p.fx, ify = 1 / p.fy;
    double sum_host = 0;
    T sum(0.0);
    for (int i = 0; i < p.n; ++i) {
      const double u = (static_cast<double>(p.x[i]) - p.cx) * ifx, v = (static_cast<double>(p.y[i]) - p.cy) * ify;
      const T iz = 1.0 / (H[6] * u + H[7] * v + H[8]);
      const T x = (H[0] * u + H[1] * v + H[2]) * iz * p.fx + p.cx, y = (H[3] * u + H[4] * v + H[5]) * iz * p.fy + p.cy;
      const double px = value_of(x), py = value_of(y);
      if (!(px >= 0 && py >= 0 && px <= p.width - 1 && py <= p.height - 1)) return false;
      const int x0 = std::min(static_cast<int>(px), p.width - 2), y0 = std::min(static_cast<int>(py), p.height - 2);
      const std::uint8_t* upper = p.target + y0 * p.stride + x0;
      const std::uint8_t* lower = upper + p.stride;
      const double dx = px - x0, dy = py - y0, along = upper[1] - upper[0], down = lower[0] - upper[0];
      const double twist = lower[1] - lower[0] - along, gx = along + dy * twist, gy = down + dx * twist;
      r[i] = sample(upper[0] + dx * along + dy * gy, gx, gy, x, y);
      sum += r[i];
      sum_host += static_cast<double>(p.intensity[i]);
    }
    const double n = p.n, mean_host = sum_host / n;
    const T mean = sum / n;
    double squares_host = 0;
    T squares(0.0);
    for (int i = 0; i < p.n; ++i) {
      r[i] -= mean;
      squares += r[i] * r[i];
      const double d = static_cast<double>(p.intensity[i]) - mean_host;
      squares_host += d * d;
    }
    using std::sqrt;
    const T scale = 1.0 / sqrt(squares);
    const double scale_host = 1 / std::sqrt(squares_host);
    for (int i = 0; i < p.n; ++i) r[i] = (static_cast<double>(p.intensity[i]) - mean_host) * scale_host - r[i] * scale;
    return true;
  }

  Problem p;
};

using Cost = ceres::AutoDiffCostFunction<Residual, ceres::DYNAMIC, 6, 3>;
using Rows6 = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;
using Rows3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

}  // namespace

struct CeresCost::State {
  explicit State(const Problem& p) : cost(new Residual(p), p.n), r(p.n), pose(p.n, 6), plane(p.n, 3) {}
  Cost cost;
  Eigen::VectorXd r;
  Rows6 pose;
  Rows3 plane;
};

CeresCost::CeresCost(const Problem& problem) : state_(new State(problem)) {}
CeresCost::~CeresCost() { delete state_; }

void CeresCost::rows() {
  const double zero[6] = {};
  const double* parameters[2] = {zero, zero};
  double* jacobians[2] = {state_->pose.data(), state_->plane.data()};
  state_->cost.Evaluate(parameters, state_->r.data(), jacobians);
}

void CeresCost::equations(Equations* out) {
  rows();
  const State& s = *state_;
  Eigen::Matrix<double, 9, 9> H;
  H.topLeftCorner<6, 6>().noalias() = s.pose.transpose() * s.pose;
  H.topRightCorner<6, 3>().noalias() = s.pose.transpose() * s.plane;
  H.bottomRightCorner<3, 3>().noalias() = s.plane.transpose() * s.plane;
  H.bottomLeftCorner<3, 6>() = H.topRightCorner<6, 3>().transpose();
  Eigen::Map<Eigen::Matrix<double, 9, 9>> H_out(out->H);
  H_out = H;
  Eigen::Map<Eigen::Matrix<double, 6, 1>> b_pose(out->b);
  Eigen::Map<Eigen::Matrix<double, 3, 1>> b_plane(out->b + 6);
  b_pose.noalias() = s.pose.transpose() * s.r;
  b_plane.noalias() = s.plane.transpose() * s.r;
  out->cost = s.r.squaredNorm();
  out->visible = static_cast<int>(s.r.size());
}

}  // namespace textplane_bench
