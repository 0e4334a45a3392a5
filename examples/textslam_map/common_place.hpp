// Whether two maps show one place, by their signs: the similarity between their worlds, with proof.
//
// A similarity has seven numbers, and a sign gives seven: place (3), orientation (3) and size (1). So one sign fits
// anywhere. Two that agree confirm each other in seven numbers, which is proof where their words are found once;
// where words repeat, arrangements may repeat too, and it takes three.
#ifndef TEXTSLAM_MAP_COMMON_PLACE_HPP
#define TEXTSLAM_MAP_COMMON_PLACE_HPP

#include <optional>
#include <utility>
#include <vector>

#include "io/evaluate.hpp"
#include "textslam_map/map_signs.hpp"

namespace textslam {

struct CommonPlace {
  Similarity S_a_b;                              ///< World of b to world of a.
  double scale_sigma = 0;                        ///< Of its scale, as a share.
  std::vector<std::pair<int, int>> texts;        ///< Ids in a and in b of what is one sign.
  std::vector<std::pair<int, int>> points = {};  ///< Of what is one point; signs alone do not tell.
};

/// What is known of the scale beforehand: as a share, where both maps are in metres.
using KnownScale = std::optional<double>;

/// Similarities come from pairs of pairs of signs with similar words. Two signs agree where their words are similar,
/// neither has a more similar one in the other map, and place, normal, direction of the line and size are within 3.3
/// standard deviations (0.1 %) of each other, those of both and a little for what maps bend. A similarity has proof
/// where
/// - at least three signs agree, with two different words among them, or two with words that are the same in both maps
///   and that nothing else in either resembles,
/// - at least half of the words that are the same in both maps and found once in each agree,
/// - at most a quarter as many cover a sign of the other map that reads otherwise,
/// - with metres in both maps its scale is 1, and
/// - no other similarity that fits other pairs has proof with more than half as many signs.
/// Nothing else is accepted: a wrong join spoils a map, a missed one does not.
std::optional<CommonPlace> find_common_place(const std::vector<MapSign>& a, const std::vector<MapSign>& b,
                                             const textplane::TextOptions& options, KnownScale scale_sigma);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_COMMON_PLACE_HPP
