#include "sign_index/word_index.hpp"

#include <algorithm>

namespace textslam {
namespace {

constexpr std::size_t kPairs = 2 * kSymbols * kSymbols;
constexpr std::size_t kCompared = 1500;  // words that are aligned with a reading, letter by letter

// Numbers of the pairs of a word, each once.
void pairs_of(const std::uint8_t* letters, std::size_t count, std::vector<std::uint16_t>* pairs) {
  pairs->clear();
  const auto at = [&](std::size_t i) { return i == 0 || i > count ? 0u : static_cast<unsigned>(letters[i - 1]); };
  for (std::size_t i = 0; i <= count; ++i) {
    pairs->push_back(static_cast<std::uint16_t>(at(i) * kSymbols + at(i + 1)));
    if (i + 2 <= count + 1 && count > 1)
      pairs->push_back(static_cast<std::uint16_t>((kSymbols + at(i)) * kSymbols + at(i + 2)));
  }
  std::sort(pairs->begin(), pairs->end());
  pairs->erase(std::unique(pairs->begin(), pairs->end()), pairs->end());
}

}  // namespace

WordIndex::WordIndex(const std::vector<std::string>& words, const ReadingErrors& errors) : errors_(errors) {
  first_letter_.reserve(words.size() + 1);
  first_word_.assign(kPairs + 1, 0);
  std::vector<std::uint16_t> pairs;
  for (const std::string& word : words) {
    const Symbols symbols = symbols_of(word);
    letter_.insert(letter_.end(), symbols.begin(), symbols.end());
    first_letter_.push_back(static_cast<std::uint32_t>(letter_.size()));
    letters_.add(symbols);
    pairs_of(symbols.data(), symbols.size(), &pairs);
    for (const std::uint16_t pair : pairs) ++first_word_[pair + 1u];
  }
  letters_.finish(errors);
  letter_.shrink_to_fit();
  for (std::size_t i = 0; i < kPairs; ++i) first_word_[i + 1] += first_word_[i];
  with_pair_.resize(first_word_.back());
  std::vector<std::uint32_t> next(first_word_.begin(), first_word_.end() - 1);
  for (std::uint32_t w = 0; w < size(); ++w) {
    pairs_of(letter_.data() + first_letter_[w], first_letter_[w + 1] - first_letter_[w], &pairs);
    for (const std::uint16_t pair : pairs) with_pair_[next[pair]++] = w;
  }
}

Symbols WordIndex::word(std::uint32_t number) const {
  return {letter_.begin() + first_letter_[number], letter_.begin() + first_letter_[number + 1]};
}

std::vector<SimilarWord> WordIndex::similar(const Symbols& reading, std::size_t most, double range,
                                            WordScratch* scratch) const {
  std::vector<SimilarWord> found;
  if (reading.empty() || size() == 0) return found;
  std::vector<std::uint16_t> pairs;
  pairs_of(reading.data(), reading.size(), &pairs);
  std::vector<std::uint8_t>& shared = scratch->shared;
  std::vector<std::uint32_t>& touched = scratch->touched;
  shared.resize(size(), 0);
  touched.clear();
  for (const std::uint16_t pair : pairs)
    for (std::uint32_t i = first_word_[pair]; i < first_word_[pair + 1u]; ++i)
      if (shared[with_pair_[i]]++ == 0) touched.push_back(with_pair_[i]);

  std::vector<std::size_t> with(pairs.size() + 1, 0);
  for (const std::uint32_t w : touched) ++with[shared[w]];
  std::size_t least = pairs.size(), count = with[least];
  while (least > 1 && count + with[least - 1] <= kCompared) count += with[--least];
  Symbols letters;
  for (const std::uint32_t w : touched) {
    if (shared[w] >= least) {
      letters.assign(letter_.begin() + first_letter_[w], letter_.begin() + first_letter_[w + 1]);
      found.push_back({w, reading_log_likelihood(reading, letters, errors_)});
    }
    shared[w] = 0;
  }
  std::sort(found.begin(), found.end(), [](const SimilarWord& a, const SimilarWord& b) {
    return a.log_likelihood != b.log_likelihood ? a.log_likelihood > b.log_likelihood : a.word < b.word;
  });
  std::size_t kept = 0;
  while (kept < std::min(most, found.size()) && found[kept].log_likelihood > found.front().log_likelihood - range)
    ++kept;
  found.resize(kept);
  return found;
}

std::size_t WordIndex::bytes() const noexcept {
  return sizeof *this + letter_.capacity() +
         sizeof(std::uint32_t) * (first_letter_.capacity() + first_word_.capacity() + with_pair_.capacity());
}

}  // namespace textslam
