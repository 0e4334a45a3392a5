// Values of the report as JSON, short and safe: six significant digits, no NaN, nothing that could end a script
// element.
#ifndef TEXTSLAM_COMMON_REPORT_JSON_HPP
#define TEXTSLAM_COMMON_REPORT_JSON_HPP

#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "io/names.hpp"
#include "textslam/common/parameters.hpp"

namespace textslam {

using Json = nlohmann::ordered_json;

/// The number to six significant digits, null where it is not finite.
Json short_number(double value);
/// [x, y, z].
Json short_vector(const Vector3<double>& v);
/// [x, y, z, qx, qy, qz, qw], qw >= 0.
Json short_pose(const SE3d& T);
/// [[x, y, z], ...].
Json short_corners(const std::array<Vector3<double>, 4>& corners);
/// [x1, y1, x2, y2, ...] in tenths of a pixel; null where a corner is not finite.
Json short_polygon(const std::vector<Vector2<double>>& corners);

/// [[section, name, value, meaning], ...] in the order of the list.
Json parameters_json(const Parameters& parameters);

/// The text of `json` for the inside of a script element: it holds no `<`, so neither `</script>` nor `<!--`, and
/// parses to the same value. Bytes that are not UTF-8 become U+FFFD.
std::string script_text(const Json& json);

}  // namespace textslam

#endif  // TEXTSLAM_COMMON_REPORT_JSON_HPP
