// 02: the plane of a sign from three of its corners in two views of known pose. More points make it a least-squares
// fit.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "stage/picture.hpp"
#include "stage/stage.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/geometry/plane_fit.hpp"

namespace tp = textplane;
using namespace textslam;

int main(int argc, char** argv) {
  const Stage stage("PLATFORM", {0.2, -0.5, 0.1});
  const tp::SE3d T_w_h = camera_at({0, 0, 0}), T_w_t = camera_at({0.6, 0.1, 0.1}, {0.0, -0.3, 0.0});
  const tp::SE3d T_t_h = T_w_t.inverse() * T_w_h;

  // Corners with errors of a quarter of a pixel, as a detector might give them: the source of the result's error.
  std::vector<tp::Vector3<double>> host, target;
  Picture picture(argc, argv);
  for (const tp::SE3d& T_w_c : {T_w_h, T_w_t}) {
    picture.panel(stage.view(T_w_c).view(), host.empty() ? "host" : "target").quad(stage.quad(T_w_c), kTruth);
    auto& points = host.empty() ? host : target;
    for (std::size_t i = 0; i < 3; ++i) {
      const tp::Vector2<double> corner = (4 * stage.quad(T_w_c).corner[i]).array().round() / 4;
      points.push_back(stage.camera().unproject(corner));
      picture.dot(corner, kFound);
    }
  }

  const tp::PlaneFit<double> fit = tp::plane_from_matches(host, target, T_t_h);
  if (!tp::is_ok(fit.status)) return 1;
  const tp::Vector3<double> truth = stage.theta(T_w_h);
  const double cosine = tp::plane_normal(fit.value).dot(tp::plane_normal(truth));
  std::printf("theta %.4f %.4f %.4f, true %.4f %.4f %.4f\n", fit.value[0], fit.value[1], fit.value[2], truth[0],
              truth[1], truth[2]);
  std::printf("rank %d, condition %.0f\n", fit.rank, fit.condition);
  std::printf("distance %.4f m, true %.4f m\n", tp::plane_distance(fit.value), tp::plane_distance(truth));
  std::printf("normal off by %.3f deg\n", std::acos(std::min(cosine, 1.0)) * 180 / 3.14159265358979);
  picture.save();
}
