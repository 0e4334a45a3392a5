// 03: the pose of a camera from one sign whose plane is known. The guess is off by four centimetres and one degree.
#include <cstdio>

#include "stage/picture.hpp"
#include "stage/stage.hpp"
#include "textplane/features/select.hpp"
#include "textplane/solver/pose.hpp"

namespace tp = textplane;
using namespace textslam;

int main(int argc, char** argv) {
  const Stage stage("TICKETS", {0.1, 0.4, 0.0});
  const tp::SE3d T_w_h = camera_at({0, 0, 0}), T_w_t = camera_at({0.4, -0.1, 0.3}, {0.05, -0.2, 0.1});
  const tp::SE3d truth = T_w_t.inverse() * T_w_h;
  const Image<std::uint8_t> host = stage.view(T_w_h), target = stage.view(T_w_t);
  const tp::Vector3<double> theta = stage.theta(T_w_h);
  const tp::Quad<double> quad = stage.quad(T_w_h);

  tp::Vector6<double> error;
  error << 0.02, -0.01, 0.03, 0.005, -0.005, 0.02;  // (v, omega): metres, radians
  const tp::SE3d guess = tp::se3_exp(error) * truth;

  const tp::TextPatch patch = tp::make_patch(host.view(), stage.camera(), quad);
  const tp::PoseAlignment fit = tp::align_pose(patch, theta, guess, tp::Pyramid(target.view()), stage.camera());
  if (!tp::is_ok(fit.status)) return 1;

  const auto off = [&](const tp::SE3d& T) {
    return corner_error(warped(quad, theta, T, stage.camera()), stage.quad(T_w_t));
  };
  std::printf("%s after %d iterations, zncc %.4f, %d pixels\n", tp::to_string(fit.status), fit.iterations, fit.zncc,
              fit.visible_pixels);
  std::printf("guess: corners off by %.2f px\n", off(guess));
  std::printf("aligned: corners off by %.3f px\n", off(fit.T_t_h));
  std::printf("position off by %.2f mm\n", 1000 * (fit.T_t_h.inverse().t - truth.inverse().t).norm());

  Picture(argc, argv)
      .panel(host.view(), "host")
      .quad(quad, kTruth)
      .panel(target.view(), "target: guess (orange), aligned (green)")
      .quad(warped(quad, theta, guess, stage.camera()), kGuess)
      .quad(warped(quad, theta, fit.T_t_h, stage.camera()), kFound)
      .save();
}
