// Scattered points through a homography on every target: against double arithmetic, bit for bit between the targets of
// a group, and without a touch of memory that is not theirs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "photometry/scene.hpp"
#include "simd/rounding_support.hpp"
#include "support/guarded.hpp"
#include "support/targets.hpp"
#include "textplane/photometry/prepared_target.hpp"
#include "textplane/photometry/residual.hpp"

namespace sample_points_test {
namespace tp = textplane;
using namespace textplane_test;

struct Points {
  std::vector<float> x, y, out_x, out_y, value, gx, gy;
  std::vector<std::uint8_t> inside;
  simd::PointArgs args;

  Points(int n, unsigned seed, const tp::ImageView8& image) {
    Random random(seed);
    for (int i = 0; i < n; ++i) {
      x.push_back(static_cast<float>(random.uniform(60, 180)));
      y.push_back(static_cast<float>(random.uniform(40, 90)));
    }
    const auto size = static_cast<std::size_t>(n);
    for (auto* v : {&out_x, &out_y, &value, &gx, &gy}) v->assign(size, -1);
    inside.assign(size, 7);
    const double h[9] = {1.1 + random.uniform(-0.2, 0.2), random.uniform(-0.3, 0.3),       random.uniform(-60, 20),
                         random.uniform(-0.3, 0.3),       0.9 + random.uniform(-0.2, 0.2), random.uniform(-30, 40),
                         random.uniform(-1e-3, 1e-3),     random.uniform(-1e-3, 1e-3),     1};
    std::memcpy(args.h, h, sizeof h);
    args.x = x.data();
    args.y = y.data();
    args.n = n;
    args.out_x = out_x.data();
    args.out_y = out_y.data();
    args.inside = inside.data();
    args.value = value.data();
    args.gx = gx.data();
    args.gy = gy.data();
    args.image.data = image.data();
    args.image.stride = image.stride();
    args.image.width = image.width();
    args.image.height = image.height();
  }
};

TEST(SamplePoints, AgreeWithDouble) {
  const auto image = texture<std::uint8_t>(200, 160, 3);
  const tp::PreparedTarget prepared(image.view());
  int inside = 0, outside = 0;
  for (int n = 1; n <= 600; n = n < 66 ? n + 1 : n * 2)
    for (const simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      SCOPED_TRACE(simd::to_string(target));
      Points p(n, static_cast<unsigned>(n), image.view());
      if (n % 2) {
        p.args.image.pairs = prepared.view().data;
        p.args.image.pair_stride = prepared.view().stride;
      }
      const simd::PointResult r = simd::sample_points(p.args);
      int count = 0;
      for (std::size_t i = 0; i < p.x.size(); ++i) {
        const double u = static_cast<double>(p.x[i]), v = static_cast<double>(p.y[i]), *h = p.args.h;
        const double z = h[6] * u + h[7] * v + h[8], x = (h[0] * u + h[1] * v + h[2]) / z,
                     y = (h[3] * u + h[4] * v + h[5]) / z;
        EXPECT_NEAR(static_cast<double>(p.out_x[i]) + r.ox, x, 2e-5);
        EXPECT_NEAR(static_cast<double>(p.out_y[i]) + r.oy, y, 2e-5);
        const auto on_line = [](double c) { return std::abs(c - std::round(c)) < 1e-4; };
        if (on_line(x) || on_line(y)) continue;
        double value = 0, gx = 0, gy = 0;
        const bool in = z > 0 && tp::sample_bilinear(tp::ImageView8(image.view()), x, y, &value, &gx, &gy);
        EXPECT_EQ(p.inside[i], in);
        count += in;
        (in ? inside : outside) += 1;
        // A gradient of at most 255 grey levels a px, and as much again of its change.
        EXPECT_NEAR(static_cast<double>(p.value[i]), value, 2e-5 * 255 * 2);
        EXPECT_NEAR(static_cast<double>(p.gx[i]), gx, 2e-5 * 255 * 4);
        EXPECT_NEAR(static_cast<double>(p.gy[i]), gy, 2e-5 * 255 * 4);
      }
      EXPECT_GE(r.inside, count);
    }
  EXPECT_GT(inside, 1000);
  EXPECT_GT(outside, 100);
}

// Targets with fused multiply-add agree to the bit, and so do those without; pairs change nothing.
TEST(SamplePoints, SameBitsWithinAGroup) {
  const auto image = texture<std::uint8_t>(200, 160, 4);
  const tp::PreparedTarget prepared(image.view());
  for (const int n : {1, 7, 15, 16, 17, 255, 256, 300}) {
    std::vector<Points> first[kRoundings];
    for (const simd::Target target : testable_targets())
      for (const bool paired : {false, true}) {
        const TargetScope scope(target);
        SCOPED_TRACE(simd::to_string(target));
        Points p(n, static_cast<unsigned>(n), image.view());
        if (paired) {
          p.args.image.pairs = prepared.view().data;
          p.args.image.pair_stride = prepared.view().stride;
        }
        EXPECT_GE(simd::sample_points(p.args).inside, 0);
        const std::vector<float> x = p.out_x, y = p.out_y;
        EXPECT_EQ(simd::warp_points(p.args).inside, std::count(p.inside.begin(), p.inside.end(), 1));
        EXPECT_EQ(x, p.out_x);
        EXPECT_EQ(y, p.out_y);
        std::vector<Points>& group = first[rounding(target)];
        if (group.empty()) group.push_back(p);
        const Points& q = group.front();
        EXPECT_EQ(p.out_x, q.out_x);
        EXPECT_EQ(p.out_y, q.out_y);
        EXPECT_EQ(p.value, q.value);
        EXPECT_EQ(p.gx, q.gx);
        EXPECT_EQ(p.gy, q.gy);
        EXPECT_EQ(p.inside, q.inside);
      }
  }
}

TEST(SamplePoints, RefusesWhatItCannotRead) {
  const auto image = texture<std::uint8_t>(40, 30, 4);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const simd::Target target : testable_targets()) {
    const TargetScope scope(target);
    for (int what = 0; what < 8; ++what) {
      Points p(20, 1, image.view());
      if (what == 0) p.args.h[4] = nan;
      if (what == 1) p.args.n = -1;
      if (what == 2) p.args.x = nullptr;
      if (what == 3) p.args.value = nullptr;
      if (what == 4) p.args.image.width = 1;
      if (what == 5) p.args.image.stride = 39;
      if (what == 6) p.args.image.data = nullptr;
      if (what == 7) p.args.h[2] = 1e300;
      EXPECT_EQ(simd::sample_points(p.args).inside, -1) << what;
      EXPECT_EQ(p.value[0], -1);
    }
    Points none(0, 1, image.view());
    float nothing = 0;
    none.args.x = none.args.y = &nothing;
    none.args.out_x = none.args.out_y = none.args.value = none.args.gx = none.args.gy = &nothing;
    EXPECT_EQ(simd::sample_points(none.args).inside, 0);
  }
}

