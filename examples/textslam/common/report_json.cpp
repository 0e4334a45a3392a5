#include "textslam/common/report_json.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace textslam {
namespace {

Json to_value(Mode mode) { return mode == Mode::text ? "text" : mode == Mode::points ? "points" : "loose"; }
Json to_value(bool value) { return value; }
Json to_value(int value) { return value; }
Json to_value(double value) { return short_number(value); }

}  // namespace

Json short_number(double value) {
  if (!std::isfinite(value)) return nullptr;
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  const double rounded = std::strtod(text, nullptr);
  // Whole numbers without their ".0".
  if (rounded == std::trunc(rounded) && std::abs(rounded) < 1e9) return static_cast<long>(rounded);
  return rounded;
}

Json short_vector(const Vector3<double>& v) {
  return Json::array({short_number(v.x()), short_number(v.y()), short_number(v.z())});
}

Json short_pose(const SE3d& T) {
  Eigen::Quaterniond q(T.R);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  Json pose = short_vector(T.t);
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) pose.push_back(short_number(value));
  return pose;
}

Json short_corners(const std::array<Vector3<double>, 4>& corners) {
  Json out = Json::array();
  for (const auto& corner : corners) out.push_back(short_vector(corner));
  return out;
}

Json short_polygon(const std::vector<Vector2<double>>& corners) {
  Json out = Json::array();
  for (const auto& corner : corners) {
    if (!corner.allFinite()) return nullptr;
    for (const double value : {corner.x(), corner.y()}) out.push_back(short_number(std::round(10 * value) / 10));
  }
  return out;
}

Json parameters_json(const Parameters& parameters) {
  Json out = Json::array();
  for_each_parameter(parameters, [&](const char* section, const char* name, const auto& value, const char* meaning) {
    out.push_back(Json::array({section, name, to_value(value), meaning}));
  });
  return out;
}

std::string script_text(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (const char c : text)
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  return out;
}

}  // namespace textslam
