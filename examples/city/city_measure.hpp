// City measure: many queries of one kind, and how often the search is right.
#ifndef TEXTSLAM_CITY_MEASURE_HPP
#define TEXTSLAM_CITY_MEASURE_HPP

#include <cstdint>
#include <vector>

#include "city/city_query.hpp"
#include "sign_index/place_search.hpp"

namespace textslam {

/// Which views are queries.
enum class CityView {
  three_signs,  ///< At least three signs are detected whole.
  one_sign,     ///< One sign is detected whole and read, and no other; no other sign of the city has its word.
  any           ///< At least one sign is detected whole.
};

/// What a search made of one query.
struct QueryResult {
  bool first_right = false;  ///< Most signs that the first guess names are those.
  bool possible = false;     ///< Something is read, and not all signs in view are of one chain.
  bool answered = false;
  bool wrong = false;       ///< Answered, and not right; or the pose is said to be sure and is off by more than 10 m.
  bool word_first = false;  ///< one_sign: the sign's word is the likeliest of all words of the city.
  double seconds = 0;
  double probability = 0;     ///< of the first guess
  double position_error = 0;  ///< m, of the answer
};

struct CityTrial {
  CityView view = CityView::three_signs;
  int queries = 1000;
  std::uint64_t seed = 1;
  int threads = 1;
  CityReader reader;
  PlaceOptions search;
};

/// The signs of a city for an index; their ids are their numbers.
std::vector<MappedSign> mapped_signs(const City& city);

/// The camera of the queries: 640 x 480 px, 525 px focal length.
CameraModel city_camera();

/// Queries in `shown`, searched in `index`, which `indexed` was made into. For a query of another city the two differ:
/// then no guess is right.
std::vector<QueryResult> run_trial(const City& shown, const City& indexed, const SignIndex& index,
                                   const CityTrial& trial);

}  // namespace textslam

#endif  // TEXTSLAM_CITY_MEASURE_HPP
