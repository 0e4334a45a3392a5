// Metres for a map that has no scale: signs of known width.
#ifndef TEXTSLAM_TEXT_METRIC_SCALE_HPP
#define TEXTSLAM_TEXT_METRIC_SCALE_HPP

#include <string>
#include <vector>

#include "textslam/map/map.hpp"

namespace textslam {

/// A word, and how wide it is written on its sign, in metres.
struct KnownWidth {
  std::string word;
  double width = 0, sigma = 0;
};

/// "EXIT=0.31" or "EXIT=0.31:0.002", with the standard deviation after the colon; without it 0.002 of the width. False
/// for anything else.
bool parse_known_width(const std::string& text, KnownWidth* out);

struct MetricScale {
  double metres = 1;  ///< A unit of the map.
  double sigma = 0;   ///< Standard deviation, as a share of `metres`.
  int texts = 0;      ///< That it rests on; 0: none of the words is on a mapped text whose width is known.
};

/// The mean over all mapped texts of these words, by their variances. Where they disagree by more than these say, the
/// standard deviation grows to what the disagreement says. The case of letters does not matter.
MetricScale metric_scale(const Map& map, const Parameters& parameters, const std::vector<KnownWidth>& widths);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_METRIC_SCALE_HPP
