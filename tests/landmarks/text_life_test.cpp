// When a text is believed, overdue, contradicted, or uncertain.
#include "textplane/landmarks/text_life.hpp"

#include <gtest/gtest.h>

namespace text_life_test {

using namespace textplane;

// 3 false hits a frame at random places: a text is met by some in the long run, by far too few for what shows it.
TEST(TextLife, DetectionsCountAsAShareOfTheFramesThatCouldHaveShownIt) {
  const TextOptions options;
  TextObject text;
  for (int view = 1; view < options.min_observations; ++view) text.views.push_back(view);
  text.detections = options.min_detections;
  text.shown = options.min_detections;
  EXPECT_TRUE(is_proven(text, options));
  text.shown = static_cast<int>(text.detections / options.detected_share) + 1;
  EXPECT_FALSE(is_proven(text, options));
  EXPECT_FALSE(is_detected(text, options));
  text.detections = static_cast<int>(0.4 * text.shown);  // 60 % missed
  EXPECT_TRUE(is_proven(text, options));
  text.shown = text.detections = options.min_detections - 1;
  EXPECT_FALSE(is_proven(text, options)) << "too few to tell";
}

TEST(TextLife, PatienceEndsByTheState) {
  const TextOptions options;
  TextObject text;
  EXPECT_FALSE(is_overdue(text, options, options.patience));
  EXPECT_TRUE(is_overdue(text, options, options.patience + 1));
  text.state = TextState::tentative;
  EXPECT_FALSE(is_overdue(text, options, options.tentative_patience));
  EXPECT_TRUE(is_overdue(text, options, options.tentative_patience + 1));
  text.state = TextState::mapped;
  EXPECT_FALSE(is_overdue(text, options, 1000));
}

TEST(TextLife, FailuresOutweighTheViewsBeforeTheyContradict) {
  const TextOptions options;
  TextObject text;
  text.failures = options.max_failures - 1;
  EXPECT_FALSE(is_contradicted(text, options));
  text.failures = options.max_failures;
  EXPECT_TRUE(is_contradicted(text, options));
  text.views.assign(static_cast<std::size_t>(options.max_failures), 1);
  EXPECT_FALSE(is_contradicted(text, options));
  ++text.failures;
  EXPECT_TRUE(is_contradicted(text, options));
}

TEST(TextLife, WhatIsDroppedGivesItsMemoryBack) {
  TextObject text;
  text.id = 7;
  text.views = {1, 2};
  text.votes["EXIT"] = 1;
  text.patch.levels.resize(2);
  drop(text);
  EXPECT_EQ(text.state, TextState::dropped);
  EXPECT_EQ(text.id, 7);
  EXPECT_EQ(text.views.capacity(), 0U);
  EXPECT_TRUE(text.votes.empty());
  EXPECT_TRUE(text.patch.levels.empty());
}

}  // namespace text_life_test
