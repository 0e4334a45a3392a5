#include "detectors/text_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "textslam/common/geometry.hpp"

namespace textslam {
namespace {

using Direction = Vector2<double>;

double ratio(double a, double b) { return std::max(a, b) / std::min(a, b); }

/// Whether b can follow a, and how well; a negative cost means no.
double pair_cost(const Letter& a, const Letter& b, const ClassicalParameters& parameters) {
  constexpr double kNo = -1.0;
  if (a.light != b.light) return kNo;
  const Direction offset = b.centre - a.centre;
  const double larger = std::max(a.size, b.size), distance = offset.norm();
  if (distance > (1.0 + parameters.max_gap) * larger + 1.0) return kNo;
  // Centres of bounding boxes scatter about the line, the more the steeper it is; fit_quad() tests the line itself.
  const double steepest = radians(std::min(parameters.max_angle + 0.5 * parameters.max_turn, 89.0));
  if (offset[0] <= 0 || std::abs(offset[1]) > std::tan(steepest) * offset[0]) return kNo;
  if (ratio(a.stroke, b.stroke) > parameters.max_stroke_ratio) return kNo;
  const double contrast = std::min(a.contrast(), b.contrast());
  const double tones = std::max(std::abs(a.ink - b.ink), std::abs(a.paper - b.paper)) / contrast;
  if (tones > parameters.max_tone_difference) return kNo;

  const Direction along = offset / distance, across(-along[1], along[0]);
  const Extent height_a = extent(a, across), height_b = extent(b, across);
  const double height = std::max(height_a.length(), height_b.length());
  const double lower = std::min(height_a.length(), height_b.length());
  if (height > parameters.max_height_ratio * lower) return kNo;
  const double overlap = std::min(height_a.high, height_b.high) - std::max(height_a.low, height_b.low);
  if (overlap < parameters.min_overlap * lower) return kNo;
  const double gap = extent(b, along).low - extent(a, along).high;
  if (gap > parameters.max_gap * height || gap < parameters.min_gap * height) return kNo;
  return std::max(gap, 0.0) / height + tones + (height / lower - 1.0) + std::abs(along[1]);
}

void find_pairs(const std::vector<Letter>& letters, const ClassicalParameters& parameters, LineScratch& scratch) {
  const int count = static_cast<int>(letters.size());
  scratch.by_x.resize(letters.size());
  std::iota(scratch.by_x.begin(), scratch.by_x.end(), 0);
  std::stable_sort(scratch.by_x.begin(), scratch.by_x.end(),
                   [&](int i, int j) { return letters[at(i)].centre[0] < letters[at(j)].centre[0]; });
  scratch.pairs.clear();
  const double reach = (1.0 + parameters.max_gap) * parameters.max_size + 1.0;
  for (int i = 0; i < count; ++i) {
    const int a = scratch.by_x[at(i)];
    for (int j = i + 1; j < count; ++j) {
      const int b = scratch.by_x[at(j)];
      if (letters[at(b)].centre[0] - letters[at(a)].centre[0] > reach) break;
      const double cost = pair_cost(letters[at(a)], letters[at(b)], parameters);
      if (cost >= 0) scratch.pairs.push_back({a, b, cost});
    }
  }
}

/// Sorts pairs by the letter `key` and by cost, and notes where each letter's pairs begin.
template <int LetterPair::*key>
void index_pairs(std::vector<LetterPair>& pairs, std::size_t letters, std::vector<int>& first) {
  std::sort(pairs.begin(), pairs.end(), [](const LetterPair& p, const LetterPair& q) {
    if (p.*key != q.*key) return p.*key < q.*key;
    if (p.cost != q.cost) return p.cost < q.cost;
    return p.a != q.a ? p.a < q.a : p.b < q.b;
  });
  first.assign(letters + 1, 0);
  for (const LetterPair& p : pairs) ++first[at(p.*key) + 1];
  for (std::size_t i = 0; i < letters; ++i) first[i + 1] += first[i];
}

/// The direction of the line so far: of the least squares line through the centres, or of the two that there are.
Direction direction_of(const std::vector<int>& line, const std::vector<Letter>& letters) {
  Direction mean = Direction::Zero();
  for (const int i : line) mean += letters[at(i)].centre;
  mean /= static_cast<double>(line.size());
  double xx = 0, xy = 0, yy = 0;
  for (const int i : line) {
    const Direction d = letters[at(i)].centre - mean;
    xx += d[0] * d[0];
    xy += d[0] * d[1];
    yy += d[1] * d[1];
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  return {std::cos(angle), std::sin(angle)};
}

/// The letter stands on the line: neither its turn from the last letter nor its distance from the line is too large.
bool continues(const std::vector<int>& line, const Letter& last, const Letter& next, const std::vector<Letter>& letters,
               const ClassicalParameters& parameters) {
  const Direction along = direction_of(line, letters), across(-along[1], along[0]);
  const Direction offset = next.centre - last.centre;
  if (std::abs(offset.dot(along)) < std::cos(radians(parameters.max_turn)) * offset.norm()) return false;
  Direction mean = Direction::Zero();
  for (const int i : line) mean += letters[at(i)].centre;
  mean /= static_cast<double>(line.size());
  // Small letters stand beside large ones on a common base or top, not on a common centre.
  const double height = std::max(extent(last, across).length(), extent(next, across).length());
  return std::abs((next.centre - mean).dot(across)) <= parameters.max_offset * height;
}

/// Appends the letter that goes on best at the line's end. False where there is none.
bool extend_right(std::vector<int>& line, const std::vector<Letter>& letters, const ClassicalParameters& parameters,
                  const LineScratch& scratch) {
  const int last = line.back();
  for (int k = scratch.first_pair[at(last)]; k < scratch.first_pair[at(last) + 1]; ++k) {
    const int next = scratch.pairs[at(k)].b;
    if (scratch.used[at(next)]) continue;
    if (!continues(line, letters[at(last)], letters[at(next)], letters, parameters)) continue;
    line.push_back(next);
    return true;
  }
  return false;
}

/// The same at its beginning.
bool extend_left(std::vector<int>& line, const std::vector<Letter>& letters, const ClassicalParameters& parameters,
                 const LineScratch& scratch) {
  const int head = line.front();
  for (int k = scratch.first_reverse[at(head)]; k < scratch.first_reverse[at(head) + 1]; ++k) {
    const int next = scratch.reverse[at(k)].a;
    if (scratch.used[at(next)]) continue;
    if (!continues(line, letters[at(head)], letters[at(next)], letters, parameters)) continue;
    line.insert(line.begin(), next);
    return true;
  }
  return false;
}

}  // namespace

void find_lines(const std::vector<Letter>& letters, const ClassicalParameters& parameters, LineScratch& scratch,
                std::vector<std::vector<int>>& lines) {
  lines.clear();
  find_pairs(letters, parameters, scratch);
  scratch.reverse = scratch.pairs;
  index_pairs<&LetterPair::a>(scratch.pairs, letters.size(), scratch.first_pair);
  index_pairs<&LetterPair::b>(scratch.reverse, letters.size(), scratch.first_reverse);
  scratch.used.assign(letters.size(), 0);
  scratch.seeds.resize(scratch.pairs.size());
  std::iota(scratch.seeds.begin(), scratch.seeds.end(), 0);
  std::stable_sort(scratch.seeds.begin(), scratch.seeds.end(),
                   [&](int i, int j) { return scratch.pairs[at(i)].cost < scratch.pairs[at(j)].cost; });

  std::vector<int> line;
  for (const int seed : scratch.seeds) {
    const LetterPair& pair = scratch.pairs[at(seed)];
    if (scratch.used[at(pair.a)] || scratch.used[at(pair.b)]) continue;
    line.assign({pair.a, pair.b});
    while (extend_right(line, letters, parameters, scratch) || extend_left(line, letters, parameters, scratch)) {
    }
    if (static_cast<int>(line.size()) < parameters.min_letters) continue;
    for (const int i : line) scratch.used[at(i)] = 1;
    lines.push_back(line);
  }
}

}  // namespace textslam
