// Culling: the rules by which points and key frames leave the map. Those of the texts are in
// textplane/landmarks/text_life.hpp.
//
// A camera that stays in place would fill the map with views that it already has. So a key frame is culled if many
// others see nearly all its points and each of its texts. The first one, the newest ones and hosts of texts stay.
#ifndef TEXTSLAM_MAP_CULLING_HPP
#define TEXTSLAM_MAP_CULLING_HPP

#include "textslam/map/local_map.hpp"

namespace textslam {

/// Flags points that are found in too few of the frames that should see them.
void cull_points(Map& map, const Parameters& parameters);

/// The first redundant key frame of the local map with an id of at least `from`; -1 where there is none.
int find_redundant_keyframe(const Map& map, const Parameters& parameters, const LocalMap& local, int from);
/// The newest key frame older than `id` that is in the map. There is one for any but the first.
int keyframe_before(const Map& map, int id);
/// Takes key frame `id` out of the map, with its image and its observations. Its id stays.
void cull_keyframe(Map& map, int id);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_CULLING_HPP
