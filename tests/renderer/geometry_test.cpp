// The pictures show the geometry that the truth states: ramps rendered and inverted, hits against a ray-plane
// intersection written on its own, the shutter's middle.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "renderer/exposure.hpp"
#include "renderer/random.hpp"
#include "renderer/renderer_support.hpp"
#include "textplane/core/se3.hpp"

namespace textslam {
namespace renderer_geometry_test {

constexpr int kTexels = 64;

/// Texel i along one side holds i: bilinear lookup gives back the texel coordinate, between the first and last centre.
Image<std::uint8_t> ramp(bool across) {
  Image<std::uint8_t> texture(across ? kTexels : 1, across ? 1 : kTexels);
  for (int i = 0; i < kTexels; ++i) texture(across ? i : 0, across ? 0 : i) = static_cast<std::uint8_t>(i);
  return texture;
}

Image<double> render(const Scene& scene, const CameraModel& camera, const SE3d& T_w_c) {
  Image<double> picture(camera.width, camera.height, 0.0);
  RayCaster(camera, {Vector2<double>::Zero()}).add(scene, T_w_c, 0, 1.0, 1.0, picture);
  return picture;
}

SE3d random_pose(Random& random, double turn) {
  textplane::Vector6<double> xi;
  for (int i = 0; i < 6; ++i) xi[i] = (i < 3 ? 0.4 : turn) * random.uniform(-1.0, 1.0);
  // A camera that looks along +y.
  SE3d forward;
  forward.R << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return textplane::se3_exp(xi) * forward;
}

// `share` of the image, at least, that the ramps cover.
void expect_ramps_invert(const CameraModel& camera, double share = 0.2) {
  Random random(5);
  for (int trial = 0; trial < 6; ++trial) {
    const Vector3<double> towards(random.uniform(-0.9, 0.9), -1.0, random.uniform(-0.6, 0.6));
    const Rectangle r = facing({0.0, 2.2, 0.1}, towards, 2.4, 1.7, random.uniform(-0.5, 0.5));
    const SE3d T_w_c = random_pose(random, 0.15), T_c_w = T_w_c.inverse();
    Scene across, along;
    across.add_unlit(r, ramp(true));
    along.add_unlit(r, ramp(false));
    const Image<double> s_picture = render(across, camera, T_w_c), t_picture = render(along, camera, T_w_c);
    int checked = 0;
    double worst = 0.0;
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const double s = s_picture(x, y), t = t_picture(x, y);
        // Beyond the outermost texel centres the ramp is flat.
        if (s <= 0.0 || t <= 0.0 || s >= kTexels - 1 || t >= kTexels - 1) continue;
        const Vector3<double> p = r.at((s + 0.5) / kTexels * r.width, (t + 0.5) / kTexels * r.height);
        Vector2<double> px;
        ASSERT_TRUE(project(camera, T_c_w, p, &px));
        worst = std::max(worst, (px - Vector2<double>(x, y)).norm());
        ++checked;
      }
    }
    EXPECT_GT(checked, share * camera.width * camera.height) << "trial " << trial;
    EXPECT_LT(worst, 1e-6) << "trial " << trial;
  }
}

TEST(RendererGeometry, ARampInvertsToPlaneCoordinatesThatReprojectToThePixel) { expect_ramps_invert(test_camera()); }

TEST(RendererGeometry, TheSameThroughALens) { expect_ramps_invert(test_camera(320, test_lens())); }

TEST(RendererGeometry, TheSameThroughAFisheye) { expect_ramps_invert(fisheye_camera(800), 0.05); }

