#include "city/city.hpp"

#include <algorithm>
#include <cmath>

#include "city/city_words.hpp"
#include "io/input_error.hpp"
#include "renderer/random.hpp"
#include "renderer/sign_plate.hpp"

namespace textslam {
namespace {

constexpr double kCommonShare = 0.15, kChainShare = 0.15;  // of the signs
constexpr double kSignsAHouse = 2.6;
constexpr double kShopsAChain = 25;
constexpr double kPitch = 2.6;  // m, between signs of a shop; three fit on the narrowest front
constexpr int kCommonLooks = 8;
constexpr int kCommonWords = 48;
constexpr double kLift = 0.03;                             // m, of a plate off the wall
constexpr double kLetter = 0.75;                           // width of a letter, of its height
constexpr double kLeastHeight = 0.09, kMostHeight = 0.55;  // m, of letters

struct Wanted {
  std::string word;
  double width, height, drop;  // m; drop: of the text's centre below the front's top
  std::uint64_t look;
  bool unique;
  int chain = -1;
};

struct Chain {
  std::vector<Wanted> signs;
};

Wanted sized(const std::string& word, double width, double squeeze, double above_street, double front_height,
             std::uint64_t look, bool unique) {
  const double letters = static_cast<double>(word.size()) * kLetter;
  const double height = std::clamp(width / letters * squeeze, kLeastHeight, kMostHeight);
  return {word, std::min(width, 1.3 * height * letters), height, front_height - above_street, look, unique};
}

class Builder {
 public:
  /// `slack`: houses, of those that are expected to be enough.
  Builder(const CityOptions& options, double slack)
      : options_(options), slack_(slack), random_(hash(options.seed, 900)) {
    city_.seed = options.seed;
  }

  City build() {
    Random words(hash(options_.seed, 901));
    common_ = sign_words(kCommonWords, words);
    for (const std::string& word : common_) names_.keep(word);
    make_chains();
    // Enough houses for all signs: blocks in a square.
    const double houses = slack_ * (options_.signs / kSignsAHouse * 1.1 + 4), a_block = 26;
    const int side = std::max(1, static_cast<int>(std::ceil(std::sqrt(houses / a_block))));
    lay(side, 60, 110, &city_.columns);
    lay(side, 40, 70, &city_.rows);
    for (const Vector2<double>& row : city_.rows)
      for (const Vector2<double>& column : city_.columns) add_block(column, row);
    return std::move(city_);
  }

 private:
  void lay(int count, double low, double high, std::vector<Vector2<double>>* spans) {
    double at = 0;
    for (int i = 0; i < count; ++i) {
      const double size = random_.uniform(low, high);
      spans->push_back({at, at + size});
      at += size + random_.uniform(12, 18);
    }
  }

  void make_chains() {
    const double shops = kChainShare * options_.signs / 2;
    const int count = std::max(1, static_cast<int>(std::lround(shops / kShopsAChain)));
    for (int i = 0; i < count; ++i) {
      Chain chain;
      const int signs = 1 + random_.below(3);
      const std::string name = names_.make(random_);
      for (int k = 0; k < signs; ++k) {
        chain.signs.push_back(wanted(k == 0 ? name : common_[static_cast<std::size_t>(random_.below(kCommonWords))],
                                     kPitch, false, random_.word()));
        chain.signs.back().chain = i;
      }
      chains_.push_back(chain);
    }
  }

  // Above the shop or beside the door; a column of the front is `room` wide.
  Wanted wanted(const std::string& word, double room, bool unique, std::uint64_t look) {
    const bool high = random_.chance(0.65);
    const double width = high ? random_.uniform(1.2, 2.8) : random_.uniform(0.6, 1.1);
    const double above = high ? random_.uniform(2.5, 3.8) : random_.uniform(1.3, 2.1);
    return sized(word, std::min(width, 0.85 * room), random_.uniform(0.85, 1.2), above, kFront, look, unique);
  }

