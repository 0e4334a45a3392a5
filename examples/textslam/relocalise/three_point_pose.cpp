#include "textslam/relocalise/three_point_pose.hpp"

#include <Eigen/LU>
#include <cstdint>

#include "textplane/solver/pose.hpp"
#include "textslam/track/pose_refit.hpp"

namespace textslam {
namespace {

using textplane::Status;
using Mat3 = Eigen::Matrix3d;

constexpr double kThin = 1e-3;     // height of a triangle by its longest side: a line
constexpr double kSettled = 1e-9;  // of squared sides
constexpr int kNewtonSteps = 12;

// Axes of the triangle's plane; false for a line.
bool triangle_axes(const std::array<Vec3, 3>& p, Mat3* axes) {
  const Vec3 a = p[1] - p[0], b = p[2] - p[0], n = a.cross(b);
  const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
  if (!(n.norm() > kThin * longest)) return false;
  const Vec3 x = a.normalized(), z = n.normalized();
  *axes << x, z.cross(x), z;
  return true;
}

double mean_side(const std::array<Vec3, 3>& p) {
  return ((p[0] - p[1]).norm() + (p[1] - p[2]).norm() + (p[2] - p[0]).norm()) / 3;
}

// Even draws; the same at every call with the same history.
class Draws {
 public:
  std::size_t below(std::size_t n) {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::size_t>(((state_ >> 33) * static_cast<std::uint64_t>(n)) >> 31);
  }

 private:
  std::uint64_t state_ = 88172645463325252U;
};

bool agrees(const PointMatch& match, const CameraView& camera, const Parameters& parameters, const SE3d& T_c_w) {
  return is_pose_inlier(parameters, pose_chi2(camera, T_c_w, match.p_w, match.px, match.sigma));
}

std::vector<PointMatch> agreeing(const std::vector<PointMatch>& matches, const CameraView& camera,
                                 const Parameters& parameters, const SE3d& T_c_w) {
  std::vector<PointMatch> out;
  for (const PointMatch& match : matches)
    if (agrees(match, camera, parameters, T_c_w)) out.push_back(match);
  return out;
}

bool fit(const std::vector<PointMatch>& matches, const CameraView& camera, SE3d* T_c_w) {
  std::vector<textplane::PosePointTerm> terms;
  for (const PointMatch& match : matches) terms.push_back({match.p_w, match.px, match.sigma});
  const int count = static_cast<int>(terms.size());
  textplane::PoseWorkspace workspace;
  workspace.reserve(nullptr, 0, count);
  const auto result = textplane::refine_pose(nullptr, 0, terms.data(), count, textplane::PyramidView(), camera, *T_c_w,
                                             textplane::PoseOptions(), workspace);
  if (!textplane::is_ok(result.status) && result.status != Status::diverged) return false;
  *T_c_w = textplane::renormalised(result.T_t_w);
  return true;
}

}  // namespace

Status three_point_pose(const std::array<Vec3, 3>& p_w, const std::array<Vec3, 3>& rays, const Vec3& depths,
                        SE3d* T_c_w) {
  for (std::size_t i = 0; i < 3; ++i)
    if (!p_w[i].allFinite() || !rays[i].allFinite()) return Status::non_finite;
  if (!depths.allFinite()) return Status::non_finite;
  Mat3 axes_w, axes_c;
  if (!triangle_axes(p_w, &axes_w) || !triangle_axes(rays, &axes_c)) return Status::degenerate;
  Vec3 d = depths;
  const double size = mean_side(p_w) * mean_side(p_w);
  bool settled = false;
  for (int step = 0; step < kNewtonSteps && !settled; ++step) {
    Vec3 error;
    Mat3 J = Mat3::Zero();
    for (int k = 0; k < 3; ++k) {
      const int i = k, j = (k + 1) % 3;
      const Vec3 &m = rays[static_cast<std::size_t>(i)], &n = rays[static_cast<std::size_t>(j)];
      const Vec3 side = d[i] * m - d[j] * n;
      error[k] =
          side.squaredNorm() - (p_w[static_cast<std::size_t>(i)] - p_w[static_cast<std::size_t>(j)]).squaredNorm();
      J(k, i) = 2 * side.dot(m);
      J(k, j) = -2 * side.dot(n);
    }
    settled = error.norm() <= kSettled * size;
    if (!settled) d -= J.partialPivLu().solve(error);
    if (!(d.minCoeff() > 0)) return Status::diverged;
  }
  const std::array<Vec3, 3> p_c = {d[0] * rays[0], d[1] * rays[1], d[2] * rays[2]};
  if (!settled || !triangle_axes(p_c, &axes_c)) return Status::diverged;
  T_c_w->R = axes_c * axes_w.transpose();
  T_c_w->t = (p_c[0] + p_c[1] + p_c[2]) / 3 - T_c_w->R * (p_w[0] + p_w[1] + p_w[2]) / 3;
  return Status::ok;
}

MatchedPose settled_pose(const std::vector<PointMatch>& matches, const CameraView& camera, const SE3d& T_c_w,
                         const Parameters& parameters) {
  MatchedPose best{T_c_w, 0};
  std::vector<PointMatch> agree = agreeing(matches, camera, parameters, T_c_w);
  best.inliers = static_cast<int>(agree.size());
  for (int round = 0; round < parameters.place_rounds && agree.size() >= 3; ++round) {
    SE3d next = best.T_c_w;
    if (!fit(agree, camera, &next)) break;
    agree = agreeing(matches, camera, parameters, next);
    if (static_cast<int>(agree.size()) < best.inliers) break;
    best = {next, static_cast<int>(agree.size())};
  }
  return best;
}

MatchedPose pose_of_matches(const std::vector<PointMatch>& matches, const CameraView& camera, const SE3d& T_near,
                            const Parameters& parameters) {
  MatchedPose best;
  if (matches.size() < 3) return best;
  Draws draws;
  for (int draw = 0; draw < parameters.place_draws; ++draw) {
    std::array<Vec3, 3> p_w, rays;
    std::array<Vec3, 3> seen;  // from nearby
    for (std::size_t i = 0; i < 3; ++i) {
      const PointMatch& match = matches[draws.below(matches.size())];
      p_w[i] = match.p_w;
      rays[i] = ray_at_pose(camera, match.px);
      seen[i] = T_near * match.p_w;
    }
    // What looks larger than nearby is as much nearer.
    const double ratio =
        mean_side({seen[0] / seen[0].z(), seen[1] / seen[1].z(), seen[2] / seen[2].z()}) / mean_side(rays);
    SE3d T_c_w;
    if (!textplane::is_ok(three_point_pose(p_w, rays, ratio * Vec3(seen[0].z(), seen[1].z(), seen[2].z()), &T_c_w)))
      continue;
    int inliers = 0;
    for (const PointMatch& match : matches) inliers += agrees(match, camera, parameters, T_c_w) ? 1 : 0;
    if (inliers > best.inliers) best = {T_c_w, inliers};
  }
  return best.inliers < 3 ? best : settled_pose(matches, camera, best.T_c_w, parameters);
}

}  // namespace textslam
