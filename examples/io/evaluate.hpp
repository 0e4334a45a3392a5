// Trajectory errors against ground truth: absolute (ATE, after Sim(3) alignment) and relative (RPE), path,
// coverage.
//
// The alignment is Umeyama's (PAMI 1991) least squares, truth ~ s R estimate + t, with the rotation from Horn's
// quaternion. A monocular estimate has no scale of its own, so relative errors use the scale of the alignment.
#ifndef TEXTSLAM_IO_EVALUATE_HPP
#define TEXTSLAM_IO_EVALUATE_HPP

#include <cstddef>
#include <vector>

#include "io/trajectory.hpp"
#include "textplane/core/status.hpp"

namespace textslam {

using textplane::Status;

/// p -> scale R p + t.
struct Similarity {
  double scale = 1;
  Matrix3<double> R = Matrix3<double>::Identity();
  Vector3<double> t = Vector3<double>::Zero();

  Vector3<double> operator*(const Vector3<double>& p) const { return scale * (R * p) + t; }
  /// A camera pose of the source world in the target world; the rotation stays a rotation.
  SE3d operator*(const SE3d& T_w_c) const { return {R * T_w_c.R, *this * T_w_c.t}; }
};
inline Similarity similarity_of(const SE3d& T) { return {1, T.R, T.t}; }
/// A after B.
inline Similarity compose(const Similarity& A, const Similarity& B) { return {A.scale * B.scale, A.R * B.R, A * B.t}; }
inline Similarity inverse(const Similarity& S) {
  return {1 / S.scale, S.R.transpose(), -(1 / S.scale) * (S.R.transpose() * S.t)};
}

/// Indices of an estimated pose and of the true pose nearest in time.
struct PosePair {
  std::size_t estimate = 0, truth = 0;
};

/// One-to-one pairs at most `tolerance` seconds apart, in order of time. Where several compete, the closest wins. The
/// times of both inputs increase.
std::vector<PosePair> associate(const std::vector<StampedPose>& estimate, const std::vector<StampedPose>& truth,
                                double tolerance);

/// The similarity (or, without scale, the rigid motion) that minimises sum |to_i - S from_i|^2. Collinear points do not
/// determine the rotation about their line; the sum is minimal all the same. Status::too_few below three points or when
/// the sizes differ, degenerate when all points of one set coincide, non_finite for NaN; *out is then untouched.
Status align_points(const std::vector<Vector3<double>>& from, const std::vector<Vector3<double>>& to, bool with_scale,
                    Similarity* out);

/// A similarity that maps the poses `from` close to the poses `to`: any number of poses on any path. Scale and
/// translation minimise sum |to_i - S from_i|^2. The rotation minimises it together with the differences of the
/// rotations, which weigh a tenth: they determine it where positions do not, as along a line. Where all positions
/// coincide the scale is that of *out. Status::too_few without poses or when the sizes differ, non_finite for NaN,
/// degenerate where the scale would not be positive; *out is then untouched.
Status align_poses(const std::vector<SE3d>& from, const std::vector<SE3d>& to, Similarity* out);

/// Zeros when n is 0. Median and 90th percentile are interpolated between neighbouring errors, so the median of an even
/// number is the mean of the middle two.
struct ErrorStatistics {
  std::size_t n = 0;
  double rmse = 0, mean = 0, median = 0, p90 = 0, max = 0;
};
ErrorStatistics error_statistics(std::vector<double> errors);

/// Relative errors over pairs of poses: |translation| and rotation angle of (true motion)^-1 (estimated motion).
struct RelativeError {
  ErrorStatistics translation;  ///< m, or the unit of the truth
  ErrorStatistics rotation;     ///< degrees
};

struct EvaluationOptions {
  double tolerance = 0.01;  ///< s, of the association
  double distance = 0.1;    ///< m of true path, for the second relative error
  bool with_scale = true;
};

struct TrajectoryEvaluation {
  Status status = Status::too_few;  ///< of the alignment; the errors are zeros unless ok
  std::size_t pairs = 0;            ///< associated poses
  Similarity alignment;             ///< estimate's world -> truth's world
  ErrorStatistics ate;              ///< m
  /// Over neighbouring pairs, without those further apart than 1.5 times the median interval.
  RelativeError rpe_frame;
  double frame_interval = 0;   ///< s, the median interval of neighbouring pairs: 1/fps where every frame has truth
  RelativeError rpe_distance;  ///< from each pair to the first one at least options.distance of true path later
  double path_length = 0;      ///< m of true path from the first associated pose to the last
  double coverage = 0;         ///< poses of the estimate over all frames of the sequence
};

/// `frames`: number of frames of the sequence. Never throws on unusual data: `status` says why there is no error to
/// report; pairs, path_length and coverage are always set.
TrajectoryEvaluation evaluate_trajectory(const std::vector<StampedPose>& estimate,
                                         const std::vector<StampedPose>& truth, std::size_t frames,
                                         const EvaluationOptions& options = {});

}  // namespace textslam

#endif  // TEXTSLAM_IO_EVALUATE_HPP
