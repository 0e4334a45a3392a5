// What a text says, by its readings: each is mostly right, and seldom right in every letter.
#ifndef TEXTPLANE_LANDMARKS_WORDS_HPP
#define TEXTPLANE_LANDMARKS_WORDS_HPP

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "textplane/landmarks/text_options.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// The word of a text that nobody read, as in ICDAR's files.
constexpr const char* kUnreadText = "###";
/// Whether it is a reading.
inline bool is_read(const std::string& text) { return !text.empty() && text != kUnreadText; }

namespace detail {
inline std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = (std::min)({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row[b.size()];
}
}  // namespace detail

/// 1 for the same word, less by twice the share of letters to change, add or leave out, at least 0.
inline double word_similarity(const std::string& a, const std::string& b) {
  const double longer = static_cast<double>((std::max)(a.size(), b.size()));
  return longer > 0 ? (std::max)(0.0, 1 - 2 * static_cast<double>(detail::edit_distance(a, b)) / longer) : 1;
}

/// Are the two readings of one word (same_word)? An unread one may be any word.
inline bool words_agree(const std::string& a, const std::string& b, const TextOptions& options = {}) {
  return !is_read(a) || !is_read(b) || word_similarity(a, b) >= options.same_word;
}

/// Adds a reading's score to its votes. Beyond max_readings, the older reading with the fewest votes is forgotten.
TEXTPLANE_DEFERRED
inline void vote(std::map<std::string, double>* votes, const std::string& word, double score,
                 const TextOptions& options = {}) {
  (*votes)[word] += score;
  if (votes->size() <= static_cast<std::size_t>(options.max_readings)) return;
  auto fewest = votes->end();
  for (auto entry = votes->begin(); entry != votes->end(); ++entry)
    if (entry->first != word && (fewest == votes->end() || entry->second < fewest->second)) fewest = entry;
  votes->erase(fewest);
}

/// The reading most similar to all readings, weighed by their votes (a weighted median of strings): letters misread
/// here and there do not split the votes. The first in order among equals, kUnreadText without readings.
TEXTPLANE_DEFERRED
inline std::string consensus(const std::map<std::string, double>& votes) {
  std::string best = kUnreadText;
  double most = 0;
  for (const auto& [word, own] : votes) {
    double support = 0;
    for (const auto& [other, count] : votes) support += count * word_similarity(word, other);
    if (support <= most) continue;
    best = word;
    most = support;
  }
  return best;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_WORDS_HPP
