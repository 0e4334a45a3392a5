// The camera models that files can name. A new one is a file in textplane/core/cameras and, here, its include, its
// place in RawCamera and its line in camera_types().
#ifndef TEXTSLAM_IO_CAMERA_TYPES_HPP
#define TEXTSLAM_IO_CAMERA_TYPES_HPP

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "io/names.hpp"
#include "textplane/core/cameras/radial_tangential.hpp"

namespace textslam {

/// The camera of the images as they were taken.
using RawCamera = std::variant<RadialTangential<double>>;

/// How files describe one camera model, beyond fx fy cx cy.
struct CameraType {
  using Names = std::vector<std::string>;
  Names camera_yaml;     ///< values of Camera.type; messages show the first
  Names sensor_yaml;     ///< values of EuRoC's distortion_model; messages show the first
  Names coefficients;    ///< `Camera.<name>` of camera.yaml; distortion_coefficients has them in the same order
  std::size_t required;  ///< so many coefficients must be given; the others are 0 by default
  RawCamera (*make)(const double* parameters);  ///< of fx fy cx cy and all coefficients
};

template <class Model>
RawCamera make_camera(const double* parameters) {
  static_assert(textplane::is_camera_model<Model>::value, "see textplane/core/cameras/camera.hpp");
  return Model::from_parameters(Eigen::Map<const Eigen::Matrix<double, Model::kParameters, 1>>(parameters));
}

/// In the order of RawCamera. A camera.yaml without Camera.type is of the first.
inline const std::array<CameraType, std::variant_size_v<RawCamera>>& camera_types() {
  static const std::array<CameraType, std::variant_size_v<RawCamera>> types = {{
      {{"PinHole", "Pinhole"},
       {"radial-tangential", "radtan"},
       {"k1", "k2", "p1", "p2", "k3"},
       4,
       make_camera<RadialTangential<double>>},
  }};
  return types;
}

/// The type that has `name` among its `names` (camera_yaml or sensor_yaml), or null.
inline const CameraType* find_camera_type(CameraType::Names CameraType::*names, const std::string& name) {
  for (const CameraType& type : camera_types())
    for (const std::string& known : type.*names)
      if (known == name) return &type;
  return nullptr;
}

/// The first name of each type, for messages: "A or B".
inline std::string known_camera_types(CameraType::Names CameraType::*names) {
  std::string out;
  for (const CameraType& type : camera_types()) out += (out.empty() ? "" : " or ") + (type.*names).front();
  return out;
}

}  // namespace textslam

#endif  // TEXTSLAM_IO_CAMERA_TYPES_HPP
