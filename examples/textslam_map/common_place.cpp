#include "textslam_map/common_place.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/landmarks/words.hpp"
#include "textslam/common/geometry.hpp"

namespace textslam {
namespace {

constexpr double kSigmas = 3.3, kPlaceChi2 = 16.27;   // 0.1 % of one number, and of three
constexpr double kBend = 0.01;                        // of the distance to the other signs: what a map drifts
constexpr double kAngleFloor = 1, kSizeFloor = 0.02;  // degrees; share: hosts' poses err too
constexpr double kBaseline = 0.15;                    // log of the ratio of a distance: a first look
constexpr double kScaleFloor = 0.01;
constexpr double kCovers = 0.5;                  // of a size, between centres
constexpr double kWidths[] = {2, 1.5, 1, 1, 1};  // in units of the gates: the first similarity is that of two signs
constexpr std::size_t kMostPairs = 400;          // those of the rarest words
constexpr std::size_t kLeastAny = 3, kLeastUnique = 2, kAgainst = 4;

struct Pair {
  std::size_t a, b;
  double cost = 0;
  bool operator==(const Pair& other) const { return a == other.a && b == other.b; }
};

struct Candidate {
  Similarity S;
  std::vector<Pair> pairs;
  double cost = 0;
};

class Search {
 public:
  Search(const std::vector<MapSign>& a, const std::vector<MapSign>& b, const textplane::TextOptions& options,
         KnownScale scale_sigma)
      : a_(a), b_(b), options_(options), scale_sigma_(scale_sigma) {
    most_alike_a_.assign(a.size(), 0);
    most_alike_b_.assign(b.size(), 0);
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t k = 0; k < b.size(); ++k) {
        const double similar = textplane::word_similarity(a[i].word, b[k].word);
        most_alike_a_[i] = std::max(most_alike_a_[i], similar);
        most_alike_b_[k] = std::max(most_alike_b_[k], similar);
      }
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t k = 0; k < b.size(); ++k)
        if (alike(i, k)) pairs_.push_back({i, k});
  }

  std::optional<CommonPlace> find() {
    std::vector<Candidate> proven;
    const std::vector<Pair> seeds = rarest();
    for (std::size_t i = 0; i < seeds.size(); ++i)
      for (std::size_t k = i + 1; k < seeds.size(); ++k) {
        const bool known = std::any_of(proven.begin(), proven.end(), [&](const Candidate& c) {
          return holds(c.pairs, seeds[i]) && holds(c.pairs, seeds[k]);
        });
        if (known || !may_fit(seeds[i], seeds[k])) continue;
        Candidate candidate;
        if (grow({seeds[i], seeds[k]}, &candidate) && has_proof(candidate)) proven.push_back(std::move(candidate));
      }
    if (proven.empty()) return std::nullopt;
    const auto best = std::min_element(proven.begin(), proven.end(), [](const Candidate& p, const Candidate& q) {
      return p.pairs.size() != q.pairs.size() ? p.pairs.size() > q.pairs.size() : p.cost < q.cost;
    });
    for (const Candidate& other : proven) {
      const bool elsewhere = std::none_of(other.pairs.begin(), other.pairs.end(),
                                          [&](const Pair& pair) { return holds(best->pairs, pair); });
      if (elsewhere && 2 * other.pairs.size() > best->pairs.size()) return std::nullopt;
    }
    CommonPlace place;
    place.S_a_b = best->S;
    place.scale_sigma = scale_sigma_of(*best);
    for (const Pair& pair : best->pairs) place.texts.emplace_back(a_[pair.a].text, b_[pair.b].text);
    std::sort(place.texts.begin(), place.texts.end());
    return place;
  }

 private:
  // ROOM 101 is like ROOM 102, but not where the other map has a ROOM 101 too.
  bool alike(std::size_t a, std::size_t b) const {
    const double similar = textplane::word_similarity(a_[a].word, b_[b].word);
    return textplane::words_agree(a_[a].word, b_[b].word, options_) && similar >= most_alike_a_[a] &&
           similar >= most_alike_b_[b];
  }
  static bool holds(const std::vector<Pair>& pairs, const Pair& pair) {
    return std::find(pairs.begin(), pairs.end(), pair) != pairs.end();
  }

