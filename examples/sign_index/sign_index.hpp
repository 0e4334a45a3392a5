// Sign index: the signs of a map by word and by place, for the question where a camera is that sees some of them.
//
// It is made once and does not change; any number of threads may ask it. Signs are ordered by cells of position, so
// that those near each other lie together in memory.
#ifndef TEXTSLAM_SIGN_INDEX_SIGN_INDEX_HPP
#define TEXTSLAM_SIGN_INDEX_SIGN_INDEX_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sign_index/word_index.hpp"
#include "textplane/core/status.hpp"
#include "textslam/common/geometry.hpp"

namespace textslam {

/// A sign as a map has it.
struct MappedSign {
  std::int64_t id = 0;
  std::string word;             ///< "###" or empty: unread
  std::array<Vec3, 4> corners;  ///< in the map's frame, on one plane, clockwise as readers see them
};

struct SignIndexOptions {
  double reach = 40;  ///< How far signs can be seen, in the map's unit: the side of a cell.
  ReadingErrors errors;
};

class SignIndex {
 public:
  static constexpr std::uint32_t kNoWord = UINT32_MAX;

  /// Status: invalid_argument for a reach that is not positive, more than 2^31 signs, or signs farther apart than 10^6
  /// cells; non_finite for corners that are not; degenerate for corners without area. The index is empty then.
  static textplane::Status build(const std::vector<MappedSign>& signs, const SignIndexOptions& options, SignIndex* out);

  std::uint32_t size() const noexcept { return static_cast<std::uint32_t>(ids_.size()); }
  std::uint32_t cells() const noexcept { return static_cast<std::uint32_t>(first_in_cell_.size() - 1); }
  const WordIndex& words() const noexcept { return words_; }
  double reach() const noexcept { return reach_; }

  // By the sign's number in the index, below size().
  std::int64_t id(std::uint32_t sign) const noexcept { return ids_[sign]; }
  /// Number of its word; kNoWord where it is unread.
  std::uint32_t word(std::uint32_t sign) const noexcept { return word_[sign]; }
  std::uint32_t cell(std::uint32_t sign) const noexcept { return cell_[sign]; }
  Vec3 corner(std::uint32_t sign, std::size_t k) const noexcept {
    return origin_ + Eigen::Map<const Eigen::Vector3f>(corners_[sign][k].data()).cast<double>();
  }
  Vec3 centre(std::uint32_t sign) const noexcept {
    return origin_ + Eigen::Map<const Eigen::Vector3f>(centres_[sign].data()).cast<double>();
  }
  std::array<Vec3, 4> corners(std::uint32_t sign) const noexcept {
    return {corner(sign, 0), corner(sign, 1), corner(sign, 2), corner(sign, 3)};
  }

  struct Range {
    const std::uint32_t *first, *last;
    const std::uint32_t* begin() const noexcept { return first; }
    const std::uint32_t* end() const noexcept { return last; }
    std::size_t size() const noexcept { return static_cast<std::size_t>(last - first); }
  };
  /// Signs of a word.
  Range signs_of(std::uint32_t word) const noexcept { return range(with_word_, first_with_word_, word); }
  /// A cell and the cells around it that hold signs.
  Range around(std::uint32_t cell) const noexcept { return range(neighbours_, first_neighbour_, cell); }
  /// The signs of a cell are [first_of(cell), first_of(cell + 1)).
  std::uint32_t first_of(std::uint32_t cell) const noexcept { return first_in_cell_[cell]; }

  /// Share of the signs that have a word whose word no other sign has.
  double unique_share() const noexcept { return unique_share_; }
  /// How often a word that the map has once is to be expected among as many signs of another place (Good and Turing's
  /// estimate, from how many words the map has once and twice).
  double expected_again() const noexcept { return expected_again_; }
  /// All memory that it holds.
  std::size_t bytes() const noexcept;

 private:
  using Corners = std::array<std::array<float, 3>, 4>;
  static Range range(const std::vector<std::uint32_t>& values, const std::vector<std::uint32_t>& first,
                     std::uint32_t i) noexcept {
    return {values.data() + first[i], values.data() + first[i + 1]};
  }
  void add_neighbours(const std::vector<std::array<std::int32_t, 3>>& cells);
  void add_words(const std::vector<MappedSign>& signs, const std::vector<std::uint32_t>& order,
                 const ReadingErrors& errors);

  Vec3 origin_ = Vec3::Zero();
  double reach_ = 0, unique_share_ = 0, expected_again_ = 0;
  std::vector<std::int64_t> ids_;
  std::vector<Corners> corners_;
  std::vector<std::array<float, 3>> centres_;
  std::vector<std::uint32_t> word_, cell_;
  std::vector<std::uint32_t> first_in_cell_{0}, first_neighbour_, neighbours_;
  std::vector<std::uint32_t> first_with_word_, with_word_;
  WordIndex words_;
};

}  // namespace textslam

#endif  // TEXTSLAM_SIGN_INDEX_SIGN_INDEX_HPP
