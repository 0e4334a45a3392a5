// OpenCV on the same work: findTransformECC, warpPerspective, remap, FAST, calcOpticalFlowPyrLK, pyrDown.
#include <memory>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "kernels/klt_task.hpp"
#include "kernels/warp_task.hpp"
#include "registry.hpp"
#include "scene.hpp"

namespace textplane_bench {

namespace {

template <class T>
cv::Mat as_mat(const tp::Image<T>& image) {
  return cv::Mat(image.height(), image.width(), cv::DataType<T>::type, const_cast<T*>(image.data()));
}

cv::Mat as_mat(const tp::Matrix3<double>& H) {
  cv::Mat out(3, 3, CV_64F);
  for (int i = 0; i < 9; ++i) out.at<double>(i / 3, i % 3) = H(i / 3, i % 3);
  return out;
}

template <class T>
Work warp_work(bool remap) {
  const auto task = std::make_shared<WarpTask<T>>();
  const auto out = std::make_shared<tp::Image<T>>(WarpTask<T>::kWidth, WarpTask<T>::kHeight);
  const auto maps = std::make_shared<std::vector<cv::Mat>>();
  const auto matrices = std::make_shared<std::vector<cv::Mat>>();
  const cv::Size size(WarpTask<T>::kWidth, WarpTask<T>::kHeight);
  for (const tp::Matrix3<double>& H : task->H) {
    matrices->push_back(as_mat(H));
    cv::Mat map(size, CV_32FC2);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const tp::Vector3<double> q = H * tp::Vector3<double>(x, y, 1);
        map.at<cv::Vec2f>(y, x) = cv::Vec2f(static_cast<float>(q[0] / q[2]), static_cast<float>(q[1] / q[2]));
      }
    maps->push_back(map);
  }
  const auto run = [=](std::size_t i) {
    cv::Mat to = as_mat(*out);
    if (remap) {
      cv::remap(as_mat(task->image), to, (*maps)[i], cv::noArray(), cv::INTER_LINEAR);
    } else {
      cv::warpPerspective(as_mat(task->image), to, (*matrices)[i], size, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
    }
  };
  Work work;
  work.items = size.area();
  double worst = 0;
  for (std::size_t i = 0; i < task->H.size(); ++i) {
    run(i);
    worst = std::max(worst, task->error(i, *out));
  }
  work.errors["error"] = worst;
  work.call = [=](std::size_t i) { run(i % task->H.size()); };
  return work;
}

Work fast_work() {
  const auto scene = std::make_shared<Scene>(make_scene(1, 3, 0, {1, 0, 0, 0}));
  const auto keypoints = std::make_shared<std::vector<cv::KeyPoint>>();
  const auto run = [=] {
    cv::FAST(as_mat(scene->host), *keypoints, kFastThreshold, true, cv::FastFeatureDetector::TYPE_9_16);
  };
  run();
  std::vector<tp::Corner> ours;
  tp::detect_fast(scene->host_view(), kFastThreshold, true, ours);
  Work work;
  work.items = Scene::kWidth * Scene::kHeight;
  double different = ours.size() == keypoints->size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(ours.size(), keypoints->size()); ++i) {
    const cv::KeyPoint& k = (*keypoints)[i];
    different += ours[i].x != k.pt.x || ours[i].y != k.pt.y || ours[i].score != k.response ? 1 : 0;
  }
  work.errors["corners"] = static_cast<double>(keypoints->size());
  work.errors["different_from_ours"] = different;
  work.call = [=](std::size_t) { run(); };
  return work;
}

// Pyramids are built beforehand, as ours are.
Work klt_work(bool light) {
  const auto task = std::make_shared<KltTask>(light);
  const auto first = std::make_shared<std::vector<cv::Mat>>(), second = std::make_shared<std::vector<cv::Mat>>();
  const cv::Size window(21, 21);
  cv::buildOpticalFlowPyramid(as_mat(task->first), *first, window, 3, true);
  cv::buildOpticalFlowPyramid(as_mat(task->second), *second, window, 3, true);
  std::vector<cv::Point2f> from;
  for (const auto& p : task->from) from.emplace_back(p[0], p[1]);
  const auto to = std::make_shared<std::vector<cv::Point2f>>();
  const auto status = std::make_shared<std::vector<unsigned char>>();
  const auto residual = std::make_shared<std::vector<float>>();
  const auto run = [=] { cv::calcOpticalFlowPyrLK(*first, *second, from, *to, *status, *residual, window, 3); };
  run();
  std::vector<double> distances;
  for (std::size_t i = 0; i < to->size(); ++i) {
    const tp::Vector2<double> at(static_cast<double>((*to)[i].x), static_cast<double>((*to)[i].y));
    distances.push_back((*status)[i] ? (at - task->truth[i]).norm() : 1e3);
  }
  Work work;
  work.items = static_cast<double>(from.size());
  work.errors = KltTask::summary(distances);
  work.call = [=](std::size_t) { run(); };
  return work;
}

Work pyramid_work() {
  const auto scene = std::make_shared<Scene>(make_scene(1, 3, 0, {1, 0, 0, 0}));
  const auto levels = std::make_shared<std::vector<cv::Mat>>(3);
  Work work;
  work.items = Scene::kWidth * Scene::kHeight;
  work.call = [=](std::size_t) {
    cv::Mat image = as_mat(scene->host);
    for (cv::Mat& level : *levels) {
      cv::pyrDown(image, level);
      image = level;
    }
  };
  return work;
}

// ECC on the patch and the target: a cut-out with a margin, as a careful user makes it, or the whole frame, as ours
// gets it.
constexpr int kEccMargin = 24;
struct EccTask {
  Scene scene;
  cv::Mat patch, cut;
  tp::Matrix3<double> start, to_patch, from_cut;
  EccTask(const cv::Size& size, unsigned seed, double px, bool whole = false)
      : scene(make_dense_scene(size.width, size.height, seed, px)) {
    const cv::Rect box(scene.left, scene.top, size.width, size.height);
    patch = as_mat(scene.host)(box).clone();
    const tp::Matrix3<double> truth = scene.pixel_homography(scene.T_t_h, scene.theta);
    const tp::Vector3<double> centre =
        truth * tp::Vector3<double>(box.x + 0.5 * size.width, box.y + 0.5 * size.height, 1);
    const int left = static_cast<int>(centre[0] / centre[2]) - size.width / 2 - kEccMargin;
    const int top = static_cast<int>(centre[1] / centre[2]) - size.height / 2 - kEccMargin;
    const cv::Rect frame(0, 0, Scene::kWidth, Scene::kHeight);
    const cv::Rect around =
        whole ? frame : cv::Rect(left, top, size.width + 2 * kEccMargin, size.height + 2 * kEccMargin) & frame;
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
  // Corner error in px after at most `iterations`, `epsilon` as in cv::TermCriteria (negative: never met).
  double run(int iterations, double epsilon) const {
    cv::Mat warp;
    as_mat(start).convertTo(warp, CV_32F);
    try {
      cv::findTransformECC(patch, cut, warp, cv::MOTION_HOMOGRAPHY,
                           cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, iterations, epsilon));
    } catch (const cv::Exception&) {
      return 1e3;
    }
    tp::Matrix3<double> H;
    for (int i = 0; i < 9; ++i) H(i / 3, i % 3) = static_cast<double>(warp.at<float>(i / 3, i % 3));
    return scene.corner_error(from_cut * H * to_patch.inverse());
  }
};

// Time for a pixel and iteration: 20 iterations, with the preparation that each call repeats.
Work ecc_iteration_work(const cv::Size& size, bool whole = false) {
  const auto task = std::make_shared<EccTask>(size, 1, 1.0, whole);
  Work work;
  work.items = 20.0 * size.area();
  work.errors["corner_error"] = task->run(20, -1);
  work.call = [=](std::size_t) { keep(task->run(20, -1)); };
  return work;
}

Work ecc_converge_work(const cv::Size& size) {
  const auto tasks = std::make_shared<std::vector<EccTask>>();
  for (unsigned seed = 1; seed <= 4; ++seed) tasks->emplace_back(size, seed, 3.0);
  Work work;
  work.items = size.area();
  for (const EccTask& t : *tasks) work.errors["corner_error"] += t.run(50, 1e-4) / 4;
  work.call = [=](std::size_t i) { keep((*tasks)[i % 4].run(50, 1e-4)); };
  return work;
}

}  // namespace

void add_opencv() {
  cv::setNumThreads(1);
  add("warpPerspective_u8/opencv/100x40", [] { return warp_work<std::uint8_t>(false); });
  add("warpPerspective_f32/opencv/100x40", [] { return warp_work<float>(false); });
  add("remap_u8/opencv/100x40", [] { return warp_work<std::uint8_t>(true); });
  add("remap_f32/opencv/100x40", [] { return warp_work<float>(true); });
  add("fast/opencv/640x480", fast_work);
  add("klt_light/opencv/points", [] { return klt_work(true); });
  add("klt_steady/opencv/points", [] { return klt_work(false); });
  add("pyramid3/opencv/640x480", pyramid_work);
  for (const cv::Size& size : {cv::Size(16, 16), cv::Size(40, 25), cv::Size(100, 40)})
    add("ecc_iteration/opencv/" + std::to_string(size.area()), [=] { return ecc_iteration_work(size); });
  add("ecc_iteration_frame/opencv/4000", [] { return ecc_iteration_work(cv::Size(100, 40), true); });
  add("ecc_converge/opencv/4000", [] { return ecc_converge_work(cv::Size(100, 40)); });
}

}  // namespace textplane_bench
