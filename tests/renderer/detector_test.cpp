// The detector model errs as its options say.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "renderer/detector_model.hpp"
#include "renderer/renderer_support.hpp"

namespace textslam {
namespace renderer_detector_test {

const char* const kWords[] = {"EXIT", "LIBRARY", "MUSEUM", "STATION"};

/// Four whole signs, far apart.
struct Views {
  std::vector<Sign> signs;
  std::vector<SignView> views;
};
Views four_signs() {
  Views v;
  for (int i = 0; i < 4; ++i) {
    v.signs.push_back({i, kWords[i], {}, Vector3<double>::UnitZ()});
    const double x = 60.0 + 300.0 * (i % 2), y = 60.0 + 200.0 * (i / 2);
    SignView view;
    view.sign = i;
    view.quad.corner = {Vector2<double>{x, y}, {x + 120, y + 6}, {x + 118, y + 46}, {x + 2, y + 40}};
    view.visible = view.cosine = 1.0;
    v.views.push_back(view);
  }
  return v;
}

constexpr int kFrames = 5000;

TEST(RendererDetector, SharesAndJitterAreThoseOfTheOptions) {
  const Views v = four_signs();
  const CameraModel camera = test_camera();
  const DetectorErrors errors;
  int found = 0, right = 0, unread = 0, wrong = 0, stray = 0;
  double sum = 0.0, squares = 0.0, cross = 0.0;
  for (int frame = 0; frame < kFrames; ++frame) {
    int strays_here = 0;
    for (const Detection& d :
         detect(v.views, v.signs, camera, errors, Random(hash(1, 2, static_cast<std::uint64_t>(frame))))) {
      const SignView* own = nullptr;
      for (const SignView& view : v.views) {
        if ((d.quad.corner[0] - view.quad.corner[0]).norm() < 12.0 &&
            (d.quad.corner[2] - view.quad.corner[2]).norm() < 12.0)
          own = &view;
      }
      if (!own) {
        ++strays_here;
        EXPECT_TRUE(textplane::inside_image(d.quad, camera.width, camera.height));
        EXPECT_GT(textplane::area(d.quad), 100.0);
        continue;
      }
      ++found;
      const std::string& word = v.signs[static_cast<std::size_t>(own->sign)].word;
      if (d.text == word) {
        ++right;
      } else if (d.text == kUnreadText) {
        ++unread;
      } else {
        ++wrong;
        ASSERT_EQ(d.text.size(), word.size());
        int different = 0;
        for (std::size_t k = 0; k < word.size(); ++k) different += d.text[k] != word[k];
        EXPECT_EQ(different, 1);
      }
      for (std::size_t k = 0; k < 4; ++k) {
        const Vector2<double> e = d.quad.corner[k] - own->quad.corner[k];
        sum += e[0] + e[1];
        squares += e.squaredNorm();
        cross += e[0] * e[1];
      }
    }
    EXPECT_LE(strays_here, 1);
    stray += strays_here;
  }
  // Five standard deviations of each estimate.
  const auto share = [](int part, double whole, double expected) {
    EXPECT_NEAR(part / whole, expected, 5.0 * std::sqrt(expected * (1.0 - expected) / whole));
  };
  share(4 * kFrames - found, 4.0 * kFrames, 0.15);
  share(right, found, 0.9);
  share(unread, found, 0.05);
  share(wrong, found, 0.05);
  share(stray, kFrames, 0.1);
  const double n = 8.0 * found;
  EXPECT_NEAR(sum / n, 0.0, 5.0 * 1.5 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 1.5, 5.0 * 1.5 / std::sqrt(2.0 * n));
  EXPECT_NEAR(cross / (0.5 * n), 0.0, 5.0 * 2.25 / std::sqrt(0.5 * n));
}

TEST(RendererDetector, SweptErrorsAreMetOverTheirWholeRange) {
  const Views v = four_signs();
  const CameraModel camera = test_camera();
  for (const double missed : {0.0, 0.5, 1.0}) {
    for (const double strays : {0.0, 1.0, 2.5}) {
      const DetectorErrors errors{8.0, missed, strays, 1.0};
      int found = 0, stray = 0;
      double squares = 0.0;
      for (int frame = 0; frame < kFrames; ++frame) {
        int strays_here = 0;
        for (const Detection& d :
             detect(v.views, v.signs, camera, errors, Random(hash(2, 1, static_cast<std::uint64_t>(frame))))) {
          if (d.text == kUnreadText) {
            ++strays_here;
            continue;
          }
          ++found;
          for (const SignView& view : v.views) {
            if (v.signs[static_cast<std::size_t>(view.sign)].word != d.text) continue;
            for (std::size_t k = 0; k < 4; ++k) squares += (d.quad.corner[k] - view.quad.corner[k]).squaredNorm();
          }
        }
        EXPECT_GE(strays_here, std::floor(strays));
        EXPECT_LE(strays_here, std::ceil(strays));
        stray += strays_here;
      }
      const double whole = 4.0 * kFrames;
      EXPECT_NEAR(found / whole, 1.0 - missed, 5.0 * std::sqrt(missed * (1.0 - missed) / whole));
      EXPECT_NEAR(stray / static_cast<double>(kFrames), strays, 5.0 * 0.5 / std::sqrt(kFrames));
      if (found == 0) continue;
      EXPECT_NEAR(std::sqrt(squares / (8.0 * found)), 8.0, 5.0 * 8.0 / std::sqrt(16.0 * found));
    }
  }
}

TEST(RendererDetector, WithoutErrorsItReportsTheTruth) {
  const Views v = four_signs();
  const DetectorErrors none{0.0, 0.0, 0.0, 1.0};
  const std::vector<Detection> found = detect(v.views, v.signs, test_camera(), none, Random(1));
  ASSERT_EQ(found.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(found[i].text, kWords[i]);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(found[i].quad.corner[k], v.views[i].quad.corner[k]);
  }
}

TEST(RendererDetector, IllegibleSignsStayUndetectedAndPartialOnesUnread) {
  Views v = four_signs();
  const CameraModel camera = test_camera();
  const DetectorErrors none{0.0, 0.0, 0.0, 1.0};
  v.views[0].visible = 0.4;
  v.views[1].cosine = 0.2;
  for (Vector2<double>& c : v.views[2].quad.corner) c[1] = 300.0 + 0.15 * (c[1] - 300.0);  // 6 px high
  v.views[3].visible = 0.8;
  for (Vector2<double>& c : v.views[3].quad.corner) c[0] += 190.0;  // reaches out on the right
  const std::vector<Detection> found = detect(v.views, v.signs, camera, none, Random(1));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].text, kUnreadText);
  EXPECT_TRUE(textplane::inside_image(found[0].quad, camera.width, camera.height));
  EXPECT_EQ(found[0].quad.corner[1][0], camera.width - 1.0);
}

}  // namespace renderer_detector_test
}  // namespace textslam
