// Merging of texts: a sign that came to be mapped twice becomes one object.
//
// That happens after drift, and where its detections fell on different parts.
#ifndef TEXTSLAM_TEXT_TEXT_MERGE_HPP
#define TEXTSLAM_TEXT_TEXT_MERGE_HPP

#include "textslam/map/map.hpp"

namespace textslam {

/// Do two texts with planes stand for one sign? Words, planes (angle and inverse depth at the centres, within a
/// tolerance beside merge_sigmas standard deviations) and quads, in the host of either, must agree.
bool same_text(const Map& map, const Parameters& parameters, const TextObject& a, const TextObject& b);

/// What `other` saw counts for `kept`; its key-frame ids are `first_keyframe` higher in kept's map.
void add_observations_of(const TextObject& other, int first_keyframe, const Parameters& parameters, TextObject& kept);

/// Merges two texts into the one with more views, a among equals. Its plane stays; the other text is dropped.
void merge_texts(Map& map, const Parameters& parameters, int a, int b);

/// Merges the mapped texts that are the same. Returns how many are gone.
int merge_duplicate_texts(Map& map, const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_MERGE_HPP
