// Where a metric map lies on the earth: its local frame as latitudes, longitudes and heights.
#ifndef TEXTSLAM_MAP_GEO_REFERENCE_HPP
#define TEXTSLAM_MAP_GEO_REFERENCE_HPP

#include <string>

#include "textslam/common/geometry.hpp"

namespace textslam {

/// WGS84, degrees and metres above the ellipsoid.
struct GeoPosition {
  double latitude = 0, longitude = 0, altitude = 0;
};

/// The map's origin lies at `origin`. Up is the map's -y: the first key frame was held level. Its z axis, where that
/// key frame looked, points `north` degrees clockwise from true north. The map is taken for the plane that touches the
/// ellipsoid's parallel surface in the origin, and its heights for distances from this plane.
struct GeoReference {
  GeoPosition origin;
  double north = 0;
};

/// "LAT,LON" or "LAT,LON,ALT"; false for anything else, and for places that are not on the earth.
bool parse_geo_position(const std::string& text, GeoPosition* out);

/// The point of the map, metres, to the east, the north and the top of the origin.
Vec3 east_north_up(const GeoReference& reference, const Vec3& p_w);

/// A point of the map on the earth, exact to a nanometre or so: through the earth's centred frame. The longitude is in
/// (-180, 180].
GeoPosition geo_position(const GeoReference& reference, const Vec3& p_w);

/// Degrees clockwise from north, in [0, 360), of a direction of the map; and above the horizon.
double azimuth(const GeoReference& reference, const Vec3& direction_w);
double elevation(const GeoReference& reference, const Vec3& direction_w);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_GEO_REFERENCE_HPP
