// Place search in small maps: one sign, equal signs, reading errors, places elsewhere, and what is no query.
#include "sign_index/place_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "city/wall_of_signs.hpp"

namespace textslam {
namespace city_test {

using textplane::Status;

PlaceOptions sure_enough(double probability) {
  PlaceOptions options;
  options.least_probability = probability;
  options.upright = Upright();
  return options;
}

TEST(PlaceSearch, ASignAloneFindsItsPlace) {
  const auto signs = lonely_signs(200);
  const SignIndex index = index_of(signs);
  PlaceSearch search(index, sure_enough(0.99));
  for (int i = 0; i < 200; i += 13) {
    const SE3d T_w_c = camera_at(30.0 * i + 0.5, 4);
    const auto seen = seen_from(signs, T_w_c);
    ASSERT_EQ(seen.size(), 1u);
    const PlaceAnswer answer = search.find(seen, city_camera());
    ASSERT_EQ(answer.status, Status::ok) << i;
    ASSERT_EQ(answer.places.front().sightings.size(), 1u);
    EXPECT_EQ(index.id(answer.places.front().sightings[0].sign), signs[static_cast<std::size_t>(i)].id);
    EXPECT_LT((answer.places.front().T_c_w.inverse().t - T_w_c.t).norm(), 0.01);
    EXPECT_LT(degrees(answer.places.front().T_c_w.R * T_w_c.R), 0.1);
  }
}

// Ten equal signs 60 m apart; beside each a sign of its own.
class EqualSigns : public testing::Test {
 protected:
  EqualSigns() {
    NameMaker names;
    Random random(6);
    for (int i = 0; i < 10; ++i) {
      signs.push_back(sign_at(60.0 * i, 2.2, "EXIT", 0.8));
      signs.push_back(sign_at(60.0 * i + 1.5, 1.9, names.make(random)));
    }
  }
  std::vector<MappedSign> signs;
};

TEST_F(EqualSigns, AloneGiveNoAnswerButTenGuesses) {
  const SignIndex index = index_of(signs);
  PlaceOptions options = sure_enough(0.5);
  options.most_places = 20;
  PlaceSearch search(index, options);
  auto seen = seen_from(signs, camera_at(180.5, 5, 0));
  ASSERT_EQ(seen.size(), 2u);
  seen.pop_back();  // its neighbour is missed
  const PlaceAnswer answer = search.find(seen, city_camera());
  EXPECT_EQ(answer.status, Status::diverged);
  ASSERT_EQ(answer.places.size(), 10u);
  for (const FoundPlace& place : answer.places) EXPECT_NEAR(place.probability / answer.places[0].probability, 1, 1e-3);
}

TEST_F(EqualSigns, AreToldApartByWhatStandsBesideThem) {
  const SignIndex index = index_of(signs);
  PlaceSearch search(index, sure_enough(0.99));
  for (int i = 0; i < 10; ++i) {
    const SE3d T_w_c = camera_at(60.0 * i + 0.5, 5, 0);
    const auto seen = seen_from(signs, T_w_c);
    ASSERT_EQ(seen.size(), 2u);
    const PlaceAnswer answer = search.find(seen, city_camera());
    ASSERT_EQ(answer.status, Status::ok) << i;
    EXPECT_EQ(answer.places.front().sightings.size(), 2u);
    EXPECT_LT((answer.places.front().T_c_w.inverse().t - T_w_c.t).norm(), 0.01);
  }
}

TEST_F(EqualSigns, AreToldApartByAnUnreadNeighbourInAnotherPlace) {
  signs[7].corners = sign_at(178.2, 2.9, "", 1.0).corners;  // the fourth: on the other side, and higher
  const SignIndex index = index_of(signs);
  PlaceSearch search(index, sure_enough(0.99));
  const SE3d T_w_c = camera_at(179.5, 5, 0.1);
  auto seen = seen_from(signs, T_w_c);
  ASSERT_EQ(seen.size(), 2u);
  seen[1].text = kUnreadText;
  const PlaceAnswer answer = search.find(seen, city_camera());
  ASSERT_EQ(answer.status, Status::ok);
  EXPECT_LT((answer.places.front().T_c_w.inverse().t - T_w_c.t).norm(), 0.01);
}

TEST(PlaceSearch, MisreadLettersStillLeadToTheSign) {
  const auto signs = lonely_signs(200);
  const SignIndex index = index_of(signs);
  PlaceSearch search(index, sure_enough(0.9));
  const auto right = seen_from(signs, camera_at(90, 4));
  ASSERT_EQ(right.size(), 1u);
  const std::size_t letters = right[0].text.size();
  for (std::size_t k = 0; k + 1 < letters; ++k) {
    std::vector<std::vector<Detection>> readings(3, right);
    readings[0][0].text[k] = 'Q';                                           // one letter wrong
    readings[1][0].text[(k + 3) % letters] = readings[1][0].text[k] = 'X';  // two
    readings[2][0].text.erase(k, 1);                                        // one left out
    for (const auto& reading : readings) {
      const PlaceAnswer answer = search.find(reading, city_camera());
      ASSERT_FALSE(answer.places.empty()) << reading[0].text;
      EXPECT_EQ(index.id(answer.places[0].sightings[0].sign), signs[3].id)
          << reading[0].text << " of " << right[0].text;
    }
  }
}

TEST(PlaceSearch, TheRightWordOnAQuadThatDoesNotFitIsNoPlace) {
  const auto signs = lonely_signs(50);
  const SignIndex index = index_of(signs);
  PlaceSearch search(index, sure_enough(0.9));
  auto seen = seen_from(signs, camera_at(300, 4));
  ASSERT_EQ(seen.size(), 1u);
  const double middle = textplane::centroid(seen[0].quad)[0];
  for (auto& corner : seen[0].quad.corner) corner[0] = middle + 0.4 * (corner[0] - middle);  // much narrower
  const PlaceAnswer answer = search.find(seen, city_camera());
  EXPECT_EQ(answer.status, Status::diverged);
}

TEST(PlaceSearch, WhatIsNoQueryGetsAStatus) {
  const auto signs = lonely_signs(20);
  const SignIndex index = index_of(signs);
  PlaceSearch search(index);
  const auto seen = seen_from(signs, camera_at(30, 4));
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(search.find({}, city_camera()).status, Status::too_few);
  EXPECT_EQ(search.find(seen, CameraModel()).status, Status::invalid_argument);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    auto broken = seen;
    broken[0].quad.corner[2][1] = bad;
    const PlaceAnswer answer = search.find(broken, city_camera());
    EXPECT_EQ(answer.status, Status::non_finite);
    EXPECT_TRUE(answer.places.empty());
    PlaceOptions options;
    options.corner_sigma = bad;
    EXPECT_EQ(PlaceSearch(index, options).find(seen, city_camera()).status, Status::invalid_argument);
  }
  auto unread = seen;
  unread[0].text = kUnreadText;
  EXPECT_EQ(search.find(unread, city_camera()).status, Status::too_few);
  auto bow_tie = seen;
  std::swap(bow_tie[0].quad.corner[0], bow_tie[0].quad.corner[1]);
  EXPECT_EQ(search.find(bow_tie, city_camera()).status, Status::too_few);
  const SignIndex empty;
  EXPECT_EQ(PlaceSearch(empty).find(seen, city_camera()).status, Status::too_few);
}

}  // namespace city_test
}  // namespace textslam
