// Settings of a TextMap by name, as `--set NAME=VALUE` gives them. The build takes the names from the library's headers
// (settings.cmake), so none is missing.
#ifndef ODOMETRY_SETTINGS_HPP
#define ODOMETRY_SETTINGS_HPP

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "textplane/landmarks/text_map.hpp"

namespace odometry {

/// Sets what "NAME=VALUE" names; a member of TextOptions is `text.NAME`. std::invalid_argument for what is none.
inline void set_by_name(const std::string& setting, textplane::TextMapOptions* options) {
  const std::size_t end = setting.find('=');
  const std::string name = setting.substr(0, end), value = end == std::string::npos ? "" : setting.substr(end + 1);
  char* rest = nullptr;
  const double number = std::strtod(value.c_str(), &rest);
  if (value.empty() || *rest != '\0' || !std::isfinite(number))
    throw std::invalid_argument("--set " + setting + ": wanted NAME=NUMBER");
#define ODOMETRY_SETTING(member)                                                                                   \
  if (name == #member) {                                                                                           \
    if (std::is_integral_v<decltype(options->member)> && (number != std::floor(number) || std::abs(number) > 1e9)) \
      throw std::invalid_argument("--set " + setting + ": wanted a whole number");                                 \
    options->member = static_cast<decltype(options->member)>(number);                                              \
    return;                                                                                                        \
  }
#include "odometry_settings.inc"
#undef ODOMETRY_SETTING
  throw std::invalid_argument("--set " + setting + ": no such setting");
}

}  // namespace odometry

#endif  // ODOMETRY_SETTINGS_HPP
