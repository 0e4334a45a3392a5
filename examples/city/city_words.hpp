// City words: names that look like names, each once.
#ifndef TEXTSLAM_CITY_WORDS_HPP
#define TEXTSLAM_CITY_WORDS_HPP

#include <string>
#include <unordered_set>

#include "renderer/random.hpp"

namespace textslam {

class NameMaker {
 public:
  /// A name of 4 to 12 capitals in two to four syllables, which this maker has neither made nor kept.
  std::string make(Random& random);
  /// A word that it shall not make.
  void keep(const std::string& word) { made_.insert(word); }

 private:
  std::unordered_set<std::string> made_;
};

}  // namespace textslam

#endif  // TEXTSLAM_CITY_WORDS_HPP
