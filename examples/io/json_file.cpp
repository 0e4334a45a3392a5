#include "io/json_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "io/text_file.hpp"

namespace textslam {

nlohmann::json read_json(const std::string& path) {
  const std::string bytes = read_file(path);
  try {
    return nlohmann::json::parse(bytes);
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t at = std::min(error.byte, bytes.size());
    const auto line = 1 + std::count(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw InputError(path, static_cast<int>(line), error.what());
  } catch (const nlohmann::json::exception& error) {  // for a number too large for a double
    throw InputError(path, 0, error.what());
  }
}

int to_int(const nlohmann::json& json) {
  const auto number = json.get<double>();
  if (!(std::abs(number) <= std::numeric_limits<int>::max()) || number != std::floor(number))
    throw std::out_of_range("a whole number expected, not " + json.dump());
  return static_cast<int>(number);
}

Vector3<double> to_vector3(const nlohmann::json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

}  // namespace textslam
