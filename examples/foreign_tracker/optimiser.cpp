#include "foreign_tracker/optimiser.hpp"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/product_manifold.h>
#include <ceres/solver.h>

#include <algorithm>
#include <set>

#include "textplane/adapters/ceres_text_map.hpp"  // text

namespace foreign {

namespace {

// Reprojection error of a point: blocks T_w_c (quaternion x y z w, translation) and p_w.
struct Reprojection {
  Camera camera;
  cv::Point2f px;
  double sigma;

  template <class T>
  bool operator()(const T* pose, const T* point, T* residual) const {
    const Eigen::Quaternion<T> q(pose[3], -pose[0], -pose[1], -pose[2]);
    const Eigen::Matrix<T, 3, 1> p =
        q * Eigen::Matrix<T, 3, 1>(point[0] - pose[4], point[1] - pose[5], point[2] - pose[6]);
    if (!(p[2] > T(1e-3))) return false;
    residual[0] = (camera.fx * p[0] / p[2] + (camera.cx - px.x)) / sigma;
    residual[1] = (camera.fy * p[1] / p[2] + (camera.cy - px.y)) / sigma;
    return true;
  }
};

bool fits(const Camera& camera, const Frame& frame, std::size_t key, const MapPoint& point) {
  double r[2];
  const Eigen::Matrix<double, 7, 1> pose = Eigen::Map<const Eigen::Matrix<double, 7, 1>>(Se3(frame.T_w_c).data());
  const Reprojection cost{camera, frame.keys[key].pt, frame.sigma(key)};
  return cost(pose.data(), point.p_w.data(), r) && r[0] * r[0] + r[1] * r[1] <= kChiSquare95;
}

void add(const Camera& camera, Frame& frame, std::size_t key, MapPoint& point, bool robust, ceres::Problem& problem) {
  const auto cost = new Reprojection{camera, frame.keys[key].pt, frame.sigma(key)};
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Reprojection, 2, 7, 3>(cost),
                           robust ? new ceres::HuberLoss(std::sqrt(kChiSquare95)) : nullptr, frame.T_w_c.data(),
                           point.p_w.data());
}

bool in_front(const Frame& frame, const MapPoint& point) { return (frame.T_w_c.inverse() * point.p_w)[2] > 0.05; }

using PoseManifold = ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>;

}  // namespace

int optimise_pose(const Camera& camera, Frame& frame) {
  const std::vector<MapPoint*> points = frame.points;
  for (int round = 0; round < 3; ++round) {
    ceres::Problem problem;
    problem.AddParameterBlock(frame.T_w_c.data(), 7, new PoseManifold);
    int n = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!frame.points[i] || !in_front(frame, *points[i])) continue;
      add(camera, frame, i, *points[i], round < 2, problem);
      ++n;
    }
    if (n < 10) return n;
    std::vector<double*> blocks;
    problem.GetParameterBlocks(&blocks);
    for (double* block : blocks)
      if (block != frame.T_w_c.data()) problem.SetParameterBlockConstant(block);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 10;
    options.function_tolerance = 1e-4;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    for (std::size_t i = 0; i < points.size(); ++i)  // an outlier that fits again comes back
      frame.points[i] = points[i] && fits(camera, frame, i, *points[i]) ? points[i] : nullptr;
  }
  return frame.tracked();
}

void adjust(const Camera& camera, Map& map, const std::vector<Frame*>& window, textplane::TextMap& texts) {  // text
  std::set<MapPoint*> points;
  for (Frame* frame : window)
    for (MapPoint* p : frame->points)
      if (p && !p->bad) points.insert(p);
  for (int round = 0; round < 2; ++round) {
    ceres::Problem problem;
    for (Frame* frame : window) problem.AddParameterBlock(frame->T_w_c.data(), 7, new PoseManifold);
    for (const auto& point : map.points) {  // a fixed order: the same sums in every run
      if (point->bad || points.count(point.get()) == 0) continue;
      for (const auto& [frame, key] : point->seen) {
        if (!in_front(*frame, *point)) continue;
        add(camera, *frame, key, *point, round == 0, problem);
      }
    }
    for (const auto& frame : map.key_frames)
      if ((frame == map.key_frames.front() || std::find(window.begin(), window.end(), frame.get()) == window.end()) &&
          problem.HasParameterBlock(frame->T_w_c.data()))
        problem.SetParameterBlockConstant(frame->T_w_c.data());
    const auto pose_of = [&](int id) { return map.key_frames[static_cast<std::size_t>(id)]->T_w_c.data(); };  // text
    textplane::adapters::TextBlocks<> blocks(texts, pose_of, problem);                                        // text
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.max_num_iterations = round == 0 ? 5 : 10;
    options.function_tolerance = 1e-4;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    blocks.write_back();  // text
    for (MapPoint* point : points) {
      auto& seen = point->seen;
      seen.erase(std::remove_if(seen.begin(), seen.end(),
                                [&](const auto& s) {
                                  if (fits(camera, *s.first, s.second, *point)) return false;
                                  s.first->points[s.second] = nullptr;
                                  return true;
                                }),
                 seen.end());
      point->bad = seen.size() < 2;
      for (const auto& [frame, key] : seen)
        if (point->bad) frame->points[key] = nullptr;
    }
  }
}

}  // namespace foreign
