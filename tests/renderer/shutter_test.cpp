// Rolling shutters of the renderer: each row is what the camera sees at the row's own time.
#include <gtest/gtest.h>

#include "io/io_support.hpp"
#include "renderer/exposure.hpp"
#include "renderer/kinds.hpp"
#include "renderer/render_sequence.hpp"
#include "renderer/renderer_support.hpp"
#include "renderer/truth.hpp"

namespace textslam {
namespace renderer_shutter_test {

TEST(RendererShutter, RowsAreThoseOfImagesTakenAtTheirTimes) {
  const Shot shot = make_shot("shutter", 3, 80, 60);
  EXPECT_EQ(shot.readout, 0.03);
  CameraModel camera = test_camera(80);
  const RayCaster at_once(camera, pixel_grid());
  camera.shutter = {0.03, 29.5, 60};
  const RayCaster rolling(camera, pixel_grid());
  const double time = 1.3;
  const Image<double> image = expose(shot.scene, rolling, shot.motion, time, shot.exposure, 8);
  bool differs = false;
  for (const int row : {0, 17, 30, 59}) {
    const double then = time + 0.03 * (row - 29.5) / 59;
    const Image<double> still = expose(shot.scene, at_once, shot.motion, then, shot.exposure, 8),
                        middle = expose(shot.scene, at_once, shot.motion, time, shot.exposure, 8);
    for (int x = 0; x < 80; ++x) {
      EXPECT_NEAR(image(x, row), still(x, row), 1e-9) << x << ' ' << row;
      differs = differs || std::abs(image(x, row) - middle(x, row)) > 1;
    }
  }
  EXPECT_TRUE(differs);
}

TEST(RendererShutter, QuadsAreWhereTheRowsShowThem) {
  const Shot shot = make_shot("shutter", 2, 640, 480);
  CameraModel camera = test_camera();
  camera.shutter = {0.03, 239.5, 480};
  int moved = 0;
  for (const double time : {0.5, 1.5, 2.5}) {
    const std::vector<SignView> at_once = views_of_signs(shot.scene, camera, shot.motion(time), time);
    std::vector<SignView> views = at_once;
    place_in_rows(camera, shot.motion, shot.scene.signs(), time, &views);
    ASSERT_FALSE(views.empty());
    for (std::size_t i = 0; i < views.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k) {
        const Vector2<double>& px = views[i].quad.corner[k];
        const SE3d T_c_w = shot.motion(time + camera.shutter.time(px[1])).inverse();
        Vector2<double> seen;
        ASSERT_TRUE(
            project(camera, T_c_w, shot.scene.signs()[static_cast<std::size_t>(views[i].sign)].corner[k], &seen));
        EXPECT_LT((seen - px).norm(), 1e-6);
        moved += (px - at_once[i].quad.corner[k]).norm() > 1;
      }
  }
  EXPECT_GT(moved, 0);
}

TEST(RendererShutter, TheCameraFileSaysHowLongItTakes) {
  const TemporaryFolder folder;
  RenderOptions options;
  options.kind = "shutter";
  options.output = folder.path("shutter");
  options.frames = 1;
  options.width = 80;
  options.height = 60;
  render_sequence(options);
  const textplane::RollingShutter shutter = read_sequence(options.output).camera.shutter;
  EXPECT_EQ(shutter.readout, 0.03);
  EXPECT_EQ(shutter.row0, 29.5);
  EXPECT_EQ(shutter.rows, 60);
  options.kind = "room";
  options.output = folder.path("room");
  render_sequence(options);
  EXPECT_FALSE(read_sequence(options.output).camera.shutter.active());
}

}  // namespace renderer_shutter_test
}  // namespace textslam
