// The points of the KLT benchmarks, under a known motion of about 8 px, as between two frames of a video.
#ifndef TEXTPLANE_BENCH_KERNELS_KLT_TASK_HPP
#define TEXTPLANE_BENCH_KERNELS_KLT_TASK_HPP

#include <algorithm>
#include <vector>

#include "registry.hpp"
#include "scene.hpp"
#include "textplane/features/fast.hpp"
#include "textplane/features/select.hpp"

namespace textplane_bench {

constexpr int kFastThreshold = 20;

struct KltTask {
  tp::Image<std::uint8_t> first, second;
  std::vector<tp::Vector2<float>> from;
  std::vector<tp::Vector2<double>> truth;

  /// With `light` the second image has another gain and bias. Both have noise.
  explicit KltTask(bool light) {
    const Scene s = make_scene(1, 5, 0, light ? Light{0.75, 25, 2, 0} : Light{1, 0, 2, 0}, 0.35);
    first = s.host;
    second = s.target;
    std::vector<tp::Corner> corners, spread;
    tp::detect_fast(s.host_view(), kFastThreshold, true, corners);
    tp::select_spread(corners, Scene::kWidth, Scene::kHeight, 20, 300, {}, spread);
    const tp::Matrix3<double> H = s.pixel_homography(s.T_t_h, s.theta);
    for (const tp::Corner& c : spread) {
      const tp::Vector3<double> q = H * tp::Vector3<double>(static_cast<double>(c.x), static_cast<double>(c.y), 1);
      const tp::Vector2<double> at(q[0] / q[2], q[1] / q[2]);
      const auto clear = [](double x, double y) {  // whole patches at the finest level
        return x > 15 && y > 15 && x < Scene::kWidth - 16 && y < Scene::kHeight - 16;
      };
      if (!clear(static_cast<double>(c.x), static_cast<double>(c.y)) || !clear(at[0], at[1])) continue;
      from.push_back({c.x, c.y});
      truth.push_back(at);
    }
  }

  /// Median and 90th percentile of the end-point errors, and the share within one pixel.
  static Errors summary(std::vector<double> distances) {
    std::sort(distances.begin(), distances.end());
    const std::size_t n = distances.size();
    const auto within = std::lower_bound(distances.begin(), distances.end(), 1.0) - distances.begin();
    return {{"error_median", distances[n / 2]},
            {"error_p90", distances[n * 9 / 10]},
            {"within_1px", static_cast<double>(within) / static_cast<double>(n)}};
  }
};

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_KERNELS_KLT_TASK_HPP
