// All pixels must be visible. Built -O3 -march=native.
#include "peer_numeric.hpp"

#include <ceres/numeric_diff_cost_function.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>

namespace textplane_bench {

namespace {

constexpr int kBlock = 8;

struct Normalisation {
  double mean_host = 0, mean_target = 0, is_host = 0, is_target = 0;
};

double sample(const Problem& p, const Eigen::Matrix3d& H, int i) {
  const Eigen::Vector3d m((static_cast<double>(p.x[i]) - p.cx) / p.fx, (static_cast<double>(p.y[i]) - p.cy) / p.fy, 1);
  const Eigen::Vector3d q = H * m;
  const double iz = 1 / q[2];
  const double x = std::clamp(p.fx * q[0] * iz + p.cx, 0.0, p.width - 1.0);
  const double y = std::clamp(p.fy * q[1] * iz + p.cy, 0.0, p.height - 1.0);
  const int x0 = std::min(static_cast<int>(x), p.width - 2), y0 = std::min(static_cast<int>(y), p.height - 2);
  const std::uint8_t* upper = p.target + y0 * p.stride + x0;
  const std::uint8_t* lower = upper + p.stride;
  const double dx = x - x0, dy = y - y0;
  return (1 - dy) * ((1 - dx) * upper[0] + dx * upper[1]) + dy * ((1 - dx) * lower[0] + dx * lower[1]);
}

struct Block {
  const Problem* p;
  const Normalisation* normalisation;
  int first;

  bool operator()(const double* q_w_h, const double* t_w_h, const double* q_w_t, const double* t_w_t,
                  const double* plane, double* r) const {
    const Eigen::Map<const Eigen::Quaterniond> qh(q_w_h), qt(q_w_t);
    const Eigen::Map<const Eigen::Vector3d> th(t_w_h), tt(t_w_t), theta(plane);
    const Eigen::Matrix3d R_t_w = qt.toRotationMatrix().transpose(), R = R_t_w * qh.toRotationMatrix();
    const Eigen::Vector3d t = R_t_w * (th - tt);
    const Eigen::Matrix3d H = R + t * theta.transpose();
    for (int k = 0; k < kBlock; ++k)
      r[k] = (static_cast<double>(p->intensity[first + k]) - normalisation->mean_host) * normalisation->is_host -
             (sample(*p, H, first + k) - normalisation->mean_target) * normalisation->is_target;
    return true;
  }
};

using Cost = ceres::NumericDiffCostFunction<Block, ceres::CENTRAL, kBlock, 4, 3, 4, 3, 3>;

}  // namespace

struct NumericCost::State {
  Problem p;
  Normalisation normalisation;
  std::vector<std::unique_ptr<Cost>> blocks;
  double q_w_h[4] = {0, 0, 0, 1}, t_w_h[3] = {}, q_w_t[4], t_w_t[3], theta[3];
  std::vector<double> r, J;  // a block's five Jacobians one behind the other
};

NumericCost::NumericCost(const Problem& problem) : state_(new State) {
  State& s = *state_;
  s.p = problem;
  const Eigen::Matrix3d R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(problem.R);
  const Eigen::Map<const Eigen::Vector3d> t(problem.t), theta(problem.theta);
  Eigen::Map<Eigen::Vector4d>(s.q_w_t) = Eigen::Quaterniond(R.transpose()).coeffs();
  Eigen::Map<Eigen::Vector3d>(s.t_w_t) = -R.transpose() * t;
  Eigen::Map<Eigen::Vector3d>(s.theta) = theta;

  const Eigen::Matrix3d H = R + t * theta.transpose();
  double host = 0, host2 = 0, target = 0, target2 = 0;
  for (int i = 0; i < problem.n; ++i) {
    const double h = static_cast<double>(problem.intensity[i]), v = sample(problem, H, i);
    host += h;
    host2 += h * h;
    target += v;
    target2 += v * v;
  }
  Normalisation& n = s.normalisation;
  n.mean_host = host / problem.n;
  n.mean_target = target / problem.n;
  n.is_host = 1 / std::sqrt(host2 - host * n.mean_host);
  n.is_target = 1 / std::sqrt(target2 - target * n.mean_target);
  for (int first = 0; first + kBlock <= problem.n; first += kBlock)
    s.blocks.push_back(std::make_unique<Cost>(new Block{&s.p, &s.normalisation, first}));
  s.r.resize(s.blocks.size() * kBlock);
  s.J.resize(s.blocks.size() * kBlock * 17);
}

NumericCost::~NumericCost() { delete state_; }

void NumericCost::rows() {
  State& s = *state_;
  const double* parameters[5] = {s.q_w_h, s.t_w_h, s.q_w_t, s.t_w_t, s.theta};
  for (std::size_t b = 0; b < s.blocks.size(); ++b) {
    double* J = s.J.data() + b * kBlock * 17;
    double* jacobians[5] = {J, J + kBlock * 4, J + kBlock * 7, J + kBlock * 11, J + kBlock * 14};
    s.blocks[b]->Evaluate(parameters, s.r.data() + b * kBlock, jacobians);
  }
}

int NumericCost::theta_rows(std::vector<double>* out) const {
  const State& s = *state_;
  out->clear();
  for (std::size_t b = 0; b < s.blocks.size(); ++b) {
    const double* J = s.J.data() + b * kBlock * 17 + kBlock * 14;
    out->insert(out->end(), J, J + kBlock * 3);
  }
  return static_cast<int>(s.blocks.size()) * kBlock;
}

}  // namespace textplane_bench
