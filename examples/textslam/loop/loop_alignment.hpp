// Loop alignment: where the newest key frame lies by what it and those before it show of the old part of the map.
//
// The points that both parts know are young in the recent one, and not well known in depth. Here the old points alone count, at
// the pixels where the recent key frames show them, and the recent key frames' poses to each other, which give the scale.
#ifndef TEXTSLAM_LOOP_LOOP_ALIGNMENT_HPP
#define TEXTSLAM_LOOP_LOOP_ALIGNMENT_HPP

#include "textslam/loop/map_join.hpp"
#include "textslam/loop/pose_graph.hpp"

namespace textslam {

struct LoopAlignment {
  bool ok = false;
  Similarity S_w_k;                       ///< The newest key frame in the old part's world.
  Matrix7 information = Matrix7::Zero();  ///< Of its error, as moved() applies one: weak where the view is narrow.
};

/// Refines where `link` puts key frame `newest` (the recent part is b) by Gauss-Newton over the reprojections of its sightings,
/// with Huber weights; what they leave open stays near the link. Not ok where there are fewer of them than join_min_pairs.
LoopAlignment align_loop(const Map& map, const Parameters& parameters, const MapLink& link, int newest);

}  // namespace textslam

#endif  // TEXTSLAM_LOOP_LOOP_ALIGNMENT_HPP
