// Reading model: how likely a reader makes one word of another, and how likely it makes a word of a sign that is in no
// map.
//
// Letters' case does not matter, and bytes that are neither letters nor digits share the symbols that are left.
#ifndef TEXTSLAM_SIGN_INDEX_READING_MODEL_HPP
#define TEXTSLAM_SIGN_INDEX_READING_MODEL_HPP

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace textslam {

constexpr int kSymbols = 64;
using Symbols = std::vector<std::uint8_t>;  ///< 1 to 63; 0 is the edge of a word.

/// The letters of a word, at most 32: what is beyond is cut.
Symbols symbols_of(const std::string& word);

/// What a reader does to each letter, independently.
struct ReadingErrors {
  double changed = 0.18;  ///< Share of the letters read as another one.
  double dropped = 0.01;
  double added = 0.01;  ///< Mean number of letters added before each.
};

/// log P(reading | word), summed over all ways to align them that shift letters by at most three places.
double reading_log_likelihood(const Symbols& reading, const Symbols& word, const ReadingErrors& errors);

/// Which letter follows which in the words of a map: what readings of unknown words look like.
class LetterModel {
 public:
  void add(const Symbols& word);
  /// Turns the counts into probabilities. Before it, log_probability() is not defined.
  void finish(const ReadingErrors& errors);
  /// log P(reading) of a word drawn from such letters and then read with these errors.
  double log_probability(const Symbols& reading) const;

 private:
  std::array<std::array<float, kSymbols>, kSymbols> follows_{};  // counts, then logarithms
};

}  // namespace textslam

#endif  // TEXTSLAM_SIGN_INDEX_READING_MODEL_HPP
