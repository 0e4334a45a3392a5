#include "io/camera_formats/yaml_map.hpp"

#include <algorithm>
#include <cmath>

#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "io/text_file.hpp"

namespace textslam {

namespace {

int line_of(const YAML::Node& node) { return node.Mark().is_null() ? 0 : node.Mark().line + 1; }

// The scalar, or the one that is alone in a list.
YAML::Node scalar_of(const YAML::Node& node) { return node.IsSequence() && node.size() == 1 ? node[0] : node; }

// The text of a file without lines that begin with '%', the others in their places.
std::string read_text(const std::string& path) {
  std::string text;
  int number = 1;
  for (const TextLine& line : read_lines(path)) {
    for (; number < line.number; ++number) text += '\n';
    if (line.text[0] != '%') text += line.text;
  }
  return text;
}

// cv::FileStorage's XML as YAML of the same lines: an element that holds elements becomes a mapping, one that holds
// text a list of its words.
class XmlReader {
 public:
  XmlReader(const std::string& path, const std::string& xml) : path_(path), xml_(xml) {}

  std::string yaml() {
    while (at_ < xml_.size()) {
      const std::string_view rest = std::string_view(xml_).substr(at_);
      if (is_blank(rest[0])) {
        pass(1);
      } else if (rest.substr(0, 2) == "<?") {
        pass_to("?>");
      } else if (rest.substr(0, 4) == "<!--") {
        pass_to("-->");
      } else if (rest[0] == '<') {
        tag();
      } else {
        word();
      }
    }
    if (!open_.empty()) refuse("the element " + shown(open_.back()) + " has no end");
    return "{" + yaml_ + "}";
  }

 private:
  enum class Content { none, text, elements };

  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
  [[noreturn]] void refuse(const std::string& message) const {
    const auto ends = std::count(xml_.begin(), xml_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    throw InputError(path_, static_cast<int>(ends) + 1, "this is no XML: " + message);
  }
  // Lines end in the YAML where they end in the XML.
  void pass(std::size_t n) {
    for (; n > 0; --n, ++at_)
      if (xml_[at_] == '\n') yaml_ += '\n';
  }
  void pass_to(const std::string& end) {
    const std::size_t found = xml_.find(end, at_);
    if (found == std::string::npos) refuse("'" + end + "' is missing");
    pass(found + end.size() - at_);
  }
  void tag() {
    const bool closes = xml_.compare(at_, 2, "</") == 0;
    const std::size_t begin = at_ + (closes ? 2 : 1), end = xml_.find_first_of(" \t\r\n>/", begin);
    if (end == std::string::npos || end == begin) refuse("a name is missing");
    const std::string name = xml_.substr(begin, end - begin);
    if (name.find_first_of("'\"<\\") != std::string::npos) refuse("a name is " + shown(name));
    if (closes) {
      if (open_.empty() || open_.back() != name) refuse(shown("</" + name + ">") + " closes nothing");
      close();
    } else {
      if (content_ == Content::text) refuse("text and the element " + shown(name) + " beside each other");
      if (content_ == Content::none && !open_.empty()) yaml_ += "{";
      yaml_ += "'" + name + "': ";
      open_.push_back(name);
      content_ = Content::none;
    }
    pass_to(">");
    if (!closes && xml_[at_ - 2] == '/') close();
  }
  void close() {
    yaml_ += content_ == Content::none ? "[]," : content_ == Content::text ? "]," : "},";
    open_.pop_back();
    content_ = Content::elements;
  }
  void word() {
    std::size_t end = at_;
    while (end < xml_.size() && !is_blank(xml_[end]) && xml_[end] != '<') ++end;
    if (open_.empty() || content_ == Content::elements) refuse("text outside of an element");
    yaml_ += content_ == Content::none ? "['" : "'";
    for (; at_ < end; ++at_) yaml_ += xml_[at_] == '\'' ? "''" : std::string(1, xml_[at_]);
    yaml_ += "',";  // yaml-cpp 0.9 takes none at the beginning of a line
    content_ = Content::text;
  }

  const std::string& path_;
  const std::string& xml_;
  std::string yaml_;
  std::vector<std::string> open_;
  Content content_ = Content::none;
  std::size_t at_ = 0;
};

}  // namespace

YamlMap YamlMap::load(const std::string& path) {
  std::string text = read_text(path);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  const bool is_xml = begin != std::string::npos && text[begin] == '<';
  if (is_xml) text = XmlReader(path, text).yaml();
  try {
    const YamlMap root(path, YAML::Load(text));
    return is_xml && root.has("opencv_storage") ? root.map("opencv_storage") : root;
  } catch (const YAML::Exception& error) {
    throw InputError(path, error.mark.is_null() ? 0 : error.mark.line + 1, "this is no YAML: " + shown(error.msg));
  }
}

YamlMap::YamlMap(std::string path, const YAML::Node& node) : path_(std::move(path)), node_(node) {
  if (!node.IsMap()) refuse(node, "expected 'key: value' lines");
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) continue;
    const auto [line, is_new] = lines_.emplace(entry.first.Scalar(), line_of(entry.first));
    if (is_new) continue;
    refuse(entry.first, shown(line->first) + " is given twice, first in line " + std::to_string(line->second));
  }
}

