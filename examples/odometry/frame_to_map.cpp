// frame_to_map SEQUENCE OUTPUT [--start N] [--first F]: the least that is an odometry. Corners are tracked from frame
// to frame, key frames triangulate them, and from then on they stay where they are; a frame's pose is OpenCV's PnP of
// the known ones. Nothing is ever corrected, so errors add up.
//
// Takes the poses of the first N frames (41), counted from frame F (0), from the truth. Writes OUTPUT/trajectory.txt,
// and with text OUTPUT/text_map.json.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <vector>

#include "odometry/front_end.hpp"
#include "odometry/session.hpp"

namespace odometry {
namespace {

constexpr int kKeyFrameEvery = 6, kMinPoints = 10;
constexpr double kInlier = 2;  // px

struct KeyFrame {
  int id;
  Pose T_w_c;
};

class FrameToMap {
 public:
  explicit FrameToMap(const Session& session)
      : texts_(session.camera(), session.options.settings),
        camera_(session.camera()),
        K_(camera_.fx, 0, camera_.cx, 0, camera_.fy, camera_.cy, 0, 0, 1) {}

  Pose grab(const cv::Mat& image, const Pose* known, const std::vector<textplane::TextDetection>& quads) {  // text
    tracks_.follow(image);
    Pose T_w_c = known ? *known : last_ * velocity_;
    const bool is_found = known || locate(&T_w_c);
    found_ += is_found;
    textplane::Pyramid pyramid = textplane::adapters::pyramid_from_cv(image);                  // text
    if (!known) T_w_c = with_texts(texts_, pyramid, T_w_c, text_points(tracks_, landmarks_));  // text
    velocity_ = is_found && found_ > 1 ? last_.inverse() * T_w_c : Pose::Identity();  // rather stand than run away
    last_ = T_w_c;
    ++since_key_frame_;
    if (since_key_frame_ >= kKeyFrameEvery || points_in_view() < 0.7 * points_at_key_frame_ || key_frames_.empty()) {
      make_key_frame(T_w_c);
      texts_.add_keyframe(key_frames_.back().id, std::move(pyramid), inverse_of(T_w_c), quads,  // text
                          text_points(tracks_, landmarks_));                                    // text
    }
    return T_w_c;
  }

  std::size_t found() const { return found_; }
  std::size_t key_frames() const { return key_frames_.size(); }
  const textplane::TextMap& texts() const { return texts_; }  // only to tell what is right

 private:
  // PnP from the predicted pose; tracks that it contradicts are dropped. Else the prediction stays.
  bool locate(Pose* T_w_c) {
    std::vector<cv::Point3d> points;
    std::vector<cv::Point2d> pixels;
    for (const Track& track : tracks_) {
      const Landmark& landmark = landmarks_[track.id];
      if (!landmark.known) continue;
      points.emplace_back(landmark.p_w.x(), landmark.p_w.y(), landmark.p_w.z());
      pixels.emplace_back(track.px);
    }
    if (points.size() < kMinPoints) return false;
    // The consensus is that of three points, which may lie on one plane; its pose begins at the prediction.
    cv::Mat r, t;
    std::vector<int> inliers;
    if (!cv::solvePnPRansac(points, pixels, K_, cv::noArray(), r, t, false, 300, kInlier, 0.999, inliers,
                            cv::SOLVEPNP_AP3P) ||
        inliers.size() < kMinPoints)
      return false;
    const Pose guess = T_w_c->inverse();
    cv::eigen2cv(Eigen::Matrix3d(guess.linear()), r);
    cv::Rodrigues(r, r);
    cv::eigen2cv(Eigen::Vector3d(guess.translation()), t);
    std::vector<cv::Point3d> good_points;
    std::vector<cv::Point2d> good_pixels;
    for (const int i : inliers) {
      good_points.push_back(points[static_cast<std::size_t>(i)]);
      good_pixels.push_back(pixels[static_cast<std::size_t>(i)]);
    }
    cv::solvePnPRefineLM(good_points, good_pixels, K_, cv::noArray(), r, t);
    Eigen::Matrix3d R;
    Eigen::Vector3d translation;
    cv::Rodrigues(r, r);
    cv::cv2eigen(r, R);
    cv::cv2eigen(t, translation);
    if (!R.allFinite() || !translation.allFinite()) return false;
    *T_w_c = Pose(Eigen::Translation3d(translation) * Eigen::Quaterniond(R).normalized()).inverse();
    tracks_.drop_if([&](const Track& track) {
      const Landmark& landmark = landmarks_[track.id];
      return landmark.known && reprojection_error(camera_, {*T_w_c, track.px}, landmark.p_w) > kInlier;
    });
    return true;
  }

  void make_key_frame(const Pose& T_w_c) {
    const KeyFrame& key_frame = key_frames_.emplace_back(KeyFrame{static_cast<int>(key_frames_.size()), T_w_c});
    tracks_.drop_if([&](const Track& track) {
      Landmark& landmark = landmarks_[track.id];
      landmark.seen.emplace_back(key_frame.id, track.px);
      if (landmark.known) return false;
      std::vector<View> views;
      for (const auto& [id, px] : landmark.seen) views.push_back({key_frames_[static_cast<std::size_t>(id)].T_w_c, px});
      const Triangulation result = triangulate(camera_, views, &landmark.p_w);
      landmark.known = result == Triangulation::done;
      return result == Triangulation::failed;
    });
    tracks_.refill();
    for (const Track& track : tracks_)
      if (landmarks_[track.id].seen.empty()) landmarks_[track.id].seen.emplace_back(key_frame.id, track.px);
    points_at_key_frame_ = points_in_view();
    since_key_frame_ = 0;
  }

  int points_in_view() {
    return static_cast<int>(
        std::count_if(tracks_.begin(), tracks_.end(), [&](const Track& t) { return landmarks_[t.id].known; }));
  }

  textplane::TextMap texts_;  // text
  textslam::Pinhole<double> camera_;
  cv::Matx33d K_;
  Tracks tracks_;
  Landmarks landmarks_;
  std::deque<KeyFrame> key_frames_;
  Pose last_ = Pose::Identity(), velocity_ = Pose::Identity();
  int since_key_frame_ = 0, points_at_key_frame_ = 0;
  std::size_t found_ = 0;
};

}  // namespace
}  // namespace odometry

int main(int argc, char** argv) { return odometry::run<odometry::FrameToMap>(argc, argv); }
