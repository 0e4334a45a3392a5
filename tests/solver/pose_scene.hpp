// A scene of three signs and points with a true pose, and refine_pose() called with it.
#ifndef TEXTPLANE_TESTS_SOLVER_POSE_SCENE_HPP
#define TEXTPLANE_TESTS_SOLVER_POSE_SCENE_HPP

#include <vector>

#include "solver/synthetic.hpp"
#include "textplane/solver/pose.hpp"

namespace pose_test {
using namespace textplane_test::planar;
using textplane::PoseFit;
using textplane::PoseOptions;
using textplane::PosePointTerm;
using textplane::PoseTextTerm;
using textplane::PoseWorkspace;

struct Input {
  Scene scene = three_signs();
  SE3d truth = target_pose();
  FloatPyramid target;
  std::vector<TextPatch> patches;
  std::vector<PoseTextTerm> texts;
  std::vector<PosePointTerm> points;
  PoseWorkspace workspace;

  explicit Input(bool exact = true, int point_count = 60, double noise_px = 0, unsigned seed = 5) {
    static const FloatPyramid rendered = scene.render(truth);
    target = rendered;
    for (const Sign& sign : scene.signs)
      patches.push_back(exact ? scene.exact_patch(sign, target, truth) : scene.patch(sign));
    for (std::size_t i = 0; i < patches.size(); ++i)
      texts.push_back({&patches[i], scene.signs[i].theta, scene.signs[i].T_w_h, 1});
    Random random(seed);
    while (static_cast<int>(points.size()) < point_count) {
      PosePointTerm p;
      const double x = random.uniform(0, 319), y = random.uniform(0, 239), z = random.uniform(1.5, 6);
      p.p_w = truth.inverse() * Vec3(z * scene.camera.unproject({x, y}));
      const double ex = noise_px * random.normal(), ey = noise_px * random.normal();
      p.px = Vec2(x + ex, y + ey);
      points.push_back(p);
    }
  }

  PoseFit solve(const SE3d& start, const PoseOptions& options = {}, bool with_texts = true, bool with_points = true,
                float* zncc = nullptr, float* chi2 = nullptr) {
    const int n = with_texts ? static_cast<int>(texts.size()) : 0,
              m = with_points ? static_cast<int>(points.size()) : 0;
    workspace.reserve(texts.data(), n, m);
    return refine_pose(texts.data(), n, points.data(), m, target.view(), scene.camera, start, options, workspace, zncc,
                       chi2);
  }
};

inline PoseOptions tight() {
  PoseOptions options;
  options.solve.max_iterations = 50;
  options.solve.cost_tolerance = 0;
  options.solve.step_tolerance = 1e-11;
  return options;
}

}  // namespace pose_test

#endif  // TEXTPLANE_TESTS_SOLVER_POSE_SCENE_HPP
