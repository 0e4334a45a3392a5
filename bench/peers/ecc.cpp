// OpenCV's findTransformECC with a homography, on one scale and through a pyramid.
#include <memory>
#include <opencv2/video/tracking.hpp>

#include "opencv/as_mat.hpp"
#include "opencv/ecc_multiscale.hpp"
#include "registry.hpp"
#include "scene.hpp"

namespace textplane_bench {

namespace {

using textplane_test::as_mat;

// ECC on the patch and the target: a cut-out with a margin, as a careful user makes it, or the whole frame, as ours
// gets it.
constexpr int kMargin = 24;
struct Task {
  Scene scene;
  cv::Mat patch, cut;
  tp::Matrix3<double> start, to_patch, from_cut;
  Task(const cv::Size& size, unsigned seed, double px, bool whole = false)
      : scene(make_dense_scene(size.width, size.height, seed, px)) {
    const cv::Rect box(scene.left, scene.top, size.width, size.height);
    patch = as_mat(scene.host)(box).clone();
    const tp::Matrix3<double> truth = scene.pixel_homography(scene.T_t_h, scene.theta);
    const tp::Vector3<double> centre =
        truth * tp::Vector3<double>(box.x + 0.5 * size.width, box.y + 0.5 * size.height, 1);
    const int left = static_cast<int>(centre[0] / centre[2]) - size.width / 2 - kMargin;
    const int top = static_cast<int>(centre[1] / centre[2]) - size.height / 2 - kMargin;
    const cv::Rect frame(0, 0, Scene::kWidth, Scene::kHeight);
    const cv::Rect around =
        whole ? frame : cv::Rect(left, top, size.width + 2 * kMargin, size.height + 2 * kMargin) & frame;
    cut = as_mat(scene.target)(around).clone();
    to_patch.setIdentity();
    to_patch(0, 2) = scene.left;
    to_patch(1, 2) = scene.top;
    from_cut.setIdentity();
    from_cut(0, 2) = around.x;
    from_cut(1, 2) = around.y;
    start = from_cut.inverse() * scene.pixel_homography(scene.T_start, scene.theta_start) * to_patch;
    start /= start(2, 2);
  }
  // Corner error in px of what `ecc` makes of the start; 1e3 where it fails.
  template <class Ecc>
  double run(const Ecc& ecc) const {
    cv::Mat warp;
    as_mat(start).convertTo(warp, CV_32F);
    try {
      ecc(patch, cut, &warp);
    } catch (const cv::Exception&) {
      return 1e3;
    }
    tp::Matrix3<double> H;
    for (int i = 0; i < 9; ++i) H(i / 3, i % 3) = static_cast<double>(warp.at<float>(i / 3, i % 3));
    return scene.corner_error(from_cut * H * to_patch.inverse());
  }
};

// At most `iterations`; `epsilon` as in cv::TermCriteria (negative: never met).
cv::TermCriteria criteria(int iterations, double epsilon) {
  return cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, iterations, epsilon);
}

struct OneScale {
  cv::TermCriteria stop;
  void operator()(const cv::Mat& patch, const cv::Mat& cut, cv::Mat* warp) const {
    cv::findTransformECC(patch, cut, *warp, cv::MOTION_HOMOGRAPHY, stop);
  }
};

// As many levels as ours: on the fourth, the default, the patch has 12 x 5 pixels, and the estimate runs away.
struct ManyScales {
  cv::TermCriteria stop;
  void operator()(const cv::Mat& patch, const cv::Mat& cut, cv::Mat* warp) const {
    textplane_test::ecc_multiscale(patch, cut, stop, 3, warp);
  }
};

// Time for a pixel and iteration: 20 iterations, with the preparation that each call repeats.
Work iteration_work(const cv::Size& size, bool whole = false) {
  const auto task = std::make_shared<Task>(size, 1, 1.0, whole);
  const OneScale ecc{criteria(20, -1)};
  Work work;
  work.items = 20.0 * size.area();
  work.errors["corner_error"] = task->run(ecc);
  work.call = [=](std::size_t) { keep(task->run(ecc)); };
  return work;
}

// To convergence from `px` of corner error, in turn on the scenes that ours aligns.
template <class Ecc>
Work converge_work(const cv::Size& size, double px) {
  const auto tasks = std::make_shared<std::vector<Task>>();
  for (unsigned seed = 1; seed <= 4; ++seed) tasks->emplace_back(size, seed, px);
  const Ecc ecc{criteria(50, 1e-4)};
  Work work;
  work.items = size.area();
  for (const Task& t : *tasks) work.errors["corner_error"] += t.run(ecc) / 4;
  work.call = [=](std::size_t i) { keep((*tasks)[i % 4].run(ecc)); };
  return work;
}

}  // namespace

void add_ecc() {
  for (const cv::Size& size : {cv::Size(16, 16), cv::Size(40, 25), cv::Size(100, 40)})
    add("ecc_iteration/opencv/" + std::to_string(size.area()), [=] { return iteration_work(size); });
  const cv::Size small(40, 25), large(100, 40);
  add("ecc_iteration_frame/opencv/4000", [=] { return iteration_work(large, true); });
  add("ecc_converge/opencv/4000", [=] { return converge_work<OneScale>(large, 3); });
  add("ecc_converge_far/opencv/4000", [=] { return converge_work<OneScale>(large, 10); });
  const std::string many = textplane_test::kEccMultiscale;
  add(many + "/opencv/1000", [=] { return converge_work<ManyScales>(small, 3); });
  add(many + "/opencv/4000", [=] { return converge_work<ManyScales>(large, 3); });
  add(many + "_far/opencv/4000", [=] { return converge_work<ManyScales>(large, 10); });
}

}  // namespace textplane_bench
