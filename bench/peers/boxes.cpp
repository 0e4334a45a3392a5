// dlib's correlation tracker on the scenes that ours aligns from 3 px: one update of a box learnt from the host. A box
// has a place and a size alone, no turn and no perspective, so that its corners cannot be right as ours can.
#include <memory>

#include "peers/dlib.hpp"
#include "registry.hpp"
#include "scene.hpp"

namespace textplane_bench {

namespace {

DlibImage as_dlib(const tp::Image<std::uint8_t>& image) { return {image.data(), image.width(), image.height()}; }

struct Task {
  Scene scene;
  DlibBox box, guess;
  DlibTracker tracker;

  explicit Task(unsigned seed, double px)
      : scene(make_scene(4000, seed, px)),
        box{static_cast<double>(scene.left), static_cast<double>(scene.top),
            static_cast<double>(scene.left + scene.columns - 1), static_cast<double>(scene.top + scene.rows - 1)},
        guess(around(scene.pixel_homography(scene.T_start, scene.theta_start))),
        tracker(as_dlib(scene.host), box) {}

  // The box whose sides are the mean of the corners' places.
  DlibBox around(const tp::Matrix3<double>& H) const {
    const auto at = [&H](double x, double y) -> tp::Vector2<double> {
      const tp::Vector3<double> q = H * tp::Vector3<double>(x, y, 1);
      return q.head<2>() / q[2];
    };
    const tp::Vector2<double> a = at(box.left, box.top), b = at(box.right, box.top), c = at(box.right, box.bottom),
                              d = at(box.left, box.bottom);
    return {0.5 * (a[0] + d[0]), 0.5 * (a[1] + b[1]), 0.5 * (b[0] + c[0]), 0.5 * (c[1] + d[1])};
  }

  double corner_error(const DlibBox& found) const {
    tp::Matrix3<double> H = tp::Matrix3<double>::Identity();
    H(0, 0) = (found.right - found.left) / (box.right - box.left);
    H(1, 1) = (found.bottom - found.top) / (box.bottom - box.top);
    H(0, 2) = found.left - H(0, 0) * box.left;
    H(1, 2) = found.top - H(1, 1) * box.top;
    return scene.corner_error(H);
  }
};

// The tracker learns with each update, which takes as long whatever it has learnt.
Work update_work(double px) {
  const auto tasks = std::make_shared<std::vector<std::unique_ptr<Task>>>();
  for (unsigned seed = 1; seed <= 4; ++seed) tasks->push_back(std::make_unique<Task>(seed, px));
  const auto update = [tasks](std::size_t i) {
    Task& t = *(*tasks)[i % 4];
    return t.tracker.update(as_dlib(t.scene.target), t.guess);
  };
  Work work;
  work.items = 4000;
  for (std::size_t i = 0; i < 4; ++i) {
    const Task& t = *(*tasks)[i];
    work.errors["corner_error"] += t.corner_error(update(i)) / 4;
    work.errors["best_box"] += t.corner_error(t.around(t.scene.pixel_homography(t.scene.T_t_h, t.scene.theta))) / 4;
  }
  work.call = [=](std::size_t i) { keep(update(i)); };
  return work;
}

}  // namespace

void add_dlib() {
  benchmark::AddCustomContext("dlib", dlib_version());
  add("correlation_tracker/dlib/4000", [] { return update_work(3); });
}

}  // namespace textplane_bench
