// The city, and searches in it: what it is made of, and that answers are right, repeatable, and none for another city.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "city/wall_of_signs.hpp"
#include "io/input_error.hpp"

namespace textslam {
namespace city_test {

TEST(City, IsTheSameForASeedAndAnotherForAnother) {
  const City a = make_city({500, 1}), b = make_city({500, 1}), c = make_city({500, 2});
  ASSERT_EQ(a.signs.size(), 500u);
  bool other = false;
  for (std::size_t i = 0; i < a.signs.size(); ++i) {
    EXPECT_EQ(a.signs[i].word, b.signs[i].word);
    EXPECT_EQ(a.signs[i].text.corner, b.signs[i].text.corner);
    EXPECT_EQ(a.signs[i].look, b.signs[i].look);
    other = other || a.signs[i].word != c.signs[i].word;
  }
  EXPECT_TRUE(other);
}

TEST(City, RepeatsThreeWordsInTenAndKeepsTheOthersUnique) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const City city = make_city({10000, seed});
    std::map<std::string, int> count;
    for (const CitySign& sign : city.signs) ++count[sign.word];
    int repeated = 0;
    for (const CitySign& sign : city.signs) {
      EXPECT_TRUE(!sign.unique || count[sign.word] == 1) << sign.word;
      repeated += count[sign.word] > 1 ? 1 : 0;
    }
    EXPECT_NEAR(repeated, 3000, 300) << seed;
  }
}

TEST(City, SignsHangOnFrontsTowardsTheStreet) {
  const City city = make_city({1000, 4});
  for (const CitySign& sign : city.signs) {
    const Vec3 before = sign.text.at(0.5 * sign.text.width, 0.5 * sign.text.height) + sign.text.normal();
    EXPECT_TRUE(city.is_street(before[0], before[1], 0.5));
    const int fronts = static_cast<int>(std::count_if(city.fronts.begin(), city.fronts.end(), [&](const Rectangle& f) {
      const auto inside = [&](const Vec3& p) {
        const double s = f.right.dot(p - f.corner), t = f.down.dot(p - f.corner);
        return s >= 0 && s <= f.width && t >= 0 && t <= f.height && std::abs(f.normal().dot(p - f.corner)) < 0.1;
      };
      return inside(sign.text.at(0, 0)) && inside(sign.text.at(sign.text.width, sign.text.height));
    }));
    EXPECT_EQ(fronts, 1) << sign.word;
  }
}

TEST(City, HasAllItsSignsWhateverTheSeed) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed)
    for (const int signs : {10, 300, 1000})
      EXPECT_EQ(make_city({signs, seed}).signs.size(), static_cast<std::size_t>(signs));
}

TEST(City, RefusesSizesOutOfRange) {
  EXPECT_THROW(make_city({9, 1}), InputError);
  EXPECT_THROW(make_city({1000001, 1}), InputError);
}

TEST(City, ReadersErrAsOftenAsTheyAreTold) {
  Random random(8);
  int letters = 0, same = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string word = "GALLERY", read = misread(word, 0.2, random);
    for (std::size_t k = 0; k < word.size() && read.size() == word.size(); ++k) {
      ++letters;
      same += word[k] == read[k] ? 1 : 0;
    }
  }
  EXPECT_GT(letters, 20000);
  EXPECT_NEAR(static_cast<double>(same) / letters, 0.82, 0.01);
}

class CitySearch : public testing::Test {
 protected:
  CitySearch() : city(make_city({1500, 11})), index(index_of(mapped_signs(city))) {
    trial.queries = 80;
    trial.seed = 11;
    trial.threads = 2;
    trial.search.upright = Upright();
  }
  std::vector<QueryResult> run(const City& shown, CityView view) {
    trial.view = view;
    return run_trial(shown, city, index, trial);
  }
  static int count(const std::vector<QueryResult>& results, bool QueryResult::*what) {
    return static_cast<int>(
        std::count_if(results.begin(), results.end(), [&](const QueryResult& r) { return r.*what; }));
  }
  const City city;
  const SignIndex index;
  CityTrial trial;
};

TEST_F(CitySearch, FindsThreeSignsAndSeldomMoreThanTheReaderAllows) {
  const auto three = run(city, CityView::three_signs), one = run(city, CityView::one_sign);
  EXPECT_GE(count(three, &QueryResult::first_right), 72);  // all three unread: 2.7 %
  EXPECT_EQ(count(three, &QueryResult::wrong), 0);
  EXPECT_GE(count(one, &QueryResult::first_right), 68);
  EXPECT_EQ(count(one, &QueryResult::wrong), 0);
}

TEST_F(CitySearch, AnotherCityHasNoAnswer) {
  const City other = make_city({1500, 12});
  for (const CityView view : {CityView::three_signs, CityView::any})
    EXPECT_EQ(count(run(other, view), &QueryResult::answered), 0);
}

TEST_F(CitySearch, DoesNotDependOnThreadsOrOrder) {
  trial.queries = 40;
  const auto two = run(city, CityView::any);
  trial.threads = 1;
  const auto one = run(city, CityView::any);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].probability, two[i].probability);
    EXPECT_EQ(one[i].position_error, two[i].position_error);
    EXPECT_EQ(one[i].first_right, two[i].first_right);
  }
}

}  // namespace city_test
}  // namespace textslam
