// The layout of the EuRoC data sets (ASL): a folder, or the `mav0` in it, with
//
//   mav0/cam0/data.csv      `timestamp [ns],file name` a line, `#` comments; the images are in mav0/cam0/data
//   mav0/cam0/sensor.yaml   the camera and T_BS, its pose in the body's frame (io/camera_model.hpp)
//   mav0/state_groundtruth_estimate0/data.csv   optional: `timestamp [ns],x,y,z,qw,qx,qy,qz` and more columns, the
//                                               body's pose
//
// Times in seconds are the nanoseconds divided by 1e9, rounded once: to 0.24 us for stamps that count from 1970.
#ifndef TEXTSLAM_IO_EUROC_HPP
#define TEXTSLAM_IO_EUROC_HPP

#include <string>
#include <vector>

#include "io/frame_list.hpp"
#include "io/trajectory.hpp"

namespace textslam {

struct EurocFiles {
  std::string list, images, camera, truth;  ///< The paths above; they need not exist.
};

/// Whether `folder` has mav0/cam0 or is a mav0 itself; then `files` receives its paths.
bool find_euroc(const std::string& folder, EurocFiles* files);

/// Throws InputError with the line for a missing name, and for a stamp that is not a whole number or does not increase.
std::vector<FrameRef> read_euroc_frames(const std::string& list, const std::string& images);

/// The camera's poses in the world: the body's poses of the file, times T_b_c. Throws InputError as read_tum() does.
std::vector<StampedPose> read_euroc_truth(const std::string& path, const SE3d& T_b_c);

}  // namespace textslam

#endif  // TEXTSLAM_IO_EUROC_HPP
