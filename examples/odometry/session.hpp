// What a run of an odometry needs and that is none of its business: options, undistorted images, the true poses that it
// starts with, and at the end its trajectory, its counts and its error.
#ifndef ODOMETRY_SESSION_HPP
#define ODOMETRY_SESSION_HPP

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/detections.hpp"
#include "io/evaluate.hpp"
#include "io/image_file.hpp"
#include "io/output_file.hpp"
#include "io/sequence.hpp"
#include "io/trajectory.hpp"
#include "odometry/settings.hpp"
#include "odometry/text_result.hpp"
#include "textplane/adapters/opencv.hpp"
#include "textplane/landmarks/text_map.hpp"

namespace odometry {

using Pose = Eigen::Isometry3d;  // camera to world

struct Options {
  std::string sequence, output;
  std::size_t start = 41;              // frames that take their poses from the truth, so that the scale is metric
  std::size_t first = 0;               // the first frame that is used
  bool text = false;                   // --text: with text features
  textplane::TextMapOptions settings;  // --set NAME=VALUE, may be given several times
};

inline Options parse(int argc, char** argv) {
  Options options;
  std::vector<std::string> names;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    std::size_t* number = word == "--start" ? &options.start : word == "--first" ? &options.first : nullptr;
    if (word == "--text") {
      options.text = true;
    } else if (word == "--set" && i + 1 < argc) {
      set_by_name(argv[++i], &options.settings);
    } else if (number && i + 1 < argc) {
      *number = std::stoul(argv[++i]);
    } else {
      names.push_back(word);
    }
  }
  if (names.size() != 2 || names[0][0] == '-' || names[1][0] == '-')
    throw std::invalid_argument("usage: SEQUENCE OUTPUT [--start N] [--first F] [--text] [--set NAME=VALUE]");
  options.sequence = names[0];
  options.output = names[1];
  return options;
}

class Session {
 public:
  Session(int argc, char** argv) : Session(parse(argc, argv)) {}

  /// Throws where the sequence is broken, or has no truth to start with.
  explicit Session(const Options& o) : options(o), sequence(textslam::read_sequence(o.sequence)) {
    if (options.first >= sequence.frames.size()) throw std::invalid_argument("--first is beyond the last frame");
    if (sequence.groundtruth.empty()) throw std::invalid_argument("the sequence has no true poses to start with");
    textslam::create_output_folder(options.output);
    cv::setRNGSeed(1);
    cv::setNumThreads(1);  // two runs give the same bytes
    if (sequence.camera.is_pinhole()) return;
    undistort_.create(sequence.camera.height, sequence.camera.width);
    undistort_.forEach([this](cv::Vec2f& from, const int* at) {
      const Eigen::Vector2d px = sequence.camera.project(camera().unproject(Eigen::Vector2d(at[1], at[0])));
      from = {static_cast<float>(px.x()), static_cast<float>(px.y())};
    });
  }

  /// Of the undistorted images.
  const textslam::Pinhole<double>& camera() const { return sequence.camera.pinhole(); }
  bool is_led(std::size_t frame) const { return frame < options.first + options.start; }

  cv::Mat image(std::size_t frame) const {
    auto pixels = textslam::load_frame(sequence, frame);
    const cv::Mat raw(sequence.camera.height, sequence.camera.width, CV_8UC1, pixels.data());
    cv::Mat image;
    if (undistort_.empty()) return raw.clone();
    cv::remap(raw, image, undistort_, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    return image;
  }

  /// Detections of a frame, undistorted; none without --text.
  std::vector<textplane::TextDetection> quads(std::size_t frame) const {
    std::vector<textplane::TextDetection> found;
    if (!options.text) return found;
    for (const auto& seen : textslam::read_detections(sequence, sequence.frames[frame]))
      found.emplace_back(seen.quad, seen.text, seen.score);
    return textplane::undistorted(found, sequence.camera, camera());
  }

  /// Between the neighbouring true poses in time; the nearest one outside of them.
  Pose true_pose(std::size_t frame) const {
    const double time = sequence.frames[frame].timestamp;
    const auto& truth = sequence.groundtruth;
    const auto after = std::find_if(truth.begin(), truth.end(), [&](const auto& p) { return p.timestamp >= time; });
    const auto& b = after == truth.end() ? truth.back() : *after;
    const auto& a = after == truth.begin() || after == truth.end() ? b : *(after - 1);
    const double s = b.timestamp > a.timestamp ? (time - a.timestamp) / (b.timestamp - a.timestamp) : 0;
    const Eigen::Quaterniond from(a.T_w_c.R), to(b.T_w_c.R);
    return Eigen::Translation3d((1 - s) * a.T_w_c.t + s * b.T_w_c.t) * from.slerp(s, to).normalized();
  }

  /// Writes and prints the results: poses of all frames from the first on, and how many of them were really found.
  void finish(const std::vector<Pose>& poses, std::size_t found, std::size_t key_frames) const {
    std::vector<textslam::StampedPose> all;
    for (const Pose& T : poses)
      all.push_back({sequence.frames[options.first + all.size()].timestamp, {T.linear(), T.translation()}});
    textslam::write_tum(options.output + "/trajectory.txt", all);
    std::printf("frames with a pose %zu of %zu\nkey frames %zu\n", found, poses.size(), key_frames);
    all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(options.start, all.size())));
    if (all.size() < 2) return;
    textslam::EvaluationOptions how;
    how.with_scale = false;
    how.tolerance = 0.5 * (all.back().timestamp - all.front().timestamp) / static_cast<double>(all.size() - 1);
    const auto error = textslam::evaluate_trajectory(all, sequence.groundtruth, all.size(), how);
    if (textplane::is_ok(error.status)) std::printf("ATE rmse %.2f mm\n", 1000 * error.ate.rmse);
  }

  const Options options;
  const textslam::Sequence sequence;

 private:
  cv::Mat_<cv::Vec2f> undistort_;  // where each pixel comes from; empty: nothing to undistort
};

/// Runs an odometry over a sequence: `Odometry(session)`, `Pose grab(image, known pose or null)`, `found()`,
/// `key_frames()`, `texts()`. The program's exit code.
template <class Odometry>
int run(int argc, char** argv) try {
  const Session session(argc, argv);
  Odometry odometry(session);
  std::vector<Pose> poses;
  for (std::size_t i = session.options.first; i < session.sequence.frames.size(); ++i) {
    const Pose truth = session.true_pose(i);
    poses.push_back(odometry.grab(session.image(i), session.is_led(i) ? &truth : nullptr, session.quads(i)));
  }
  session.finish(poses, odometry.found(), odometry.key_frames());
  const Options& options = session.options;
  if (options.text) finish_texts(odometry.texts(), session.sequence, options.sequence, options.output);
  return 0;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s: %s\n", argv[0], error.what()), 2;
}

}  // namespace odometry

#endif  // ODOMETRY_SESSION_HPP
