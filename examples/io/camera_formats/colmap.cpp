// COLMAP's cameras.txt: `CAMERA_ID MODEL WIDTH HEIGHT PARAMS...` a line, '#' comments. The centre of its top-left pixel
// is (0.5, 0.5).
#include <algorithm>
#include <cmath>
#include <map>

#include "io/camera_formats/formats.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "io/text_file.hpp"

namespace textslam {

namespace {

struct ColmapModel {
  const char* name;
  const char* model;             // the library's
  CameraType::Names parameters;  // f is fx and fy
};

// Those with fx and fy are written, the first that has all that is not 0.
const std::vector<ColmapModel>& colmap_models() {
  static const std::vector<ColmapModel> models = {
      {"SIMPLE_PINHOLE", "pinhole", {"f", "cx", "cy"}},
      {"PINHOLE", "pinhole", {"fx", "fy", "cx", "cy"}},
      {"SIMPLE_RADIAL", "radial_tangential", {"f", "cx", "cy", "k1"}},
      {"RADIAL", "radial_tangential", {"f", "cx", "cy", "k1", "k2"}},
      {"OPENCV", "radial_tangential", {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"}},
      {"FULL_OPENCV", "rational", {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"}},
      {"SIMPLE_RADIAL_FISHEYE", "kannala_brandt", {"f", "cx", "cy", "k1"}},
      {"RADIAL_FISHEYE", "kannala_brandt", {"f", "cx", "cy", "k1", "k2"}},
      {"OPENCV_FISHEYE", "kannala_brandt", {"fx", "fy", "cx", "cy", "k1", "k2", "k3", "k4"}},
      {"FOV", "fov", {"fx", "fy", "cx", "cy", "omega"}},
  };
  return models;
}

const ColmapModel& find_model(const std::string& path, int line, std::string_view name) {
  std::string known;
  for (const ColmapModel& model : colmap_models()) {
    if (model.name == name) return model;
    known += (known.empty() ? "" : ", ") + std::string(model.name);
  }
  throw InputError(path, line, "the camera model should be one of " + known + ", not " + shown(name));
}

int side(const std::string& path, int line, std::string_view text, const std::string& what) {
  const double value = require_number(text, path, line, what);
  if (!(value >= 1 && value <= kMaxImageSide) || value != std::floor(value))
    throw InputError(
        path, line,
        what + " should be a whole number of at most " + std::to_string(kMaxImageSide) + ", not " + shown(text));
  return static_cast<int>(value);
}

}  // namespace

CameraModel colmap_camera(const std::string& path, int line, const std::vector<std::string_view>& words) {
  if (words.size() < 4) throw InputError(path, line, "expected 'id MODEL width height parameters'");
  const ColmapModel& model = find_model(path, line, words[1]);
  CameraModel camera;
  camera.width = side(path, line, words[2], "the width");
  camera.height = side(path, line, words[3], "the height");
  if (words.size() != 4 + model.parameters.size())
    throw InputError(path, line,
                     std::string(model.name) + " has " + std::to_string(model.parameters.size()) + " parameters, not " +
                         std::to_string(words.size() - 4));
  std::map<std::string, double> values;
  for (std::size_t i = 0; i < model.parameters.size(); ++i)
    values[model.parameters[i]] = require_number(words[4 + i], path, line, model.parameters[i]);
  if (values.count("f")) values["fx"] = values["fy"] = values["f"];
  values["cx"] -= kColmapHalfPixel;
  values["cy"] -= kColmapHalfPixel;
  std::vector<double> parameters;
  const CameraType& type = camera_type(model.model);
  for (const std::string& name : type.parameters()) parameters.push_back(values[name]);
  if (!make_camera(type, parameters, &camera.raw))
    throw InputError(path, line, "the parameters are out of the range of " + std::string(model.name));
  return camera;
}

bool is_colmap(const std::string& path) {
  for (const TextLine& line : read_lines(path)) {
    const std::string_view text = trimmed(line.text);
    if (text[0] == '#') continue;
    const std::vector<std::string_view> words = split_blanks(text);
    return words[0].find_first_not_of("0123456789") == std::string_view::npos;
  }
  return false;
}

CameraFile read_colmap(const std::string& path) {
  CameraFile out;
  int first = 0;
  for (const TextLine& line : read_lines(path)) {
    const std::string_view text = trimmed(line.text);
    if (text[0] == '#') continue;
    if (first > 0)
      throw InputError(
          path, line.number,
          "a second camera, after that of line " + std::to_string(first) + ": keep the one that took the images");
    first = line.number;
    out.model = colmap_camera(path, line.number, split_blanks(text));
  }
  return out;
}

std::string format_colmap(const CameraModel& camera) {
  const std::string own = camera.raw.name();
  const CameraType::Names names = camera_type(own).parameters();
  std::map<std::string, double> values;
  const std::vector<double> parameters = parameters_of(camera);
  for (std::size_t i = 0; i < names.size(); ++i) values[names[i]] = parameters[i];
  for (const ColmapModel& model : colmap_models()) {
    if (model.parameters[0] == "f") continue;
    if (model.model != own && !(own == "radial_tangential" && std::string(model.model) == "rational")) continue;
    const bool has_all = std::all_of(values.begin(), values.end(), [&](const auto& value) {
      return value.second == 0 || is_one_of(model.parameters, value.first);
    });
    if (!has_all) continue;
    values["cx"] += kColmapHalfPixel;
    values["cy"] += kColmapHalfPixel;
    std::string out = "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]\n1 " + std::string(model.name) + " " +
                      std::to_string(camera.width) + " " + std::to_string(camera.height);
    for (const std::string& name : model.parameters) out += " " + shortest(values[name]);
    return out + "\n";
  }
  return "";
}

}  // namespace textslam