// Image, pixels and mask each end, or begin, at a forbidden page; poses of every kind, NaN and infinity among them.
TEST(SamplePoints, TouchNothingElse) {
  Random random(8);
  for (int trial = 0; trial < 60; ++trial) {
    const int w = random.integer(2, 40), h = random.integer(2, 30), n = random.integer(1, trial % 5 == 0 ? 300 : 40);
    const auto size = static_cast<std::size_t>(w * h), count = static_cast<std::size_t>(n);
    const Guarded<std::uint8_t> image(size), mask(count), flags(count);
    const Guarded<float> x(count), y(count), v(count), ox(count), oy(count), value(count), gx(count), gy(count);
    const bool upper = trial % 2 == 0;
    const auto at = [upper](const auto& g) { return upper ? g.data() : g.front(); };
    for (std::size_t i = 0; i < size; ++i) at(image)[i] = static_cast<std::uint8_t>(random.integer(0, 255));
    for (std::size_t i = 0; i < count; ++i) {
      at(x)[i] = static_cast<float>(random.uniform(-20, 60));
      at(y)[i] = static_cast<float>(random.uniform(-20, 50));
      at(v)[i] = static_cast<float>(random.uniform(0, 255));
      at(mask)[i] = static_cast<std::uint8_t>(random.integer(0, 3));
    }
    tp::PhotometricInput in;
    in.patch = {at(x), at(y), at(v), trial % 3 ? at(mask) : nullptr, n};
    in.target = tp::ImageView8(at(image), w, h);
    in.host_camera = in.target_camera = tp::Pinhole<double>(50, 50, w / 2.0, h / 2.0);
    tp::PhotometricWorkspace workspace(n);
    const double extremes[6] = {
        0, 1, 3, 1e8, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()};
    const double size_of_motion = extremes[trial % 6];
    tp::SE3d T = tp::se3_exp<double>(random.twist(0.1, 0.2));
    T.t *= size_of_motion;
    const tp::Vector3<double> theta(random.uniform(-1, 1), random.uniform(-1, 1), 1);
    for (const simd::Target target : testable_targets()) {
      const TargetScope scope(target);
      const auto a = tp::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{in, theta, T}, workspace);
      const auto b = tp::linearise<tp::Parameters::pose>(tp::ResidualRequest{in, theta, T}, workspace);
      EXPECT_EQ(a.status, b.status);
      tp::evaluate(tp::ResidualRequest{in, theta, T}, workspace, in.patch.mask);
      simd::PointArgs p;
      p.x = at(x);
      p.y = at(y);
      p.n = n;
      p.h[2] = random.uniform(-50, 50);
      p.h[6] = random.uniform(-0.1, 0.1) * size_of_motion;
      p.image.data = at(image);
      p.image.width = w;
      p.image.stride = w;
      p.image.height = h;
      p.out_x = at(ox);
      p.out_y = at(oy);
      p.value = at(value);
      p.gx = at(gx);
      p.gy = at(gy);
      p.inside = at(flags);
      simd::sample_points(p);
      simd::warp_points(p);
      const Guarded<std::uint16_t> pairs(static_cast<std::size_t>(w * (h - 1)));
      simd::prepare_pair16(p.image, at(pairs), w);
      p.image.pairs = at(pairs);
      p.image.pair_stride = w;
      simd::sample_points(p);
    }
  }
}

}  // namespace sample_points_test
