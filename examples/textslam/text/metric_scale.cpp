#include "textslam/text/metric_scale.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "io/text_file.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/text/text_centre.hpp"
#include "textslam/text/text_width.hpp"

namespace textslam {
namespace {

constexpr double kUsualSigma = 0.002;  // of a length, where none is given

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

struct Estimate {
  double log_scale, variance;  // relative errors are errors of the logarithm
};

Estimate estimate(const KnownLength& known, double seen, double sigma) {
  const double relative = std::hypot(known.sigma / known.length, sigma / seen);
  return {std::log(known.length / seen), relative * relative};
}

std::vector<const TextObject*> texts_of(const Map& map, const std::string& word) {
  std::vector<const TextObject*> found;
  for (const TextObject& text : map.texts)
    if (text.state == TextState::mapped && lower(textplane::consensus(text.votes)) == lower(word))
      found.push_back(&text);
  return found;
}

void add_widths(const Map& map, const Parameters& parameters, const KnownLength& known, std::vector<Estimate>* out) {
  for (const TextObject* text : texts_of(map, known.word)) {
    const TextWidth seen = text_width(map, parameters, *text);
    if (seen.width > 0) out->push_back(estimate(known, seen.width, seen.sigma));
  }
}

void add_distance(const Map& map, const KnownLength& known, std::vector<Estimate>* out) {
  const auto first = texts_of(map, known.word), second = texts_of(map, known.other);
  if (first.size() != 1 || second.size() != 1 || first == second) return;
  const TextCentre a = text_centre(map, *first.front()), b = text_centre(map, *second.front());
  const Vec3 between = b.at - a.at, along = between.normalized();
  if (!(between.norm() > 0)) return;
  out->push_back(estimate(known, between.norm(), std::sqrt(along.dot((a.covariance + b.covariance) * along))));
}

}  // namespace

bool parse_known_length(const std::string& text, KnownLength* out) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) return false;
  const std::string numbers = text.substr(equals + 1);
  const std::size_t colon = numbers.find(':');
  KnownLength known;
  known.word = text.substr(0, equals);
  const std::size_t dots = known.word.find("..");
  if (dots != std::string::npos) {
    known.other = known.word.substr(dots + 2);
    known.word.resize(dots);
    if (known.word.empty() || known.other.empty() || known.word == known.other) return false;
  }
  if (!parse_number(numbers.substr(0, colon), &known.length) || !(known.length > 0)) return false;
  known.sigma = kUsualSigma * known.length;
  if (colon != std::string::npos && (!parse_number(numbers.substr(colon + 1), &known.sigma) || !(known.sigma > 0)))
    return false;
  *out = known;
  return true;
}

MetricScale metric_scale(const Map& map, const Parameters& parameters, const std::vector<KnownLength>& lengths) {
  std::vector<Estimate> estimates;
  for (const KnownLength& known : lengths) {
    if (known.other.empty())
      add_widths(map, parameters, known, &estimates);
    else
      add_distance(map, known, &estimates);
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
