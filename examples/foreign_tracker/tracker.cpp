#include "foreign_tracker/tracker.hpp"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <set>

#include "foreign_tracker/optimiser.hpp"

namespace foreign {

namespace {

constexpr int kFewest = 30;  // points: with fewer a frame is lost

Se3 from_cv(const cv::Mat& R, const cv::Mat& t) {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  cv::cv2eigen(R, rotation);
  cv::cv2eigen(t, translation);
  return {rotation, translation};
}

}  // namespace

void Tracker::grab(Frame frame) {
  extract(camera_, frame);
  if (map_.key_frames.empty()) return initialise(std::move(frame));
  const bool was_lost = lost_;
  lost_ = !(was_lost ? relocalise(frame) : track(frame));
  if (lost_) return;
  velocity_ = was_lost ? Se3() : last_.T_w_c.inverse() * frame.T_w_c;
  trajectory_.push_back({frame.time, reference_, reference_->T_w_c.inverse() * frame.T_w_c});
  last_ = frame;
  ++since_key_frame_;
  const int tracked = frame.tracked();
  if (since_key_frame_ >= 10 || (since_key_frame_ >= 2 && tracked < 0.8 * reference_->tracked()))
    make_key_frame(std::move(frame));
}

// Initialises from two views by the essential matrix; the first camera is the world.
void Tracker::initialise(Frame frame) {
  const Matches matches = first_.keys.empty() ? Matches() : match_by_descriptor(first_, frame, false, 0.9);
  if (matches.size() < 100) {
    first_ = std::move(frame);
    return;
  }
  std::vector<cv::Point2f> a, b;
  std::vector<double> moved;
  for (const auto& [i, k] : matches) {
    a.push_back(first_.keys[i].pt);
    b.push_back(frame.keys[k].pt);
    moved.push_back(cv::norm(a.back() - b.back()));
  }
  std::nth_element(moved.begin(), moved.begin() + static_cast<std::ptrdiff_t>(moved.size() / 2), moved.end());
  if (moved[moved.size() / 2] < 20) return;
  cv::Mat R, t, inliers;
  const cv::Mat E = cv::findEssentialMat(a, b, cv::Mat(camera_.matrix()), cv::RANSAC, 0.9999, 1.0, inliers);
  if (E.rows != 3 || cv::recoverPose(E, a, b, cv::Mat(camera_.matrix()), R, t, inliers) < 80) return;
  frame.T_w_c = from_cv(R, t).inverse();

  map_.key_frames.push_back(std::make_unique<Frame>(first_));
  map_.key_frames.push_back(std::make_unique<Frame>(std::move(frame)));
  Frame &one = *map_.key_frames[0], &two = *map_.key_frames[1];
  if (triangulate(one, two, matches) < 80) {
    map_ = {};
    return;
  }
  adjust(camera_, map_, {&one, &two}, texts_);                                       // text
  texts_.add_keyframe(0, one.pyramid(), one.T_c_w(), one.quads, one.text_points());  // text
  texts_.add_keyframe(1, two.pyramid(), two.T_c_w(), two.quads, two.text_points());  // text
  reference_ = &two;
  trajectory_ = {{one.time, &one, Se3()}, {two.time, &two, Se3()}};
  last_ = two;
  first_ = {};
}

bool Tracker::track(Frame& frame) {
  frame.T_w_c = last_.T_w_c * velocity_;
  const Se3 predicted = frame.T_w_c;
  for (const double radius : {15.0, 30.0}) {
    if (match_by_projection(camera_, last_.points, radius, 100, 0.9, frame) >= 20) break;
    frame.points.assign(frame.keys.size(), nullptr);
  }
  if (optimise_pose(camera_, frame) < 10) {
    frame.T_w_c = predicted;
    if (!match_reference(*reference_, frame)) frame.T_w_c = predicted;
  }
  return track_local_map(frame);
}

// Finds more points for a pose that is nearly right.
bool Tracker::track_local_map(Frame& frame) {
  const std::vector<MapPoint*> local = local_points(frame);
  match_by_projection(camera_, local, 4, 100, 0.8, frame);
  const int tracked = optimise_pose(camera_, frame);
  const auto& fit = texts_.track(frame.pyramid(), frame.T_c_w(), frame.text_points());      // text
  if (fit.refined) frame.T_w_c = textplane::adapters::to_sophus<Se3>(fit.T_c_w.inverse());  // text
  const Se3 T_c_w = frame.T_w_c.inverse();
  for (MapPoint* point : local) {
    const Eigen::Vector3d p = T_c_w * point->p_w;
    point->expected += p[2] > 0.05 && camera_.contains(camera_.project(p));
  }
  for (MapPoint* point : frame.points)
    if (point) ++point->found;
  return tracked >= kFewest;
}

bool Tracker::match_reference(const Frame& reference, Frame& frame) const {
  const Matches matches = match_by_descriptor(reference, frame, true, 0.8);
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> px;
  for (const auto& [i, k] : matches) {
    const Eigen::Vector3d& p = reference.points[i]->p_w;
    points.emplace_back(p[0], p[1], p[2]);
    px.push_back(frame.keys[k].pt);
  }
  cv::Mat rotation, t, R;
  std::vector<int> inliers;
  if (points.size() < 15 ||
      !cv::solvePnPRansac(points, px, camera_.matrix(), cv::noArray(), rotation, t, false, 200, 4, 0.99, inliers) ||
      inliers.size() < 15)
    return false;
  cv::Rodrigues(rotation, R);
  frame.T_w_c = from_cv(R, t).inverse();
  frame.points.assign(frame.keys.size(), nullptr);
  for (const int i : inliers) {
    const auto& [from, to] = matches[static_cast<std::size_t>(i)];
    frame.points[to] = reference.points[from];
  }
  return optimise_pose(camera_, frame) >= 10;
}

bool Tracker::relocalise(Frame& frame) {
  for (auto it = map_.key_frames.rbegin(); it != map_.key_frames.rend(); ++it) {
    frame.points.assign(frame.keys.size(), nullptr);
    if (!match_reference(**it, frame) || !track_local_map(frame)) continue;
    reference_ = it->get();
    return true;
  }
  return false;
}

// Points of the key frames that share points with the frame, or with its reference where it has none.
std::vector<MapPoint*> Tracker::local_points(const Frame& frame) const {
  std::vector<Frame*> frames = covisible(map_, frame, 20);
  if (frames.empty()) frames = covisible(map_, *reference_, 20);
  frames.push_back(reference_);
  std::set<const MapPoint*> seen;
  std::vector<MapPoint*> out;
  for (const Frame* f : frames)
    for (MapPoint* p : f->points)
      if (p && !p->bad && seen.insert(p).second) out.push_back(p);
  return out;
}

std::vector<std::pair<double, Se3>> Tracker::trajectory() const {
  std::vector<std::pair<double, Se3>> out;
  for (const Pose& pose : trajectory_) out.emplace_back(pose.time, pose.reference->T_w_c * pose.T_r_c);
  return out;
}

}  // namespace foreign
