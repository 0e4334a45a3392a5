// EuRoC's sensor.yaml and kalibr's camchain.yaml, which share their words.
#include <cmath>

#include "io/camera_formats/formats.hpp"
#include "io/image_file.hpp"
#include "io/text_file.hpp"

namespace textslam {

namespace {

constexpr const char* kPinhole = "pinhole";

void require_focal_lengths(const YamlMap& file, double fx, double fy) {
  if (!(fx > 0 && fy > 0)) file.refuse(file.at("intrinsics"), "the focal lengths of the intrinsics should be positive");
}

// Mei's unified camera: m_d = (x, y) / (z + xi |p|), which is the extended one of alpha = xi / (1 + xi), beta = 1.
textplane::AnyCamera<double> read_omni(const YamlMap& file) {
  const std::vector<double> k = file.numbers("intrinsics", 5, 5);
  if (!(k[0] >= 0)) file.refuse(file.at("intrinsics"), "xi, the first of the intrinsics, should not be negative");
  require_focal_lengths(file, k[1], k[2]);
  const double scale = 1 / (1 + k[0]);
  return make_camera(camera_type("extended_unified"), {k[1] * scale, k[2] * scale, k[3], k[4], k[0] * scale, 1}, file,
                     "intrinsics");
}

void require_no_lens(const YamlMap& file, const std::string& model) {
  if (file.has("distortion_model") && file.text("distortion_model") != "none")
    file.refuse_value("distortion_model", "none for the camera_model " + model);
}

// A camera_model with intrinsics of its own: the coefficients, then fu fv pu pv.
textplane::AnyCamera<double> read_projection(const YamlMap& file) {
  const std::string name = file.text("camera_model");
  const CameraType* type = find_camera_type(
      [&](const CameraType& known) { return known.projection == name && !name.empty() && name != kPinhole; });
  if (!type && name != "omni") file.refuse_value("camera_model", "pinhole or ds or eucm or omni");
  require_no_lens(file, name);
  if (!type) return read_omni(file);
  const std::size_t count = type->coefficients.size();
  const std::vector<double> k = file.numbers("intrinsics", count + 4, count + 4);
  std::vector<double> parameters(k.begin() + static_cast<std::ptrdiff_t>(count), k.end());
  parameters.insert(parameters.end(), k.begin(), k.begin() + static_cast<std::ptrdiff_t>(count));
  require_focal_lengths(file, parameters[0], parameters[1]);
  return make_camera(*type, parameters, file, "intrinsics");
}

textplane::AnyCamera<double> read_pinhole(const YamlMap& file) {
  std::vector<double> parameters = file.numbers("intrinsics", 4, 4);
  require_focal_lengths(file, parameters[0], parameters[1]);
  const std::string name = file.text("distortion_model");
  std::string known;
  for (const CameraType& type : camera_types())
    if (type.projection == kPinhole) known += (known.empty() ? "" : " or ") + type.distortion.front();
  const CameraType* type = find_camera_type(
      [&](const CameraType& each) { return each.projection == kPinhole && is_one_of(each.distortion, name); });
  if (!type) file.refuse_value("distortion_model", known);
  std::string key = "intrinsics";
  if (type->required > 0) {
    key = file.has("distortion_coeffs") ? "distortion_coeffs" : "distortion_coefficients";
    const std::vector<double> k = file.numbers(key, type->required, type->coefficients.size());
    parameters.insert(parameters.end(), k.begin(), k.end());
  }
  return make_camera(*type, parameters, file, key);
}

CameraFile read_words(const YamlMap& file) {
  CameraFile out;
  const std::vector<double> size = file.numbers("resolution", 2, 2);
  for (const double side : size)
    if (!(side >= 1 && side <= kMaxImageSide) || side != std::floor(side))
      file.refuse(file.at("resolution"),
                  "resolution should be whole numbers of at most " + std::to_string(kMaxImageSide));
  out.model.width = static_cast<int>(size[0]);
  out.model.height = static_cast<int>(size[1]);
  out.model.raw = file.text("camera_model") == kPinhole ? read_pinhole(file) : read_projection(file);
  return out;
}

// The motion of 16 numbers, row by row.
SE3d motion_of(const YamlMap& file, const YAML::Node& node, const std::string& what, const std::vector<double>& v) {
  SE3d T;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) T.R(row, column) = v[static_cast<std::size_t>(4 * row + column)];
    T.t[row] = v[static_cast<std::size_t>(4 * row + 3)];
  }
  // The file rounds its digits: take the nearest rotation.
  const bool rigid = (T.R * T.R.transpose() - Matrix3<double>::Identity()).cwiseAbs().maxCoeff() < 1e-3 &&
                     T.R.determinant() > 0 && T.t.allFinite();
  if (!rigid) file.refuse(node, what + " should be a rotation and a translation");
  T.R = Eigen::Quaterniond(T.R).normalized().toRotationMatrix();
  return T;
}

