// The alignment of docs/first_minutes.md, timed on every SIMD target that this program holds and this machine runs; in
// few lines that any compiler takes. One line a target: name, median and least of kRuns runs in us with the pyramid of
// the target image, and the least with a pyramid made before, which takes no memory from the system. With any argument,
// one alignment a target, for emulated CPUs.
//
// Exit code 1 where an alignment does not find the pose.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "../statistics.hpp"
#include "textplane/textplane.hpp"

namespace tp = textplane;

namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr int kWarmUp = 400, kRuns = 1501, kAlignments = 4;  // of a run: short, so that few meet another program

double sign(double x, double y) {
  return 125 + 45 * std::sin(0.21 * x + 0.2) * std::cos(0.17 * y) +
         40 * std::sin(0.06 * x + 0.1 * y) * std::cos(0.04 * x - 0.11 * y);
}

struct Scene {
  tp::Pinhole<double> camera{300, 300, 159.5, 119.5};
  tp::Vector3<double> theta{0.1, -0.05, 0.5};
  tp::SE3d truth;
  tp::Image<std::uint8_t> host{kWidth, kHeight}, target{kWidth, kHeight};
  tp::TextPatch patch;
};

bool make_scene(Scene* scene) {
  tp::Vector6<double> xi;
  xi << 0.02, -0.01, 0.015, 0.005, 0.008, -0.01;
  scene->truth = tp::se3_exp(xi);
  tp::Matrix3<double> back;
  if (!tp::is_ok(tp::plane_homography_inverse(scene->theta, scene->truth, &back))) return false;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const tp::Vector3<double> q = back * scene->camera.unproject({x + 0.0, y + 0.0});
      const tp::Vector2<double> px = scene->camera.pixel({q[0] / q[2], q[1] / q[2]});
      scene->host(x, y) = static_cast<std::uint8_t>(std::lround(sign(x, y)));
      scene->target(x, y) = static_cast<std::uint8_t>(std::lround(0.7 * sign(px[0], px[1]) + 5));
    }
  tp::Quad<double> quad;
  quad.corner = {tp::Vector2<double>(100, 80), tp::Vector2<double>(220, 80), tp::Vector2<double>(220, 160),
                 tp::Vector2<double>(100, 160)};
  scene->patch = tp::make_patch(scene->host.view(), scene->camera, quad);
  return true;
}

// Error of the pose; infinite where the alignment fails.
double align(const Scene& s, const tp::Pyramid& target) {
  const auto fit = tp::align_pose(s.patch, s.theta, tp::SE3d(), target, s.camera);
  return fit.status == tp::Status::converged ? tp::se3_log(fit.T_t_h * s.truth.inverse()).norm() : HUGE_VAL;
}

// Microseconds of an alignment, of each run; empty where one misses the pose. error(): aligns, and gives the error.
template <class Error>
std::vector<double> time_alignment(const Error& error, bool once) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> us;
  for (int i = 0; i < (once ? 0 : kWarmUp); ++i)
    if (!(error() < 5e-3)) return {};
  for (int run = 0; run < (once ? 1 : kRuns); ++run) {
    const Clock::time_point begin = Clock::now();
    for (int i = 0; i < (once ? 1 : kAlignments); ++i)
      if (!(error() < 5e-3)) return {};
    us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - begin).count() / kAlignments);
  }
  return us;
}

}  // namespace

int main(int count, char**) {
  Scene scene;
  if (!make_scene(&scene)) return 1;
  const tp::Pyramid pyramid(scene.target.view());
  for (int i = 0; i < tp::simd::kTargetCount; ++i) {
    const auto target = static_cast<tp::simd::Target>(i);
    if (tp::simd::set_target(target) != tp::Status::ok) continue;
    const auto us = time_alignment([&] { return align(scene, tp::Pyramid(scene.target.view())); }, count > 1);
    const auto prepared = time_alignment([&] { return align(scene, pyramid); }, count > 1);
    if (us.empty() || prepared.empty()) {
      std::fprintf(stderr, "%s does not find the pose\n", tp::simd::to_string(target));
      return 1;
    }
    std::printf("%s %.1f %.1f %.1f\n", tp::simd::to_string(target), textplane_bench::median(us),
                textplane_bench::least(us), textplane_bench::least(prepared));
  }
  return 0;
}
