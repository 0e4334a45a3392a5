#include "textslam/map/text_words.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "textslam/map/map.hpp"

namespace textslam {
namespace {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

double word_similarity(const std::string& a, const std::string& b) {
  const double longer = static_cast<double>(std::max(a.size(), b.size()));
  return longer > 0 ? std::max(0.0, 1 - 2 * static_cast<double>(edit_distance(a, b)) / longer) : 1;
}

bool words_agree(const std::string& a, const std::string& b, const Parameters& parameters) {
  return !is_read(a) || !is_read(b) || word_similarity(a, b) >= parameters.same_word;
}

void vote(std::map<std::string, double>* votes, const std::string& word, double score, const Parameters& parameters) {
  (*votes)[word] += score;
  if (votes->size() <= static_cast<std::size_t>(parameters.max_readings)) return;
  auto fewest = votes->end();
  for (auto entry = votes->begin(); entry != votes->end(); ++entry)
    if (entry->first != word && (fewest == votes->end() || entry->second < fewest->second)) fewest = entry;
  votes->erase(fewest);
}

std::string consensus(const std::map<std::string, double>& votes) {
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

std::string TextObject::word() const { return consensus(votes); }

}  // namespace textslam
