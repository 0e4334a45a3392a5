// The texts of the final map in the world frame, and against the exact signs of a rendered sequence. The system never
// sees the truth.
#ifndef TEXTSLAM_REPORT_EVALUATE_TEXT_HPP
#define TEXTSLAM_REPORT_EVALUATE_TEXT_HPP

#include <vector>

#include "io/evaluate_signs.hpp"
#include "io/sequence.hpp"
#include "textslam/map/map.hpp"

namespace textslam {

/// The signs in the folder truth of a sequence; see read_true_signs() in io/evaluate_signs.hpp.
std::vector<TrueSign> read_true_signs(const Sequence& sequence);

/// Matches the mapped texts to the signs after `alignment` (map to truth).
TextEvaluation evaluate_text(const Map& map, const std::vector<TrueSign>& signs, const Similarity& alignment);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_EVALUATE_TEXT_HPP
