// Merging of texts: a sign that came to be mapped twice becomes one object.
//
// That happens where the map had drifted when the sign was seen again, and where detections of it fell on different
// parts.
#ifndef TEXTSLAM_TEXT_TEXT_MERGE_HPP
#define TEXTSLAM_TEXT_TEXT_MERGE_HPP

#include "textslam/map/map.hpp"

namespace textslam {

/// Do two texts with planes stand for one sign? Their words agree; their planes agree in angle and, at their centres,
/// in inverse depth, within a tolerance beside merge_sigmas standard deviations; and their quads overlap in the host of
/// either.
bool same_text(const Map& map, const Parameters& parameters, const TextObject& a, const TextObject& b);

/// What `other` saw counts for `kept`: words, detections, and key frames, whose ids are `first_keyframe` higher in
/// kept's map.
void add_observations_of(const TextObject& other, int first_keyframe, const Parameters& parameters, TextObject& kept);

/// Merges two texts into the one that more key frames observe, a among equals: what the other saw counts for it, its
/// plane stays, and the other is dropped.
void merge_texts(Map& map, const Parameters& parameters, int a, int b);

/// Merges the mapped texts that are the same. Returns how many are gone.
int merge_duplicate_texts(Map& map, const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_MERGE_HPP
