#include "textslam/report/report_parameters.hpp"

namespace textslam {
namespace {

Json to_value(Mode mode) { return mode == Mode::text ? "text" : mode == Mode::points ? "points" : "loose"; }
Json to_value(bool value) { return value; }
Json to_value(int value) { return value; }
Json to_value(double value) { return short_number(value); }
Json to_value(float value) { return short_number(static_cast<double>(value)); }

}  // namespace

Json parameters_json(const Parameters& parameters) {
  Json out = Json::array();
  for_each_parameter(parameters, [&](const char* section, const char* name, const auto& value, const char* meaning) {
    out.push_back(Json::array({section, name, to_value(value), meaning}));
  });
  return out;
}

}  // namespace textslam
