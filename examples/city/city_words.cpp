#include "city/city_words.hpp"

#include <cstddef>

namespace textslam {
namespace {

constexpr std::size_t kShortest = 4, kLongest = 12;

template <std::size_t N>
const char* one_of(const char* const (&parts)[N], Random& random) {
  return parts[static_cast<std::size_t>(random.below(static_cast<int>(N)))];
}

std::string syllable(Random& random) {
  static const char* const kOnsets[] = {
      "B",  "C",  "D",  "F",  "G",  "H",  "J",  "K",  "L",  "M",  "N", "P", "R", "S", "T", "V", "W", "Z", "BR", "CH",
      "CL", "DR", "FL", "GR", "KR", "PR", "SH", "SL", "ST", "TR", "B", "D", "L", "M", "N", "R", "S", "T", "M",  "L"};
  static const char* const kVowels[] = {"A", "E", "I", "O", "U", "A", "E", "I", "O", "A", "E", "AI", "EI", "OU", "Y"};
  static const char* const kCodas[] = {"", "", "", "", "", "", "N", "R", "L", "S", "T", "M", "K"};
  std::string text = one_of(kOnsets, random);
  text += one_of(kVowels, random);
  return text + one_of(kCodas, random);
}

}  // namespace

std::string NameMaker::make(Random& random) {
  while (true) {
    const double share = random.uniform();
    const int syllables = share < 0.25 ? 2 : share < 0.75 ? 3 : 4;
    std::string name;
    for (int i = 0; i < syllables; ++i) name += syllable(random);
    if (name.size() >= kShortest && name.size() <= kLongest && made_.insert(name).second) return name;
  }
}

}  // namespace textslam
