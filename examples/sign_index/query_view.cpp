#include "sign_index/query_view.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/landmarks/words.hpp"

namespace textslam {
namespace {

using textplane::Status;
constexpr double kEdge = 0.01;           // px from the edge of the image: a quad that touches it is cut off
constexpr double kWordRange = 12;        // nats below the likeliest word
constexpr double kOtherWord = -12;       // nats, of a word that nobody would read so
constexpr double kLeastSide = 4;         // px
constexpr double kClutterSpread = 2.54;  // minus the log of the spreads below

// A quad anywhere in the image: its centre uniform, height and width within a factor of about e, its sides' slopes
// within .3, and opposite sides' lengths within .15 of each other.
double log_clutter(double width, double height, double image_area) {
  return kClutterSpread - std::log(image_area) - 3 * std::log(height) - 3 * std::log(width);
}

bool is_cut(const Quad<double>& quad, const CameraModel& camera) {
  for (const Vec2& c : quad.corner)
    if (c[0] < kEdge || c[1] < kEdge || c[0] > camera.width - 1 - kEdge || c[1] > camera.height - 1 - kEdge)
      return true;
  return false;
}

std::vector<WordEvidence> evidence(const SignIndex& index, int most, const std::string& text, WordScratch* scratch) {
  const Symbols reading = symbols_of(text);
  const auto matches = index.words().similar(reading, static_cast<std::size_t>(most), kWordRange, scratch);
  // An unknown place has words of its own, and words of this map: the common ones as often as the map has them.
  double unknown = index.unique_share() * std::exp(index.words().letters().log_probability(reading));
  for (const SimilarWord& m : matches) {
    const std::size_t count = index.signs_of(m.word).size();
    const double expected = count > 1 ? static_cast<double>(count) : index.expected_again();
    unknown += expected / index.size() * std::exp(m.log_likelihood);
  }
  std::vector<WordEvidence> words;
  for (const SimilarWord& m : matches) words.push_back({m.word, m.log_likelihood - std::log(unknown + 1e-300)});
  std::sort(words.begin(), words.end(), [](const WordEvidence& a, const WordEvidence& b) { return a.word < b.word; });
  return words;
}

}  // namespace

double QuerySign::log_ratio(std::uint32_t word) const noexcept {
  if (!read || word == SignIndex::kNoWord) return 0;
  const auto found = std::lower_bound(words.begin(), words.end(), word,
                                      [](const WordEvidence& a, std::uint32_t w) { return a.word < w; });
  return found != words.end() && found->word == word ? found->log_ratio : kOtherWord;
}

QueryView make_query_view(const SignIndex& index, const PlaceOptions& options, const std::vector<Detection>& detections,
                          const CameraModel& camera, WordScratch* scratch) {
  QueryView view;
  const double f = camera.pinhole().fx;
  if (camera.width < 2 || camera.height < 2 || !(f > 0) || !(options.corner_sigma > 0)) {
    view.status = Status::invalid_argument;
    return view;
  }
  view.sigma = options.corner_sigma / f;
  view.low = camera.pinhole().unproject(Vec2(0, 0)).head<2>();
  view.high = camera.pinhole().unproject(Vec2(camera.width - 1, camera.height - 1)).head<2>();
  bool any_read = false;
  for (std::size_t i = 0; i < detections.size(); ++i) {
    const Detection& d = detections[i];
    if (!textplane::all_finite(d.quad)) {
      view.status = Status::non_finite;
      view.signs.clear();
      return view;
    }
    const auto& c = d.quad.corner;
    const double width = 0.5 * ((c[1] - c[0]).norm() + (c[2] - c[3]).norm());
    const double height = 0.5 * ((c[3] - c[0]).norm() + (c[2] - c[1]).norm());
    if (!textplane::is_convex(d.quad) || !(textplane::area(d.quad) > 0) || !(width > kLeastSide) ||
        !(height > kLeastSide) || is_cut(d.quad, camera))
      continue;
    QuerySign sign;
    sign.detection = static_cast<int>(i);
    bool seen = true;
    for (std::size_t k = 0; k < 4; ++k) {
      Vec3 m;
      seen = seen && textplane::is_ok(camera.unproject(c[k], &m));
      if (seen) sign.quad.corner[k] = m.head<2>();
    }
    if (!seen || !textplane::is_convex(sign.quad)) continue;
    sign.centre = (sign.quad.corner[0] + sign.quad.corner[1] + sign.quad.corner[2] + sign.quad.corner[3]) / 4;
    sign.area = textplane::area(d.quad);
    const double pixels = static_cast<double>(camera.width) * camera.height;
    sign.log_peak = std::log((1 - options.missed) / options.unmapped) - log_clutter(width, height, pixels) -
                    8 * std::log(options.corner_sigma * std::sqrt(2 * M_PI));
    sign.read = textplane::is_read(d.text);
    if (sign.read) sign.words = evidence(index, options.most_words, d.text, scratch);
    any_read = any_read || !sign.words.empty();
    view.signs.push_back(std::move(sign));
  }
  view.status = any_read ? Status::ok : Status::too_few;
  return view;
}

}  // namespace textslam
