// Two maps of one place made one.
#ifndef TEXTSLAM_MAP_MERGE_MAPS_HPP
#define TEXTSLAM_MAP_MERGE_MAPS_HPP

#include <optional>
#include <string>

#include "textslam/map_file/map_file.hpp"
#include "textslam_map/common_place.hpp"

namespace textslam {

/// Whether both are records of one session.
bool is_same_session(const SavedSession& a, const SavedSession& b);

/// Where map b lies in map a; nothing where that has no proof.
std::optional<CommonPlace> common_place(const LoadedMap& a, const LoadedMap& b, const Parameters& parameters);

/// Everything of b in a, whose world, camera and ids stay; b's ids follow a's. A sign of both is one text: votes and
/// observations are added, and the plane, with its host and pixels, is that of the smaller uncertainty. Points stay
/// two but those that the place names. Where only b is in metres, a is brought to them.
LoadedMap merge_maps(LoadedMap a, LoadedMap b, const CommonPlace& place, const Parameters& parameters);

/// Joins the map files `a` and `b` into `output` in one transaction, and says what was joined in a line. Empty:
/// they show no common place, and nothing was written. InputError where a file is no map, where the cameras differ, or
/// where both hold the same session.
std::string merge_map_files(const std::string& a, const std::string& b, const std::string& output);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_MERGE_MAPS_HPP
