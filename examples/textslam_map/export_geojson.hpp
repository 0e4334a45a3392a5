// The signs and the paths of a metric map as GeoJSON (RFC 7946).
#ifndef TEXTSLAM_MAP_EXPORT_GEOJSON_HPP
#define TEXTSLAM_MAP_EXPORT_GEOJSON_HPP

#include <string>

#include "textslam/map_file/map_file.hpp"
#include "textslam_map/geo_reference.hpp"

namespace textslam {

/// A FeatureCollection: a Point at the centre of each sign, its outline in a property, and the key frames of each
/// session in the order of time as a LineString. Positions are longitude, latitude and height above the ellipsoid. A
/// session of one key frame is a Point.
std::string map_geojson(const LoadedMap& map, const GeoReference& reference);

/// Writes it. InputError that names `file`, the map's, where its lengths are not metres.
void export_geojson(const LoadedMap& map, const std::string& file, const GeoReference& reference,
                    const std::string& path);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_EXPORT_GEOJSON_HPP
