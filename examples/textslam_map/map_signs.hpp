// The signs of a map with how well each is known: what two maps of one place are compared by.
#ifndef TEXTSLAM_MAP_MAP_SIGNS_HPP
#define TEXTSLAM_MAP_MAP_SIGNS_HPP

#include <array>
#include <string>
#include <vector>

#include "textslam/map/map.hpp"

namespace textslam {

/// A mapped text that was read. Standard deviations come from the covariance of its plane and the detector's box in the
/// host (text_centre.hpp).
struct MapSign {
  int text = -1;
  std::string word;
  bool unique = false;  ///< No other sign of the map reads alike.
  std::array<Vec3, 4> corners;
  Vec3 centre = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();    ///< Columns: along the line, down, into the wall.
  double size = 0;                                       ///< Root of width times height.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< Of the centre.
  double normal_sigma = 0;                               ///< rad
  double turn_sigma = 0;                                 ///< rad, of the line in the sign's plane.
  double size_sigma = 0;                                 ///< As a share of the size.
};

std::vector<MapSign> map_signs(const Map& map, const textplane::TextOptions& options);

/// How uncertain a text's plane is, whatever the unit: its normal (rad) and its distance (as a share).
double plane_uncertainty(const TextObject& text);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_MAP_SIGNS_HPP
