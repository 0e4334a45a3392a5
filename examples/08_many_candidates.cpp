// 08: which of a thousand poses shows the sign? One call gives ZNCC for all of them, for relocalisation or to check a
// detection. Then the best is refined.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "renderer/random.hpp"
#include "stage/picture.hpp"
#include "stage/stage.hpp"
#include "textplane/features/select.hpp"
#include "textplane/photometry/candidates.hpp"
#include "textplane/solver/pose.hpp"

namespace tp = textplane;
using namespace textslam;

int main(int argc, char** argv) {
  const Stage stage("LIBRARY", {0.1, 0.3, 0.0});
  const tp::SE3d T_w_h = camera_at({0, 0, 0}), T_w_t = camera_at({0.3, 0.15, 0.2}, {-0.05, -0.1, 0.05});
  const Image<std::uint8_t> host = stage.view(T_w_h), target = stage.view(T_w_t);
  const tp::Vector3<double> theta = stage.theta(T_w_h);
  const tp::TextPatch patch = tp::make_patch(host.view(), stage.camera(), stage.quad(T_w_h));
  const tp::Pyramid pyramid(target.view());

  // Poses within about 40 cm and 8 degrees of the host's own, on level 2, where near poses already correlate.
  Random random(8);
  std::vector<tp::SE3d> poses;
  for (int i = 0; i < 1000; ++i) {
    tp::Vector6<double> xi;
    for (int k = 0; k < 6; ++k) xi[k] = (k < 3 ? 0.4 : 0.15) * random.uniform(-1, 1);
    poses.push_back(tp::se3_exp(xi));
  }
  constexpr int kLevel = 2;
  tp::TemplatePatch prepared;
  prepared.prepare(patch.levels[kLevel].view());
  tp::PhotometricWorkspace workspace(patch.max_pixels());
  std::vector<float> zncc(poses.size());
  tp::zncc_candidates(tp::photometric_input(patch, kLevel, pyramid, stage.camera()), theta, poses.data(),
                      static_cast<int>(poses.size()), {}, workspace, zncc.data(), &prepared);
  const auto best = static_cast<std::size_t>(std::max_element(zncc.begin(), zncc.end()) - zncc.begin());

  const tp::PoseAlignment fit = tp::align_pose(patch, theta, poses[best], pyramid, stage.camera());
  const auto quad = [&](const tp::SE3d& T) { return warped(patch.quad, theta, T, stage.camera()); };
  const tp::Quad<double> there = stage.quad(T_w_t);
  std::printf("best of %zu: zncc %.3f, corners off by %.2f px; not moved at all %.2f px\n", poses.size(),
              static_cast<double>(zncc[best]), corner_error(quad(poses[best]), there), corner_error(patch.quad, there));
  std::printf("refined: corners off by %.3f px\n", corner_error(quad(fit.T_t_h), there));

  Picture picture(argc, argv);
  picture.panel(host.view(), "host").quad(patch.quad, kTruth);
  picture.panel(target.view(), "some candidates, the best (orange), refined (green)");
  for (std::size_t i = 0; i < 30; ++i) picture.quad(quad(poses[i]), "#9aa0a8");
  picture.quad(quad(poses[best]), kGuess).quad(quad(fit.T_t_h), kFound).save();
}
