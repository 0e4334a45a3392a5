#include "sign_index/place_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sign_index/constellation.hpp"
#include "sign_index/place_seeds.hpp"
#include "sign_index/query_view.hpp"

namespace textslam {
namespace {

using textplane::Status;

constexpr double kRivalRange = 14;  // nats

bool is_probability(double p) { return p > 0 && p < 1; }

bool are_valid(const PlaceOptions& o) {
  return o.corner_sigma > 0 && std::isfinite(o.corner_sigma) && is_probability(o.least_probability) &&
         is_probability(o.in_map) && is_probability(o.missed) && o.unmapped > 0 && o.most_words > 0 &&
         o.most_seeds > 0 && o.most_places > 0;
}

bool share_a_sighting(const FoundPlace& a, const FoundPlace& b) {
  for (const SignSighting& s : a.sightings)
    for (const SignSighting& t : b.sightings)
      if (s.detection == t.detection && s.sign == t.sign) return true;
  return false;
}

bool holds(const FoundPlace& place, int detection, std::uint32_t sign) {
  return std::any_of(place.sightings.begin(), place.sightings.end(),
                     [&](const SignSighting& s) { return s.detection == detection && s.sign == sign; });
}

// Of places that share a sighting only the best stays: they are one place, or one of them is wrong about another sign.
void keep_distinct(std::vector<FoundPlace>* places) {
  std::stable_sort(places->begin(), places->end(),
                   [](const FoundPlace& a, const FoundPlace& b) { return a.log_evidence > b.log_evidence; });
  std::vector<FoundPlace> kept;
  for (FoundPlace& place : *places)
    if (std::none_of(kept.begin(), kept.end(), [&](const FoundPlace& k) { return share_a_sighting(k, place); }))
      kept.push_back(std::move(place));
  *places = std::move(kept);
}

void set_probabilities(double in_map, std::vector<FoundPlace>* places) {
  if (places->empty()) return;
  const double odds = std::log(in_map / (1 - in_map)), top = std::max(0.0, places->front().log_evidence + odds);
  double sum = std::exp(-top);  // elsewhere
  for (const FoundPlace& place : *places) sum += std::exp(place.log_evidence + odds - top);
  for (FoundPlace& place : *places) place.probability = std::exp(place.log_evidence + odds - top) / sum;
}

}  // namespace

class PlaceSearch::Engine {
 public:
  Engine(const SignIndex& index, const PlaceOptions& options)
      : index_(index), options_(options), constellation_(index_, options_) {}

  PlaceAnswer find(const std::vector<Detection>& detections, const CameraModel& camera) {
    PlaceAnswer answer;
    if (!are_valid(options_)) {
      answer.status = Status::invalid_argument;
      return answer;
    }
    const QueryView view = make_query_view(index_, options_, detections, camera, &scratch_);
    answer.status = view.status;
    if (!textplane::is_ok(view.status)) return answer;
    std::vector<FoundPlace>& places = answer.places;
    double least = -1e9;
    for (const PlaceSeed& seed : seeds_.find(index_, view, static_cast<std::size_t>(options_.most_seeds))) {
      if (seed.score < least) break;
      const int detection = view.signs[seed.query].detection;
      const bool known = std::any_of(places.begin(), places.end(), [&](const FoundPlace& p) {
        return p.sightings.size() > 1 && holds(p, detection, seed.sign);
      });
      if (known) continue;
      if (auto place = constellation_.grow(view, seed)) {
        least = std::max(least, least_rival(view, *place));
        places.push_back(std::move(*place));
      }
    }
    keep_distinct(&places);
    set_probabilities(options_.in_map, &places);
    const auto most = static_cast<std::size_t>(options_.most_places);
    if (places.size() > most) places.resize(most);
    const bool sure = !places.empty() && places.front().probability >= options_.least_probability;
    answer.status = sure ? Status::ok : Status::diverged;
    return answer;
  }

 private:
  // Seeds with less than this score cannot rival the place: it explains the same detections, and their words say less.
  // What it leaves unexplained may speak for the other.
  double least_rival(const QueryView& view, const FoundPlace& place) const {
    double words = 0, unexplained = 0;
    for (const QuerySign& sign : view.signs) {
      const auto own = std::find_if(place.sightings.begin(), place.sightings.end(),
                                    [&](const SignSighting& s) { return s.detection == sign.detection; });
      if (own == place.sightings.end())
        unexplained += std::max(0.0, sign.log_peak);
      else
        words += sign.log_ratio(index_.word(own->sign));
    }
    return words - unexplained - kRivalRange;
  }

  const SignIndex& index_;
  const PlaceOptions options_;
  WordScratch scratch_;
  SeedFinder seeds_;
  Constellation constellation_;
};

PlaceSearch::PlaceSearch(const SignIndex& index, const PlaceOptions& options)
    : engine_(std::make_unique<Engine>(index, options)) {}
PlaceSearch::~PlaceSearch() = default;
PlaceSearch::PlaceSearch(PlaceSearch&&) noexcept = default;

PlaceAnswer PlaceSearch::find(const std::vector<Detection>& detections, const CameraModel& camera) {
  return engine_->find(detections, camera);
}

}  // namespace textslam
