#include "textslam/loop/loop_alignment.hpp"

#include <Eigen/Cholesky>

#include "textslam/map/observations.hpp"

namespace textslam {
namespace {

constexpr double kSettledStep = 1e-10;  // length of a step

struct NormalEquations {
  Matrix7 H = Matrix7::Zero();
  Vector7 b = Vector7::Zero();
  int observations = 0;
};

// S: the newest key frame in the old world. A step moves a point q of its frame by -(t + w x q + l q).
NormalEquations linearise(const Map& map, const Parameters& parameters, const MapLink& link, int newest,
                          const Similarity& S) {
  NormalEquations out;
  const Similarity S_k_w = inverse(S);
  for (const LinkSighting& sighting : link.sightings) {
    const SE3d T_j_k = map.keyframe(sighting.keyframe).T_w_c.inverse() * map.keyframe(newest).T_w_c;
    for (const Track& track : sighting.tracks) {
      if (map.point(track.point).bad) continue;
      const Vec3 q = S_k_w * map.point(track.point).p_w, p = T_j_k * q;
      if (!map.camera.in_domain(p)) continue;
      Eigen::Matrix<double, 2, 3> P;
      const Vec2 px = map.camera.project(p, &P);
      Eigen::Matrix<double, 3, 7> Q;
      Q << -Eigen::Matrix3d::Identity(), textplane::hat(q), -q;
      const Eigen::Matrix<double, 2, 7> J = P * T_j_k.R * Q / parameters.point_sigma;
      const Vec2 e = (px - track.px.cast<double>()) / parameters.point_sigma;
      const double w = e.norm() > parameters.loop_huber ? parameters.loop_huber / e.norm() : 1;
      out.H += w * J.transpose() * J;
      out.b -= w * J.transpose() * e;
      ++out.observations;
    }
  }
  return out;
}

}  // namespace

LoopAlignment align_loop(const Map& map, const Parameters& parameters, const MapLink& link, int newest) {
  LoopAlignment out;
  const double depth = median_depth(map, newest);
  if (!(depth > 0)) return out;
  Vector7 by_link = Vector7::Constant(1 / (parameters.loop_link_sigma * parameters.loop_link_sigma)),
          moved_by = Vector7::Zero();
  by_link.head<3>() /= depth * depth;
  out.S_w_k = compose(link.S_a_b, similarity_of(map.keyframe(newest).T_w_c));
  for (int iteration = 0; iteration < parameters.loop_iterations; ++iteration) {
    const NormalEquations equations = linearise(map, parameters, link, newest, out.S_w_k);
    if (equations.observations < parameters.join_min_pairs) return out;
    const Matrix7 H = equations.H + Matrix7(by_link.asDiagonal());
    const Vector7 step = H.ldlt().solve(equations.b - by_link.cwiseProduct(moved_by));
    if (!step.allFinite()) return out;
    moved_by += step;
    out.S_w_k = moved(out.S_w_k, step);
    // An old point has the same error in every key frame, so that all sightings inform as much as one.
    out.information = equations.H / static_cast<double>(link.sightings.size());
    if (step.norm() < kSettledStep) break;
  }
  out.ok = true;
  return out;
}

}  // namespace textslam