  Wanted any_sign(double room) {
    if (random_.chance(kCommonShare / (1 - kChainShare))) {
      const std::string& word = common_[static_cast<std::size_t>(random_.below(kCommonWords))];
      return wanted(word, room, false, hash(901, static_cast<std::uint64_t>(random_.below(kCommonLooks))));
    }
    return wanted(names_.make(random_), room, true, random_.word());
  }

  void add_block(const Vector2<double>& x, const Vector2<double>& y) {
    // Seen from the street, a front begins at its left.
    const double width = x[1] - x[0], depth = y[1] - y[0];
    add_row({x[0], y[0], 0}, Vector3<double>::UnitX(), width);
    add_row({x[1], y[0], 0}, Vector3<double>::UnitY(), depth);
    add_row({x[1], y[1], 0}, -Vector3<double>::UnitX(), width);
    add_row({x[0], y[1], 0}, -Vector3<double>::UnitY(), depth);
  }

  void add_row(const Vector3<double>& corner, const Vector3<double>& right, double length) {
    const int houses = std::max(1, static_cast<int>(length / random_.uniform(8, 13)));
    for (int i = 0; i < houses; ++i) {
      Rectangle front;
      front.corner = corner + right * (length * i / houses) + Vector3<double>(0, 0, kFront);
      front.right = right;
      front.width = length / houses;
      front.height = kFront;
      city_.fronts.push_back(front);
      furnish(front);
    }
  }

  void furnish(const Rectangle& front) {
    if (!chains_.empty() && random_.chance(kChainHouses)) {
      const Chain& chain = chains_[static_cast<std::size_t>(random_.below(static_cast<int>(chains_.size())))];
      for (std::size_t k = 0; k < chain.signs.size(); ++k)
        hang(front, kPitch * (static_cast<double>(k) + 0.5), chain.signs[k]);
      return;
    }
    const int signs = 1 + random_.below(4);
    const double room = front.width / signs;
    for (int k = 0; k < signs; ++k) {
      const Wanted sign = any_sign(room);
      const double play = 0.5 * (room - sign.width) - 0.1;
      hang(front, room * (k + 0.5) + (play > 0 ? random_.uniform(-play, play) : 0), sign);
    }
  }

  void hang(const Rectangle& front, double s, const Wanted& sign) {
    if (static_cast<int>(city_.signs.size()) >= options_.signs) return;
    const Rectangle text = on(front, s, sign.drop, sign.width, sign.height, kLift);
    city_.signs.push_back({sign.word, text, sign.look, sign.unique, sign.chain});
  }

  static constexpr double kFront = 9;           // m, height of houses
  static constexpr double kChainHouses = 0.19;  // of all: with two signs each, 15 % of the signs
  const CityOptions options_;
  const double slack_;
  Random random_;
  City city_;
  NameMaker names_;
  std::vector<std::string> common_;
  std::vector<Chain> chains_;
};

}  // namespace

bool City::is_street(double x, double y, double clear) const {
  constexpr double kOutermost = 12;
  if (columns.empty() || x < -kOutermost || y < -kOutermost || x > columns.back()[1] + kOutermost ||
      y > rows.back()[1] + kOutermost)
    return false;
  const auto inside = [&](const std::vector<Vector2<double>>& spans, double at) {
    return std::any_of(spans.begin(), spans.end(),
                       [&](const Vector2<double>& s) { return at > s[0] - clear && at < s[1] + clear; });
  };
  return !(inside(columns, x) && inside(rows, y));
}

City make_city(const CityOptions& options) {
  if (options.signs < 10 || options.signs > 1000000)
    throw InputError("city", 0, "the number of signs must be 10 to 1000000, not " + std::to_string(options.signs));
  City city;
  for (double slack = 1; static_cast<int>(city.signs.size()) < options.signs; slack *= 1.2)
    city = Builder(options, slack).build();
  return city;
}

}  // namespace textslam
