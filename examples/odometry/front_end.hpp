// The front end of both odometries: corners that Lucas and Kanade's tracker follows from frame to frame, and the points
// in the world that they become once key frames see them from far enough apart.
#ifndef ODOMETRY_FRONT_END_HPP
#define ODOMETRY_FRONT_END_HPP

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <utility>
#include <vector>

#include "odometry/session.hpp"

namespace odometry {

/// A corner in the newest frame. Its id is that of its landmark.
struct Track {
  int id;
  cv::Point2f px;
};

/// The corners of the newest frame. The owner may drop tracks.
class Tracks : public std::vector<Track> {
 public:
  /// Follows the corners into the next frame; those that do not come back to where they were are lost.
  void follow(const cv::Mat& image) {
    std::vector<cv::Mat> before;
    before.swap(pyramid_);
    cv::buildOpticalFlowPyramid(image, pyramid_, kWindow, kLevels);
    image_ = image;
    if (empty()) return;
    std::vector<cv::Point2f> from, to, back;
    for (const Track& track : *this) from.push_back(track.px);
    std::vector<unsigned char> ok, ok_back;
    back = from;
    cv::calcOpticalFlowPyrLK(before, pyramid_, from, to, ok, cv::noArray(), kWindow, kLevels);
    cv::calcOpticalFlowPyrLK(pyramid_, before, to, back, ok_back, cv::noArray(), kWindow, kLevels,
                             {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 0.01}, cv::OPTFLOW_USE_INITIAL_FLOW);
    const cv::Rect2f inside(2, 2, static_cast<float>(image.cols - 4), static_cast<float>(image.rows - 4));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size(); ++i)
      if (ok[i] && ok_back[i] && cv::norm(back[i] - from[i]) < .7 && inside.contains(to[i]))
        (*this)[kept++] = {(*this)[i].id, to[i]};
    resize(kept);
  }

  /// New corners where there are no tracks.
  void refill() {
    cv::Mat free(image_.size(), CV_8UC1, cv::Scalar(255));
    for (const Track& track : *this) cv::circle(free, track.px, kDistance, cv::Scalar(0), cv::FILLED);
    const int missing = kCorners - static_cast<int>(size());
    std::vector<cv::Point2f> corners;
    if (missing > 0) cv::goodFeaturesToTrack(image_, corners, missing, 0.01, kDistance, free);
    for (const cv::Point2f& corner : corners) push_back({next_id_++, corner});
  }

  template <class Predicate>
  void drop_if(Predicate predicate) {
    erase(std::remove_if(begin(), end(), predicate), end());
  }

 private:
  static constexpr int kCorners = 400, kDistance = 10, kLevels = 4;
  static inline const cv::Size kWindow{21, 21};

  cv::Mat image_;
  std::vector<cv::Mat> pyramid_;
  int next_id_ = 0;
};

/// What a track shows: where key frames saw it, and its place in the world once that is known.
struct Landmark {
  std::vector<std::pair<int, cv::Point2f>> seen;  // ids of key frames, in order
  bool known = false;
  Eigen::Vector3d p_w = Eigen::Vector3d::Zero();
};
using Landmarks = std::map<int, Landmark>;

/// A view of a point.
struct View {
  Pose T_w_c;
  cv::Point2f px;
};

/// Distance in pixels between a point's image and where it was seen; infinite behind the camera.
inline double reprojection_error(const textslam::Pinhole<double>& camera, const View& view,
                                 const Eigen::Vector3d& p_w) {
  const Eigen::Vector3d p = view.T_w_c.inverse() * p_w;
  if (!(p.z() > 0.05)) return HUGE_VAL;
  return (camera.project(p) - Eigen::Vector2d(view.px.x, view.px.y)).norm();
}

enum class Triangulation { done, too_early, failed };

/// The point nearest to all rays. Too early while the first and the last ray are within 1.5 degrees; failed where the
/// rays do not meet within 2 px in front of the cameras.
inline Triangulation triangulate(const textslam::Pinhole<double>& camera, const std::vector<View>& views,
                                 Eigen::Vector3d* p_w) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero(), first = b, last = b;
  for (const View& view : views) {
    last = (view.T_w_c.linear() * camera.unproject(Eigen::Vector2d(view.px.x, view.px.y))).normalized();
    if (&view == &views.front()) first = last;
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - last * last.transpose();
    A += across;
    b += across * view.T_w_c.translation();
  }
  if (views.size() < 2 || first.cross(last).norm() < 0.026) return Triangulation::too_early;
  *p_w = A.ldlt().solve(b);
  for (const View& view : views)
    if (!(reprojection_error(camera, view, *p_w) < 2)) return Triangulation::failed;
  return Triangulation::done;
}

inline textplane::SE3d inverse_of(const Pose& T) { return {T.inverse().linear(), T.inverse().translation()}; }  // text
inline Pose inverse_of(const textplane::SE3d& T) {                                                              // text
  return Pose(Eigen::Translation3d(T.inverse().t) * Eigen::Quaterniond(T.inverse().R));                         // text
}

/// The corners of a frame for the texts: where they are, and what they show.
inline std::vector<textplane::TextPoint> text_points(const Tracks& tracks, Landmarks& landmarks) {  // text
  std::vector<textplane::TextPoint> points;                                                         // text
  for (const Track& track : tracks) {                                                               // text
    const Eigen::Vector2d px(track.px.x, track.px.y);                                               // text
    const Landmark& known = landmarks[track.id];                                                    // text
    points.push_back(known.known ? textplane::TextPoint::at(px, known.p_w, track.id)                // text
                                 : textplane::TextPoint::track(px, track.id));                      // text
  }
  return points;  // text
}

/// The pose by texts and points, or as it was.
inline Pose with_texts(textplane::TextMap& texts, const textplane::Pyramid& image, const Pose& T_w_c,  // text
                       const std::vector<textplane::TextPoint>& points) {                              // text
  const auto& fit = texts.track(image, inverse_of(T_w_c), points);                                     // text
  return fit.refined ? inverse_of(fit.T_c_w) : T_w_c;                                                  // text
}

}  // namespace odometry

#endif  // ODOMETRY_FRONT_END_HPP
