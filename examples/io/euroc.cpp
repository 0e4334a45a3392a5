#include "io/euroc.hpp"

#include <yaml-cpp/yaml.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "io/paths.hpp"
#include "io/text_file.hpp"
#include "textplane/core/numeric.hpp"

namespace textslam {

namespace fs = std::filesystem;

namespace {

std::vector<std::string_view> split_commas(std::string_view text) {
  std::vector<std::string_view> columns;
  for (;;) {
    const std::size_t comma = text.find(',');
    columns.push_back(trimmed(text.substr(0, comma)));
    if (comma == std::string_view::npos) return columns;
    text.remove_prefix(comma + 1);
  }
}

double seconds(std::string_view stamp, const std::string& path, int line) {
  std::int64_t ns = 0;
  const auto [end, error] = std::from_chars(stamp.data(), stamp.data() + stamp.size(), ns);
  if (error != std::errc() || end != stamp.data() + stamp.size())
    throw InputError(path, line, "the timestamp should be a whole number of nanoseconds, not " + shown(stamp));
  return static_cast<double>(ns) / 1e9;
}

[[noreturn]] void refuse_order(const std::string& path, int line, std::string_view stamp) {
  throw InputError(path, line, "times must increase: " + shown(stamp) + " does not follow the line before");
}

// sensor.yaml: values, and errors with their line.
class SensorFile {
 public:
  explicit SensorFile(const std::string& path) : path_(path) {
    try {
      root_ = YAML::Load(read_file(path));
    } catch (const YAML::Exception& error) {
      throw InputError(path, error.mark.is_null() ? 0 : error.mark.line + 1, "this is no YAML: " + shown(error.msg));
    }
    if (!root_.IsMap()) throw InputError(path, 0, "expected 'key: value' lines");
  }

  bool has(const char* key) const { return static_cast<bool>(root_[key]); }
  YAML::Node at(const char* key) const {
    const YAML::Node node = root_[key];
    if (!node) throw InputError(path_, 0, std::string("the key ") + key + " is missing");
    return node;
  }
  [[noreturn]] void refuse(const YAML::Node& node, const std::string& message) const {
    throw InputError(path_, node.Mark().is_null() ? 0 : node.Mark().line + 1, message);
  }
  double number(const YAML::Node& node, const std::string& what) const {
    if (!node.IsScalar()) refuse(node, what + " should be a number");
    return require_number(node.Scalar(), path_, node.Mark().line + 1, what);
  }
  std::vector<double> numbers(const YAML::Node& node, const std::string& what, std::size_t least,
                              std::size_t most) const {
    if (!node.IsSequence() || node.size() < least || node.size() > most)
      refuse(node, what + " should be " + (least == most ? "" : std::to_string(least) + " to ") + std::to_string(most) +
                       " numbers in brackets");
    std::vector<double> out;
    for (std::size_t i = 0; i < node.size(); ++i) out.push_back(number(node[i], what));
    return out;
  }
  std::string name(const char* key) const {
    const YAML::Node node = at(key);
    return node.IsScalar() ? node.Scalar() : "";
  }
  [[noreturn]] void refuse_name(const char* key, const std::string& known) const {
    refuse(at(key), std::string(key) + " should be " + known + ", not " + shown(name(key)));
  }

 private:
  std::string path_;
  YAML::Node root_;
};

// The camera of fx fy cx cy and the file's lens. "none" is the first type with all coefficients 0.
RawCamera read_distortion(const SensorFile& file, std::vector<double> parameters) {
  const std::string name = file.name("distortion_model");
  const CameraType* type = name == "none" ? &camera_types().front() : find_camera_type(&CameraType::sensor_yaml, name);
  if (!type) file.refuse_name("distortion_model", known_camera_types(&CameraType::sensor_yaml) + " or none");
  const std::size_t most = type->coefficients.size();
  if (name != "none") {
    const char* const key = "distortion_coefficients";
    const std::vector<double> k = file.numbers(file.at(key), key, type->required, most);
    parameters.insert(parameters.end(), k.begin(), k.end());
  }
  parameters.resize(4 + most);
  return type->make(parameters.data());
}

SE3d read_motion(const SensorFile& file, const YAML::Node& node) {
  if (!node.IsMap() || !node["data"]) file.refuse(node, "T_BS should have rows, cols and data");
  const YAML::Node data = node["data"];
  const std::vector<double> v = file.numbers(data, "the data of T_BS", 16, 16);
  SE3d T;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) T.R(row, column) = v[static_cast<std::size_t>(4 * row + column)];
    T.t[row] = v[static_cast<std::size_t>(4 * row + 3)];
  }
  // The file rounds its digits: take the nearest rotation.
  const bool rigid = (T.R * T.R.transpose() - Matrix3<double>::Identity()).cwiseAbs().maxCoeff() < 1e-3 &&
                     T.R.determinant() > 0 && T.t.allFinite();
  if (!rigid) file.refuse(data, "T_BS should be a rotation and a translation");
  T.R = Eigen::Quaterniond(T.R).normalized().toRotationMatrix();
  return T;
}

}  // namespace

