// Readings of one word: how alike they are, and what they say together.
#include "textplane/landmarks/words.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace words_test {

using namespace textplane;

TEST(TextWords, LikenessFallsWithEveryLetter) {
  EXPECT_EQ(word_similarity("EXIT", "EXIT"), 1);
  EXPECT_EQ(word_similarity("", ""), 1);
  EXPECT_DOUBLE_EQ(word_similarity("Computer", "Comouter"), 0.75) << "another letter";
  EXPECT_DOUBLE_EQ(word_similarity("Computer", "Compuer"), 0.75) << "one left out";
  EXPECT_DOUBLE_EQ(word_similarity("Compute", "Computer"), 0.75) << "one added";
  EXPECT_DOUBLE_EQ(word_similarity("EXIT", "EXAM"), 0) << "half of it";
  EXPECT_EQ(word_similarity("EXIT", "OFFICE"), 0);
  EXPECT_EQ(word_similarity("EXIT", ""), 0);
}

TEST(TextWords, NoiseThatDiffersDoesNotSplitTheVotes) {
  // Each misread once, in another letter; a wrong word, read twice the same way, has more votes than any of them.
  EXPECT_EQ(consensus({{"Computer", 0.9}, {"Comquter", 0.8}, {"Computez", 0.8}, {"Gomputer", 0.8}, {"we", 1.4}}),
            "Computer");
}

TEST(TextWords, ReadingsAreBounded) {
  std::map<std::string, double> votes;
  for (int i = 0; i < 1000; ++i) {
    vote(&votes, "noise" + std::to_string(i), 0.5 + 0.001 * (i % 7));
    if (i % 5 == 0) vote(&votes, "EXIT", 0.4);
    if (i >= 600) vote(&votes, "MARKET", 0.9);
    ASSERT_LE(votes.size(), static_cast<std::size_t>(TextOptions{}.max_readings));
  }
  EXPECT_NEAR(votes.at("EXIT"), 200 * 0.4, 1e-9) << "the word that is read most is never left out";
  EXPECT_NEAR(votes.at("MARKET"), 400 * 0.9, 1e-9) << "one that comes late is heard";
  EXPECT_EQ(consensus(votes), "MARKET");
  EXPECT_EQ(votes.count("noise999"), 1u) << "the newest stays, else none could begin";
}

TEST(TextWords, AmongWordsThatAreNotAlikeTheVotesDecide) {
  EXPECT_EQ(consensus({{"OFTEN", 0.9}, {"SURE", 0.95}}), "SURE");
  EXPECT_EQ(consensus({{"A", 1}, {"B", 1}}), "A") << "the first in order";
  EXPECT_EQ(consensus({}), kUnreadText);
}

}  // namespace words_test
