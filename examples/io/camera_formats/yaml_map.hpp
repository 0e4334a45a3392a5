// A mapping of a YAML file: its values, and errors with their line.
#ifndef TEXTSLAM_IO_CAMERA_FORMATS_YAML_MAP_HPP
#define TEXTSLAM_IO_CAMERA_FORMATS_YAML_MAP_HPP

#include <yaml-cpp/yaml.h>

#include <map>
#include <string>
#include <vector>

namespace textslam {

class YamlMap {
 public:
  /// The mapping that a file is. OpenCV's %YAML:1.0, which is no directive of YAML, is passed over; XML as
  /// cv::FileStorage writes it is read as YAML of the same lines. Throws InputError, with the line where there is one,
  /// for a file that cannot be read, is neither, or is no mapping, and for a key that is there twice.
  static YamlMap load(const std::string& path);

  bool has(const std::string& key) const { return static_cast<bool>(node_[key]); }
  /// Whether a key begins like this.
  bool has_prefix(const std::string& prefix) const;
  /// The methods below throw InputError where the key is missing or has another kind of value.
  YAML::Node at(const std::string& key) const;
  YamlMap map(const std::string& key) const;
  std::string text(const std::string& key) const;  ///< Empty where the value is no scalar.
  double number(const std::string& key) const;
  double positive(const std::string& key) const;
  int side(const std::string& key) const;  ///< Of an image, px.
  /// A list of numbers, of a length from `least` to `most`.
  std::vector<double> numbers(const std::string& key, std::size_t least, std::size_t most) const;
  /// The same of a node, which messages call `what`.
  std::vector<double> numbers(const YAML::Node& node, const std::string& what, std::size_t least,
                              std::size_t most) const;

  /// Throws InputError at the node's line.
  [[noreturn]] void refuse(const YAML::Node& node, const std::string& message) const;
  /// Throws "key should be ..., not 'value'".
  [[noreturn]] void refuse_value(const std::string& key, const std::string& should) const;

 private:
  YamlMap(std::string path, const YAML::Node& node);
  double number(const YAML::Node& node, const std::string& what) const;

  std::string path_;
  YAML::Node node_;
  std::map<std::string, int> lines_;  // of the keys
};

}  // namespace textslam

#endif  // TEXTSLAM_IO_CAMERA_FORMATS_YAML_MAP_HPP
