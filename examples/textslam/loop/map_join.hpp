// Joining of two maps that turn out to show one place.
//
// Key frames of map b are searched for in map a. Points at the same pixel, and texts that overlap, give the similarity
// between the worlds; several key frames must agree on it. Then b's contents move to a, and what is in both is merged.
#ifndef TEXTSLAM_LOOP_MAP_JOIN_HPP
#define TEXTSLAM_LOOP_MAP_JOIN_HPP

#include <utility>
#include <vector>

#include "io/evaluate.hpp"
#include "textslam/relocalise/relocalisation.hpp"

namespace textslam {

/// A key frame of b, and the points of a that it shows.
struct LinkSighting {
  int keyframe;
  std::vector<Track> tracks;
};

struct MapLink {
  bool ok = false;
  Similarity S_a_b;                         ///< World of b to world of a.
  std::vector<std::pair<int, int>> points;  ///< Ids in a and in b of what is one point; each id once.
  std::vector<std::pair<int, int>> texts;   ///< Of what is one text.
  std::vector<LinkSighting> sightings;      ///< The key frames of b that agree with the similarity.
};

/// Where map b lies in map a. `seen` is b's newest key frame as recognised in a; the others are looked for from there.
MapLink link_maps(const Map& a, const Map& b, const Parameters& parameters, const Relocalisation& seen);

/// The new ids, in a, of what was in b.
struct JoinedIds {
  int first_keyframe = 0;   ///< Key frame k of b is first_keyframe + k.
  std::vector<int> points;  ///< -1 for those that were bad.
};

/// Moves the contents of b into a by the link. a's poses stay as they are; nothing is adjusted.
JoinedIds join_maps(Map& a, const Map& b, const MapLink& link, const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_LOOP_MAP_JOIN_HPP
