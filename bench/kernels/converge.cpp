// Ours from 3 px of corner error, or 10 (`far`), to convergence: pose and plane of 100 x 40 pixels by each policy, on
// three levels. The time includes the pyramid of the target's cut-out, the one that findTransformECC is given. A run
// ends where a step promises less than 3e-3 of the cost; its error is the mean corner error, which is at most that of
// findTransformECC (least squares). From 10 px `forward` ends elsewhere in one scene of the four.
#include <cmath>
#include <memory>

#include "kernels/align.hpp"
#include "registry.hpp"
#include "scene.hpp"

namespace textplane_bench {

namespace {

struct Task {
  static constexpr int kLevels = 3, kMargin = 24;

  Scene scene;
  tp::TextPatch patch;
  std::vector<tp::TemplatePatch> prepared{kLevels};
  tp::ImageView8 cut;
  tp::Pinhole<double> camera;  // of the cut-out

  Task(unsigned seed, double px) : scene(make_scene(4000, seed, px)), camera(scene.camera) {
    const double right = scene.left + scene.columns - 1, bottom = scene.top + scene.rows - 1;
    tp::Quad<double> quad;
    quad.corner = {tp::Vector2<double>(scene.left, scene.top), tp::Vector2<double>(right, scene.top),
                   tp::Vector2<double>(right, bottom), tp::Vector2<double>(scene.left, bottom)};
    std::vector<std::vector<tp::Vector2<float>>> pixels(kLevels);
    for (int l = 0; l < kLevels; ++l)
      for (int y = scene.top >> l; y < (scene.top + scene.rows) >> l; ++y)
        for (int x = scene.left >> l; x < (scene.left + scene.columns) >> l; ++x)
          pixels[static_cast<std::size_t>(l)].push_back({static_cast<float>(x), static_cast<float>(y)});
    const tp::Pyramid host(scene.host_view(), kLevels);
    patch = tp::patch_from_pixels(host.view(), scene.camera, quad, pixels);
    for (std::size_t l = 0; l < kLevels; ++l) prepared[l].prepare(patch.levels[l].view());

    const tp::Vector3<double> centre = scene.pixel_homography(scene.T_t_h, scene.theta) *
                                       tp::Vector3<double>(0.5 * (scene.left + right), 0.5 * (scene.top + bottom), 1);
    const int width = scene.columns + 2 * kMargin, height = scene.rows + 2 * kMargin;
    const int x = std::clamp(static_cast<int>(centre[0] / centre[2]) - width / 2, 0, Scene::kWidth - width);
    const int y = std::clamp(static_cast<int>(centre[1] / centre[2]) - height / 2, 0, Scene::kHeight - height);
    cut = tp::ImageView8(&scene.target(x, y), width, height, scene.target_view().stride());
    camera.cx -= x;
    camera.cy -= y;
  }
};

double run(const Task& task, tp::LinearisePolicy policy, const tp::PhotometricOptions& options, tp::Pyramid& pyramid,
           tp::PhotometricWorkspace& workspace) {
  Start s{task.scene.T_start, task.scene.theta_start};
  pyramid.build(task.cut, Task::kLevels);
  align(task.patch, task.prepared, Task::kLevels, pyramid.view(), task.camera, policy, options, 1e-2, 3e-3, workspace,
        &s);
  return task.scene.corner_error(task.scene.pixel_homography(s.T_t_h, s.theta));
}

Work converge_work(tp::LinearisePolicy policy, const tp::PhotometricOptions& options = {}, double px = 3) {
  const auto tasks = std::make_shared<std::vector<std::unique_ptr<Task>>>();
  for (unsigned seed = 1; seed <= 4; ++seed) tasks->push_back(std::make_unique<Task>(seed, px));
  const auto workspace = std::make_shared<tp::PhotometricWorkspace>(4000);
  const auto pyramid = std::make_shared<tp::Pyramid>();
  Work work;
  work.items = 4000;
  for (const auto& task : *tasks) work.errors["corner_error"] += run(*task, policy, options, *pyramid, *workspace) / 4;
  work.call = [=](std::size_t i) { keep(run(*(*tasks)[i % 4], policy, options, *pyramid, *workspace)); };
  return work;
}

}  // namespace

void add_converge() {
  add_targets("converge_forward", "4000", [] { return converge_work(tp::LinearisePolicy::forward); });
  add_targets("converge_template", "4000", [] { return converge_work(tp::LinearisePolicy::template_jacobian); });
  tp::PhotometricOptions l2;
  l2.robust.kind = tp::RobustKind::l2;
  add_targets("converge_template_l2", "4000",
              [=] { return converge_work(tp::LinearisePolicy::template_jacobian, l2); });
  add_targets("converge_esm", "4000", [] { return converge_work(tp::LinearisePolicy::esm); });
  add_targets("converge_hybrid", "4000", [] { return converge_work(tp::LinearisePolicy::hybrid); });
  add_targets("converge_automatic", "4000", [] { return converge_work(tp::LinearisePolicy::automatic); });
  add_targets("converge_automatic_far", "4000", [] { return converge_work(tp::LinearisePolicy::automatic, {}, 10); });
}

}  // namespace textplane_bench
