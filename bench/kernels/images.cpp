// Ours: warps of a 100 x 40 patch, FAST, KLT and the pyramid. Errors of warps: the largest difference from the double
// reference, grey levels. Errors of KLT: median and 90th percentile of the end-point error, px.
#include <algorithm>
#include <cmath>
#include <memory>

#include "kernels/klt_task.hpp"
#include "kernels/warp_task.hpp"
#include "registry.hpp"
#include "scene.hpp"
#include "textplane/features/fast.hpp"
#include "textplane/features/klt.hpp"
#include "textplane/photometry/warp_patch.hpp"

namespace textplane_bench {

namespace {

template <class S, class D>
Work warp_work() {
  const auto task = std::make_shared<WarpTask<S>>();
  const auto out = std::make_shared<tp::Image<D>>(WarpTask<S>::kWidth, WarpTask<S>::kHeight);
  Work work;
  work.items = WarpTask<S>::kWidth * WarpTask<S>::kHeight;
  double worst = 0;
  for (std::size_t i = 0; i < task->H.size(); ++i) {
    tp::warp_patch<S, D>(task->source(), task->H[i], out->view());
    worst = std::max(worst, task->error(i, *out));
  }
  work.errors["error"] = worst;
  work.call = [=](std::size_t i) {
    keep(tp::warp_patch<S, D>(task->source(), task->H[i % task->H.size()], out->view()));
  };
  return work;
}

Work fast_work() {
  const auto scene = std::make_shared<Scene>(make_scene(1, 3, 0, {1, 0, 0, 0}));
  const auto scratch = std::make_shared<std::vector<std::uint8_t>>(tp::fast_scratch_size(Scene::kWidth));
  const auto corners =
      std::make_shared<std::vector<tp::Corner>>(static_cast<std::size_t>(Scene::kWidth * Scene::kHeight));
  Work work;
  work.items = Scene::kWidth * Scene::kHeight;
  work.call = [=](std::size_t) {
    int found = 0;
    tp::detect_fast(scene->host_view(), kFastThreshold, true, scratch->data(), corners->data(),
                    static_cast<int>(corners->size()), &found);
    keep(found);
  };
  return work;
}

Work klt_work(bool light) {
  const auto task = std::make_shared<KltTask>(light);
  const auto from = std::make_shared<tp::Pyramid>(task->first.view(), 4);
  const auto to = std::make_shared<tp::Pyramid>(task->second.view(), 4);
  const auto results = std::make_shared<std::vector<tp::KltResult>>(task->from.size());
  tp::KltOptions options;
  options.max_forward_backward = 0;  // as OpenCV, which has no backward check
  Work work;
  work.items = static_cast<double>(task->from.size());
  const auto track = [=] {
    tp::track_klt(*from, *to, task->from.data(), nullptr, static_cast<int>(task->from.size()), options,
                  results->data());
  };
  track();
  std::vector<double> distances;
  for (std::size_t i = 0; i < results->size(); ++i)
    distances.push_back(is_ok((*results)[i].status) ? ((*results)[i].px.cast<double>() - task->truth[i]).norm() : 1e3);
  work.errors = KltTask::summary(distances);
  work.call = [=](std::size_t) { track(); };
  return work;
}

Work pyramid_work() {
  const auto scene = std::make_shared<Scene>(make_scene(1, 3, 0, {1, 0, 0, 0}));
  const auto pyramid = std::make_shared<tp::Pyramid>();
  Work work;
  work.items = Scene::kWidth * Scene::kHeight;
  work.call = [=](std::size_t) { keep(pyramid->build(scene->host_view(), 4)); };
  return work;
}

}  // namespace

void add_images() {
  add_targets("warp_u8_f32", "100x40", warp_work<std::uint8_t, float>);
  add_targets("warp_u8_u8", "100x40", warp_work<std::uint8_t, std::uint8_t>);
  add_targets("warp_f32_f32", "100x40", warp_work<float, float>);
  add_targets("fast", "640x480", fast_work);
  add_targets("klt_light", "points", [] { return klt_work(true); });
  add_targets("klt_steady", "points", [] { return klt_work(false); });
  add_targets("pyramid3", "640x480", pyramid_work);
}

}  // namespace textplane_bench
