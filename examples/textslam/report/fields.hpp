// A record as its outputs show it. Each field is described once: its name in the file, its name on the report's page,
// its value.
#ifndef TEXTSLAM_REPORT_FIELDS_HPP
#define TEXTSLAM_REPORT_FIELDS_HPP

#include <array>
#include <cstdio>
#include <string>

#include "textslam/common/report_json.hpp"

namespace textslam {

class Fields {
 public:
  /// `value` as it is in the file, and to six digits on the page. A null name: not there.
  template <class Value>
  void add(const char* in_file, const char* on_page, const Value& value) {
    if (in_file != nullptr) file[in_file] = exact(value);
    if (on_page != nullptr) page[on_page] = shortened(value);
  }
  /// A row of the table on the terminal; `format` as for printf.
  template <class... Values>
  void row(const char* name, const char* format, Values... values) {
    char value[120], line[160];
    std::snprintf(value, sizeof value, format, values...);
    std::snprintf(line, sizeof line, "  %-22s %s\n", name, value);
    table += line;
  }

  Json file = Json::object(), page = Json::object();
  std::string table;

 private:
  template <class Value>
  static Json exact(const Value& value) {
    return value;
  }
  static Json exact(const Vector3<double>& v) { return Json::array({v.x(), v.y(), v.z()}); }
  static Json exact(const std::array<Vector3<double>, 4>& corners) {
    Json out = Json::array();
    for (const auto& corner : corners) out.push_back(exact(corner));
    return out;
  }
  template <class Value>
  static Json shortened(const Value& value) {
    return value;
  }
  static Json shortened(double value) { return short_number(value); }
  static Json shortened(const Vector3<double>& v) { return short_vector(v); }
  static Json shortened(const std::array<Vector3<double>, 4>& corners) { return short_corners(corners); }
};

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_FIELDS_HPP
