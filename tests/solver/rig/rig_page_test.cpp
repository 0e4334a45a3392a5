// The program of docs/integrate.md for a rig of cameras: tests/integrate_page.cmake.
#include <gtest/gtest.h>

#include <vector>

#include "rig.hpp"
#include "solver/synthetic.hpp"

namespace rig_page_test {
using namespace textplane_test::planar;

TEST(RigPage, StereoByPointsAndATextEach) {
  const Scene scene = three_signs();
  const SE3d truth = target_pose();
  SE3d right;
  right.t = Vec3(0.1, 0, 0);
  std::vector<tp::Pyramid> images;
  std::vector<TextPatch> patches;
  std::vector<Seen> rig;
  images.reserve(2);
  patches.reserve(2);
  for (const SE3d& T_r_c : {SE3d(), right}) {
    const SE3d T_c_w = T_r_c.inverse() * truth;
    const FloatPyramid rendered = scene.render(T_c_w);
    Image<std::uint8_t> image(Scene::kWidth, Scene::kHeight);
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        image(x, y) = static_cast<std::uint8_t>(std::lround(rendered.levels[0](x, y)));
    images.emplace_back(image.view(), 3);
    const Sign& sign = scene.signs[rig.size()];
    patches.push_back(scene.patch(sign));
    Seen seen{scene.camera, T_r_c, &images.back(), {}, {{&patches.back(), sign.theta, sign.T_w_h, 1}}};
    for (const Vec2& px : {Vec2(40, 50), Vec2(250, 60), Vec2(150, 200)})
      seen.points.push_back({T_c_w.inverse() * Vec3(3 * scene.camera.unproject(px)), px});
    rig.push_back(seen);
  }
  Random random(3);
  const tp::PoseFit fit = refine_rig(rig, tp::se3_exp<double>(random.twist(0.01, 0.005)) * truth);
  EXPECT_TRUE(is_ok(fit.status)) << to_string(fit.status);
  EXPECT_EQ(fit.texts, 2);
  EXPECT_EQ(fit.inlier_points, 6);
  EXPECT_LT(pose_distance(fit.T_t_w, truth), 2e-3);
}

}  // namespace rig_page_test
