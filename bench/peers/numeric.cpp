// All pixels must be visible. Built -O3 -march=native.
#include "peers/numeric.hpp"

#include <ceres/numeric_diff_cost_function.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <memory>

namespace textplane_bench {

namespace {

constexpr int kBlock = 8;

struct Normalisation {
  double mean_host = 0, mean_target = 0, is_host = 0, is_target = 0;
};

// Eight pixels of a text: their rays in the host and normalised intensities.
struct Block {
  const Problem* p;
  const Normalisation* normalisation;
  std::vector<Eigen::Vector3d> rays;
  std::vector<double> host;

  Block(const Problem& problem, const Normalisation& n, int first) : p(&problem), normalisation(&n) {
    for (int i = first; i < first + kBlock; ++i) {
      rays.push_back(ray(problem, i));
      host.push_back((static_cast<double>(problem.intensity[i]) - n.mean_host) * n.is_host);
    }
  }

  static Eigen::Vector3d ray(const Problem& p, int i) {
    return {(static_cast<double>(p.x[i]) - p.cx) / p.fx, (static_cast<double>(p.y[i]) - p.cy) / p.fy, 1};
  }

  static Eigen::Matrix4d world_to_camera(const double* q, const double* t) {
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    T.topLeftCorner<3, 3>() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
    T.topRightCorner<3, 1>() = Eigen::Map<const Eigen::Vector3d>(t);
    return T;
  }

  // The target at the projection of the point where the ray meets the plane, bilinear.
  static double sample(const Problem& p, const Eigen::Matrix4d& T_t_h, const Eigen::Vector3d& theta,
                       const Eigen::Vector3d& ray) {
    const double inverse_depth = ray.dot(theta);
    const Eigen::Vector3d q = T_t_h.topLeftCorner<3, 3>() * (ray / inverse_depth) + T_t_h.topRightCorner<3, 1>();
    const double x = p.fx * q[0] / q[2] + p.cx, y = p.fy * q[1] / q[2] + p.cy;
    const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
    if (left < 0 || top < 0 || std::ceil(x) >= p.width || std::ceil(y) >= p.height) return 0;
    const std::uint8_t* at = p.target + top * p.stride + left;
    const double dx = x - left, dy = y - top;
    return (1 - dx) * (1 - dy) * at[0] + dx * (1 - dy) * at[1] + (1 - dx) * dy * at[p.stride] +
           dx * dy * at[p.stride + 1];
  }

  bool operator()(const double* q_h_w, const double* t_h_w, const double* q_t_w, const double* t_t_w,
                  const double* plane, double* r) const {
    const Eigen::Matrix4d T_t_h = world_to_camera(q_t_w, t_t_w) * world_to_camera(q_h_w, t_h_w).inverse();
    const Eigen::Vector3d theta(plane[0], plane[1], plane[2]);
    for (std::size_t k = 0; k < rays.size(); ++k)
      r[k] = host[k] - (sample(*p, T_t_h, theta, rays[k]) - normalisation->mean_target) * normalisation->is_target;
    return true;
  }
};

using Cost = ceres::NumericDiffCostFunction<Block, ceres::CENTRAL, kBlock, 4, 3, 4, 3, 3>;

}  // namespace

struct NumericCost::State {
  Problem p;
  Normalisation normalisation;
  std::vector<std::unique_ptr<Cost>> blocks;
  double q_h_w[4] = {0, 0, 0, 1}, t_h_w[3] = {}, q_t_w[4], t_t_w[3], theta[3];
  std::vector<double> r, J;  // a block's five Jacobians one behind the other
};

NumericCost::NumericCost(const Problem& problem) : state_(new State) {
  State& s = *state_;
  s.p = problem;
  const Eigen::Matrix3d R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(problem.R);
  const Eigen::Map<const Eigen::Vector3d> t(problem.t), theta(problem.theta);
  Eigen::Map<Eigen::Vector4d>(s.q_t_w) = Eigen::Quaterniond(R).coeffs();
  Eigen::Map<Eigen::Vector3d>(s.t_t_w) = t;
  Eigen::Map<Eigen::Vector3d>(s.theta) = theta;

  const Eigen::Matrix4d T_t_h = Block::world_to_camera(s.q_t_w, s.t_t_w);
  double host = 0, host2 = 0, target = 0, target2 = 0;
  for (int i = 0; i < problem.n; ++i) {
    const double h = static_cast<double>(problem.intensity[i]),
                 v = Block::sample(problem, T_t_h, theta, Block::ray(problem, i));
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
    s.blocks.push_back(std::make_unique<Cost>(new Block(s.p, s.normalisation, first)));
  s.r.resize(s.blocks.size() * kBlock);
  s.J.resize(s.blocks.size() * kBlock * 17);
}

NumericCost::~NumericCost() { delete state_; }

void NumericCost::rows() {
  State& s = *state_;
  const double* parameters[5] = {s.q_h_w, s.t_h_w, s.q_t_w, s.t_t_w, s.theta};
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
