// LensMap: the polynomials of a lens, its inverse, and where it ends; CameraView beside the models themselves.
#include "textplane/core/cameras/lens_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/random.hpp"
#include "textplane/core/cameras/camera_view.hpp"

namespace lens_map_test {
namespace tp = textplane;
using Vec2 = tp::Vector2<double>;
using Vec3 = tp::Vector3<double>;

const tp::Pinhole<double> kPinhole(310, 305, 320.5, 239.2);
std::vector<tp::AnyCamera<double>> cameras() {
  return {kPinhole,
          tp::RadialTangential<double>{kPinhole, -0.28, 0.07, 2e-4, 1.8e-5, 0.001},
          tp::Rational<double>{kPinhole, 0.4, 0.1, 1e-3, -5e-4, 0.01, 0.7, 0.15, 0.02},
          tp::KannalaBrandt<double>{kPinhole, 0.0034, 0.0007, -0.0020, 0.0002},
          tp::DoubleSphere<double>{kPinhole, -0.2, 0.6},
          tp::ExtendedUnified<double>{kPinhole, 0.6, 1.1},
          tp::Fov<double>{kPinhole, 0.9}};
}

// Whatever part of the domain is asked for, a piece holds it, to 1e-6 px at a focal length of 500 px.
TEST(LensMap, PiecesHoldTheLens) {
  textplane_test::Random random(2);
  for (const tp::AnyCamera<double>& camera : cameras()) {
    SCOPED_TRACE(camera.name());
    const tp::LensMap map(camera);
    ASSERT_GT(map.max_r2(), 0.5);
    int held = 0;
    for (int trial = 0; trial < 300; ++trial) {
      const double low = random.uniform(0, map.max_r2()), width = 0.3 * (1 + low),
                   high = std::min(low + random.uniform(0, width), map.max_r2());
      const tp::LensPiece* piece = map.piece(low, high);
      if (!piece) continue;
      ++held;
      for (const double share : {0.0, 0.3, 0.7, 1.0}) {
        const double r2 = low + share * (high - low);
        EXPECT_LT(std::abs(piece->at(r2) - map.radial(r2)) * std::sqrt(r2), 3e-9) << r2;
      }
    }
    EXPECT_EQ(held, 300);
    EXPECT_EQ(map.piece(0, map.max_r2() * 1.01), nullptr);
  }
}

TEST(LensMap, SeesAsTheModel) {
  textplane_test::Random random(3);
  for (const tp::AnyCamera<double>& model : cameras()) {
    SCOPED_TRACE(model.name());
    const tp::LensMap map(model);
    const tp::CameraView camera(model.pinhole(), &map);
    EXPECT_TRUE(camera.valid());
    for (int trial = 0; trial < 300; ++trial) {
      const double end = std::sqrt(map.max_r2()) * 0.999, r = random.uniform(0, end), a = random.uniform(-3.2, 3.2);
      const double z = random.uniform(0.5, 4);
      const Vec3 p(z * r * std::cos(a), z * r * std::sin(a), z);
      ASSERT_TRUE(camera.in_domain(p));
      tp::FixedMatrix<double, 2, 3> J, want_J;
      const Vec2 px = camera.project(p, &J), want = model.project(p, &want_J);
      EXPECT_LT((px - want).norm(), 1e-9);
      EXPECT_LT((J - want_J).norm(), 1e-9 * (1 + want_J.norm()));
      EXPECT_EQ(camera.project(p), px);
      Vec3 ray = Vec3::Zero();
      ASSERT_EQ(camera.unproject(px, &ray), tp::Status::ok) << r;
      EXPECT_LT((ray - Vec3(p / z)).norm(), 1e-9 * (1 + r * r)) << r;
      const int level = random.integer(0, 3);
      EXPECT_LT((camera.at_level(level).project(p) - model.at_level(level).project(p)).norm(), 1e-9);
    }
  }
}

TEST(LensMap, BordersOfTheDomain) {
  const tp::LensMap folded(tp::RadialTangential<double>{kPinhole, -0.8, 0, 0, 0, 0});
  const double end = std::sqrt(1 / 2.4);
  EXPECT_NEAR(folded.max_r2(), end * end, 1e-5);
  const tp::CameraView camera(kPinhole, &folded);
  EXPECT_TRUE(camera.in_domain({end - 1e-4, 0, 1}));
  EXPECT_FALSE(camera.in_domain({end + 1e-4, 0, 1}));
  EXPECT_FALSE(camera.in_domain({0, 0, -1}));
  EXPECT_FALSE(camera.in_domain({std::nan(""), 0, 1}));
  Vec3 ray(7, 7, 7);
  // The pixel of the fold, and a little beyond: no ray leads there.
  const double farthest = end * (1 - 0.8 * end * end);
  EXPECT_EQ(camera.unproject({kPinhole.fx * (farthest - 1e-3) + kPinhole.cx, kPinhole.cy}, &ray), tp::Status::ok);
  const Vec3 before = ray;
  EXPECT_EQ(camera.unproject({kPinhole.fx * (farthest + 1e-3) + kPinhole.cx, kPinhole.cy}, &ray),
            tp::Status::degenerate);
  EXPECT_EQ(camera.unproject({std::nan(""), 0}, &ray), tp::Status::non_finite);
  EXPECT_EQ(ray, before);
  // Text is seen up to 80 degrees off the axis.
  const tp::LensMap fisheye(tp::KannalaBrandt<double>{kPinhole, 0.0034, 0.0007, -0.0020, 0.0002});
  EXPECT_NEAR(std::atan(std::sqrt(fisheye.max_r2())) * 180 / 3.14159265, 80, 0.01);
}

TEST(LensMap, ABadCameraSeesNothing) {
  for (const tp::AnyCamera<double>& bad : std::vector<tp::AnyCamera<double>>{
           tp::RadialTangential<double>{kPinhole, std::nan(""), 0, 0, 0, 0},
           tp::RadialTangential<double>{{0, 300, 1, 1}, -0.28, 0, 0, 0, 0},
           tp::KannalaBrandt<double>{kPinhole, std::numeric_limits<double>::infinity(), 0, 0, 0}}) {
    const tp::LensMap map(bad);
    EXPECT_EQ(map.max_r2(), 0);
    EXPECT_EQ(map.piece(0, 0.1), nullptr);
    const tp::CameraView camera(kPinhole, &map);
    EXPECT_FALSE(camera.valid());
    Vec3 ray;
    EXPECT_EQ(camera.unproject({100, 100}, &ray), tp::Status::degenerate);
    Vec2 m;
    EXPECT_EQ(map.undistort(Vec2(0, 0), &m), tp::Status::degenerate) << "not even its middle";
  }
}

}  // namespace lens_map_test
