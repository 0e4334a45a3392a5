// What a second sign on one wall says of a place.
#include "sign_index/wall.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "city/wall_of_signs.hpp"

namespace textslam {
namespace city_test {

constexpr double kSigma = 1.5 / 525, kMissed = 0.35, kReach = 40;

SignCorners moved(const SE3d& T, SignCorners corners) {
  for (Vec3& corner : corners) corner = T * corner;
  return corners;
}

// Before a camera that looks straight at it, J^T J is diagonal: (4, 4, 1, 1) / z^2.
TEST(Wall, APeakIsThatOfTheFourNumbersOfARectangle) {
  const double width = 0.8, height = 0.2, z = 5;
  const SE3d T_c_w = camera_at(3, z, 0).inverse();
  const double density = 1 / (0.5 * kReach * 0.1 * kReach * 2 * height * 3 * width);
  const double expected = std::log((1 - kMissed) / 2) - std::log(density) + std::log(4 / std::pow(z, 4)) -
                          2 * std::log(2 * M_PI * kSigma * kSigma);
  const SignCorners middle = sign_at(3, 1.6, "", width, height).corners;
  EXPECT_NEAR(log_wall_peak(middle, {T_c_w, kSigma, kMissed, kReach}), expected, 1e-9);
  const SignCorners twice = sign_at(3, 1.6, "", 2 * width, height).corners;
  EXPECT_GT(log_wall_peak(twice, {T_c_w, kSigma, kMissed, kReach}), expected)
      << "wide ones are rarer: their corners lie wider";
  SE3d world;
  world.R = textplane::so3_exp<double>(Vec3(0.3, -1, 2));
  world.t = Vec3(100, -20, 3);
  const SignCorners corners = sign_at(3.5, 2.2, "", width, height).corners;
  const SE3d T = camera_at(3, z, 0.4).inverse();
  EXPECT_NEAR(log_wall_peak(moved(world, corners), {T * world.inverse(), kSigma, kMissed, kReach}),
              log_wall_peak(corners, {T, kSigma, kMissed, kReach}), 1e-6);
}

TEST(Wall, SignsOnOneWallAreFlushAndFaceTheSameWay) {
  const SignCorners a = sign_at(0, 2, "").corners, b = sign_at(2, 2.5, "").corners;
  const auto turned = [&](double degrees) {
    SE3d about;
    about.R = textplane::so3_exp<double>(Vec3(0, 0, degrees * M_PI / 180));
    const Vec3 centre(2, 0, 2.5);
    about.t = centre - about.R * centre;
    return moved(about, b);
  };
  const auto proud = [&](double metres) {
    SE3d out;
    out.t = Vec3(0, -metres, 0);
    return moved(out, b);
  };
  EXPECT_TRUE(on_one_wall(a, b));
  EXPECT_TRUE(on_one_wall(a, turned(8)));
  EXPECT_FALSE(on_one_wall(a, turned(12)));
  EXPECT_FALSE(on_one_wall(a, turned(180))) << "the other side of the wall";
  EXPECT_TRUE(on_one_wall(a, proud(0.15)));
  EXPECT_FALSE(on_one_wall(a, proud(0.3)));
  EXPECT_FALSE(on_one_wall(a, proud(-0.3)));
}

// Two signs side by side are found on walls elsewhere, too.
TEST(Wall, APlaceWithBothSignsOnOneWallHasLessEvidence) {
  std::vector<MappedSign> signs = lonely_signs(50);
  signs.push_back(sign_at(61.5, 2.6, "", 0.8));
  const SE3d T_w_c = camera_at(60.5, 5);
  const auto evidence_of = [&] {
    PlaceOptions options;
    options.upright = Upright();
    const SignIndex index = index_of(signs);
    const PlaceAnswer answer = PlaceSearch(index, options).find(seen_from(signs, T_w_c), city_camera());
    EXPECT_FALSE(answer.places.empty());
    if (answer.places.empty()) return 0.0;
    EXPECT_EQ(answer.places.front().sightings.size(), 2u);
    return answer.places.front().log_evidence;
  };
  const double flush = evidence_of();
  for (Vec3& corner : signs.back().corners) corner.y() -= 0.4;
  EXPECT_GT(evidence_of(), flush + 3);
}

}  // namespace city_test
}  // namespace textslam
