// Ceres: the texts of a TextMap in an adjustment of your own.
//
//   ceres::Problem problem;                                    // your points, your poses, what is constant
//   adapters::TextBlocks<> texts(map, [&](int id) { return pose_block(id); }, problem);
//   ceres::Solve(options, &problem, &summary);
//   texts.write_back();                                        // planes and poses
//
// A pose block is T_w_c (ceres_pose.hpp). A key frame stays where the map has it if its block is null, is not in the
// problem yet, or is constant there: so fill the problem first. A text adds a block of its plane, a TextCost for each
// key frame that sees it and moves, and what all other key frames say of the plane, as landmarks/text_terms.hpp has it.
// Planes are eliminated first by ceres::SPARSE_SCHUR and DENSE_SCHUR, as points are.
#ifndef TEXTPLANE_ADAPTERS_CERES_TEXT_MAP_HPP
#define TEXTPLANE_ADAPTERS_CERES_TEXT_MAP_HPP

#include <ceres/cost_function.h>
#include <ceres/problem.h>

#include <array>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "ceres.hpp"

#ifndef TEXTPLANE_SINGLE_HEADER
#include "textplane/landmarks/text_terms.hpp"
#endif

TEXTPLANE_BEGIN_NAMESPACE

namespace adapters {

/// L^T (theta - theta_0) of an information L L^T: block theta.
class TextPriorCost : public ceres::SizedCostFunction<3, 3> {
 public:
  /// sigma_rep: of the points that have unit weight, px.
  explicit TextPriorCost(const TextPrior& prior, double sigma_rep = 1)
      : theta_(prior.text->theta), rows_(sigma_rep * prior.information.llt().matrixU().toDenseMatrix()) {}

  /// As ceres::CostFunction.
  bool Evaluate(const double* const* blocks, double* residuals, double** jacobians) const override {
    Eigen::Map<Vector3<double>>{residuals} = rows_ * (Eigen::Map<const Vector3<double>>(blocks[0]) - theta_);
    if (jacobians && jacobians[0]) Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{jacobians[0]} = rows_;
    return true;
  }

 private:
  const Vector3<double> theta_;
  const Matrix3<double> rows_;
};

/// The standard deviation of the residuals of two numbers that a problem has at its start: the median of their lengths
/// over that of a Rayleigh distribution. `otherwise` where there are fewer than twenty, or all are zero.
inline double point_scale(const ceres::Problem& problem, double otherwise) {
  std::vector<ceres::ResidualBlockId> ids;
  problem.GetResidualBlocks(&ids);
  std::vector<double> lengths;
  std::vector<double*> blocks;
  for (const ceres::ResidualBlockId id : ids) {
    const ceres::CostFunction& cost = *problem.GetCostFunctionForResidualBlock(id);
    if (cost.num_residuals() != 2) continue;
    problem.GetParameterBlocksForResidualBlock(id, &blocks);
    Vector2<double> residual;
    if (cost.Evaluate(blocks.data(), residual.data(), nullptr) && all_finite(residual))
      lengths.push_back(residual.norm());
  }
  if (lengths.size() < 20) return otherwise;
  const double scale = sigma_of_lengths(lengths);
  return valid_sigma(scale) ? scale : otherwise;
}

/// See the head of this file. It must outlive the problem's last solve; the map must not change before write_back().
template <PoseOrder Order = PoseOrder::quaternion_translation>
class TextBlocks {
 public:
  /// block_of(id): the pose block of a key frame, or null. sigma_rep: the standard deviation of the residuals that the
  /// host's cost has, where they should have unit variance.
  TextBlocks(TextMap& map, std::function<double*(int)> block_of, ceres::Problem& problem, double sigma_rep)
      : map_(map), block_of_(std::move(block_of)) {
    add_to(problem, sigma_rep);
  }
  /// The same, by what the problem's points say of themselves (point_scale()). So add the points first.
  TextBlocks(TextMap& map, std::function<double*(int)> block_of, ceres::Problem& problem)
      : TextBlocks(map, std::move(block_of), problem, point_scale(problem, map.point_scale())) {}

  int texts() const noexcept { return static_cast<int>(planes_.size()); }  ///< Texts that the problem has.

  /// The planes found, and the poses of the blocks, become the map's.
  void write_back() {
    for (const Plane& plane : planes_) map_.set_plane(plane.text, plane.theta);
    map_.move([&](int id) {
      if (const double* block = block_of_(id)) return pose_from_block<Order>(block).inverse();
      SE3d stays;
      stays.t.setConstant(std::numeric_limits<double>::quiet_NaN());
      return stays;
    });
  }

 private:
  struct Plane {
    int text;
    Vector3<double> theta;
  };

  void add_to(ceres::Problem& problem, double sigma_rep) {
    const auto moving = [&](int id) {
      double* block = block_of_(id);
      return block && problem.HasParameterBlock(block) && !problem.IsParameterBlockConstant(block) ? block : nullptr;
    };
    const TextTerms all = text_terms(map_, [&](int id) { return moving(id) != nullptr; });
    const auto pool = std::make_shared<WorkspacePool>();
    const auto pose = [&](int id) {
      if (double* block = moving(id)) return block;
      const auto [at, is_new] = still_.try_emplace(id);
      if (is_new) pose_to_block<Order>(map_.keyframes().text_keyframe(id).T_w_c, at->second.data());
      return at->second.data();
    };
    planes_.reserve(all.priors.size());
    auto term = all.terms.begin();
    for (const TextPrior& prior : all.priors) {
      planes_.push_back({prior.text->id, prior.text->theta});
      Plane& plane = planes_.back();
      for (; term != all.terms.end() && term->text == prior.text; ++term) {
        TextCostOptions options;
        options.sigma_rep = sigma_rep;
        options.sigma_photo = term->sigma_photo;
        problem.AddResidualBlock(new TextCost<Order>(term->input, options, pool), nullptr, pose(prior.text->host),
                                 pose(term->target), plane.theta.data());
      }
      if (prior.information.trace() > 0)
        problem.AddResidualBlock(new TextPriorCost(prior, sigma_rep), nullptr, plane.theta.data());
    }
    for (auto& [id, block] : still_) problem.SetParameterBlockConstant(block.data());
  }

  TextMap& map_;
  std::function<double*(int)> block_of_;
  std::vector<Plane> planes_;                           // reserved, so that their addresses stay
  std::map<int, std::array<double, kPoseSize>> still_;  // poses of key frames without a block
};

}  // namespace adapters

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_ADAPTERS_CERES_TEXT_MAP_HPP
