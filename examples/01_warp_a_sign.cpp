// 01: predicts how another view will see a sign of one view. It needs plane and pose, which give a homography.
#include <cstdio>
#include <vector>

#include "stage/picture.hpp"
#include "stage/stage.hpp"
#include "textplane/geometry/homography.hpp"
#include "textplane/photometry/warp_patch.hpp"
#include "textplane/photometry/zncc.hpp"

namespace tp = textplane;
using namespace textslam;

int main(int argc, char** argv) {
  const Stage stage("WELCOME", {0.1, 0.4, 0.0});
  const tp::SE3d T_w_h = camera_at({0, 0, 0});                            // host: the view that is known
  const tp::SE3d T_w_t = camera_at({0.7, -0.2, 0.2}, {0.1, -0.35, 0.1});  // target: the view to come
  const Image<std::uint8_t> host = stage.view(T_w_h), target = stage.view(T_w_t);

  // warp_patch() maps each pixel of the output to its source: target to host.
  const tp::SE3d T_t_h = T_w_t.inverse() * T_w_h;
  tp::Matrix3<double> H_h_t;
  if (!tp::is_ok(tp::plane_homography_inverse(stage.theta(T_w_h), T_t_h, &H_h_t))) return 1;
  Image<std::uint8_t> predicted(target.width(), target.height());
  tp::warp_patch(host.view(), tp::pixel_homography(H_h_t, stage.camera(), stage.camera()), predicted.view());

  // How well the prediction fits: ZNCC (1 is perfect) inside the text's quad.
  const tp::Quad<double> quad = stage.quad(T_w_t);
  std::vector<std::uint8_t> a, b;
  for (int y = 0; y < target.height(); ++y)
    for (int x = 0; x < target.width(); ++x)
      if (tp::contains(quad, tp::Vector2<double>(x, y))) {
        a.push_back(predicted(x, y));
        b.push_back(target(x, y));
      }
  std::printf("zncc %.4f\n", tp::zncc(a.data(), b.data(), nullptr, static_cast<int>(a.size())));

  Picture(argc, argv)
      .panel(host.view(), "host")
      .quad(stage.quad(T_w_h), kTruth)
      .panel(predicted.view(), "host, warped")
      .quad(warped(stage.quad(T_w_h), stage.theta(T_w_h), T_t_h, stage.camera()), kFound)
      .panel(target.view(), "target")
      .quad(quad, kTruth)
      .save();
}
