// sliding_window SEQUENCE OUTPUT [--start N] [--first F]: an odometry with bundle adjustment. The front end is that of
// frame_to_map; Ceres finds the pose of each frame from the known points, and at each key frame adjusts the poses and
// points of the last few key frames.
//
// Takes the poses of the first N frames (41), counted from frame F (0), from the truth. Writes OUTPUT/trajectory.txt,
// and with text OUTPUT/text_map.json.
#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/product_manifold.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cstddef>
#include <deque>
#include <vector>

#include "odometry/front_end.hpp"
#include "odometry/session.hpp"
#include "textplane/adapters/ceres_text_map.hpp"  // text

namespace odometry {
namespace {

constexpr int kKeyFrameEvery = 5, kWindow = 8, kMinPoints = 10;
constexpr double kHuber = 1, kInlier = 3;  // px

using PoseManifold = ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>;

// Camera to world as a block of Ceres: a unit quaternion x y z w, and the translation.
struct PoseBlock {
  explicit PoseBlock(const Pose& T) : q(T.linear()), t(T.translation()) { static_assert(sizeof *this == 56); }
  Pose pose() const { return Eigen::Translation3d(t) * q.normalized(); }
  double* data() { return q.coeffs().data(); }

  Eigen::Quaternion<double, Eigen::DontAlign> q;
  Eigen::Vector3d t;
};

struct KeyFrame {
  int id;
  PoseBlock T_w_c;
  bool is_led;  // its pose is the true one
};

struct Reprojection {
  textslam::Pinhole<double> camera;
  cv::Point2f px;

  template <class T>
  bool operator()(const T* pose, const T* point, T* residual) const {
    const Eigen::Map<const Eigen::Quaternion<T>> q(pose);
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> t(pose + 4), p_w(point);
    const Eigen::Matrix<T, 3, 1> p = q.conjugate() * (p_w - t);
    if (!(p[2] > T(1e-3))) return false;
    residual[0] = camera.fx * p[0] / p[2] + (camera.cx - px.x);
    residual[1] = camera.fy * p[1] / p[2] + (camera.cy - px.y);
    return true;
  }
};

class SlidingWindow {
 public:
  explicit SlidingWindow(const Session& session)
      : texts_(session.camera(), session.options.settings), camera_(session.camera()) {}

  Pose grab(const cv::Mat& image, const Pose* known, const std::vector<textplane::TextDetection>& quads) {  // text
    tracks_.follow(image);
    Pose T_w_c = known ? *known : last_ * velocity_;
    const bool is_found = known || locate(&T_w_c);
    found_ += is_found;
    textplane::Pyramid pyramid = textplane::adapters::pyramid_from_cv(image);                  // text
    if (!known) T_w_c = with_texts(texts_, pyramid, T_w_c, text_points(tracks_, landmarks_));  // text
    Pose before = last_;
    last_ = T_w_c;
    ++since_key_frame_;
    if (since_key_frame_ >= kKeyFrameEvery || points_in_view() < 0.7 * points_at_key_frame_ || key_frames_.empty()) {
      key_frames_.push_back({static_cast<int>(key_frames_.size()), PoseBlock(last_), known != nullptr});
      texts_.add_keyframe(key_frames_.back().id, std::move(pyramid), inverse_of(last_), quads,  // text
                          text_points(tracks_, landmarks_));                                    // text
      make_key_frame();
    }
    velocity_ = is_found && found_ > 1 ? before.inverse() * T_w_c : Pose::Identity();  // rather stand than run away
    return last_;
  }

  std::size_t found() const { return found_; }
  std::size_t key_frames() const { return key_frames_.size(); }
  const textplane::TextMap& texts() const { return texts_; }  // only to tell what is right

 private:
  // The pose that fits the known points best, from the predicted one; tracks that it contradicts are dropped.
  bool locate(Pose* T_w_c) {
    PoseBlock block(*T_w_c);
    for (const double limit : {HUGE_VAL, 3 * kInlier}) {
      const Pose before = block.pose();
      ceres::Problem problem(ownership());
      problem.AddParameterBlock(block.data(), 7, &manifold_);
      int count = 0;
      for (const Track& track : tracks_) {
        Landmark& landmark = landmarks_[track.id];
        const double error = landmark.known ? reprojection_error(camera_, {before, track.px}, landmark.p_w) : HUGE_VAL;
        if (error < limit) count += add(track.px, &block, &landmark, &problem);
      }
      if (count < kMinPoints) return false;
      for (const Track& track : tracks_)
        if (double* p = landmarks_[track.id].p_w.data(); problem.HasParameterBlock(p))
          problem.SetParameterBlockConstant(p);
      if (!solve(ceres::DENSE_QR, &problem)) return false;
    }
    const Pose T = block.pose();
    const auto contradicts = [&](const Track& track) {
      const Landmark& landmark = landmarks_[track.id];
      return landmark.known && !(reprojection_error(camera_, {T, track.px}, landmark.p_w) < kInlier);
    };
    const int points = points_in_view();
    const auto wrong = std::count_if(tracks_.begin(), tracks_.end(), contradicts);
    if (points - wrong < kMinPoints) return false;
    tracks_.drop_if(contradicts);
    *T_w_c = T;
    return true;
  }

