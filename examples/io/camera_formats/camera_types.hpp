// The names that files have for camera models and their parameters. A new model is a file in textplane/core/cameras and
// a line here.
#ifndef TEXTSLAM_IO_CAMERA_FORMATS_CAMERA_TYPES_HPP
#define TEXTSLAM_IO_CAMERA_FORMATS_CAMERA_TYPES_HPP

#include <string>
#include <string_view>
#include <vector>

#include "io/names.hpp"

namespace textslam {

struct CameraType {
  using Names = std::vector<std::string>;
  std::string model;         ///< kName of the library's model
  Names settings;            ///< values of Camera.type (ORB-SLAM's settings); the first is written
  std::string projection;    ///< camera_model of EuRoC and kalibr; empty where they have no word for it
  Names distortion;          ///< distortion_model beside it; the first is EuRoC's, the last kalibr's
  Names coefficients;        ///< parameters after fx fy cx cy, as `Camera.<name>` and COLMAP call them
  std::size_t required = 0;  ///< so many coefficients must be given; the others are 0 by default

  /// fx fy cx cy, then the coefficients.
  Names parameters() const {
    Names all = {"fx", "fy", "cx", "cy"};
    all.insert(all.end(), coefficients.begin(), coefficients.end());
    return all;
  }
};

/// Settings without Camera.type are of the first.
inline const std::vector<CameraType>& camera_types() {
  static const std::vector<CameraType> types = {
      {RadialTangential<double>::kName,
       {"PinHole", "Pinhole"},
       "pinhole",
       {"radial-tangential", "radtan"},
       {"k1", "k2", "p1", "p2", "k3"},
       4},
      {Pinhole<double>::kName, {"Rectified"}, "pinhole", {"none"}, {}, 0},
      {textplane::Rational<double>::kName, {"Rational"}, "", {}, {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"}, 8},
      {textplane::KannalaBrandt<double>::kName,
       {"KannalaBrandt8", "KannalaBrandt"},
       "pinhole",
       {"equidistant"},
       {"k1", "k2", "k3", "k4"},
       4},
      {textplane::DoubleSphere<double>::kName, {"DoubleSphere"}, "ds", {"none"}, {"xi", "alpha"}, 2},
      {textplane::ExtendedUnified<double>::kName, {"EUCM"}, "eucm", {"none"}, {"alpha", "beta"}, 2},
      {textplane::Fov<double>::kName, {"FOV"}, "pinhole", {"fov"}, {"omega"}, 1},
  };
  return types;
}

/// The type of a library's model, which is there.
inline const CameraType& camera_type(std::string_view model) {
  for (const CameraType& type : camera_types())
    if (type.model == model) return type;
  return camera_types().front();
}

/// The first type that `accepts(type)`, or null.
template <class Accepts>
const CameraType* find_camera_type(const Accepts& accepts) {
  for (const CameraType& type : camera_types())
    if (accepts(type)) return &type;
  return nullptr;
}

inline bool is_one_of(const CameraType::Names& names, const std::string& name) {
  for (const std::string& known : names)
    if (known == name) return true;
  return false;
}

}  // namespace textslam

#endif  // TEXTSLAM_IO_CAMERA_FORMATS_CAMERA_TYPES_HPP