bool find_euroc(const std::string& folder, EurocFiles* files) {
  fs::path mav = fs::path(folder) / "mav0";
  if (!is_folder(mav / "cam0")) mav = folder;
  if (!is_folder(mav / "cam0")) return false;
  files->list = (mav / "cam0" / "data.csv").string();
  files->images = (mav / "cam0" / "data").string();
  files->camera = (mav / "cam0" / "sensor.yaml").string();
  files->truth = (mav / "state_groundtruth_estimate0" / "data.csv").string();
  return true;
}

EurocCamera read_euroc_camera(const std::string& path) {
  const SensorFile file(path);
  const auto positive = [&](double value, const char* key) {
    if (!(value > 0)) file.refuse(file.at(key), std::string(key) + " should be positive");
    return value;
  };
  if (file.name("camera_model") != "pinhole") file.refuse_name("camera_model", "pinhole");
  EurocCamera camera;
  CameraModel& model = camera.model;
  const std::vector<double> size = file.numbers(file.at("resolution"), "resolution", 2, 2);
  for (const double side : size) {
    if (!(side >= 1 && side <= kMaxImageSide) || side != std::floor(side))
      file.refuse(file.at("resolution"),
                  "resolution should be whole numbers of at most " + std::to_string(kMaxImageSide));
  }
  model.width = static_cast<int>(size[0]);
  model.height = static_cast<int>(size[1]);
  std::vector<double> parameters = file.numbers(file.at("intrinsics"), "intrinsics", 4, 4);
  for (std::size_t i = 0; i < 2; ++i) positive(parameters[i], "intrinsics");
  model.raw = read_distortion(file, std::move(parameters));
  if (file.has("rate_hz")) model.fps = positive(file.number(file.at("rate_hz"), "rate_hz"), "rate_hz");
  if (file.has("T_BS")) camera.T_b_c = read_motion(file, file.at("T_BS"));
  return camera;
}

std::vector<FrameRef> read_euroc_frames(const std::string& list, const std::string& images) {
  std::vector<FrameRef> frames;
  for (const TextLine& line : read_lines(list)) {
    if (trimmed(line.text)[0] == '#') continue;
    const std::vector<std::string_view> columns = split_commas(line.text);
    FrameRef frame;
    frame.line = line.number;
    frame.timestamp = seconds(columns[0], list, line.number);
    if (columns.size() != 2 || columns[1].empty())
      throw InputError(list, line.number, "expected 'timestamp,file name'");
    if (!frames.empty() && !(frame.timestamp > frames.back().timestamp)) refuse_order(list, line.number, columns[0]);
    const fs::path path = fs::path(images) / columns[1];
    frame.path = path.string();
    frame.stem = path.stem().string();
    frames.push_back(std::move(frame));
  }
  if (frames.empty()) throw InputError(list, 0, "the list names no image");
  return frames;
}

std::vector<StampedPose> read_euroc_truth(const std::string& path, const SE3d& T_b_c) {
  static const char* const kColumns[8] = {"timestamp", "x", "y", "z", "qw", "qx", "qy", "qz"};
  std::vector<StampedPose> poses;
  for (const TextLine& line : read_lines(path)) {
    if (trimmed(line.text)[0] == '#') continue;
    const std::vector<std::string_view> columns = split_commas(line.text);
    if (columns.size() < 8) {
      throw InputError(path, line.number,
                       "a pose has 8 columns (timestamp,x,y,z,qw,qx,qy,qz), not " + std::to_string(columns.size()));
    }
    StampedPose pose;
    pose.timestamp = seconds(columns[0], path, line.number);
    if (!poses.empty() && !(pose.timestamp > poses.back().timestamp)) refuse_order(path, line.number, columns[0]);
    double v[8] = {};
    for (std::size_t i = 1; i < 8; ++i) v[i] = require_number(columns[i], path, line.number, kColumns[i]);
    const Eigen::Quaterniond q(v[4], v[5], v[6], v[7]);
    if (!(std::abs(q.norm() - 1) <= 0.01)) throw InputError(path, line.number, "the quaternion is not of unit length");
    pose.T_w_c = SE3d{q.normalized().toRotationMatrix(), Vector3<double>(v[1], v[2], v[3])} * T_b_c;
    if (!textplane::all_finite(pose.T_w_c)) throw InputError(path, line.number, "the position is out of range");
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace textslam
