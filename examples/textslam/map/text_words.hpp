// What a text says, by its readings: each is mostly right, and seldom right in every letter.
#ifndef TEXTSLAM_MAP_TEXT_WORDS_HPP
#define TEXTSLAM_MAP_TEXT_WORDS_HPP

#include <map>
#include <string>

#include "textslam/common/parameters.hpp"

namespace textslam {

/// 1 for the same word, less by twice the share of letters to change, add or leave out, at least 0.
double word_similarity(const std::string& a, const std::string& b);

/// Are the two readings of one word (same_word)? An unread one may be any word.
bool words_agree(const std::string& a, const std::string& b, const Parameters& parameters);

/// Adds a reading's score to its votes. Beyond max_readings, the older reading with the fewest votes is forgotten.
void vote(std::map<std::string, double>* votes, const std::string& word, double score,
          const Parameters& parameters = {});

/// The reading most similar to all readings, weighed by their votes (a weighted median of strings): letters misread
/// here and there do not split the votes. The first in order among equals, kUnreadText without readings.
std::string consensus(const std::map<std::string, double>& votes);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_TEXT_WORDS_HPP