// The words of both formats; empty where there are none for the model.
std::string format_words(const CameraModel& camera, const std::string& indent, bool kalibr) {
  const CameraType& type = camera_type(camera.raw.name());
  std::vector<double> all = parameters_of(camera), k(all.begin() + 4, all.end());
  if (type.projection.empty()) return "";
  all.resize(4);
  if (type.projection != kPinhole) {
    all.insert(all.begin(), k.begin(), k.end());
    k.clear();
  }
  if (k.size() > type.required) {
    if (kalibr && k.back() != 0) return "";
    if (k.back() == 0) k.resize(type.required);
  }
  std::string out;
  const auto add = [&](const std::string& key, const std::string& value) { out += indent + key + ": " + value + "\n"; };
  add("camera_model", type.projection);
  add("intrinsics", "[" + list_of(all) + "]");
  add("distortion_model", kalibr ? type.distortion.back() : type.distortion.front());
  add(kalibr ? "distortion_coeffs" : "distortion_coefficients", "[" + list_of(k) + "]");
  add("resolution", "[" + std::to_string(camera.width) + ", " + std::to_string(camera.height) + "]");
  return out;
}

}  // namespace

bool is_sensor(const YamlMap& file) { return file.has("intrinsics"); }
bool is_camchain(const YamlMap& file) { return file.has("cam0"); }

CameraFile read_sensor(const YamlMap& file) {
  CameraFile out = read_words(file);
  if (file.has("rate_hz")) out.model.fps = file.positive("rate_hz");
  if (!file.has("T_BS")) return out;
  const YAML::Node node = file.at("T_BS");
  if (!node.IsMap() || !node["data"]) file.refuse(node, "T_BS should have rows, cols and data");
  out.T_b_c = motion_of(file, node["data"], "T_BS", file.numbers(node["data"], "the data of T_BS", 16, 16));
  return out;
}

CameraFile read_camchain(const YamlMap& file) {
  const YamlMap first = file.map("cam0");
  CameraFile out = read_words(first);
  if (!first.has("T_cam_imu")) return out;
  const YAML::Node rows = first.at("T_cam_imu");
  if (!rows.IsSequence() || rows.size() != 4) first.refuse(rows, "T_cam_imu should have 4 rows");
  std::vector<double> v;
  for (const auto& row : rows) {
    const std::vector<double> numbers = first.numbers(row, "a row of T_cam_imu", 4, 4);
    v.insert(v.end(), numbers.begin(), numbers.end());
  }
  out.T_b_c = motion_of(first, rows, "T_cam_imu", v).inverse();
  return out;
}

std::string format_sensor(const CameraModel& camera) {
  const std::string words = format_words(camera, "", false);
  if (words.empty()) return "";
  return "sensor_type: camera\n" + (camera.fps > 0 ? "rate_hz: " + shortest(camera.fps) + "\n" : "") + words;
}

std::string format_camchain(const CameraModel& camera) {
  const std::string words = format_words(camera, "  ", true);
  return words.empty() ? "" : "cam0:\n" + words;
}

}  // namespace textslam
