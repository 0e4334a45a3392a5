// Readers and writers of each format of camera files; io/camera_model.hpp says what they are. Readers throw InputError;
// writers return an empty text where the format has no word for the model.
#ifndef TEXTSLAM_IO_CAMERA_FORMATS_FORMATS_HPP
#define TEXTSLAM_IO_CAMERA_FORMATS_FORMATS_HPP

#include <string>
#include <string_view>
#include <vector>

#include "io/camera_formats/camera_types.hpp"
#include "io/camera_formats/yaml_map.hpp"
#include "io/camera_model.hpp"

namespace textslam {

bool is_settings(const YamlMap& file);
CameraFile read_settings(const YamlMap& file);
std::string format_settings(const CameraModel& camera);

bool is_sensor(const YamlMap& file);
bool is_camchain(const YamlMap& file);
CameraFile read_sensor(const YamlMap& file);
CameraFile read_camchain(const YamlMap& file);
std::string format_sensor(const CameraModel& camera);
std::string format_camchain(const CameraModel& camera);

bool is_opencv(const YamlMap& file);
CameraFile read_opencv(const YamlMap& file);
std::string format_opencv(const CameraModel& camera);

inline constexpr double kColmapHalfPixel = 0.5;  ///< The centre of COLMAP's top-left pixel is there, ours at 0.
bool is_colmap(const std::string& path);
CameraFile read_colmap(const std::string& path);
std::string format_colmap(const CameraModel& camera);
/// The camera of the words of a line: id, model, width, height, parameters.
CameraModel colmap_camera(const std::string& path, int line, const std::vector<std::string_view>& words);

/// The camera of a type and fx fy cx cy and its coefficients; those at the end that are missing are 0. The numbers are
/// out of the model's range where it is false.
bool make_camera(const CameraType& type, std::vector<double> parameters, textplane::AnyCamera<double>* camera);
/// The same; InputError at the line of `key` where they are out of range.
textplane::AnyCamera<double> make_camera(const CameraType& type, const std::vector<double>& parameters,
                                         const YamlMap& file, const std::string& key);

/// "a, b, c" as the shortest decimals.
std::string list_of(const std::vector<double>& numbers);
/// fx fy cx cy and the coefficients.
std::vector<double> parameters_of(const CameraModel& camera);

}  // namespace textslam

#endif  // TEXTSLAM_IO_CAMERA_FORMATS_FORMATS_HPP
