// Culling: all rules by which points, texts and key frames leave the map, and by which a text becomes part of it.
//
// A camera that stays in place would fill the map with views that it already has. So a key frame is culled if many
// others see nearly all its points and each of its texts. The first one, the newest ones and hosts of texts stay.
#ifndef TEXTSLAM_MAP_CULLING_HPP
#define TEXTSLAM_MAP_CULLING_HPP

#include "textslam/map/local_map.hpp"

namespace textslam {

/// Flags points that are found in too few of the frames that should see them.
void cull_points(Map& map, const Parameters& parameters);

/// Detected in enough of the frames that could have shown it: a detector's false hits are elsewhere in each frame.
bool is_detected(const TextObject& text, const Parameters& parameters);
/// Observed and detected often enough to be mapped.
bool is_proven(const TextObject& text, const Parameters& parameters);
/// Not mapped in time: by the newest key frame `newest`, too late for a plane, or for n_min observations.
bool is_overdue(const TextObject& text, const Parameters& parameters, int newest);
/// The images (in mode loose: the points) have stopped agreeing with its plane.
bool is_contradicted(const TextObject& text, const Parameters& parameters);
/// The direction of its normal is not known well enough for the final map.
bool is_uncertain(const TextObject& text, const Parameters& parameters);
/// Takes a text out of the map and frees its patch, views and readings. Its id stays.
void drop(TextObject& text);

/// The first redundant key frame of the local map with an id of at least `from`; -1 where there is none.
int find_redundant_keyframe(const Map& map, const Parameters& parameters, const LocalMap& local, int from);
/// The newest key frame older than `id` that is in the map. There is one for any but the first.
int keyframe_before(const Map& map, int id);
/// Takes key frame `id` out of the map, with its image and its observations. Its id stays.
void cull_keyframe(Map& map, int id);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_CULLING_HPP
