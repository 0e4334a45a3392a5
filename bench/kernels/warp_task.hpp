// The work of the warp benchmarks: a 100 x 40 patch, unwarped from an image by eight homographies.
#ifndef TEXTPLANE_BENCH_KERNELS_WARP_TASK_HPP
#define TEXTPLANE_BENCH_KERNELS_WARP_TASK_HPP

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene.hpp"
#include "textplane/photometry/warp_patch.hpp"

namespace textplane_bench {

template <class S>
struct WarpTask {
  static constexpr int kWidth = 100, kHeight = 40;

  tp::Image<S> image;
  std::vector<tp::Matrix3<double>> H;       ///< Output pixel to image pixel.
  std::vector<tp::Image<double>> expected;  ///< By the double reference.

  WarpTask() : image(Scene::kWidth, Scene::kHeight) {
    for (unsigned seed = 1; seed <= 8; ++seed) {
      const Scene s = make_scene(4000, seed);
      if (seed == 1) std::copy(s.target.data(), s.target.data() + Scene::kWidth * Scene::kHeight, image.data());
      tp::Matrix3<double> shift = tp::Matrix3<double>::Identity();
      shift(0, 2) = s.left;
      shift(1, 2) = s.top;
      H.push_back(s.pixel_homography(s.T_t_h, s.theta) * shift);
      expected.emplace_back(kWidth, kHeight);
      tp::reference::warp_patch(source(), H.back(), expected.back().view());
    }
  }

  tp::ImageView<const S> source() const { return image.view(); }

  /// Largest difference from the reference; for bytes less 0.5, which rounding explains.
  template <class D>
  double error(std::size_t i, const tp::Image<D>& out) const {
    double worst = 0;
    for (int k = 0; k < kWidth * kHeight; ++k) {
      const double e = std::abs(static_cast<double>(out.data()[k]) - expected[i].data()[k]);
      worst = std::max(worst, std::is_same<D, std::uint8_t>::value ? e - 0.5 : e);
    }
    return worst;
  }
};

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_KERNELS_WARP_TASK_HPP
