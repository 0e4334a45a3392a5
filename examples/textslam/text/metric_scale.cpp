#include "textslam/text/metric_scale.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "io/text_file.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/text/text_width.hpp"

namespace textslam {
namespace {

constexpr double kUsualSigma = 0.002;  // of a width, where none is given

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

bool parse_known_width(const std::string& text, KnownWidth* out) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) return false;
  const std::string numbers = text.substr(equals + 1);
  const std::size_t colon = numbers.find(':');
  KnownWidth known;
  known.word = text.substr(0, equals);
  if (!parse_number(numbers.substr(0, colon), &known.width) || !(known.width > 0)) return false;
  known.sigma = kUsualSigma * known.width;
  if (colon != std::string::npos && (!parse_number(numbers.substr(colon + 1), &known.sigma) || !(known.sigma > 0)))
    return false;
  *out = known;
  return true;
}

MetricScale metric_scale(const Map& map, const Parameters& parameters, const std::vector<KnownWidth>& widths) {
  struct Estimate {
    double log_scale, variance;  // relative errors are errors of the logarithm
  };
  std::vector<Estimate> estimates;
  for (const TextObject& text : map.texts) {
    if (text.state != TextState::mapped) continue;
    const std::string word = lower(textplane::consensus(text.votes));
    for (const KnownWidth& known : widths) {
      if (lower(known.word) != word) continue;
      const TextWidth seen = text_width(map, parameters, text);
      if (!(seen.width > 0)) continue;
      const double sigma = std::hypot(known.sigma / known.width, seen.sigma / seen.width);
      estimates.push_back({std::log(known.width / seen.width), sigma * sigma});
    }
  }
  MetricScale out;
  double sum = 0, weights = 0, chi2 = 0;
  for (const Estimate& e : estimates) {
    sum += e.log_scale / e.variance;
    weights += 1 / e.variance;
  }
  if (estimates.empty()) return out;
  const double mean = sum / weights;
  for (const Estimate& e : estimates) chi2 += (e.log_scale - mean) * (e.log_scale - mean) / e.variance;
  const double freedom = static_cast<double>(estimates.size()) - 1;
  out.metres = std::exp(mean);
  out.sigma = std::sqrt((freedom > 0 ? std::max(1.0, chi2 / freedom) : 1) / weights);
  out.texts = static_cast<int>(estimates.size());
  return out;
}

}  // namespace textslam
