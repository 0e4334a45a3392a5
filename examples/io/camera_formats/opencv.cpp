// Calibrations of cv::FileStorage, as OpenCV's programs write them, and ROS's camera_info files, which are alike.
#include "io/camera_formats/formats.hpp"
#include "io/text_file.hpp"

namespace textslam {

namespace {

// OpenCV 2 wrote capitals.
std::string key_of(const YamlMap& file, const std::string& now, const std::string& before) {
  return !file.has(now) && file.has(before) ? before : now;
}

std::vector<double> matrix(const YamlMap& file, const std::string& key, std::size_t least, std::size_t most) {
  const YamlMap map = file.map(key);
  return map.numbers(map.at("data"), "the data of " + key, least, most);
}

bool is_fisheye(const YamlMap& file) {
  if (file.has("fisheye_model")) return file.number("fisheye_model") != 0;
  return file.has("distortion_model") && file.text("distortion_model") == "equidistant";
}

}  // namespace

bool is_opencv(const YamlMap& file) { return file.has("camera_matrix") || file.has("Camera_Matrix"); }

CameraFile read_opencv(const YamlMap& file) {
  CameraFile out;
  out.model.width = file.side(key_of(file, "image_width", "image_Width"));
  out.model.height = file.side(key_of(file, "image_height", "image_Height"));
  const std::string K_key = key_of(file, "camera_matrix", "Camera_Matrix");
  const std::string D_key = key_of(file, "distortion_coefficients", "Distortion_Coefficients");
  const std::vector<double> K = matrix(file, K_key, 9, 9);
  if (!(K[0] > 0 && K[4] > 0)) file.refuse(file.at(K_key), "the focal lengths of " + K_key + " should be positive");
  if (K[1] != 0 || K[3] != 0 || K[6] != 0 || K[7] != 0 || K[8] != 1)
    file.refuse(file.at(K_key), K_key + " should be [fx, 0, cx; 0, fy, cy; 0, 0, 1]");
  const bool fisheye = is_fisheye(file);
  std::vector<double> D = matrix(file, D_key, fisheye ? 4 : 0, fisheye ? 4 : 14);
  while (D.size() > 8 && D.back() == 0) D.pop_back();  // thin prisms and tilts that were not calibrated
  if (D.size() != 0 && D.size() != 4 && D.size() != 5 && D.size() != 8)
    file.refuse(file.at(D_key), D_key + " should be 4, 5 or 8 numbers: thin prisms and tilted sensors are not known");
  std::vector<double> parameters = {K[0], K[4], K[2], K[5]};
  parameters.insert(parameters.end(), D.begin(), D.end());
  const char* const model = fisheye         ? "kannala_brandt"
                            : D.size() == 8 ? "rational"
                            : D.empty()     ? "pinhole"
                                            : "radial_tangential";
  out.model.raw = make_camera(camera_type(model), parameters, file, D_key);
  return out;
}

std::string format_opencv(const CameraModel& camera) {
  const std::string model = camera.raw.name();
  const bool fisheye = model == "kannala_brandt";
  if (!fisheye && model != "pinhole" && model != "radial_tangential" && model != "rational") return "";
  std::vector<double> k = parameters_of(camera);
  const std::string K = list_of({k[0], 0, k[2], 0, k[1], k[3], 0, 0, 1});
  k.erase(k.begin(), k.begin() + 4);
  if (k.empty()) k.resize(5);  // programs that read it expect some
  const auto add = [](const std::string& key, const std::string& rows, const std::string& columns,
                      const std::string& data) {
    return key + ": !!opencv-matrix\n   rows: " + rows + "\n   cols: " + columns + "\n   dt: d\n   data: [ " + data +
           " ]\n";
  };
  std::string out = "%YAML:1.0\n---\nimage_width: " + std::to_string(camera.width) +
                    "\nimage_height: " + std::to_string(camera.height) + "\n";
  if (fisheye) out += "fisheye_model: 1\n";
  return out + add("camera_matrix", "3", "3", K) +
         add("distortion_coefficients", "1", std::to_string(k.size()), list_of(k));
}

}  // namespace textslam