  std::vector<Pair> rarest() const {
    std::vector<std::size_t> of_a(a_.size(), 0), of_b(b_.size(), 0);
    for (const Pair& pair : pairs_) {
      ++of_a[pair.a];
      ++of_b[pair.b];
    }
    std::vector<Pair> seeds = pairs_;
    std::stable_sort(seeds.begin(), seeds.end(),
                     [&](const Pair& p, const Pair& q) { return of_a[p.a] * of_b[p.b] < of_a[q.a] * of_b[q.b]; });
    if (seeds.size() > kMostPairs) seeds.resize(kMostPairs, seeds.front());
    return seeds;
  }

  // The distance between the signs grows as their sizes do.
  bool may_fit(const Pair& p, const Pair& q) const {
    if (p.a == q.a || p.b == q.b) return false;
    const double of_a = (a_[p.a].centre - a_[q.a].centre).norm(), of_b = (b_[p.b].centre - b_[q.b].centre).norm();
    if (!(of_a > 0 && of_b > 0)) return false;
    const auto fits = [&](const Pair& pair) {
      const double sigma = std::hypot(a_[pair.a].size_sigma, b_[pair.b].size_sigma, kSizeFloor);
      return std::abs(std::log(of_a / of_b * b_[pair.b].size / a_[pair.a].size)) <= 2 * kSigmas * sigma + kBaseline;
    };
    return fits(p) && fits(q);
  }

  bool fit(const std::vector<Pair>& pairs, Similarity* S) const {
    std::vector<Vec3> from, to;
    for (const Pair& pair : pairs)
      for (std::size_t k = 0; k < 4; ++k) {
        from.push_back(b_[pair.b].corners[k]);
        to.push_back(a_[pair.a].corners[k]);
      }
    return textplane::is_ok(align_points(from, to, true, S)) && S->scale > 0;
  }

  // Squared standard deviations; nothing beyond the gates. `reach`: how far from the signs that made S.
  std::optional<double> agreement(const Similarity& S, const MapSign& a, const MapSign& b, double reach,
                                  double width) const {
    const double bend = kBend * reach, s = S.scale;
    const Vec3 e = S * b.centre - a.centre;
    // Most pairs are far off: no direction is less certain than all together.
    const double all = a.covariance.trace() + s * s * b.covariance.trace() + 3 * bend * bend;
    if (e.squaredNorm() > width * width * kPlaceChi2 * all) return std::nullopt;
    const Eigen::Matrix3d C =
        a.covariance + s * s * S.R * b.covariance * S.R.transpose() + bend * bend * Eigen::Matrix3d::Identity();
    const double place = e.dot(C.ldlt().solve(e));
    const double floor = radians(kAngleFloor);
    const double normal = radians(degrees_between(a.axes.col(2), S.R * b.axes.col(2))) /
                          std::hypot(a.normal_sigma, b.normal_sigma, floor);
    const double turn =
        radians(degrees_between(a.axes.col(0), S.R * b.axes.col(0))) / std::hypot(a.turn_sigma, b.turn_sigma, floor);
    const double size = std::log(a.size / (s * b.size)) / std::hypot(a.size_sigma, b.size_sigma, kSizeFloor);
    const double limit = width * kSigmas;
    if (!(place <= width * width * kPlaceChi2 && normal <= limit && turn <= limit && std::abs(size) <= limit))
      return std::nullopt;
    return place + normal * normal + turn * turn + size * size;
  }

  // How far a sign of a is from the middle of those that made the similarity.
  double reach_of(const std::vector<Pair>& made_by, const Vec3& centre) const {
    Vec3 middle = Vec3::Zero();
    for (const Pair& pair : made_by) middle += a_[pair.a].centre / static_cast<double>(made_by.size());
    return (centre - middle).norm();
  }

