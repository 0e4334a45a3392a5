// Two maps made one, whether they were made on their own or grew from one map.
//
// Robots that take one map from a server and go on in it have most of it in common: a key frame of a session that is
// in both maps is one key frame, and so are the points and texts that it shows. What only one of them has is added.
#ifndef TEXTSLAM_MAP_JOIN_BRANCHES_HPP
#define TEXTSLAM_MAP_JOIN_BRANCHES_HPP

#include <optional>
#include <string>

#include "textslam/map_file/map_file.hpp"

namespace textslam {

/// All of b in a, whose world, ids and poses stay. Empty: they have no session in common, and show no common place
/// (common_place.hpp).
///
/// With sessions in common, the worlds lie to each other as the first key frame of both does, with the scale that the
/// key frames of both have. Points are one where a key frame of both sees them at the same pixel. Texts are one where
/// key frames of both see them under the same id, or where they lie as signs of a common place do. Of a text that was
/// in the map that both grew from, each reading counts as in the map where it counts more: nothing counts twice. What
/// only one of them took away comes back.
///
/// InputError, which names `file_b`, where the cameras differ.
std::optional<LoadedMap> join_branches(LoadedMap a, LoadedMap b, const std::string& file_b,
                                       const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_JOIN_BRANCHES_HPP
