// What the texts say to an adjustment of the host's own.
#include "textplane/landmarks/text_terms.hpp"

#include <gtest/gtest.h>

#include "landmarks/text_map_support.hpp"
#include "textplane/landmarks/text_window.hpp"
#include "textplane/solver/window.hpp"

namespace text_map_test {
using textplane::StillViews;
using textplane::text_terms;
using textplane::TextPrior;
using textplane::TextTerm;
using textplane::TextTerms;

class TextTermsTest : public TextMapTest {
 protected:
  TextTermsTest() : map(scene.camera) { walk(map, kLast); }
  static bool is_newest(int id) { return id == kLast; }

  static constexpr int kLast = 7;
  TextMap map;
};

TEST_F(TextTermsTest, KeyFramesThatStayGiveNoTerms) {
  const TextTerms none = text_terms(map, [](int) { return false; });
  EXPECT_TRUE(none.terms.empty());
  EXPECT_TRUE(none.priors.empty());
}

TEST_F(TextTermsTest, AViewThatMovesGivesATermAndTheOthersAPrior) {
  const TextTerms found = text_terms(map, is_newest);
  ASSERT_EQ(found.terms.size(), 3U);
  ASSERT_EQ(found.priors.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const TextTerm& term = found.terms[i];
    EXPECT_EQ(term.text, found.priors[i].text);
    EXPECT_EQ(term.target, kLast);
    EXPECT_GT(term.zncc, 0.95);
    EXPECT_GT(term.visible, 15);
    // Its weight is that of as many independent residuals, divided by what the views vary by beyond that.
    const double variance = term.sigma_photo * term.sigma_photo;
    EXPECT_NEAR(variance, term.text->variance_factor * std::max(0.03, 2 * (1 - term.zncc)), 1e-12);
    EXPECT_NEAR(term.weight(), term.visible / variance, 1e-9 * term.weight());
    // One of its views moves; the prior is what the rest say.
    const double share = 1 - 1.0 / static_cast<double>(term.text->views.size());
    const textplane::Matrix3<double> identity = found.priors[i].information * term.text->covariance / share;
    EXPECT_LT((identity - textplane::Matrix3<double>::Identity()).norm(), 1e-6);
  }
}

TEST_F(TextTermsTest, AHostThatMovesIsHeldByViewsAndNotByAPrior) {
  const TextTerms found = text_terms(map, [&](int id) { return id == map.objects()[0].host; });
  ASSERT_FALSE(found.priors.empty());
  EXPECT_EQ(found.priors[0].text, &map.objects()[0]);
  EXPECT_EQ(found.priors[0].information.norm(), 0);
  std::size_t terms = 0;
  for (const TextTerm& term : found.terms) terms += term.text == &map.objects()[0] ? 1U : 0U;
  EXPECT_EQ(terms, map.objects()[0].views.size());
}

TEST_F(TextTermsTest, StillViewsMayBeTermsInPlaceOfAPrior) {
  const TextTerms found = text_terms(map, is_newest, StillViews::as_terms);
  EXPECT_GT(found.terms.size(), 9U);
  for (const TextPrior& prior : found.priors) EXPECT_EQ(prior.information.norm(), 0);
}

TEST_F(TextTermsTest, TheirNormalEquationsLeadAKeyFrameBack) {
  const SE3d truth = pose(kLast), start = textplane::se3_exp<double>(Random(4).twist(0.01, 0.004)) * truth;
  SE3d now = start;
  textplane::PhotometricWorkspace workspace;
  for (int round = 0; round < 6; ++round) {
    map.move([&](int id) { return id == kLast ? now : pose(id); });
    textplane::FixedMatrix<double, 6, 6> H = textplane::FixedMatrix<double, 6, 6>::Zero();
    Vec6 b = Vec6::Zero();
    for (const TextTerm& term : text_terms(map, is_newest).terms) {
      workspace.reserve(term.input.patch.n);
      const auto sums = textplane::linearise<textplane::Parameters::pose>(term.request(), workspace);
      ASSERT_EQ(sums.status, Status::ok);
      H += term.weight() * sums.H;
      b += term.weight() * sums.b;
    }
    now = textplane::se3_exp<double>(Vec6(-H.ldlt().solve(b))) * now;
  }
  EXPECT_LT(shift(now, truth), 0.1 * shift(start, truth));
}

TEST_F(TextTermsTest, AWindowWithTextsLeadsAKeyFrameBack) {
  const SE3d truth = pose(kLast), start = textplane::se3_exp<double>(Random(5).twist(0.01, 0.004)) * truth;
  map.move([&](int id) { return id == kLast ? start : pose(id); });
  textplane::Window window;
  window.camera = scene.camera;
  window.frames.resize(2);
  window.frames[0].T_w_c = start.inverse();
  window.frames[1].T_w_c = pose(kLast - 1).inverse();
  window.frames[1].fixed = true;
  textplane::WindowOptions options;
  textplane::WindowTexts texts(
      map, [](int id) { return id == kLast       ? 0
                               : id == kLast - 1 ? 1
                                                 : -1; }, options, window);
  EXPECT_EQ(texts.texts(), 3);
  ASSERT_GT(window.frames.size(), 2U);
  for (std::size_t f = 1; f < window.frames.size(); ++f) EXPECT_TRUE(window.frames[f].fixed);
  textplane::WindowWorkspace workspace;
  EXPECT_TRUE(is_ok(solve_window(window, options, workspace).status));
  EXPECT_LT(shift(window.frames[0].T_w_c.inverse(), truth), 0.1 * shift(start, truth));
  texts.write_back(window);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(map.objects()[i].theta, window.texts[i].theta);
}

TEST_F(TextTermsTest, SetPlaneRefusesWhatIsNoPlane) {
  const TextObject text = map.objects()[0];
  EXPECT_FALSE(map.set_plane(text.id, -text.theta)) << "its back";
  EXPECT_FALSE(map.set_plane(text.id, Vec3(kNaN, 0, 0)));
  EXPECT_FALSE(map.set_plane(77, text.theta)) << "unknown";
  EXPECT_EQ(map.objects()[0].theta, text.theta);
  EXPECT_TRUE(map.set_plane(text.id, 1.01 * text.theta));
  EXPECT_EQ(map.objects()[0].theta, Vec3(1.01 * text.theta));
}

}  // namespace text_map_test
