// Aligns two images of a sign with the single header alone and prints the pose, which is known.
#include "textplane.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>

namespace tp = textplane;

constexpr int kWidth = 320, kHeight = 240;

// The sign's pixels, as a function of the host's.
double sign(double x, double y) {
  return 125 + 45 * std::sin(0.21 * x + 0.2) * std::cos(0.17 * y) +
         40 * std::sin(0.06 * x + 0.1 * y) * std::cos(0.04 * x - 0.11 * y);
}

int main() {
  const tp::Pinhole<double> camera(300, 300, 159.5, 119.5);
  const tp::Vector3<double> theta(0.1, -0.05, 0.5);  // A plane two metres away.
  tp::Vector6<double> xi;
  xi << 0.02, -0.01, 0.015, 0.005, 0.008, -0.01;
  const tp::SE3d truth = tp::se3_exp(xi);

  // The second image is darker and seen from the side.
  tp::Image<std::uint8_t> host(kWidth, kHeight), target(kWidth, kHeight);
  tp::Matrix3<double> back;
  if (!tp::is_ok(tp::plane_homography_inverse(theta, truth, &back))) return 1;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const tp::Vector3<double> q = back * camera.unproject({x + 0.0, y + 0.0});
      const tp::Vector2<double> px = camera.pixel({q[0] / q[2], q[1] / q[2]});
      host(x, y) = static_cast<std::uint8_t>(std::lround(sign(x, y)));
      target(x, y) = static_cast<std::uint8_t>(std::lround(0.7 * sign(px[0], px[1]) + 5));
    }

  tp::Quad<double> quad;
  quad.corner = {tp::Vector2<double>(100, 80), tp::Vector2<double>(220, 80), tp::Vector2<double>(220, 160),
                 tp::Vector2<double>(100, 160)};
  const auto patch = tp::make_patch(host.view(), camera, quad);
  const auto fit = tp::align_pose(patch, theta, tp::SE3d(), tp::Pyramid(target.view()), camera);
  const double error = tp::se3_log(fit.T_t_h * truth.inverse()).norm();
  std::printf("%s, ZNCC %.4f, t = %.4f %.4f %.4f, error %.1e\n", tp::to_string(fit.status), fit.zncc, fit.T_t_h.t[0],
              fit.T_t_h.t[1], fit.T_t_h.t[2], error);
  return fit.status == tp::Status::converged && error < 5e-3 ? 0 : 1;
}
