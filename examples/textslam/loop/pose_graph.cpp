#include "textslam/loop/pose_graph.hpp"

#include <Eigen/SparseCholesky>
#include <cmath>

namespace textslam {
namespace {

constexpr double kSettled = 1e-6;  // largest entry of a step: the next would be about its square

// M moved(I, d) M^-1 = moved(I, adjoint(M) d) to first order.
Matrix7 adjoint(const Similarity& M) {
  Matrix7 A = Matrix7::Zero();
  A.topLeftCorner<3, 3>() = M.scale * M.R;
  A.block<3, 3>(0, 3) = textplane::hat(M.t) * M.R;
  A.block<3, 1>(0, 6) = -M.t;
  A.block<3, 3>(3, 3) = M.R;
  A(6, 6) = 1;
  return A;
}

class Relaxation {
 public:
  Relaxation(const std::vector<GraphEdge>& edges, int nodes, int fixed) : edges_(edges), nodes_(nodes), fixed_(fixed) {}

  // Where a step in the tangent space of each node leads; false where there is none.
  bool step(const std::vector<Similarity>& S, Eigen::VectorXd* x) {
    const int n = 7 * (nodes_ - 1);
    triplets_.clear();
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    for (const GraphEdge& edge : edges_) {
      const Similarity &A = S[static_cast<std::size_t>(edge.a)], &B = S[static_cast<std::size_t>(edge.b)];
      const Similarity E = compose(inverse(edge.S_a_b), compose(inverse(A), B));
      Vector7 e;
      e << E.t, textplane::so3_log<double>(E.R), std::log(E.scale);
      Matrix7 J_b = Matrix7::Identity();
      J_b.topLeftCorner<3, 3>() = E.scale * E.R;
      J_b.block<3, 3>(3, 3) += 0.5 * textplane::hat<double>(e.segment<3>(3));
      const Matrix7 J_a = -J_b * adjoint(compose(inverse(B), A));
      const Matrix7& W = edge.information;
      add(edge.a, edge.a, J_a.transpose() * W * J_a);
      add(edge.b, edge.b, J_b.transpose() * W * J_b);
      if (edge.a > edge.b)
        add(edge.a, edge.b, J_a.transpose() * W * J_b);
      else
        add(edge.b, edge.a, J_b.transpose() * W * J_a);
      if (edge.a != fixed_) b.segment<7>(at(edge.a)) -= J_a.transpose() * W * e;
      if (edge.b != fixed_) b.segment<7>(at(edge.b)) -= J_b.transpose() * W * e;
    }
    Eigen::SparseMatrix<double> H(n, n);
    H.setFromTriplets(triplets_.begin(), triplets_.end());
    if (!analysed_) solver_.analyzePattern(H);
    analysed_ = true;
    solver_.factorize(H);
    if (solver_.info() != Eigen::Success) return false;
    *x = solver_.solve(b);
    return x->allFinite();
  }

  int at(int node) const { return 7 * (node < fixed_ ? node : node - 1); }

 private:
  // Of the lower triangle, which is all that the solver reads.
  void add(int a, int b, const Matrix7& block) {
    if (a == fixed_ || b == fixed_) return;
    for (int i = 0; i < 7; ++i)
      for (int j = 0; j < 7; ++j) triplets_.emplace_back(at(a) + i, at(b) + j, block(i, j));
  }

  const std::vector<GraphEdge>& edges_;
  int nodes_, fixed_;
  std::vector<Eigen::Triplet<double>> triplets_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
  bool analysed_ = false;  // the edges, and with them the pattern, stay
};

}  // namespace

Similarity moved(const Similarity& S, const Vector7& step) {
  Similarity out =
      compose(S, {std::exp(step[6]), textplane::so3_exp<double>(Vec3(step.segment<3>(3))), step.head<3>()});
  out.R = textplane::renormalised(SE3d{out.R, out.t}).R;
  return out;
}

bool relax(std::vector<Similarity>& nodes, const std::vector<GraphEdge>& edges, int fixed,
           const Parameters& parameters) {
  Relaxation relaxation(edges, static_cast<int>(nodes.size()), fixed);
  std::vector<Similarity> S = nodes;
  for (int iteration = 0; iteration < parameters.loop_graph_iterations; ++iteration) {
    Eigen::VectorXd x;
    if (!relaxation.step(S, &x)) return false;
    for (int k = 0; k < static_cast<int>(S.size()); ++k)
      if (k != fixed)
        S[static_cast<std::size_t>(k)] = moved(S[static_cast<std::size_t>(k)], x.segment<7>(relaxation.at(k)));
    if (x.lpNorm<Eigen::Infinity>() < kSettled) break;
  }
  nodes = std::move(S);
  return true;
}

}  // namespace textslam