void expect_nearest_surfaces(const CameraModel& camera, int least_covered) {
  Random random(9);
  Scene scene;
  std::vector<Rectangle> rectangles;
  const auto add = [&](const Rectangle& r) {
    rectangles.push_back(r);
    scene.add_unlit(r, Image<std::uint8_t>(2, 2, static_cast<std::uint8_t>(rectangles.size())));
  };
  for (int i = 0; i < 60; ++i) {
    const Vector3<double> centre(random.uniform(-2.5, 2.5), random.uniform(-1.0, 5.0), random.uniform(-2.0, 2.0));
    const Vector3<double> towards(random.normal(), random.normal(), 0.5 * random.normal());
    add(facing(centre, towards, random.uniform(0.2, 2.5), random.uniform(0.2, 2.5), random.uniform(0.0, 6.0)));
  }
  int covered = 0;
  for (int view = 0; view < 8; ++view) {
    const SE3d T_w_c = random_pose(random, 1.0);
    const Image<double> picture = render(scene, camera, T_w_c);
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        // Solve corner + s right + t down = eye + distance ray for each rectangle.
        Vector3<double> in_camera;
        if (!ray_of(camera, Vector2<double>(x, y), &in_camera)) {
          ASSERT_EQ(picture(x, y), 0.0) << "beyond the lens's circle";
          continue;
        }
        const Vector3<double> ray = T_w_c.R * in_camera;
        double nearest = 1e9, expected = 0.0;
        for (std::size_t i = 0; i < rectangles.size(); ++i) {
          const Rectangle& r = rectangles[i];
          if (ray.dot(r.down.cross(r.right)) >= 0.0) continue;  // from behind
          Matrix3<double> A;
          A << r.right, r.down, -ray;
          const Vector3<double> u = A.colPivHouseholderQr().solve(T_w_c.t - r.corner);
          const bool inside = u[0] >= 0.0 && u[0] <= r.width && u[1] >= 0.0 && u[1] <= r.height;
          if (inside && u[2] > 0.0 && u[2] < nearest) {
            nearest = u[2];
            expected = static_cast<double>(i + 1);
          }
        }
        ASSERT_EQ(picture(x, y), expected) << "view " << view << " pixel " << x << "," << y;
        const Hit hit = scene.first_hit(T_w_c.t, ray);
        ASSERT_EQ(hit.surface + 1, static_cast<int>(expected));
        if (hit.surface >= 0) {
          ASSERT_NEAR(hit.distance, nearest, 1e-9 * nearest);
          ++covered;
        }
      }
    }
  }
  EXPECT_GT(covered, least_covered);
}

TEST(RendererGeometry, EveryPixelShowsTheNearestSurfaceOnItsRay) {
  expect_nearest_surfaces(test_camera(160), 8 * 160 * 120 / 3);
}

TEST(RendererGeometry, SoDoesAFisheyeBeyond90Degrees) {
  const CameraModel camera = fisheye_camera(160);
  Vector3<double> ray;
  ASSERT_TRUE(ray_of(camera, {0, 59.5}, &ray));
  ASSERT_LT(ray[2], 0) << "behind the camera";
  ASSERT_FALSE(ray_of(camera, {1, 1}, &ray));
  expect_nearest_surfaces(camera, 8 * 160 * 120 / 4);
}

TEST(RendererGeometry, InstantsAndSamplesAreSymmetricAboutTheMiddle) {
  const std::vector<Vector2<double>> grid = pixel_grid();
  ASSERT_EQ(grid.size(), 4u);
  for (const int n : {4, 8, 12, 32}) {
    const std::vector<double> times = exposure_times(2.5, 0.01, n);
    ASSERT_EQ(times.size(), static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
      const std::size_t k = static_cast<std::size_t>(i), mirror = static_cast<std::size_t>(n - 1 - i);
      EXPECT_NEAR(times[k] + times[mirror], 5.0, 1e-15);
      EXPECT_GT(times[k], 2.495);
      EXPECT_LT(times[k], 2.505);
    }
  }
  EXPECT_EQ(instants_for(0.1), 4);
  EXPECT_GE(instants_for(15.0), 16);
  for (double blur = 0.5; blur < 60.0; blur += 0.7) EXPECT_EQ(instants_for(blur) % 8, 0);
}