  void make_key_frame() {
    const int id = key_frames_.back().id;
    for (const Track& track : tracks_) landmarks_[track.id].seen.emplace_back(id, track.px);
    forget();
    triangulate_new();
    adjust();
    last_ = key_frames_.back().T_w_c.pose();
    tracks_.refill();
    for (const Track& track : tracks_)
      if (Landmark& landmark = landmarks_[track.id]; landmark.seen.empty()) landmark.seen.emplace_back(id, track.px);
    points_at_key_frame_ = points_in_view();
    since_key_frame_ = 0;
  }

  // Observations by key frames that left the window, and landmarks that no key frame of the window sees.
  void forget() {
    const int oldest = static_cast<int>(key_frames_.size()) - kWindow;
    for (auto entry = landmarks_.begin(); entry != landmarks_.end();) {
      auto& seen = entry->second.seen;
      seen.erase(std::remove_if(seen.begin(), seen.end(), [&](const auto& s) { return s.first < oldest; }), seen.end());
      entry = seen.empty() ? landmarks_.erase(entry) : std::next(entry);
    }
  }

  void triangulate_new() {
    tracks_.drop_if([&](const Track& track) {
      Landmark& landmark = landmarks_[track.id];
      if (landmark.known) return false;
      std::vector<View> views;
      for (const auto& [id, px] : landmark.seen) views.push_back({block(id).pose(), px});
      const Triangulation result = triangulate(camera_, views, &landmark.p_w);
      landmark.known = result == Triangulation::done;
      return result == Triangulation::failed;
    });
  }

  // Bundle adjustment of the window. Its oldest two key frames stay, which holds position and scale.
  void adjust() {
    ceres::Problem problem(ownership());
    const int newest = static_cast<int>(key_frames_.size()) - 1, oldest = std::max(0, newest + 1 - kWindow);
    for (auto& [number, landmark] : landmarks_)
      if (landmark.known && landmark.seen.size() >= 3)
        for (const auto& [id, px] : landmark.seen)
          add(px, &key_frames_[static_cast<std::size_t>(id)].T_w_c, &landmark, &problem);
    for (int id = oldest; id <= newest; ++id) {
      if (!problem.HasParameterBlock(block(id).data())) continue;
      problem.SetManifold(block(id).data(), &manifold_);
      if (id < oldest + 2 || key_frames_[static_cast<std::size_t>(id)].is_led)
        problem.SetParameterBlockConstant(block(id).data());
    }
    textplane::adapters::TextBlocks<> texts(                         // text
        texts_, [&](int id) { return block(id).data(); }, problem);  // text
    if (problem.NumResidualBlocks() > 0) solve(ceres::DENSE_SCHUR, &problem);
    texts.write_back();  // text
    // What does not fit now is forgotten, and its track with it.
    for (auto& [number, landmark] : landmarks_) {
      if (!landmark.known) continue;
      auto& seen = landmark.seen;
      const auto is_wrong = [&, &p = landmark.p_w](const auto& s) {
        return !(reprojection_error(camera_, {block(s.first).pose(), s.second}, p) < kInlier);
      };
      const bool was_seen_now = seen.back().first == newest;
      seen.erase(std::remove_if(seen.begin(), seen.end(), is_wrong), seen.end());
      if (was_seen_now && (seen.empty() || seen.back().first != newest)) seen.clear();
      landmark.known = seen.size() >= 2;
    }
    tracks_.drop_if([&](const Track& track) { return landmarks_[track.id].seen.empty(); });
  }

  // Adds a reprojection error unless the point is behind the camera, where Ceres could not begin.
  bool add(const cv::Point2f& px, PoseBlock* pose, Landmark* landmark, ceres::Problem* problem) {
    if (reprojection_error(camera_, {pose->pose(), px}, landmark->p_w) == HUGE_VAL) return false;
    problem->AddResidualBlock(new ceres::AutoDiffCostFunction<Reprojection, 2, 7, 3>(new Reprojection{camera_, px}),
                              &loss_, pose->data(), landmark->p_w.data());
    return true;
  }

  static bool solve(ceres::LinearSolverType type, ceres::Problem* problem) {
    ceres::Solver::Options options;
    options.linear_solver_type = type;
    options.max_num_iterations = 15;
    options.function_tolerance = 1e-5;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, problem, &summary);
    return summary.IsSolutionUsable();
  }

  static ceres::Problem::Options ownership() {
    ceres::Problem::Options options;
    options.manifold_ownership = options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  PoseBlock& block(int id) { return key_frames_[static_cast<std::size_t>(id)].T_w_c; }

  int points_in_view() {
    return static_cast<int>(
        std::count_if(tracks_.begin(), tracks_.end(), [&](const Track& t) { return landmarks_[t.id].known; }));
  }

  textplane::TextMap texts_;  // text
  textslam::Pinhole<double> camera_;
  PoseManifold manifold_;
  ceres::HuberLoss loss_{kHuber};
  Tracks tracks_;
  Landmarks landmarks_;
  std::deque<KeyFrame> key_frames_;  // all of them; the window is the last few
  Pose last_ = Pose::Identity(), velocity_ = Pose::Identity();
  int since_key_frame_ = 0, points_at_key_frame_ = 0;
  std::size_t found_ = 0;
};

}  // namespace
}  // namespace odometry

int main(int argc, char** argv) { return odometry::run<odometry::SlidingWindow>(argc, argv); }
