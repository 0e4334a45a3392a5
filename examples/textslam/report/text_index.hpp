// The texts of a map to be searched by their words, as `textslam-map` does: text_index.json of an output folder.
//
//   {"texts": [{"id", "text", "score", "readings": {word: votes}, "position", "normal", "image", "quad", "timestamp"}]}
//
// `position`, the centre of the text's quad, and `normal` are in the world frame. `image` is the file, in the
// sequence's folder, of the key frame that shows the text largest; `quad` is where, in px of it. Each reading
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

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_TEXT_INDEX_HPP
