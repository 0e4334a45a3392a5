// City: a net of streets with signs on its house fronts, for a search at the size of a city.
//
// Streets cross at right angles; houses stand wall to wall round each block. 30 % of the signs bear a word that other
// signs bear too: half of these are common words (EXIT, TAXI), half belong to chains, whose shops have the same signs
// of the same look in the same arrangement. The other words are names, each there once. A seed always gives the same
// city.
#ifndef TEXTSLAM_CITY_CITY_HPP
#define TEXTSLAM_CITY_CITY_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/scene.hpp"

namespace textslam {

struct CityOptions {
  int signs = 10000;  ///< 10 to 1000000
  std::uint64_t seed = 1;
};

struct CitySign {
  std::string word;
  Rectangle text;      ///< m, z up; streets lie at z = 0
  std::uint64_t look;  ///< Equal numbers: equal plates for equal words.
  bool unique;         ///< No other sign of the city has its word.
  int chain = -1;      ///< Whose shop it belongs to; -1: none.
};

struct City {
  std::uint64_t seed = 0;
  std::vector<CitySign> signs;
  std::vector<Rectangle> fronts;  ///< of houses, towards the street
  /// Blocks of houses, m: x from low to high in columns, y in rows.
  std::vector<Vector2<double>> columns, rows;

  /// Outside all blocks by at least `clear`, and within the outermost streets.
  bool is_street(double x, double y, double clear) const;
};

/// Throws InputError for a number of signs out of range.
City make_city(const CityOptions& options);

}  // namespace textslam

#endif  // TEXTSLAM_CITY_CITY_HPP
