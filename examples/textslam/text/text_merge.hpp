// Merging of texts: a sign that came to be mapped twice becomes one object.
//
// That happens where the map had drifted when the sign was seen again, and where detections of it fell on different parts.
#ifndef TEXTSLAM_TEXT_TEXT_MERGE_HPP
#define TEXTSLAM_TEXT_TEXT_MERGE_HPP

#include "textslam/common/parameters.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// The words of two texts are alike, as two readings of one word are, or one of them was never read.
bool words_agree(const TextObject& a, const TextObject& b);

/// Do two texts with planes stand for one sign? Their words agree; their planes agree in angle and,
/// at their centres, in inverse depth, within three standard deviations of the two and a tolerance; and in the host of either
/// their quads overlap.
bool same_text(const Map& map, const Parameters& parameters, const TextObject& a, const TextObject& b);

/// What `other` saw counts for `kept`: key frames, whose ids are `first_keyframe` higher in kept's map, words and detections.
void add_sightings(TextObject& kept, const TextObject& other, int first_keyframe);

/// Text `other` becomes part of text `kept`: its key frames observe that one now, its words and detections count for it.
/// The plane stays that of `kept`; `other` is dropped.
void merge_texts(Map& map, int kept, int other);

/// Merges the mapped texts that are the same into the one that more key frames observe, the older one among equals. Returns
/// how many are gone.
int merge_duplicate_texts(Map& map, const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_MERGE_HPP
