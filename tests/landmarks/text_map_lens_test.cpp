// TextMap on images behind a lens: raw pixels in, the planes of the world out.
#include "landmarks/text_map_support.hpp"
#include "textplane/landmarks/text_terms.hpp"

namespace text_map_test {
namespace {
using textplane::KannalaBrandt;
using textplane::LensMap;
using textplane::RadialTangential;

class TextMapLensTest : public TextMapTest, public testing::WithParamInterface<bool> {
 protected:
  TextMapLensTest() : lens_(map_of(GetParam())) { scene.lens = &lens_; }

  static LensMap map_of(bool fisheye) {
    if (fisheye) return LensMap(KannalaBrandt<double>{{}, 0.01, -0.003, 0.002, -0.001});
    return LensMap(RadialTangential<double>{{}, -0.28, 0.07, 1e-3, -5e-4, 0});
  }
  const LensMap lens_;
};

TEST_P(TextMapLensTest, MapsAndTracksRawImages) {
  TextMap map(scene.view());
  walk(map, 7);
  EXPECT_EQ(mapped(map), 3);
  EXPECT_LT(largest_angle(map), 1) << "degrees";
  const SE3d truth = pose(3.5);
  Vec6 xi;
  xi << 0.008, -0.006, 0.004, 0.002, -0.002, 0.004;
  const TextFit& fit = map.track(image(truth), textplane::se3_exp<double>(xi) * truth, points(truth, 0.5));
  ASSERT_TRUE(fit.refined);
  EXPECT_EQ(fit.texts, 3);
  EXPECT_LT(shift(fit.T_c_w, truth), 6e-3);
  const TextFit& alone = map.track(image(truth), textplane::se3_exp<double>(xi) * truth, {});
  ASSERT_TRUE(alone.refined);
  EXPECT_LT(shift(alone.T_c_w, truth), 6e-3);
  const auto all = textplane::text_terms(map, [](int) { return true; });
  EXPECT_GE(all.terms.size(), 6U);
}

TEST_P(TextMapLensTest, PixelsAloneMapTexts) {
  TextMap map(scene.view());
  walk(map, 7, [](const SE3d&) { return std::vector<TextPoint>(); });
  EXPECT_EQ(mapped(map), 3);
  EXPECT_LT(largest_angle(map), 1.5) << "degrees";
}

// The same raw images without their lens: the planes are off, so the tests above can fail.
TEST_P(TextMapLensTest, WithoutItsLensTheWorldIsBent) {
  TextMap map(scene.camera);
  walk(map, 7);
  EXPECT_GT(mapped(map) < 3 ? 90 : largest_angle(map), 2) << "degrees";
}

INSTANTIATE_TEST_SUITE_P(Lenses, TextMapLensTest, testing::Bool(),
                         [](const auto& which) { return which.param ? "fisheye" : "radial_tangential"; });

}  // namespace
}  // namespace text_map_test
