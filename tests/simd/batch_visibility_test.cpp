// Which pixels the batch sees at the image's border: those of the reference, on every target. Whole objects are judged
// by their corners first, so they lie across the border by hundredths of a pixel here.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "photometry/scene.hpp"
#include "support/targets.hpp"
#include "textplane/photometry/text_batch.hpp"

namespace batch_visibility_test {
namespace tp = textplane;
using namespace textplane_test;

constexpr int kWidth = 64, kHeight = 48, kSide = 5;

// 5 x 5 pixels about (x, y), `spacing` px apart, at the places that `T` moves host pixels to: the camera is one, so the
// identity keeps them. Offsets of 0.002 px and more keep samples clear of the border.
struct Object {
  std::vector<float> x, y, intensity;
  Object(double cx, double cy, double spacing) {
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) {
        x.push_back(static_cast<float>(cx + spacing * (i - 2)));
        y.push_back(static_cast<float>(cy + spacing * (j - 2)));
        intensity.push_back(static_cast<float>(100 + 37 * ((3 * i + 2 * j) % 5)));
      }
  }
  tp::PatchView view() const { return {x.data(), y.data(), intensity.data(), nullptr, kSide * kSide}; }
};

// Objects that this rotation brings to the borders of the image.
std::vector<Object> objects_at_borders(const tp::Pinhole<double>& camera, const tp::Matrix3<double>& R) {
  std::vector<Object> objects;
  const auto put = [&](double x, double y, double spacing) {
    const tp::Vector2<double> host = camera.project(R.transpose() * camera.unproject({x, y}));
    objects.emplace_back(host[0], host[1], spacing);
  };
  for (const double spacing : {0.011, 0.1, 0.31})
    for (double d = -1.0; d <= 1.0; d += 0.1) {
      const double off = d + 0.037;  // no sample on the border itself
      for (const double x : {off, kWidth - 1 + off}) put(x, 20.4, spacing);
      for (const double y : {off, kHeight - 1 + off}) put(30.4, y, spacing);
    }
  return objects;
}

TEST(BatchVisibility, IsThatOfTheReferenceAtEveryBorder) {
  const tp::Image<std::uint8_t> image = texture<std::uint8_t>(kWidth, kHeight, 3);
  const tp::Pinhole<double> camera(80, 80, 31.3, 23.8);
  tp::PhotometricOptions o;
  o.min_visible = 1;
  o.min_contrast = 0;
  const tp::Vector3<double> theta(0, 0, 0.5);
  const tp::SE3d nearly = tp::se3_exp<double>((tp::Vector6<double>() << 0, 0, 0, 1e-4, -2e-4, 0.001).finished());
  tp::SE3d turned;  // by a right angle, exactly
  turned.R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  for (const tp::SE3d& T : {tp::SE3d{}, nearly, turned}) {
    const std::vector<Object> objects =
        objects_at_borders(camera, T.R(0, 0) > 0 ? tp::Matrix3<double>::Identity() : T.R);
    std::vector<tp::TextBatchItem> items;
    for (const Object& object : objects) items.push_back({object.view(), camera, theta});
    const std::vector<tp::SE3d> poses(items.size(), T);
    const tp::TextBatch batch(items.data(), static_cast<int>(items.size()));
    tp::TextBatchResult result(batch);
    tp::PhotometricWorkspace workspace(kSide * kSide);
    for (const simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      SCOPED_TRACE(simd::to_string(target));
      ASSERT_EQ(tp::evaluate_batch(batch, image.view(), camera, poses.data(), o, result), tp::Status::ok);
      int partly = 0;
      for (std::size_t i = 0; i < items.size(); ++i) {
        const tp::PhotometricInput in{items[i].patch, camera, camera, image.view()};
        const auto exact = tp::reference::evaluate(tp::ResidualRequest{in, theta, T, o}, workspace);
        const int k = static_cast<int>(i);
        ASSERT_EQ(result.status(k), exact.status) << items[i].patch.x[12] << ' ' << items[i].patch.y[12] << ' '
                                                  << to_string(result.status(k)) << ' ' << to_string(exact.status);
        if (!tp::is_ok(exact.status)) continue;
        ASSERT_EQ(result.visible(k), exact.visible) << items[i].patch.x[12] << ' ' << items[i].patch.y[12];
        EXPECT_NEAR(result.error(k), exact.error, 1e-3);
        partly += exact.visible < kSide * kSide;
      }
      EXPECT_GT(partly, 40);
    }
  }
}

}  // namespace batch_visibility_test
