// Loop alignment: where the newest key frame lies, by the old points that it and the key frames before it show.
//
// The recent points' depths are uncertain, so only old points count, at the pixels where the recent key frames show
// them; these key frames' relative poses give the scale.
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

/// Refines where `link` puts key frame `newest` (the recent part is b) by Gauss-Newton over the reprojections of its
/// sightings, with Huber weights and the link as a weak prior. Not ok with fewer than join_min_pairs of them.
LoopAlignment align_loop(const Map& map, const Parameters& parameters, const MapLink& link, int newest);

}  // namespace textslam

#endif  // TEXTSLAM_LOOP_LOOP_ALIGNMENT_HPP
