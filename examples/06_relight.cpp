// 06: aligns one sign in six lights from the same guess. Gain and bias cancel exactly; the robust cost deals with a
// vignette and a reflection.
#include <algorithm>
#include <cstdio>
#include <utility>

#include "stage/picture.hpp"
#include "stage/stage.hpp"
#include "textplane/features/select.hpp"
#include "textplane/solver/pose.hpp"

namespace tp = textplane;
using namespace textslam;

int main(int argc, char** argv) {
  const Stage stage("MUSEUM", {0.1, -0.3, 0.0});
  const tp::SE3d T_w_h = camera_at({0, 0, 0}), T_w_t = camera_at({-0.3, 0.1, 0.2}, {0.0, 0.15, -0.05});
  const tp::SE3d truth = T_w_t.inverse() * T_w_h;
  const Image<std::uint8_t> host = stage.view(T_w_h);
  const tp::Vector3<double> theta = stage.theta(T_w_h);
  const tp::TextPatch patch = tp::make_patch(host.view(), stage.camera(), stage.quad(T_w_h));
  tp::Vector6<double> error;
  error << 0.01, -0.005, 0.03, -0.005, 0.005, 0.02;
  const tp::SE3d guess = tp::se3_exp(error) * truth;

  SensorState dim, bright, hazy, vignette, glare;
  dim.gain = 0.35;
  bright.gain = 1.15;  // some of it is clipped at 255
  hazy.gain = 0.5;
  hazy.bias = 90;
  vignette.vignette = 0.7;
  glare.glare.push_back({{210, 170}, 30, 120});
  const std::pair<const char*, SensorState> lights[] = {{"steady", {}}, {"dim", dim},           {"bright", bright},
                                                        {"haze", hazy}, {"vignette", vignette}, {"reflex", glare}};
  Picture picture(argc, argv);
  double worst = 0;
  for (const auto& [name, light] : lights) {
    const Image<std::uint8_t> target = stage.view(T_w_t, light);
    const auto fit = tp::align_pose(patch, theta, guess, tp::Pyramid(target.view()), stage.camera());
    const tp::Quad<double> found = warped(patch.quad, theta, fit.T_t_h, stage.camera());
    const double off = corner_error(found, stage.quad(T_w_t));
    worst = std::max(worst, tp::is_ok(fit.status) ? off : 1e3);
    std::printf("%-8s %-9s zncc %.4f, corners off by %.3f px\n", name, tp::to_string(fit.status), fit.zncc, off);
    picture.panel(target.view(), name).quad(found, kFound);
  }
  std::printf("worst: corners off by %.3f px\n", worst);
  picture.save();
}
