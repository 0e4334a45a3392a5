// Questions to a text index: which texts match a word, and the angles between them.
#ifndef TEXTSLAM_MAP_TEXT_QUERY_HPP
#define TEXTSLAM_MAP_TEXT_QUERY_HPP

#include "textslam/report/text_index.hpp"

namespace textslam {

/// Reads text_index.json. Throws InputError where the file is missing or not such a text.
std::vector<IndexedText> read_text_index(const std::string& path);

/// Texts that match `word`, whatever the case of letters: first texts of that word, then texts whose word begins with
/// it, then those where a later word of several does, then texts whose word holds it, then texts with a reading that
/// holds it, then texts with a similar reading (word_similarity() of same_word). Equals are ordered by score.
std::vector<IndexedText> query(const std::vector<IndexedText>& texts, const std::string& word);

/// Between the normals of two texts, degrees.
double angle_between(const IndexedText& a, const IndexedText& b);

struct LargestAngle {
  double degrees = 0;
  int first = -1, second = -1;  ///< Ids of the texts; -1 where there are no two.
};
/// The first pair with the largest angle.
LargestAngle largest_angle(const std::vector<IndexedText>& texts);

/// {"texts": [{"id", "text", "score", "normal"}, ...], "degrees": [[...], ...], "largest": {"degrees", "texts"}}: the
/// angles between each text and all, in the order of the texts; `largest` is null where there are no two.
std::string angles_json(const std::vector<IndexedText>& texts);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_TEXT_QUERY_HPP
