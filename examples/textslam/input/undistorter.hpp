// Undistorter: raw camera images and pixels to those of an ideal pinhole with the same intrinsics.
#ifndef TEXTSLAM_INPUT_UNDISTORTER_HPP
#define TEXTSLAM_INPUT_UNDISTORTER_HPP

#include <cstdint>
#include <vector>

#include "io/detections.hpp"
#include "io/sequence.hpp"

namespace textslam {

class Undistorter {
 public:
  explicit Undistorter(const CameraModel& camera);

  /// The pinhole image; bilinear, edge pixels repeated beyond the raw image.
  Image<std::uint8_t> operator()(const Image<std::uint8_t>& raw) const;
  /// Detections in pinhole pixels; those that leave the domain of the lens model are left out.
  std::vector<Detection> operator()(std::vector<Detection> raw) const;

 private:
  CameraModel camera_;
  std::vector<float> map_x_, map_y_;  // raw position of each pinhole pixel; empty without distortion
};

}  // namespace textslam

#endif  // TEXTSLAM_INPUT_UNDISTORTER_HPP
