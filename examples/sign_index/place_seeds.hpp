// Place seeds: pairs of a detection and a sign that it may be, the most promising first.
//
// A pair counts by its word, and by the words of the other detections that signs near it may be.
#ifndef TEXTSLAM_SIGN_INDEX_PLACE_SEEDS_HPP
#define TEXTSLAM_SIGN_INDEX_PLACE_SEEDS_HPP

#include <cstdint>
#include <vector>

#include "sign_index/query_view.hpp"

namespace textslam {

struct PlaceSeed {
  std::size_t query;   ///< number in the view
  std::uint32_t sign;  ///< number in the index
  double score;        ///< nats
};

class SeedFinder {
 public:
  /// At most `most`, sorted; of equal ones the larger quad first.
  std::vector<PlaceSeed> find(const SignIndex& index, const QueryView& view, std::size_t most);

 private:
  void vote(const SignIndex& index, const QueryView& view);
  float support(const SignIndex& index, std::uint32_t cell, std::size_t query) const;

  std::size_t stride_ = 0;
  std::vector<float> best_;  // of each cell and detection
  std::vector<std::uint32_t> touched_;
  std::vector<PlaceSeed> seeds_;
};

}  // namespace textslam

#endif  // TEXTSLAM_SIGN_INDEX_PLACE_SEEDS_HPP
