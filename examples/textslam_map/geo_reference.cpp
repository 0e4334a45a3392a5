#include "textslam_map/geo_reference.hpp"

#include <array>
#include <cmath>

#include "io/text_file.hpp"

namespace textslam {
namespace {

// WGS84.
constexpr double kAxis = 6378137, kFlattening = 1 / 298.257223563;
constexpr double kEccentricity2 = kFlattening * (2 - kFlattening);
constexpr int kSteps = 8;            // each makes the latitude's error 150 times smaller near the ground
constexpr double kHighest = 1e5;     // m: beyond it nobody walks
constexpr double kSmallestUp = 0.5;  // of a cosine: there the height is that along the axis

double curvature_radius(double sine) { return kAxis / std::sqrt(1 - kEccentricity2 * sine * sine); }

Vec3 earth_centred(const GeoPosition& p) {
  const double lat = radians(p.latitude), lon = radians(p.longitude), n = curvature_radius(std::sin(lat));
  return {(n + p.altitude) * std::cos(lat) * std::cos(lon), (n + p.altitude) * std::cos(lat) * std::sin(lon),
          ((1 - kEccentricity2) * n + p.altitude) * std::sin(lat)};
}

GeoPosition geodetic(const Vec3& p) {
  const double r = std::hypot(p.x(), p.y());
  double lat = std::atan2(p.z(), (1 - kEccentricity2) * r), height = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double s = std::sin(lat), c = std::cos(lat), n = curvature_radius(s);
    height = c > kSmallestUp ? r / c - n : p.z() / s - (1 - kEccentricity2) * n;
    lat = std::atan2(p.z() * (n + height), r * ((1 - kEccentricity2) * n + height));
  }
  return {lat * 180 / M_PI, std::atan2(p.y(), p.x()) * 180 / M_PI, height};
}

}  // namespace

bool parse_geo_position(const std::string& text, GeoPosition* out) {
  std::array<double, 3> numbers{};
  std::size_t count = 0, from = 0;
  for (;;) {
    const std::size_t comma = text.find(',', from);
    if (count == numbers.size() || !parse_number(text.substr(from, comma - from), &numbers[count])) return false;
    ++count;
    if (comma == std::string::npos) break;
    from = comma + 1;
  }
  if (count < 2 || std::abs(numbers[0]) > 90 || std::abs(numbers[1]) > 180 || std::abs(numbers[2]) > kHighest)
    return false;
  *out = {numbers[0], numbers[1], numbers[2]};
  return true;
}

Vec3 east_north_up(const GeoReference& reference, const Vec3& p_w) {
  const double s = std::sin(radians(reference.north)), c = std::cos(radians(reference.north));
  return {c * p_w.x() + s * p_w.z(), c * p_w.z() - s * p_w.x(), -p_w.y()};
}

GeoPosition geo_position(const GeoReference& reference, const Vec3& p_w) {
  const double lat = radians(reference.origin.latitude), lon = radians(reference.origin.longitude);
  const Vec3 east(-std::sin(lon), std::cos(lon), 0),
      north(-std::sin(lat) * std::cos(lon), -std::sin(lat) * std::sin(lon), std::cos(lat)),
      up(std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat));
  const Vec3 p = east_north_up(reference, p_w);
  return geodetic(earth_centred(reference.origin) + p.x() * east + p.y() * north + p.z() * up);
}

double azimuth(const GeoReference& reference, const Vec3& direction_w) {
  const Vec3 d = east_north_up(reference, direction_w);
  const double degrees = std::atan2(d.x(), d.y()) * 180 / M_PI;
  return degrees < 0 ? degrees + 360 : degrees;
}

double elevation(const GeoReference& reference, const Vec3& direction_w) {
  const Vec3 d = east_north_up(reference, direction_w);
  return std::atan2(d.z(), std::hypot(d.x(), d.y())) * 180 / M_PI;
}

}  // namespace textslam
