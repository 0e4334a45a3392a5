// Cost on the best SIMD target, by pixels of one object and by objects of a batch, on one and two threads.
// Every thread has its own workspace and works on its own objects against the same image.
#include <algorithm>
#include <map>
#include <mutex>

#include "compare.hpp"
#include "registry.hpp"
#include "scene.hpp"
#include "textplane/photometry/text_batch.hpp"

namespace textplane_bench {

namespace {

void count(benchmark::State& state, double items) {
  state.counters["ns_pixel"] =
      benchmark::Counter(items * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// Made once: Google Benchmark calls a benchmark several times for each repetition, and from each thread.
const Scene& scene_of(int n) {
  static std::mutex mutex;
  static std::map<int, Scene> scenes;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto found = scenes.find(n);
  return found != scenes.end() ? found->second : scenes.emplace(n, make_scene(n, 1)).first->second;
}

void pixels(benchmark::State& state, int n) {
  const Scene& scene = scene_of(n);
  const tp::PhotometricInput in = scene.input();
  tp::PhotometricWorkspace workspace(n);
  for (auto _ : state)
    keep(tp::linearise<tp::Parameters::pose_plane>(
        tp::ResidualRequest{in, scene.theta_start, scene.T_start, options(true)}, workspace));
  count(state, n);
}

// Objects of 15 pixels all over the image, like the signs of a building that are verified against one frame.
void objects(benchmark::State& state, int count_objects) {
  const Scene& scene = scene_of(100000);
  const auto m = static_cast<std::size_t>(count_objects);
  constexpr int kPixels = 15;
  std::vector<float> x(m * kPixels), y(m * kPixels), intensity(m * kPixels);
  std::vector<tp::TextBatchItem> items(m);
  const std::vector<tp::SE3d> poses(m, scene.T_start);
  unsigned h = 12345;
  const auto next = [&h](int range) {
    h = h * 1664525U + 1013904223U;
    return static_cast<int>((h >> 8) % static_cast<unsigned>(range));
  };
  for (std::size_t i = 0; i < m; ++i) {
    const int left = 60 + next(480), top = 50 + next(350);
    for (std::size_t k = i * kPixels; k < (i + 1) * kPixels; ++k) {
      const int px = left + next(40), py = top + next(20);
      x[k] = static_cast<float>(px);
      y[k] = static_cast<float>(py);
      intensity[k] = static_cast<float>(scene.host(px, py));
    }
    items[i].patch.x = x.data() + i * kPixels;
    items[i].patch.y = y.data() + i * kPixels;
    items[i].patch.intensity = intensity.data() + i * kPixels;
    items[i].patch.n = kPixels;
    items[i].host_camera = scene.camera;
    items[i].theta = scene.theta_start;
  }
  const tp::TextBatch batch(items.data(), count_objects);
  tp::TextBatchResult result(batch);
  for (auto _ : state)
    keep(tp::linearise_batch<tp::Parameters::pose>(batch, scene.target_view(), scene.camera, poses.data(),
                                                   options(true), result));
  count(state, static_cast<double>(m) * kPixels);
}

}  // namespace

void add_growth() {
  const std::string target = tp::simd::to_string(tp::simd::best_target());
  for (const int threads : {1, 2}) {
    const std::string suffix = "_" + std::to_string(threads) + "threads/" + target + "/";
    for (const int n : {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000, 100000})
      benchmark::RegisterBenchmark(("growth_pixels" + suffix + std::to_string(n)).c_str(), pixels, n)
          ->Threads(threads)
          ->UseRealTime();
    for (const int n : {1, 2, 5, 10, 16, 32, 100, 320, 1000, 3200, 10000, 32000, 100000})
      benchmark::RegisterBenchmark(("growth_objects" + suffix + std::to_string(n)).c_str(), objects, n)
          ->Threads(threads)
          ->UseRealTime();
  }
}

}  // namespace textplane_bench
