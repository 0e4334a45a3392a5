// Metres for a map that has no scale: signs of known width, or a known distance between two.
#ifndef TEXTSLAM_TEXT_METRIC_SCALE_HPP
#define TEXTSLAM_TEXT_METRIC_SCALE_HPP

#include <string>
#include <vector>

#include "textslam/map/map.hpp"

namespace textslam {

/// How wide a word is written on its sign, or how far the centres of two signs are apart, in metres.
struct KnownLength {
  std::string word;
  std::string other;  ///< The other sign; empty: the width of `word`.
  double length = 0, sigma = 0;
};

/// "EXIT=0.31" or "EXIT=0.31:0.002", with the standard deviation after the colon; without it 0.002 of the length.
/// "EXIT..ROOM 12=4.2": the distance of two signs. False for anything else.
bool parse_known_length(const std::string& text, KnownLength* out);

struct MetricScale {
  double metres = 1;  ///< A unit of the map.
  double sigma = 0;   ///< Standard deviation, as a share of `metres`.
  int texts = 0;      ///< Or pairs of them, that it rests on; 0: no such text is mapped well enough.
};

/// The mean over all mapped texts of these words, by their variances. Where they disagree by more than these say, the
/// standard deviation grows to what the disagreement says. The case of letters does not matter. A distance counts where
/// each of its words is on one mapped text alone.
MetricScale metric_scale(const Map& map, const Parameters& parameters, const std::vector<KnownLength>& lengths);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_METRIC_SCALE_HPP
