#include "sign_index/reading_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace textslam {
namespace {

constexpr std::size_t kLongest = 32;
constexpr int kShift = 3;
constexpr double kAlphabet = 26;  // letters that one may be taken for

std::uint8_t symbol_of(unsigned char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<std::uint8_t>(1 + c - 'A');
  if (c >= 'a' && c <= 'z') return static_cast<std::uint8_t>(1 + c - 'a');
  if (c >= '0' && c <= '9') return static_cast<std::uint8_t>(27 + c - '0');
  return static_cast<std::uint8_t>(37 + c % 27);
}

}  // namespace

Symbols symbols_of(const std::string& word) {
  Symbols symbols;
  for (std::size_t i = 0; i < std::min(word.size(), kLongest); ++i)
    symbols.push_back(symbol_of(static_cast<unsigned char>(word[i])));
  return symbols;
}

double reading_log_likelihood(const Symbols& reading, const Symbols& word, const ReadingErrors& errors) {
  const int n = static_cast<int>(word.size()), m = static_cast<int>(reading.size());
  if (std::abs(n - m) > kShift) return -1e3;
  // Before each letter, and at the end, letters are added until none is.
  const double none = 1 - errors.added, add = errors.added / kAlphabet;
  const double keep = none * (1 - errors.changed - errors.dropped), drop = none * errors.dropped;
  const double change = none * errors.changed / (kAlphabet - 1);
  // before[j], now[j]: i letters of the word gave j letters of the reading.
  double before[kLongest + 1] = {1}, now[kLongest + 1];
  for (int j = 1; j <= std::min(m, kShift); ++j) before[j] = before[j - 1] * add;
  for (int i = 1; i <= n; ++i) {
    const int first = std::max(0, i - kShift), last = std::min(m, i + kShift);
    for (int j = first; j <= last; ++j) {
      double p = j < i + kShift ? before[j] * drop : 0;
      if (j > 0) {
        const bool same = word[static_cast<std::size_t>(i - 1)] == reading[static_cast<std::size_t>(j - 1)];
        p += before[j - 1] * (same ? keep : change);
      }
      if (j > first) p += now[j - 1] * add;
      now[j] = p;
    }
    std::copy(now + first, now + last + 1, before + first);
  }
  return before[m] > 0 ? std::log(none * before[m]) : -1e3;
}

void LetterModel::add(const Symbols& word) {
  std::uint8_t last = 0;
  for (const std::uint8_t symbol : word) {
    follows_[last][symbol] += 1;
    last = symbol;
  }
  follows_[last][0] += 1;
}

void LetterModel::finish(const ReadingErrors& errors) {
  std::array<double, kSymbols> all{};
  double total = 0;
  for (const auto& row : follows_)
    for (std::size_t b = 0; b < kSymbols; ++b) {
      all[b] += static_cast<double>(row[b]);
      total += static_cast<double>(row[b]);
    }
  const double right = 1 - errors.changed - errors.dropped;
  for (auto& row : follows_) {
    double sum = 0;
    for (const float count : row) sum += static_cast<double>(count);
    for (std::size_t b = 0; b < kSymbols; ++b) {
      // A letter after a misread one follows no rule; a misread letter is any letter.
      const double rule = (static_cast<double>(row[b]) + 0.1) / (sum + 0.1 * kSymbols);
      const double loose = (all[b] + 1) / (total + kSymbols);
      const double p = b == 0 ? rule : right * (right * rule + (1 - right) * loose) + (1 - right) / kAlphabet;
      row[b] = static_cast<float>(std::log(p));
    }
  }
}

double LetterModel::log_probability(const Symbols& reading) const {
  double sum = 0;
  std::uint8_t last = 0;
  for (const std::uint8_t symbol : reading) {
    sum += static_cast<double>(follows_[last][symbol]);
    last = symbol;
  }
  return sum + static_cast<double>(follows_[last][0]);
}

}  // namespace textslam
