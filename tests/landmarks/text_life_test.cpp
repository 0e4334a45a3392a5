// When a text is believed, overdue, contradicted, or uncertain.
#include "textplane/landmarks/text_life.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

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

TEST(TextLife, WhatNoDetectorSawIsNotDetected) {
  TextOptions options;
  options.min_detections = 1;
  EXPECT_FALSE(is_detected(TextObject(), options));
}

TEST(TextLife, ATextBeginsWithAWholeQuadOnNoOtherText) {
  const TextOptions options;
  const auto box = [](double x, double y, double width, double height) {
    Quad<double> quad;
    quad.corner = {Vector2<double>(x, y), Vector2<double>(x + width, y), Vector2<double>(x + width, y + height),
                   Vector2<double>(x, y + height)};
    return quad;
  };
  const Quad<double> quad = box(50, 50, 60, 20);
  EXPECT_TRUE(may_begin(options, quad, 320, 240, {}));
  EXPECT_TRUE(may_begin(options, quad, 320, 240, {box(110, 50, 60, 20)})) << "beside another";
  EXPECT_FALSE(may_begin(options, quad, 320, 240, {box(200, 50, 60, 20), box(90, 50, 60, 20)})) << "a third on another";
  EXPECT_FALSE(may_begin(options, box(50, 50, 10, 10), 320, 240, {})) << "too small";
  EXPECT_FALSE(may_begin(options, box(options.border - 1, 50, 60, 20), 320, 240, {})) << "on the border";
  Quad<double> crossed = quad;
  std::swap(crossed.corner[0], crossed.corner[1]);
  EXPECT_FALSE(may_begin(options, crossed, 320, 240, {}));
}

TEST(TextLife, AKeyFrameIsAViewOrAFailureOrTellsNothing) {
  const TextOptions options;
  TextObject text;
  text.views = {2, 6};
  text.failures = 3;
  const auto count = [&](int id, double zncc, bool detected) {
    count_view(options, id, zncc, options.min_zncc, text, [=] { return detected; });
  };
  count(4, options.min_zncc, false);
  EXPECT_EQ(text.views, std::vector<int>({2, 4, 6}));
  EXPECT_EQ(text.failures, 0);
  count(7, options.cull_zncc - 0.01, false);
  EXPECT_EQ(text.failures, 1);
  count(8, options.cull_zncc - 0.01, true);
  EXPECT_EQ(text.failures, 1) << "the detector sees it";
  count(9, options.cull_zncc + 0.01, false);
  EXPECT_EQ(text.failures, 1) << "neither like it nor unlike";
  EXPECT_EQ(text.views.size(), 3U);
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
