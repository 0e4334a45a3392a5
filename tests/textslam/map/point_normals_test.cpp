// Normals of map points by their neighbours, and what counts as a wide view.
#include "textslam/map/point_normals.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "textslam/common/wide_view.hpp"
#include "textslam/lens_support.hpp"
#include "textslam/map/observations.hpp"

namespace textslam {
namespace point_normals_test {

// A key frame at the origin of a map, turned, in a box of which it sees the front, the floor and the right wall.
struct Box {
  Map map;
  Parameters parameters;

  Box() {
    map.camera = {{217, 217, 319.5, 239.5}, &lens_support::fisheye()};
    map.width = 640;
    map.height = 480;
    KeyFrame keyframe;
    keyframe.T_w_c.R = textplane::so3_exp<double>(Vec3(0.3, -0.2, 0.5));
    keyframe.T_w_c.t = Vec3(1, 2, 3);
    map.keyframes.push_back(keyframe);
  }
  int add(const Vec3& p_c) {
    const int id = static_cast<int>(map.points.size());
    map.points.push_back({map.keyframe(0).T_w_c * p_c});
    add_observation(map, id, 0, map.camera.project(p_c));
    return id;
  }
  // Every 15 px over a rectangle of the image, on the plane n . p = d of the camera.
  void add_plane(const Vec3& n, double d, double x0, double y0, double x1, double y1, double ripple = 0) {
    int k = 0;
    for (double y = y0; y <= y1; y += 15)
      for (double x = x0; x <= x1; x += 15) {
        const Vec3 ray = ray_of(map.camera, {x, y});
        add(Vec3(ray * (d / n.dot(ray)) * (1 + (k++ % 2 == 0 ? ripple : -ripple))));
      }
  }
  double degrees_off(int id, const Vec3& n) const {
    return degrees_between(map.keyframe(0).T_w_c.R.transpose() * map.point(id).normal_w, n);
  }
};

TEST(PointNormals, AreThoseOfFrontFloorAndWall) {
  Box box;
  box.add_plane({0, 0, 1}, 3, 250, 180, 380, 300);
  const int front = static_cast<int>(box.map.points.size());
  box.add_plane({0, 1, 0}, 1.5, 250, 360, 380, 440);
  const int floor = static_cast<int>(box.map.points.size());
  box.add_plane({1, 0, 0}, 2, 440, 150, 560, 300);
  const int wall = static_cast<int>(box.map.points.size());
  box.parameters.normal_slope = 3;
  fit_point_normals(box.map, box.parameters, 0);
  for (int id = 0; id < wall; ++id) {
    const Vec3 n = id < front ? Vec3(0, 0, 1) : id < floor ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
    EXPECT_LT(box.degrees_off(id, n), 4) << id;
    EXPECT_NEAR(box.map.point(id).normal_w.norm(), 1, 1e-12);
  }
}

// With the default prior a noisy floor is still far nearer to its own normal than to the direction of view.
TEST(PointNormals, NoiseAndThePriorLeaveTheSlant) {
  Box box;
  box.add_plane({0, 1, 0}, 1.5, 250, 380, 380, 440, 0.01);
  fit_point_normals(box.map, box.parameters, 0);
  for (std::size_t i = 0; i < box.map.points.size(); ++i) {
    const Vec3 view = box.map.keyframe(0).T_w_c.inverse() * box.map.points[i].p_w;
    const double slant = degrees_between(view, Vec3(0, 1, 0));
    EXPECT_LT(box.degrees_off(static_cast<int>(i), {0, 1, 0}), 0.5 * slant) << i;
  }
}

TEST(PointNormals, WithoutNeighboursFaceTheCamera) {
  Box box;
  const Vec3 p(2, -1, 1.5);
  const int id = box.add(p);
  fit_point_normals(box.map, box.parameters, 0);
  EXPECT_LT(box.degrees_off(id, p), 1e-6);
}

// What stands far behind or before the surface does not turn it.
TEST(PointNormals, NeighboursOffTheSurfaceAreLeftOut) {
  Box box;
  box.add_plane({0, 0, 1}, 3, 280, 200, 360, 280);
  const int plane = static_cast<int>(box.map.points.size());
  for (const Vec2& px : {Vec2(275, 205), Vec2(275, 225), Vec2(275, 245), Vec2(275, 265)})
    box.add(Vec3(1.5 * ray_of(box.map.camera, px)));
  fit_point_normals(box.map, box.parameters, 0);
  for (int id = 0; id < plane; ++id) EXPECT_LT(box.degrees_off(id, {0, 0, 1}), 5) << id;
}

TEST(WideView, IsWhatReachesBeyond60Degrees) {
  const Parameters p;
  EXPECT_FALSE(is_wide(CameraView(525, 525, 319.5, 239.5), 640, 480, p));
  EXPECT_FALSE(is_wide({{525, 525, 319.5, 239.5}, &lens_support::wide_lens()}, 640, 480, p));
  EXPECT_TRUE(is_wide({{217, 217, 319.5, 239.5}, &lens_support::fisheye()}, 640, 480, p));
  EXPECT_TRUE(is_wide(CameraView(100, 100, 319.5, 239.5), 640, 480, p)) << "a pinhole of 145 degrees";
  EXPECT_TRUE(is_wide(CameraView(200, 200, 100, 239.5), 640, 480, p)) << "to one side";
}

TEST(WideView, MovesFewerPixelsAndIsFollowedByFewer) {
  const Parameters p;
  const Parameters narrow = at_view(p, CameraView(400, 400, 319.5, 239.5), 640, 480);
  EXPECT_EQ(narrow.keyframe_flow, p.keyframe_flow);
  EXPECT_EQ(narrow.klt_radius, p.klt_radius);
  const Parameters wide = at_view(p, {{210, 210, 319.5, 239.5}, &lens_support::fisheye()}, 640, 480);
  EXPECT_NEAR(wide.keyframe_flow, 0.4 * p.keyframe_flow, 1e-9);
  EXPECT_NEAR(wide.init_view_flow, 0.4 * p.init_view_flow, 1e-9);
  EXPECT_LT(wide.klt_radius, narrow.klt_radius);
  const Parameters twice = at_view(p, {{420, 420, 639.5, 479.5}, &lens_support::fisheye()}, 1280, 960);
  EXPECT_NEAR(twice.keyframe_flow, wide.keyframe_flow, 1e-9);
}

}  // namespace point_normals_test
}  // namespace textslam
