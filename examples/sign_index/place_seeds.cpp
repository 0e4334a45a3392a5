#include "sign_index/place_seeds.hpp"

#include <algorithm>

namespace textslam {
namespace {

constexpr double kSeedRange = 25;  // nats below the best seed

}  // namespace

void SeedFinder::vote(const SignIndex& index, const QueryView& view) {
  stride_ = view.signs.size();
  best_.assign(index.cells() * stride_, 0.0F);
  touched_.clear();
  seeds_.clear();
  std::vector<std::uint8_t> seen(index.cells(), 0);
  for (std::size_t q = 0; q < stride_; ++q)
    for (const WordEvidence& word : view.signs[q].words)
      for (const std::uint32_t sign : index.signs_of(word.word)) {
        const std::uint32_t cell = index.cell(sign);
        float& best = best_[cell * stride_ + q];
        best = std::max(best, static_cast<float>(word.log_ratio));
        seeds_.push_back({q, sign, word.log_ratio});
        if (!seen[cell]) touched_.push_back(cell);
        seen[cell] = 1;
      }
}

float SeedFinder::support(const SignIndex& index, std::uint32_t cell, std::size_t query) const {
  float most = 0;
  for (const std::uint32_t other : index.around(cell)) most = std::max(most, best_[other * stride_ + query]);
  return most;
}

std::vector<PlaceSeed> SeedFinder::find(const SignIndex& index, const QueryView& view, std::size_t most) {
  vote(index, view);
  std::vector<float> around(best_.size(), 0.0F);
  for (const std::uint32_t cell : touched_)
    for (std::size_t q = 0; q < stride_; ++q) around[cell * stride_ + q] = support(index, cell, q);
  for (PlaceSeed& seed : seeds_) {
    const float* own = &around[index.cell(seed.sign) * stride_];
    for (std::size_t q = 0; q < stride_; ++q)
      if (q != seed.query) seed.score += static_cast<double>(own[q]);
  }
  const auto better = [&](const PlaceSeed& a, const PlaceSeed& b) {
    if (a.score != b.score) return a.score > b.score;
    const double area_a = view.signs[a.query].area, area_b = view.signs[b.query].area;
    if (area_a != area_b) return area_a > area_b;
    return a.sign != b.sign ? a.sign < b.sign : a.query < b.query;
  };
  const auto end = seeds_.begin() + static_cast<std::ptrdiff_t>(std::min(most, seeds_.size()));
  std::partial_sort(seeds_.begin(), end, seeds_.end(), better);
  std::vector<PlaceSeed> found(seeds_.begin(), end);
  while (!found.empty() && found.back().score < found.front().score - kSeedRange) found.pop_back();
  return found;
}

}  // namespace textslam
