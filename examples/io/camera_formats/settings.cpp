// camera.yaml, and ORB-SLAM's settings.
#include <algorithm>

#include "io/camera_formats/formats.hpp"
#include "io/text_file.hpp"

namespace textslam {

bool is_settings(const YamlMap& file) { return file.has_prefix("Camera.") || file.has_prefix("Camera1."); }

namespace {

const std::string kReadout = "Camera.readout";

textplane::RollingShutter read_shutter(const YamlMap& file, int height) {
  const std::string row = "Camera.readout_row";
  textplane::RollingShutter shutter = all_at_once(height);
  if (file.has(kReadout)) shutter.readout = file.number(kReadout);
  if (file.has(row)) shutter.row0 = file.number(row);
  if (shutter.readout != 0 && height < 2) file.refuse(file.at(kReadout), "an image of one row has no readout");
  return shutter;
}

}  // namespace

CameraFile read_settings(const YamlMap& file) {
  const CameraType* type = &camera_types().front();
  if (file.has("Camera.type")) {
    const std::string name = file.text("Camera.type");
    type = find_camera_type([&](const CameraType& known) { return is_one_of(known.settings, name); });
    std::string known;
    for (const CameraType& each : camera_types()) known += (known.empty() ? "" : " or ") + each.settings.front();
    if (!type) file.refuse_value("Camera.type", known);
  }
  CameraFile out;
  CameraModel& camera = out.model;
  camera.width = file.side("Camera.width");
  camera.height = file.side("Camera.height");
  if (file.has("Camera.fps")) camera.fps = file.positive("Camera.fps");
  camera.shutter = read_shutter(file, camera.height);
  camera.knows_readout = file.has(kReadout);
  const std::string prefix = file.has_prefix("Camera1.") ? "Camera1." : "Camera.";
  const auto is_given = [&](const std::string& name) { return file.has(prefix + name); };
  if (type == &camera_types().front() && std::none_of(type->coefficients.begin(), type->coefficients.end(), is_given))
    type = &camera_type("pinhole");  // as ORB-SLAM3 has it
  std::vector<double> parameters = {file.positive(prefix + "fx"), file.positive(prefix + "fy"),
                                    file.number(prefix + "cx"), file.number(prefix + "cy")};
  for (std::size_t i = 0; i < type->coefficients.size(); ++i) {
    const std::string key = prefix + type->coefficients[i];
    parameters.push_back(i < type->required || file.has(key) ? file.number(key) : 0);
  }
  camera.raw = make_camera(*type, parameters, file, prefix + (type->required ? type->coefficients.front() : "fx"));
  return out;
}

std::string format_settings(const CameraModel& camera) {
  const CameraType& type = camera_type(camera.raw.name());
  std::string out;
  const auto add = [&out](const std::string& key, const std::string& value) {
    out += "Camera." + key + ": " + value + "\n";
  };
  if (&type != &camera_types().front()) add("type", type.settings.front());
  add("width", std::to_string(camera.width));
  add("height", std::to_string(camera.height));
  if (camera.fps > 0) add("fps", shortest(camera.fps));
  if (camera.shutter.active() || camera.knows_readout) add("readout", shortest(camera.shutter.readout));
  if (camera.shutter.active()) add("readout_row", shortest(camera.shutter.row0));
  const CameraType::Names keys = type.parameters();
  const std::vector<double> parameters = parameters_of(camera);
  for (std::size_t i = 0; i < keys.size(); ++i) add(keys[i], shortest(parameters[i]));
  return out;
}

}  // namespace textslam