TEST(RendererGeometry, WhereASampleLiesHasNothingToDoWithWhenItIsTaken) {
  const std::vector<Vector2<double>> grid = pixel_grid();
  for (const int n : {8, 16, 32}) {
    const std::vector<double> times = exposure_times(0.0, 1.0, n);
    Vector2<double> mean = Vector2<double>::Zero(), with_time = mean;
    for (int i = 0; i < n; ++i) {
      const Vector2<double>& at = grid[static_cast<std::size_t>(sample_at(i))];
      mean += at;
      with_time += times[static_cast<std::size_t>(i)] * at;
    }
    EXPECT_LT(mean.norm(), 1e-15) << n;
    EXPECT_LT(with_time.norm(), 1e-14) << n;
  }
}

TEST(RendererGeometry, ABlurredPictureBelongsToThePoseInTheMiddleOfTheExposure) {
  // Before a wall, moving along it: light is linear in time on a ramp, so the blurred picture is the one of the middle.
  const Rectangle wall = facing({0.0, 2.0, 0.0}, {0.0, -1.0, 0.0}, 4.0, 3.0);
  const CameraModel camera = test_camera(160);
  const Motion motion = [](double t) {
    SE3d T;
    T.R << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    T.t = {0.9 * t, 0.0, -0.4 * t};
    return T;
  };
  const double middle = 0.3, exposure = 0.05;
  for (const bool across : {true, false}) {
    Scene scene;
    scene.add_unlit(wall, ramp(across));
    const Blur blur = blur_of(scene, camera, motion, middle, exposure);
    const double expected = camera.pinhole().fx * std::hypot(0.9, 0.4) * exposure / 2.0;
    EXPECT_NEAR(blur.median, expected, 1e-9);
    EXPECT_NEAR(blur.max, expected, 1e-9);
    const Image<double> sharp = render(scene, camera, motion(middle));
    for (const int instants : {4, 8, 16}) {
      const Image<double> blurred = expose(scene, RayCaster(camera, pixel_grid()), motion, middle, exposure, instants);
      double worst = 0.0;
      for (int y = 0; y < camera.height; ++y) {
        for (int x = 0; x < camera.width; ++x) {
          if (sharp(x, y) < 3.0 || sharp(x, y) > kTexels - 4) continue;  // the flat ends of the ramp
          worst = std::max(worst, std::abs(blurred(x, y) - sharp(x, y)));
        }
      }
      EXPECT_LT(worst, 1e-9) << instants;
    }
    EXPECT_THROW(expose(scene, RayCaster(camera, pixel_grid()), motion, middle, exposure, 6), std::invalid_argument);
  }
}

TEST(RendererGeometry, FarTexturesAreAveragedNotAliased) {
  // A checkerboard of single texels, many to a pixel, straight on and at a grazing angle.
  Image<std::uint8_t> board(1024, 1024);
  for (int y = 0; y < 1024; ++y) {
    for (int x = 0; x < 1024; ++x) board(x, y) = (x + y) % 2 == 0 ? 255 : 1;
  }
  for (const double slant : {0.0, 4.0}) {
    Scene scene;
    scene.add_unlit(facing({0.0, 3.0, 0.0}, {slant, -1.0, 0.0}, 2.0, 2.0), board);
    SE3d T_w_c;
    T_w_c.R << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    const Image<double> picture = render(scene, test_camera(160), T_w_c);
    const Hit hit = scene.first_hit(T_w_c.t, {0.0, 1.0, 0.0});
    ASSERT_EQ(hit.surface, 0);
    for (int y = 50; y < 70; ++y) {
      for (int x = 77; x < 83; ++x) EXPECT_NEAR(picture(x, y), 128.0, 1.5);
    }
  }
}

}  // namespace renderer_geometry_test
}  // namespace textslam
