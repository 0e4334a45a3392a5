// Trajectories in TUM's text format: `timestamp tx ty tz qx qy qz qw` a line, camera to world, `#` comments.
#ifndef TEXTSLAM_IO_TRAJECTORY_HPP
#define TEXTSLAM_IO_TRAJECTORY_HPP

#include <string>
#include <vector>

#include "io/names.hpp"

namespace textslam {

struct StampedPose {
  double timestamp = 0;  ///< s
  SE3d T_w_c;            ///< camera to world
};

/// Reads a trajectory; a file of comments alone gives an empty one. Throws InputError with the line for a bad number, a
/// wrong number of columns, a quaternion whose norm is off by more than 1 %, or times that do not strictly increase.
/// Quaternions are normalised.
std::vector<StampedPose> read_tum(const std::string& path);

/// The text that write_tum() writes: times with 9 decimals, positions and unit quaternions (qw >= 0) with 12; the same
/// poses give the same bytes.
std::string format_tum(const std::vector<StampedPose>& poses);
/// Writes the file as write_file() does. Throws std::invalid_argument for a pose that is not finite.
void write_tum(const std::string& path, const std::vector<StampedPose>& poses);

}  // namespace textslam

#endif  // TEXTSLAM_IO_TRAJECTORY_HPP
