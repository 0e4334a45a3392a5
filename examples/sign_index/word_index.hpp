// Word index: the words of a map by their pairs of letters, so that a misread word still finds the right one.
//
// A word has the pairs of neighbours, its edges included, and the pairs with one letter between. A wrong letter breaks
// four of them at most; the others still lead to the word.
#ifndef TEXTSLAM_SIGN_INDEX_WORD_INDEX_HPP
#define TEXTSLAM_SIGN_INDEX_WORD_INDEX_HPP

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sign_index/reading_model.hpp"

namespace textslam {

struct SimilarWord {
  std::uint32_t word;     ///< number in the index
  double log_likelihood;  ///< of the reading, given that word
};

/// What a query needs beside the index: one a thread.
struct WordScratch {
  std::vector<std::uint8_t> shared;    // pairs in common, by word
  std::vector<std::uint32_t> touched;  // words with any
};

class WordIndex {
 public:
  WordIndex() = default;
  /// `words`: each once.
  WordIndex(const std::vector<std::string>& words, const ReadingErrors& errors);

  std::uint32_t size() const noexcept { return static_cast<std::uint32_t>(first_letter_.size() - 1); }
  Symbols word(std::uint32_t number) const;
  const ReadingErrors& errors() const noexcept { return errors_; }
  const LetterModel& letters() const noexcept { return letters_; }

  /// The words that may have been read so, the likeliest first, at most `most`, none less likely than the first by more
  /// than exp(-range).
  std::vector<SimilarWord> similar(const Symbols& reading, std::size_t most, double range, WordScratch* scratch) const;

  std::size_t bytes() const noexcept;

 private:
  std::vector<std::uint32_t> first_letter_{0};  // by word; one more at the end
  Symbols letter_;
  std::vector<std::uint32_t> first_word_;  // by pair; one more at the end
  std::vector<std::uint32_t> with_pair_;
  LetterModel letters_;
  ReadingErrors errors_;
};

}  // namespace textslam

#endif  // TEXTSLAM_SIGN_INDEX_WORD_INDEX_HPP
