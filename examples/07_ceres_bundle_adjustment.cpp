// 07: bundle adjustment by Ceres of five key frames, two of them fixed, and the plane of one sign, from the sign's
// pixels alone. Add costs of your own by problem.problem().AddResidualBlock(). Built where Ceres is found, with
// TEXTPLANE_BUILD_PEER_EXAMPLES.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "renderer/random.hpp"
#include "stage/picture.hpp"
#include "stage/stage.hpp"
#include "textplane/adapters/ceres_window.hpp"
#include "textplane/features/select.hpp"

namespace tp = textplane;
using namespace textslam;

// Coarse to fine.
void adjust(tp::Window& window) {
  for (int level = 2; level >= 0; --level) {
    tp::WindowOptions options;
    options.text_level = level;
    options.max_iterations = 50;
    tp::adapters::WindowProblem problem(window, options);
    ceres::Solver::Summary summary;
    ceres::Solve(problem.solver_options(), &problem.problem(), &summary);
    problem.write_back();
    std::printf("level %d: %s\n", level, summary.BriefReport().c_str());
  }
}

int main(int argc, char** argv) {
  const Stage stage("GALLERY", {0.2, 0.5, 0.0});
  std::vector<tp::SE3d> truth;
  std::vector<Image<std::uint8_t>> views;
  std::vector<tp::Pyramid> images;
  tp::Window window;
  window.camera = stage.camera();
  Random random(7);
  for (int i = 0; i < 5; ++i) {
    truth.push_back(camera_at({0.15 * i, -0.05 * i, 0.05 * i}, {0.02 * i, -0.06 * i, 0.03 * i}));
    views.push_back(stage.view(truth.back()));
    images.emplace_back(views.back().view());
    tp::WindowFrame& frame = window.frames.emplace_back();
    frame.fixed = i == 0 || i == 4;  // two fixed poses fix the gauge, scale included
    tp::Vector6<double> error = tp::Vector6<double>::Zero();
    for (int k = 0; k < 6 && !frame.fixed; ++k) error[k] = (k < 3 ? 0.006 : 0.003) * random.normal();
    frame.T_w_c = tp::se3_exp(error) * truth.back();
  }
  for (std::size_t i = 0; i < images.size(); ++i) window.frames[i].image = images[i].view();

  const tp::TextPatch patch = tp::make_patch(images[0].view(), stage.camera(), stage.quad(truth[0]));
  tp::WindowText& sign = window.texts.emplace_back();
  sign.host = 0;
  sign.patch = &patch;
  sign.theta = stage.theta(truth[0]) + tp::Vector3<double>(0.06, -0.04, 0.01);  // ten degrees off
  for (int i = 1; i < 5; ++i) {
    tp::WindowTextObservation& seen = window.text_observations.emplace_back();
    seen.text = 0;
    seen.frame = i;
  }

  const auto worst_position = [&] {
    double worst = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
      worst = std::max(worst, (window.frames[i].T_w_c.t - truth[i].t).norm());
    return 1000 * worst;
  };
  const auto reprojected = [&] {  // the sign in the last free frame, by the window's poses and plane
    return warped(patch.quad, window.texts[0].theta, window.frames[3].T_w_c.inverse() * window.frames[0].T_w_c,
                  stage.camera());
  };
  std::printf("before: positions off by %.1f mm at worst\n", worst_position());
  const Quad<double> guess = reprojected();
  adjust(window);
  std::printf("after: positions off by %.2f mm at worst\n", worst_position());
  std::printf("theta off by %.5f\n", (window.texts[0].theta - stage.theta(truth[0])).norm());
  Picture(argc, argv)
      .panel(views[0].view(), "host")
      .quad(patch.quad, kTruth)
      .panel(views[3].view(), "key frame 3: before (orange), after (green)")
      .quad(guess, kGuess)
      .quad(reprojected(), kFound)
      .save();
}
