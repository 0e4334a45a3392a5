// 04: the plane of a sign from many views of known pose, from the sign's pixels. The start is a plane that faces the
// camera, 40 degrees off.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "stage/picture.hpp"
#include "stage/stage.hpp"
#include "textplane/features/select.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/solver/plane.hpp"

namespace tp = textplane;
using namespace textslam;

int main(int argc, char** argv) {
  const Stage stage("BAGGAGE", {0.3, 0.65, 0.0});
  const tp::SE3d T_w_h = camera_at({0, 0, 0});
  const Image<std::uint8_t> host = stage.view(T_w_h);
  const tp::Vector3<double> truth = stage.theta(T_w_h);
  const tp::TextPatch patch = tp::make_patch(host.view(), stage.camera(), stage.quad(T_w_h));

  // A camera that passes by: near views first, in which a wrong plane still fits.
  std::vector<tp::Pyramid> images;
  std::vector<tp::SE3d> poses;
  for (int i = 1; i <= 6; ++i) {
    const tp::SE3d T_w_t = camera_at({0.08 * i, -0.03 * i, 0.02 * i}, {0.0, -0.03 * i, 0.0});
    images.emplace_back(stage.view(T_w_t).view());
    poses.push_back(T_w_t.inverse() * T_w_h);
  }
  std::vector<tp::PlaneTarget> targets;
  for (std::size_t i = 0; i < images.size(); ++i) targets.push_back({images[i].view(), poses[i]});

  const auto degrees_off = [&truth](const tp::Vector3<double>& theta) {
    return std::acos(std::min(tp::plane_normal(theta).dot(tp::plane_normal(truth)), 1.0)) * 180 / 3.14159265358979;
  };
  tp::PlaneWorkspace workspace;
  workspace.reserve(patch, static_cast<int>(targets.size()));
  const tp::Vector3<double> start(0, 0, truth[2]);
  tp::Vector3<double> theta = start;
  for (std::size_t n = 2; n <= targets.size(); n += 2) {  // as views come in
    const auto fit = tp::refine_plane(patch, theta, targets.data(), static_cast<int>(n), stage.camera(), {}, workspace);
    if (!tp::is_ok(fit.status)) return 1;
    theta = fit.theta;
    std::printf("%zu views: %s, normal off by %.3f deg, zncc %.4f\n", n, tp::to_string(fit.status), degrees_off(theta),
                fit.zncc);
  }
  std::printf("start: normal off by %.1f deg\n", degrees_off(start));
  std::printf("refined: normal off by %.3f deg\n", degrees_off(theta));

  Picture(argc, argv)
      .panel(host.view(), "host")
      .quad(stage.quad(T_w_h), kTruth)
      .panel(images.back().level(0), "last view: by the first plane (orange), by the refined one (green)")
      .quad(warped(patch.quad, start, poses.back(), stage.camera()), kGuess)
      .quad(warped(patch.quad, theta, poses.back(), stage.camera()), kFound)
      .save();
}
