// What a text says, by its readings: each is mostly right, and seldom all right.
#ifndef TEXTSLAM_TEXT_TEXT_WORDS_HPP
#define TEXTSLAM_TEXT_TEXT_WORDS_HPP

#include <cstddef>
#include <map>
#include <string>

namespace textslam {

/// 1 for the same word, falling by twice the share of letters to change, add or leave out; 0 from half of the longer word on.
double likeness(const std::string& a, const std::string& b);

/// The least likeness of two readings of one word: a quarter of the letters may differ.
constexpr double kSameWord = 0.5;

/// Different readings of a text that are kept: noise reads one word in ever new ways.
constexpr std::size_t kMostReadings = 32;

/// Adds a reading's score to its votes. Of more than kMostReadings the one of fewest votes goes, the newest of them spared: a word
/// that is read again and again comes up, whatever was read before.
void vote(std::map<std::string, double>* votes, const std::string& word, double score);

/// The reading that all the readings are most like, each weighed by its votes (a weighted median of strings): one letter read
/// wrongly, here in one view and there in another, does not split the votes. The first in order among equals, kUnreadText
/// without readings.
std::string consensus(const std::map<std::string, double>& votes);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_WORDS_HPP
