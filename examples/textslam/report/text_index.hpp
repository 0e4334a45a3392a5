// The texts of a map to be searched by their words: text_index.json of an output folder, and `textslam-map query`.
//
//   {"texts": [{"id", "text", "score", "readings": {word: votes}, "position", "normal", "image", "quad", "timestamp"}]}
//
// Position is the centre of the text's quad, both in the world frame. `image` is the one among the key frames that
// observe the text which shows it largest, slant counted: its file in the sequence's folder, and there the quad in
// undistorted px. `score` is the share of the votes that the text's own word has; each reading votes with its score.
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

/// The key frame, host or observer, that shows most of the text's area, all of it inside the image where there is such a one.
int best_view(const Map& map, const TextObject& text, Quad<double>* quad);

/// The mapped texts. `image`: the file of a frame that was processed, by its index.
std::vector<IndexedText> index_texts(const Map& map, const std::function<std::string(int)>& image);

std::string text_index_json(const std::vector<IndexedText>& texts);
/// Throws InputError where the file is missing or not such a text.
std::vector<IndexedText> read_text_index(const std::string& path);

/// Texts that have `word` in their own word or in a reading, letters' case aside: first those that are the word, then those
/// whose own word holds it, then those that were read so at times, last those with a reading like it (word_similarity() of a half);
/// among equals by score.
std::vector<IndexedText> query(const std::vector<IndexedText>& texts, const std::string& word);

/// Between the normals of two texts, degrees.
double angle_between(const IndexedText& a, const IndexedText& b);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_TEXT_INDEX_HPP
