#include "sign_index/sign_index.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "textplane/landmarks/words.hpp"

namespace textslam {
namespace {

using textplane::Status;
using Cell = std::array<std::int32_t, 3>;
constexpr double kMostCells = 1e6;
constexpr double kLeastArea = 1e-12;  // of the square of the longest side

Status check(const std::vector<MappedSign>& signs) {
  for (const MappedSign& sign : signs) {
    const auto& c = sign.corners;
    for (const Vec3& corner : c)
      if (!textplane::all_finite(corner)) return Status::non_finite;
    const Vec3 across = c[2] - c[0], along = c[3] - c[1];
    const double most = std::max(across.squaredNorm(), along.squaredNorm());
    if (!(across.cross(along).norm() > kLeastArea * most)) return Status::degenerate;
  }
  return Status::ok;
}

Vec3 centre_of(const MappedSign& sign) {
  return (sign.corners[0] + sign.corners[1] + sign.corners[2] + sign.corners[3]) / 4;
}

std::size_t memory(const std::vector<std::uint32_t>& v) { return v.capacity() * sizeof(std::uint32_t); }

}  // namespace

Status SignIndex::build(const std::vector<MappedSign>& signs, const SignIndexOptions& options, SignIndex* out) {
  *out = SignIndex();
  if (!(options.reach > 0) || !std::isfinite(options.reach) || signs.size() >= (1u << 31))
    return Status::invalid_argument;
  const Status status = check(signs);
  if (!textplane::is_ok(status)) return status;

  SignIndex index;
  index.reach_ = options.reach;
  for (const MappedSign& sign : signs) index.origin_ += centre_of(sign) / static_cast<double>(signs.size());
  std::vector<Cell> cells;
  for (const MappedSign& sign : signs) {
    // Half a cell apart, so that signs at about one height lie in one layer of cells.
    const Vec3 at = (centre_of(sign) - index.origin_) / options.reach + Vec3::Constant(0.5);
    if (!(at.cwiseAbs().maxCoeff() < kMostCells)) return Status::invalid_argument;
    cells.push_back({static_cast<std::int32_t>(std::floor(at[0])), static_cast<std::int32_t>(std::floor(at[1])),
                     static_cast<std::int32_t>(std::floor(at[2]))});
  }
  std::vector<std::uint32_t> order(signs.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return cells[a] < cells[b]; });

  std::vector<Cell> kept;
  for (const std::uint32_t i : order) {
    if (kept.empty() || kept.back() != cells[i]) {
      kept.push_back(cells[i]);
      index.first_in_cell_.push_back(index.first_in_cell_.back());
    }
    ++index.first_in_cell_.back();
    index.cell_.push_back(static_cast<std::uint32_t>(kept.size() - 1));
    index.ids_.push_back(signs[i].id);
    Corners corners;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 p = signs[i].corners[k] - index.origin_;
      for (std::size_t j = 0; j < 3; ++j) corners[k][j] = static_cast<float>(p[static_cast<int>(j)]);
    }
    index.corners_.push_back(corners);
    const Eigen::Vector3f centre = (centre_of(signs[i]) - index.origin_).cast<float>();
    index.centres_.push_back({centre[0], centre[1], centre[2]});
  }
  index.add_neighbours(kept);
  index.add_words(signs, order, options.errors);
  index.ids_.shrink_to_fit();
  index.corners_.shrink_to_fit();
  index.centres_.shrink_to_fit();
  index.cell_.shrink_to_fit();
  *out = std::move(index);
  return Status::ok;
}

void SignIndex::add_neighbours(const std::vector<Cell>& cells) {
  first_neighbour_.assign(1, 0);
  for (const Cell& cell : cells) {
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const Cell other = {cell[0] + dx, cell[1] + dy, cell[2] + dz};
          const auto found = std::lower_bound(cells.begin(), cells.end(), other);
          if (found != cells.end() && *found == other)
            neighbours_.push_back(static_cast<std::uint32_t>(found - cells.begin()));
        }
    first_neighbour_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
  }
  neighbours_.shrink_to_fit();
}

void SignIndex::add_words(const std::vector<MappedSign>& signs, const std::vector<std::uint32_t>& order,
                          const ReadingErrors& errors) {
  std::vector<std::string> words;
  std::unordered_map<std::string, std::uint32_t> numbers;
  for (const std::uint32_t i : order) {
    std::uint32_t number = kNoWord;
    if (textplane::is_read(signs[i].word)) {
      const Symbols symbols = symbols_of(signs[i].word);
      const auto next = static_cast<std::uint32_t>(words.size());
      const auto [entry, is_new] = numbers.emplace(std::string(symbols.begin(), symbols.end()), next);
      if (is_new) words.push_back(signs[i].word);
      number = entry->second;
    }
    word_.push_back(number);
  }
  word_.shrink_to_fit();
  words_ = WordIndex(words, errors);
  first_with_word_.assign(words.size() + 1, 0);
  for (const std::uint32_t word : word_)
    if (word != kNoWord) ++first_with_word_[word + 1u];
  std::size_t alone = 0, twice = 0;
  for (std::size_t w = 0; w < words.size(); ++w) {
    alone += first_with_word_[w + 1] == 1 ? 1u : 0u;
    twice += first_with_word_[w + 1] == 2 ? 1u : 0u;
    first_with_word_[w + 1] += first_with_word_[w];
  }
  with_word_.resize(first_with_word_.back());
  std::vector<std::uint32_t> next(first_with_word_.begin(), first_with_word_.end() - 1);
  for (std::uint32_t sign = 0; sign < size(); ++sign)
    if (word_[sign] != kNoWord) with_word_[next[word_[sign]]++] = sign;
  if (alone > 0) expected_again_ = std::min(1.0, (2.0 * static_cast<double>(twice) + 1) / static_cast<double>(alone));
  if (!with_word_.empty()) unique_share_ = static_cast<double>(alone) / static_cast<double>(with_word_.size());
}

std::size_t SignIndex::bytes() const noexcept {
  return sizeof *this - sizeof words_ + words_.bytes() + ids_.capacity() * sizeof(std::int64_t) +
         corners_.capacity() * sizeof(Corners) + centres_.capacity() * sizeof centres_.front() + memory(word_) +
         memory(cell_) + memory(first_in_cell_) + memory(first_neighbour_) + memory(neighbours_) +
         memory(first_with_word_) + memory(with_word_);
}

}  // namespace textslam
