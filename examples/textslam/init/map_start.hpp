// MapStart: follows corners from a reference frame until two views give a reliable map.
//
// Where several motions explain the two views, all are kept until further views leave one (motion_hypotheses.hpp).
#ifndef TEXTSLAM_INIT_MAP_START_HPP
#define TEXTSLAM_INIT_MAP_START_HPP

#include <memory>
#include <optional>
#include <vector>

#include "textslam/init/motion_hypotheses.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

class MapStart {
 public:
  /// Finds the corners of the reference.
  MapStart(const Frame& reference, const CameraView& camera, const Parameters& parameters);

  const Frame& reference() const { return reference_; }
  /// The frame after it.
  const Frame& beside() const { return beside_; }
  /// Share of its corners that are still followed.
  double share() const { return corners_ > 0 ? static_cast<double>(tracks_.size()) / corners_ : 0; }
  /// Whether no map can come of it any more.
  bool over() const { return contradicted_ || static_cast<int>(tracks_.size()) < matches_needed(); }

  /// How the rows of the reference moved, and by how much that may be wrong, radians a s.
  void know_rows(std::shared_ptr<const textplane::RowMotion> rows, double unsure);
  /// Late detections of the reference, `last` the last frame followed to.
  void add_detections(std::vector<Detection> detections, const CameraView& camera, const Frame& last);
  /// Follows the corners from the last frame to the newest, which is turned by R_newest_last.
  void follow(const Frame& last, const Frame& newest, const Eigen::Matrix3d& R_newest_last, const CameraView& camera);
  /// True when `map` now holds two key frames (the reference and the newest) and their points, with a median depth of
  /// 1, and `tracks` the corners in the newest. `unsure`: as know_rows() has it, of the newest.
  bool build(const Frame& newest, double unsure, Map& map, std::vector<Track>* tracks);

 private:
  /// From the reference frame to the newest, up to scale.
  struct Motion {
    SE3d T_b_a;
    std::vector<char> inlier;  // per track
  };

  int matches_needed() const;
  std::optional<Motion> motion_of_two_views(const Frame& newest, double unsure, const CameraView& camera);
  std::optional<Motion> motion_of_hypotheses(const Frame& newest, double unsure, const CameraView& camera);
  double error_of_rows(const Frame& newest, double unsure, double parallax) const;
  double parallax(const Motion& motion, const Frame& newest, const CameraView& camera) const;
  bool build_by(const Motion& motion, const Frame& newest, Map& map, std::vector<Track>* tracks);

  const Parameters& parameters_;
  Frame reference_, beside_;
  std::vector<Track> tracks_;    // observations: in the reference frame, then in the hypotheses' views, standing
  int corners_ = 0;              // that the reference frame had
  MotionHypotheses hypotheses_;  // empty while two views may decide
  bool contradicted_ = false;    // no motion explains the views
  double began_ = 0;             // time of the frame that the hypotheses are from, s
  double unsure_ = 0;            // of the reference's rows
};

}  // namespace textslam

#endif  // TEXTSLAM_INIT_MAP_START_HPP
