// The index: what it refuses, what it finds by word and by place, and what it costs.
#include "sign_index/sign_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "city/wall_of_signs.hpp"

namespace textslam {
namespace city_test {

using textplane::Status;

TEST(ReadingModel, LikelihoodsOfAllReadingsSumToOne) {
  // Of a word of two letters, all readings of up to four letters in the 26 that a reader knows.
  const ReadingErrors errors;
  const Symbols word = symbols_of("AB");
  double sum = 0;
  for (int a = 0; a <= 26; ++a)
    for (int b = 0; b <= (a ? 26 : 0); ++b)
      for (int c = 0; c <= (b ? 26 : 0); ++c)
        for (int d = 0; d <= (c ? 26 : 0); ++d) {
          Symbols reading;
          for (const int letter : {a, b, c, d})
            if (letter) reading.push_back(static_cast<std::uint8_t>(letter));
          sum += std::exp(reading_log_likelihood(reading, word, errors));
        }
  EXPECT_NEAR(sum, 1, 1e-4);  // more letters are added once in many thousand times
}

TEST(ReadingModel, FewerErrorsAreLikelier) {
  const ReadingErrors errors;
  const auto log_likelihood = [&](const char* reading) {
    return reading_log_likelihood(symbols_of(reading), symbols_of("PHARMACY"), errors);
  };
  EXPECT_GT(log_likelihood("pharmacy"), log_likelihood("PHARMACX"));
  EXPECT_GT(log_likelihood("PHARMACX"), log_likelihood("PHARNACX"));
  EXPECT_GT(log_likelihood("PHARNACX"), log_likelihood("QHARNACX"));
  EXPECT_GT(log_likelihood("QHARNACX"), log_likelihood("BAKERY"));
}

TEST(WordIndex, FindsTheWordOfAReadingWithErrorsAmongThousands) {
  NameMaker names;
  Random random(7);
  std::vector<std::string> words;
  for (int i = 0; i < 5000; ++i) words.push_back(names.make(random));
  const WordIndex index(words, {});
  WordScratch scratch;
  int long_words = 0, found = 0;
  for (std::uint32_t w = 0; w < index.size(); w += 7) {
    EXPECT_EQ(index.word(w), symbols_of(words[w]));
    const auto exact = index.similar(symbols_of(words[w]), 10, 10, &scratch);
    ASSERT_FALSE(exact.empty());
    EXPECT_EQ(exact.front().word, w);
    if (words[w].size() < 7) continue;
    std::string wrong = words[w];
    wrong[2] = wrong[2] == 'Q' ? 'X' : 'Q';
    const auto similar = index.similar(symbols_of(wrong), 10, 10, &scratch);
    ++long_words;
    found += !similar.empty() && similar.front().word == w ? 1 : 0;
  }
  EXPECT_GT(long_words, 300);
  EXPECT_GT(found, 0.98 * long_words);
  EXPECT_TRUE(std::all_of(scratch.shared.begin(), scratch.shared.end(), [](int count) { return count == 0; }));
}

TEST(SignIndex, RefusesWhatIsNoMap) {
  const auto good = lonely_signs(5);
  SignIndex index;
  EXPECT_EQ(SignIndex::build({}, {}, &index), Status::ok);
  EXPECT_EQ(index.size(), 0u);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    auto signs = good;
    signs[3].corners[1][2] = bad;
    EXPECT_EQ(SignIndex::build(signs, {}, &index), Status::non_finite);
    EXPECT_EQ(index.size(), 0u);
    EXPECT_EQ(SignIndex::build(good, {bad, {}}, &index), Status::invalid_argument);
  }
  EXPECT_EQ(SignIndex::build(good, {0, {}}, &index), Status::invalid_argument);
  EXPECT_EQ(SignIndex::build(good, {1e-9, {}}, &index), Status::invalid_argument);
  auto flat = good;
  flat[2].corners = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)};
  EXPECT_EQ(SignIndex::build(flat, {}, &index), Status::degenerate);
}

TEST(SignIndex, KeepsEverySignOnceByWordAndByPlace) {
  const City city = make_city({2000, 3});
  const auto signs = mapped_signs(city);
  const SignIndex index = index_of(signs);
  ASSERT_EQ(index.size(), signs.size());
  std::vector<int> ids(signs.size(), 0), by_word(signs.size(), 0);
  for (std::uint32_t i = 0; i < index.size(); ++i) {
    const MappedSign& sign = signs[static_cast<std::size_t>(index.id(i))];
    ++ids[static_cast<std::size_t>(index.id(i))];
    EXPECT_EQ(index.words().word(index.word(i)), symbols_of(sign.word));
    for (std::size_t k = 0; k < 4; ++k) EXPECT_LT((index.corner(i, k) - sign.corners[k]).norm(), 1e-3);
    EXPECT_LE(index.first_of(index.cell(i)), i);
    EXPECT_GT(index.first_of(index.cell(i) + 1), i);
  }
  for (std::uint32_t w = 0; w < index.words().size(); ++w)
    for (const std::uint32_t sign : index.signs_of(w)) ++by_word[sign];
  EXPECT_EQ(ids, std::vector<int>(signs.size(), 1));
  EXPECT_EQ(by_word, std::vector<int>(signs.size(), 1));
  // What is within reach lies in the cells around.
  for (std::uint32_t i = 0; i < index.size(); i += 97)
    for (std::uint32_t j = 0; j < index.size(); ++j) {
      const auto around = index.around(index.cell(i));
      const bool is_around = std::find(around.begin(), around.end(), index.cell(j)) != around.end();
      EXPECT_TRUE(is_around || (index.centre(i) - index.centre(j)).norm() >= index.reach()) << i << " " << j;
    }
}

TEST(SignIndex, UnreadSignsHaveNoWord) {
  auto signs = lonely_signs(4);
  signs[1].word = kUnreadText;
  const SignIndex index = index_of(signs);
  EXPECT_EQ(index.words().size(), 3u);
  for (std::uint32_t i = 0; i < index.size(); ++i)
    EXPECT_EQ(index.word(i) == SignIndex::kNoWord, index.id(i) == signs[1].id);
}

}  // namespace city_test
}  // namespace textslam
