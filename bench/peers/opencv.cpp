// OpenCV on the same work: warpPerspective, remap, FAST, calcOpticalFlowPyrLK, pyrDown; ecc.cpp has findTransformECC.
#include <memory>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "kernels/klt_task.hpp"
#include "kernels/warp_task.hpp"
#include "opencv/as_mat.hpp"
#include "registry.hpp"
#include "scene.hpp"

namespace textplane_bench {

namespace {

using textplane_test::as_mat;

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

}  // namespace

void add_opencv() {
  cv::setNumThreads(1);
  benchmark::AddCustomContext("OpenCV", CV_VERSION);
  add("warpPerspective_u8/opencv/100x40", [] { return warp_work<std::uint8_t>(false); });
  add("warpPerspective_f32/opencv/100x40", [] { return warp_work<float>(false); });
  add("remap_u8/opencv/100x40", [] { return warp_work<std::uint8_t>(true); });
  add("remap_f32/opencv/100x40", [] { return warp_work<float>(true); });
  add("fast/opencv/640x480", fast_work);
  add("klt_light/opencv/points", [] { return klt_work(true); });
  add("klt_steady/opencv/points", [] { return klt_work(false); });
  add("pyramid3/opencv/640x480", pyramid_work);
}

}  // namespace textplane_bench