  bool grow(std::vector<Pair> pairs, Candidate* out) const {
    for (const double width : kWidths) {
      if (pairs.size() < kLeastUnique || !fit(pairs, &out->S)) return false;
      std::vector<Pair> agree;
      for (Pair pair : pairs_) {
        const auto cost = agreement(out->S, a_[pair.a], b_[pair.b], reach_of(pairs, a_[pair.a].centre), width);
        if (!cost) continue;
        pair.cost = *cost;
        agree.push_back(pair);
      }
      std::sort(agree.begin(), agree.end(), [](const Pair& p, const Pair& q) { return p.cost < q.cost; });
      pairs.clear();
      for (const Pair& pair : agree)
        if (std::none_of(pairs.begin(), pairs.end(),
                         [&](const Pair& taken) { return taken.a == pair.a || taken.b == pair.b; }))
          pairs.push_back(pair);
    }
    out->pairs = std::move(pairs);
    for (const Pair& pair : out->pairs) out->cost += pair.cost;
    return out->pairs.size() >= kLeastUnique;
  }

  // Signs that cover each other and read otherwise, of those that have not found theirs: they may hang side by side.
  std::size_t against(const Candidate& candidate) const {
    std::vector<char> taken_a(a_.size(), 0), taken_b(b_.size(), 0);
    for (const Pair& pair : candidate.pairs) taken_a[pair.a] = taken_b[pair.b] = 1;
    const auto covers = [&](std::size_t a, std::size_t b) {
      return !taken_a[a] && !alike(a, b) && (candidate.S * b_[b].centre - a_[a].centre).norm() < kCovers * a_[a].size &&
             agreement(candidate.S, a_[a], b_[b], reach_of(candidate.pairs, a_[a].centre), 1).has_value();
    };
    std::size_t count = 0;
    for (std::size_t b = 0; b < b_.size(); ++b)
      for (std::size_t a = 0; a < a_.size() && !taken_b[b]; ++a)
        if (covers(a, b)) {
          ++count;
          break;
        }
    return count;
  }

  // Pairs of signs whose words are the same, and found once in each map.
  std::size_t unique_in(const std::vector<Pair>& pairs) const {
    return static_cast<std::size_t>(std::count_if(pairs.begin(), pairs.end(), [&](const Pair& pair) {
      const MapSign &a = a_[pair.a], &b = b_[pair.b];
      return a.unique && b.unique && a.word == b.word;
    }));
  }

  bool has_proof(const Candidate& candidate) const {
    const std::vector<Pair>& pairs = candidate.pairs;
    const bool differ = std::any_of(pairs.begin(), pairs.end(), [&](const Pair& pair) {
      return !textplane::words_agree(a_[pair.a].word, a_[pairs.front().a].word, options_);
    });
    const std::size_t unique = unique_in(pairs);
    const bool enough = (pairs.size() >= kLeastAny && differ) || unique >= kLeastUnique;
    const double off = std::abs(std::log(candidate.S.scale));
    return enough && 2 * unique >= unique_in(pairs_) && kAgainst * against(candidate) <= pairs.size() &&
           (!scale_sigma_ || off <= kSigmas * std::hypot(*scale_sigma_, kScaleFloor));
  }

  // By what is left of the least squares. A sign errs in one direction most: that of its distance.
  double scale_sigma_of(const Candidate& candidate) const {
    const auto n = static_cast<double>(candidate.pairs.size());
    Vec3 middle = Vec3::Zero();
    for (const Pair& pair : candidate.pairs) middle += b_[pair.b].centre / n;
    double errors = 0, spread = 0;
    for (const Pair& pair : candidate.pairs) {
      errors += (candidate.S * b_[pair.b].centre - a_[pair.a].centre).squaredNorm();
      spread += (candidate.S.scale * (b_[pair.b].centre - middle)).squaredNorm();
    }
    return std::sqrt(errors / (n - 1) / spread);
  }

  const std::vector<MapSign>&a_, &b_;
  const textplane::TextOptions& options_;
  KnownScale scale_sigma_;
  std::vector<double> most_alike_a_, most_alike_b_;  // similarity of the best word in the other map
  std::vector<Pair> pairs_;
};

}  // namespace

std::optional<CommonPlace> find_common_place(const std::vector<MapSign>& a, const std::vector<MapSign>& b,
                                             const textplane::TextOptions& options, KnownScale scale_sigma) {
  return Search(a, b, options, scale_sigma).find();
}

}  // namespace textslam