bool YamlMap::has_prefix(const std::string& prefix) const {
  return std::any_of(node_.begin(), node_.end(), [&](const auto& entry) {
    return entry.first.IsScalar() && entry.first.Scalar().compare(0, prefix.size(), prefix) == 0;
  });
}

YAML::Node YamlMap::at(const std::string& key) const {
  const YAML::Node node = node_[key];
  if (!node) throw InputError(path_, 0, "the key " + key + " is missing");
  return node;
}

YamlMap YamlMap::map(const std::string& key) const {
  const YAML::Node node = at(key);
  if (!node.IsMap()) refuse(node, key + " should have keys of its own");
  return {path_, node};
}

std::string YamlMap::text(const std::string& key) const {
  const YAML::Node node = scalar_of(at(key));
  return node.IsScalar() ? node.Scalar() : "";
}

double YamlMap::number(const YAML::Node& list, const std::string& what) const {
  const YAML::Node node = scalar_of(list);
  if (!node.IsScalar()) refuse(node, what + " should be a number");
  return require_number(node.Scalar(), path_, line_of(node), what);
}

double YamlMap::number(const std::string& key) const {
  const YAML::Node node = at(key);
  if (node.IsNull()) throw not_a_number("", path_, lines_.at(key), key);  // its own mark is at what follows
  return number(node, key);
}

double YamlMap::positive(const std::string& key) const {
  const double value = number(key);
  if (!(value > 0)) refuse_value(key, "positive");
  return value;
}

int YamlMap::side(const std::string& key) const {
  const double value = positive(key);
  if (value > kMaxImageSide || value != std::floor(value))
    refuse_value(key, "a whole number of at most " + std::to_string(kMaxImageSide));
  return static_cast<int>(value);
}

std::vector<double> YamlMap::numbers(const std::string& key, std::size_t least, std::size_t most) const {
  return numbers(at(key), key, least, most);
}

std::vector<double> YamlMap::numbers(const YAML::Node& node, const std::string& what, std::size_t least,
                                     std::size_t most) const {
  if (!node.IsSequence() || node.size() < least || node.size() > most)
    refuse(node, what + " should be " + (least == most ? "" : std::to_string(least) + " to ") + std::to_string(most) +
                     " numbers in brackets");
  std::vector<double> out;
  for (const auto& entry : node) out.push_back(number(entry, what));
  return out;
}

void YamlMap::refuse(const YAML::Node& node, const std::string& message) const {
  throw InputError(path_, line_of(node), message);
}

void YamlMap::refuse_value(const std::string& key, const std::string& should) const {
  refuse(at(key), key + " should be " + should + ", not " + shown(text(key)));
}

}  // namespace textslam
