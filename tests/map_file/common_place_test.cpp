// Where one map lies in another: found with proof, or not at all.
#include "textslam_map/common_place.hpp"

#include <gtest/gtest.h>

#include "map_file/signs_support.hpp"
#include "textslam/common/geometry.hpp"

namespace textslam {
namespace common_place_test {

using namespace signs_support;

constexpr int kPlaces = 20;
const std::vector<std::string> kWords = {"EXIT",   "CANTEEN", "LIBRARY", "TOILETS", "OFFICE",
                                         "STAIRS", "PRINTER", "MEETING", "ARCHIVE", "KITCHEN"};
const Similarity kS{2.7, textplane::so3_exp<double>(Vec3(0.3, 2.1, -0.4)), {4, -7, 1.5}};

std::optional<CommonPlace> found(const Map& a, const Map& b, KnownScale scale = {}) {
  const textplane::TextOptions options;
  return find_common_place(map_signs(a, options), map_signs(b, options), options, scale);
}
// Of S_a_b against the truth, where b is the signs' world moved by kS and a is the signs' world.
void expect_inverse(const Similarity& S_a_b, double degrees_off, double share, double units) {
  const Similarity left = compose(S_a_b, kS);
  EXPECT_LT(degrees(left.R), degrees_off);
  EXPECT_NEAR(left.scale, 1, share);
  EXPECT_LT(left.t.norm(), units);
}
std::vector<std::string> some(std::size_t from, std::size_t count) {
  return {kWords.begin() + static_cast<std::ptrdiff_t>(from),
          kWords.begin() + static_cast<std::ptrdiff_t>(from + count)};
}

TEST(CommonPlace, AKnownSimilarityIsFound) {
  for (unsigned seed = 1; seed <= kPlaces; ++seed) {
    MapMaker make(seed);
    const auto signs = make.room(kWords);
    const auto place = found(make.map_of(signs), make.map_of(signs, kS));
    ASSERT_TRUE(place.has_value()) << seed;
    EXPECT_EQ(place->texts.size(), kWords.size());
    for (const auto& [a, b] : place->texts) EXPECT_EQ(a, b);
    expect_inverse(place->S_a_b, 1e-6, 1e-9, 1e-6);
  }
}

// Errors of boxes and planes as the covariances say: every place is found, and no sign is taken for another.
TEST(CommonPlace, NoiseIsWithinTheCovariances) {
  std::size_t agree = 0;
  for (unsigned seed = 1; seed <= kPlaces; ++seed) {
    MapMaker make(seed);
    const auto signs = make.room(kWords);
    const auto place = found(make.map_of(signs, {}, 1, 1), make.map_of(signs, kS, 1, 1));
    ASSERT_TRUE(place.has_value()) << seed;
    for (const auto& [a, b] : place->texts) EXPECT_EQ(a, b);
    agree += place->texts.size();
    expect_inverse(place->S_a_b, 1.5, 0.02, 0.15);
    EXPECT_LT(std::abs(place->S_a_b.scale * kS.scale - 1), 5 * place->scale_sigma);
    EXPECT_LT(place->scale_sigma, 0.02);
  }
  EXPECT_GT(agree, 0.95 * kPlaces * static_cast<double>(kWords.size()));
}

// The maps share some of their signs; the others are each map's own.
TEST(CommonPlace, APartInCommonIsEnough) {
  for (unsigned seed = 1; seed <= kPlaces; ++seed) {
    MapMaker make(seed);
    const auto all = make.room(kWords);
    const std::vector<Sign> first(all.begin(), all.begin() + 6), second(all.begin() + 3, all.end());
    const auto place = found(make.map_of(first, {}, 0.5, 0.5), make.map_of(second, kS, 0.5, 0.5));
    ASSERT_TRUE(place.has_value()) << seed;
    EXPECT_EQ(place->texts, (std::vector<std::pair<int, int>>{{3, 0}, {4, 1}, {5, 2}}));
  }
}

TEST(CommonPlace, OtherWordsAreNoCommonPlace) {
  for (unsigned seed = 1; seed <= kPlaces; ++seed) {
    MapMaker make(seed);
    EXPECT_FALSE(found(make.map_of(make.room(some(0, 5))), make.map_of(make.room(some(5, 5)))).has_value());
  }
}

// The same words hang elsewhere in another place.
TEST(CommonPlace, TheSameWordsElsewhereAreNoCommonPlace) {
  for (unsigned seed = 1; seed <= 3 * kPlaces; ++seed) {
    MapMaker make(seed);
    EXPECT_FALSE(found(make.map_of(make.room(kWords), {}, 1, 1), make.map_of(make.room(kWords), {}, 1, 1)).has_value())
        << seed;
  }
}

// Two or three words that two rooms share by chance, with planes known to a hundredth only.
TEST(CommonPlace, ChanceAgreesSeldom) {
  for (const std::size_t words : {2u, 3u}) {
    int wrong = 0;
    for (unsigned seed = 1; seed <= 1000; ++seed) {
      MapMaker make(seed);
      const Map a = make.map_of(make.room(some(0, words)), {}, 1, 1),
                b = make.map_of(make.room(some(0, words)), {}, 1, 1);
      wrong += found(a, b).has_value() ? 1 : 0;
    }
    EXPECT_LE(wrong, 5) << words << " words";
  }
}

TEST(CommonPlace, TwoSignsNeedWordsThatAreFoundOnce) {
  for (unsigned seed = 1; seed <= kPlaces; ++seed) {
    MapMaker make(seed);
    auto signs = make.room(some(0, 2));
    signs[1].T_w_s = signs[0].T_w_s * moved({2, 0.3, 0}, {0, 0.4, 0});
    EXPECT_TRUE(found(make.map_of(signs), make.map_of(signs, kS)).has_value()) << seed;
    EXPECT_FALSE(found(make.map_of({signs[0]}), make.map_of({signs[0]}, kS)).has_value()) << "one sign fits anywhere";
    auto more = signs;
    more.push_back({signs[0].word, signs[0].T_w_s * moved({-1, -0.5, 0}, {0, 0, 0})});
    EXPECT_FALSE(found(make.map_of(more), make.map_of(signs, kS)).has_value()) << "its word is there twice";
  }
}

// A corridor: doors of equal distances, whose words repeat.
std::vector<Sign> corridor(const std::vector<std::string>& words, std::size_t doors) {
  std::vector<Sign> signs;
  for (std::size_t i = 0; i < doors; ++i)
    signs.push_back({words[i % words.size()], moved({2.0 * static_cast<double>(i), 0, 3}, {0, 0, 0})});
  return signs;
}

TEST(CommonPlace, RepeatedWordsAreNoProof) {
  MapMaker make(1);
  const auto exits = corridor({"EXIT"}, 8);
  EXPECT_FALSE(found(make.map_of(exits), make.map_of(exits, kS)).has_value()) << "one word alone";
  const auto doors = corridor({"PULL", "LIFT"}, 12);
  EXPECT_FALSE(found(make.map_of(doors), make.map_of(doors, kS)).has_value()) << "it fits two doors on as well";
}

// Numbers on doors are alike, and tell the doors apart all the same.
TEST(CommonPlace, NumberedDoorsAreToldApart) {
  for (unsigned seed = 1; seed <= kPlaces; ++seed) {
    MapMaker make(seed);
    const auto rooms = corridor({"ROOM 101", "ROOM 102", "ROOM 103", "ROOM 104", "ROOM 105", "ROOM 106"}, 6);
    const auto upstairs = corridor({"ROOM 201", "ROOM 202", "ROOM 203", "ROOM 204", "ROOM 205", "ROOM 206"}, 6);
    auto with_lift = rooms, upstairs_lift = upstairs;
    for (auto* signs : {&with_lift, &upstairs_lift}) signs->push_back({"LIFT", moved({13, 0.5, 1}, {0, 1.2, 0})});
    const auto place = found(make.map_of(with_lift, {}, 0.5, 0.5), make.map_of(with_lift, kS, 0.5, 0.5));
    ASSERT_TRUE(place.has_value()) << seed;
    for (const auto& [a, b] : place->texts) EXPECT_EQ(a, b);
    EXPECT_GE(place->texts.size(), 6u);
  }
}

// Another floor: the lift and the stairs are at the same places, the rooms read otherwise.
TEST(CommonPlace, SignsThatReadOtherwiseSpeakAgainstIt) {
  MapMaker make(3);
  auto floor = make.room(some(0, 4)), other = floor;
  const auto place = found(make.map_of(floor), make.map_of(other, kS));
  EXPECT_TRUE(place.has_value());
  const char* const own[][2] = {{"SALES", "BIOLOGY"}, {"MUSIC", "DENTIST"}};
  for (int i = 0; i < 2; ++i) {
    const SE3d T = floor[0].T_w_s * moved({0.3 * i - 0.5, 0.6 + 0.4 * i, 0}, {0, 0, 0});
    floor.push_back({own[i][0], T});
    other.push_back({own[i][1], T});
  }
  EXPECT_FALSE(found(make.map_of(floor), make.map_of(other, kS)).has_value());
}

// A mirrored arrangement of signs that read the right way round is another place.
TEST(CommonPlace, MirroredConstellationsAreOtherPlaces) {
  const Eigen::Matrix3d mirror = Vec3(-1, 1, 1).asDiagonal();
  for (unsigned seed = 1; seed <= kPlaces; ++seed) {
    MapMaker make(seed);
    auto signs = make.room(kWords), mirrored = signs;
    std::vector<Sign> wall, mirrored_wall;
    for (std::size_t i = 0; i < signs.size(); ++i) {
      SE3d& T = mirrored[i].T_w_s;
      T.t = mirror * T.t;
      T.R = mirror * T.R * mirror;  // a rotation again: each sign is mirrored once more in itself
      wall.push_back({signs[i].word, moved({make.uniform(-4, 4), make.uniform(-1, 1), 3}, {0, 0, 0})});
      mirrored_wall.push_back({signs[i].word, moved(mirror * wall.back().T_w_s.t, {0, 0, 0})});
    }
    EXPECT_FALSE(found(make.map_of(signs), make.map_of(mirrored, kS)).has_value()) << seed;
    EXPECT_FALSE(found(make.map_of(wall), make.map_of(mirrored_wall, kS)).has_value()) << seed;
  }
}

TEST(CommonPlace, MetresAreMetres) {
  MapMaker make(4);
  const auto signs = make.room(kWords);
  const Similarity larger{1.2, kS.R, kS.t}, same{1.003, kS.R, kS.t};
  EXPECT_TRUE(found(make.map_of(signs), make.map_of(signs, larger)).has_value());
  EXPECT_FALSE(found(make.map_of(signs), make.map_of(signs, larger), 0.01).has_value());
  EXPECT_TRUE(found(make.map_of(signs), make.map_of(signs, same), 0.01).has_value());
}

}  // namespace common_place_test
}  // namespace textslam
