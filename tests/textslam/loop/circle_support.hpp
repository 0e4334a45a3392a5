// A walk round a circle as a chain of similarities.
#ifndef TESTS_TEXTSLAM_LOOP_CIRCLE_SUPPORT_HPP
#define TESTS_TEXTSLAM_LOOP_CIRCLE_SUPPORT_HPP

#include <cmath>
#include <vector>

#include "textslam/loop/pose_graph.hpp"

namespace textslam {

inline Similarity similarity(double scale, const Vec3& w, const Vec3& t) {
  Similarity S;
  S.scale = scale;
  S.R = textplane::so3_exp<double>(w);
  S.t = t;
  return S;
}

inline double distance(const Similarity& A, const Similarity& B) {
  const Similarity E = compose(inverse(A), B);
  return E.t.norm() + textplane::so3_log<double>(E.R).norm() + std::abs(std::log(E.scale));
}

// A walk once round a circle of radius 2, looking outwards.
inline std::vector<Similarity> circle(int n) {
  std::vector<Similarity> nodes;
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * M_PI * k / n;
    nodes.push_back(
        similarity(1, {0, angle, 0}, {2 * std::sin(angle), 0.1 * std::sin(3 * angle), 2 * std::cos(angle)}));
  }
  return nodes;
}

}  // namespace textslam

#endif  // TESTS_TEXTSLAM_LOOP_CIRCLE_SUPPORT_HPP
