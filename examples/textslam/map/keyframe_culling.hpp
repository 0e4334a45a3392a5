// Key frames that can go: a camera that stays where it was would fill the map, and memory, with views that it has already.
//
// A key frame is redundant where nearly all its points are seen by many others, and each text that it shows, too. It goes with
// its image and its observations; its id stays. The newest key frames and the first, which holds the world, stay, and so does
// the host of any text.
#ifndef TEXTSLAM_MAP_KEYFRAME_CULLING_HPP
#define TEXTSLAM_MAP_KEYFRAME_CULLING_HPP

#include "textslam/map/local_map.hpp"
#include "textslam/track/pose_refit.hpp"

namespace textslam {

/// The first redundant key frame of the local map with an id of at least `from`; -1 where there is none.
int find_redundant_keyframe(const Map& map, const Parameters& parameters, const LocalMap& local, int from);

/// What key frame `id` sees of the map, evenly thinned to `most`.
std::vector<SeenPoint> seen_by_keyframe(const Map& map, int id, std::size_t most);

/// The newest key frame older than `id` that is in the map. There is one for any but the first.
int keyframe_before(const Map& map, int id);

/// Takes key frame `id` out of the map. Tracks without a point forget that they were seen in it.
void cull_keyframe(Map& map, int id, std::vector<Track>& tracks);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_KEYFRAME_CULLING_HPP
