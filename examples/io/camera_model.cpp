#include "io/camera_model.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/camera_formats/formats.hpp"
#include "io/input_error.hpp"
#include "io/paths.hpp"
#include "io/text_file.hpp"

namespace textslam {

namespace fs = std::filesystem;

// Here, so that each program compiles all models once.
Vector2<double> CameraModel::project(const Vector3<double>& p) const noexcept { return raw.project(p); }

textplane::Status CameraModel::unproject(const Vector2<double>& px, Vector3<double>* m) const noexcept {
  return raw.unproject(px, m);
}

bool make_camera(const CameraType& type, std::vector<double> parameters, textplane::AnyCamera<double>* camera) {
  parameters.resize(4 + type.coefficients.size());
  textplane::AnyCamera<double>::Parameters all(static_cast<Eigen::Index>(parameters.size()));
  std::copy(parameters.begin(), parameters.end(), all.data());
  return textplane::is_ok(textplane::AnyCamera<double>::make(type.model, all, camera));
}

textplane::AnyCamera<double> make_camera(const CameraType& type, const std::vector<double>& parameters,
                                         const YamlMap& file, const std::string& key) {
  textplane::AnyCamera<double> camera;
  if (!make_camera(type, parameters, &camera))
    file.refuse(file.at(key), "the parameters are out of the range of the model " + type.model);
  return camera;
}

std::string list_of(const std::vector<double>& numbers) {
  std::string out;
  for (const double number : numbers) out += (out.empty() ? "" : ", ") + shortest(number);
  return out;
}

std::vector<double> parameters_of(const CameraModel& camera) {
  const auto parameters = camera.raw.parameters();
  return {parameters.data(), parameters.data() + parameters.size()};
}

CameraFile read_camera_file(const std::string& path) {
  if (is_colmap(path)) return read_colmap(path);
  const YamlMap file = YamlMap::load(path);
  if (is_settings(file)) return read_settings(file);
  if (is_sensor(file)) return read_sensor(file);
  if (is_camchain(file)) return read_camchain(file);
  if (is_opencv(file)) return read_opencv(file);
  throw InputError(path, 0,
                   "no camera is described here: expected the keys Camera.fx and so on, intrinsics (EuRoC), cam0 "
                   "(kalibr) or camera_matrix (OpenCV), or a line of COLMAP's cameras.txt");
}

CameraModel read_camera(const std::string& path) { return read_camera_file(path).model; }

std::string format_camera(const CameraModel& camera, CameraFormat format) {
  switch (format) {
    case CameraFormat::sensor: return format_sensor(camera);
    case CameraFormat::camchain: return format_camchain(camera);
    case CameraFormat::opencv: return format_opencv(camera);
    case CameraFormat::colmap: return format_colmap(camera);
    default: return format_settings(camera);
  }
}

std::string find_camera(const std::string& folder) {
  const auto inside = [&](const char* name) { return (fs::path(folder) / name).string(); };
  for (const char* name : {"camera.yaml", "sensor.yaml", "camchain.yaml"})
    if (is_there(inside(name))) return inside(name);
  const std::string ending = "-camchain.yaml";
  std::vector<std::string> chains;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.size() > ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0)
      chains.push_back(entry.path().string());
  }
  if (chains.size() > 1) {
    std::sort(chains.begin(), chains.end());
    throw InputError(
        chains[1], 0,
        "a second camera file beside " + fs::path(chains[0]).filename().string() + ": give the right one by --camera");
  }
  if (!chains.empty()) return chains[0];
  return is_there(inside("cameras.txt")) ? inside("cameras.txt") : "";
}

CameraModel camera_from_fov(double fov, int width, int height) {
  CameraModel camera;
  camera.width = width;
  camera.height = height;
  const double f = 0.5 * width / std::tan(fov * (M_PI / 360));
  camera.raw = Pinhole<double>(f, f, 0.5 * (width - 1), 0.5 * (height - 1));
  return camera;
}

}  // namespace textslam
