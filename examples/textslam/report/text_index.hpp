// The texts of a map to be searched by their words: text_index.json of an output folder, and `textslam-map query`.
//
//   {"texts": [{"id", "text", "score", "readings": {word: votes}, "position", "normal", "image", "quad", "timestamp"}]}
//
// `position`, the centre of the text's quad, and `normal` are in the world frame. `image` is the file, in the
// sequence's folder, of the key frame that shows the text largest; `quad` is where, in undistorted px. Each reading
// votes with its score for its word; `score` is the share of the text's own word.
#ifndef TEXTSLAM_REPORT_TEXT_INDEX_HPP
#define TEXTSLAM_REPORT_TEXT_INDEX_HPP

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "textslam/map/map.hpp"

namespace textslam {

struct IndexedText {
  int id = -1;
  std::string text;  ///< The word of most votes, or kUnreadText.
  double score = 0;
  std::map<std::string, double> readings;
  Vec3 position, normal;
  std::string image;
  Quad<double> quad;
  double timestamp = 0;
};

/// The key frame, host or observer, that shows the text's largest area; one that shows all of the text comes first.
int best_view(const Map& map, const TextObject& text, Quad<double>* quad);

/// The mapped texts. `image`: the file of a frame that was processed, by its index.
std::vector<IndexedText> index_texts(const Map& map, const std::function<std::string(int)>& image);

std::string text_index_json(const std::vector<IndexedText>& texts);
/// Throws InputError where the file is missing or not such a text.
std::vector<IndexedText> read_text_index(const std::string& path);

/// Texts that match `word`, whatever the case of letters: first texts of that word, then texts whose word holds it,
/// then texts with a reading that holds it, then texts with a similar reading (word_similarity() of same_word). Equals
/// are ordered by score.
std::vector<IndexedText> query(const std::vector<IndexedText>& texts, const std::string& word);

/// Between the normals of two texts, degrees.
double angle_between(const IndexedText& a, const IndexedText& b);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_TEXT_INDEX_HPP
