#include "io/camera_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "io/text_file.hpp"

namespace textslam {

namespace {

struct Setting {
  std::string value;
  int line = 0;
};
using Settings = std::map<std::string, Setting>;

// The scalar of "value  # comment" or "'value'", as in YAML, for scalars on one line.
std::string_view scalar(std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && (text[0] == '"' || text[0] == '\'')) {
    const std::size_t end = text.find(text[0], 1);
    if (end != std::string_view::npos) return text.substr(1, end - 1);
  }
  if (!text.empty() && text[0] == '#') return {};
  const std::size_t comment = std::min(text.find(" #"), text.find("\t#"));
  return trimmed(text.substr(0, comment));
}

// The top-level `key: value` lines. Indented lines and list items, which belong to keys of other programs, are
// skipped; so are directives and document marks, OpenCV's "%YAML:1.0" included, which a YAML parser refuses.
Settings read_settings(const std::string& path) {
  Settings settings;
  for (const TextLine& line : read_lines(path)) {
    const char first = line.text[0];
    const std::string_view text = trimmed(line.text);
    if (text[0] == '#' || first == '%' || text == "---" || text == "...") continue;
    if (first == ' ' || first == '\t' || first == '-') continue;
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos || colon == 0) {
      throw InputError(path, line.number, "expected 'key: value', not " + shown(text));
    }
    const std::string key(trimmed(text.substr(0, colon)));
    const auto [entry, is_new] =
        settings.emplace(key, Setting{std::string(scalar(text.substr(colon + 1))), line.number});
    if (!is_new) {
      throw InputError(path, line.number, key + " is given twice, first in line " + std::to_string(entry->second.line));
    }
  }
  return settings;
}

class CameraReader {
 public:
  explicit CameraReader(const std::string& path) : path_(path), settings_(read_settings(path)) {}

  const Setting* find(const std::string& key) const {
    const auto entry = settings_.find(key);
    return entry == settings_.end() ? nullptr : &entry->second;
  }
  double number(const std::string& key) const {
    const Setting* setting = find(key);
    if (!setting) throw InputError(path_, 0, "the key " + key + " is missing");
    return require_number(setting->value, path_, setting->line, key);
  }
  double positive(const std::string& key) const {
    const double value = number(key);
    if (!(value > 0)) refuse(key, "should be positive");
    return value;
  }
  int size(const std::string& key) const {
    const double value = positive(key);
    if (value > kMaxImageSide || value != std::floor(value)) {
      refuse(key, "should be a whole number of at most " + std::to_string(kMaxImageSide));
    }
    return static_cast<int>(value);
  }
  [[noreturn]] void refuse(const std::string& key, const std::string& reason) const {
    const Setting* setting = find(key);
    throw InputError(path_, setting->line, key + " " + reason + ", not " + shown(setting->value));
  }

 private:
  std::string path_;
  Settings settings_;
};

}  // namespace

CameraModel read_camera(const std::string& path) {
  const CameraReader reader(path);
  const CameraType* type = &camera_types().front();
  if (const Setting* name = reader.find("Camera.type")) {
    type = find_camera_type(&CameraType::camera_yaml, name->value);
    if (!type) reader.refuse("Camera.type", "should be " + known_camera_types(&CameraType::camera_yaml));
  }
  CameraModel camera;
  camera.width = reader.size("Camera.width");
  camera.height = reader.size("Camera.height");
  camera.fps = reader.positive("Camera.fps");
  std::vector<double> parameters = {reader.positive("Camera.fx"), reader.positive("Camera.fy"),
                                    reader.number("Camera.cx"), reader.number("Camera.cy")};
  for (std::size_t i = 0; i < type->coefficients.size(); ++i) {
    const std::string key = "Camera." + type->coefficients[i];
    parameters.push_back(i < type->required || reader.find(key) ? reader.number(key) : 0);
  }
  camera.raw = type->make(parameters.data());
  return camera;
}

std::string format_camera(const CameraModel& camera) {
  const CameraType& type = camera_types()[camera.raw.index()];
  std::string out;
  const auto add = [&out](const std::string& key, const std::string& value) {
    out += "Camera." + key + ": " + value + "\n";
  };
  if (camera.raw.index() != 0) add("type", type.camera_yaml.front());
  add("width", std::to_string(camera.width));
  add("height", std::to_string(camera.height));
  add("fps", shortest(camera.fps));
  std::vector<std::string> keys = {"fx", "fy", "cx", "cy"};
  keys.insert(keys.end(), type.coefficients.begin(), type.coefficients.end());
  std::visit(
      [&](const auto& raw) {
        const auto parameters = raw.parameters();
        for (std::size_t i = 0; i < keys.size(); ++i) add(keys[i], shortest(parameters[static_cast<int>(i)]));
      },
      camera.raw);
  return out;
}

CameraModel camera_from_fov(double fov, int width, int height) {
  CameraModel camera;
  camera.width = width;
  camera.height = height;
  const double f = 0.5 * width / std::tan(fov * (M_PI / 360));
  camera.raw = RadialTangential<double>{{f, f, 0.5 * (width - 1), 0.5 * (height - 1)}};
  return camera;
}

}  // namespace textslam
