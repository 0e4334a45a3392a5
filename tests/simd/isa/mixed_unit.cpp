// One translation unit of a program whose units are compiled for different CPUs (mixed_main.cpp): what a tracker calls,
// from the image to pose and plane. TEXTPLANE_TEST_UNIT is the name of its function.
//
// The room landmarks is included and not called: it is for key frames, and its strings, maps and sorts are the standard
// library's, whose symbols the units of any program share.
#include <textplane/textplane.hpp>

#include <cstdint>
#include <vector>

/// Runs corners, KLT, patch, pose and plane on the image (width x height, 8 bits) as host and target; `result` receives
/// eight numbers. True when each of them succeeded.
bool TEXTPLANE_TEST_UNIT(const std::uint8_t* pixels, int width, int height, double* result) {
  namespace tp = textplane;
  const tp::ImageView<const std::uint8_t> image(pixels, width, height, width);
  const tp::Pinhole<double> camera(200, 200, width / 2.0, height / 2.0);
  const tp::Pyramid pyramid(image);

  std::vector<tp::Corner> corners;
  if (tp::detect_fast(image, 20, true, corners) != tp::Status::ok) return false;
  const tp::Vector2<float> from(static_cast<float>(width) / 2, static_cast<float>(height) / 2),
      guess = from + tp::Vector2<float>(1, -1);
  tp::KltResult tracked;
  tp::track_klt(pyramid, pyramid, &from, &guess, 1, tp::KltOptions(), &tracked);

  tp::Quad<double> quad;
  quad.corner = {tp::Vector2<double>(40, 30), tp::Vector2<double>(120, 30), tp::Vector2<double>(120, 90),
                 tp::Vector2<double>(40, 90)};
  const auto patch = tp::make_patch(image, camera, quad);
  const tp::Vector3<double> theta(0.02, -0.01, 0.5);
  tp::SE3d start;
  start.t = tp::Vector3<double>(0.004, -0.003, 0.002);
  const auto pose = tp::align_pose(patch, theta, start, pyramid, camera);
  const auto plane = tp::align_plane(patch, theta, start, pyramid, camera);

  result[0] = static_cast<double>(corners.size());
  result[1] = static_cast<double>(tracked.px.x());
  result[2] = static_cast<double>(tracked.px.y());
  result[3] = pose.zncc;
  result[4] = pose.T_t_h.t.norm();
  result[5] = plane.zncc;
  result[6] = pose.T_t_h.R(0, 2);
  result[7] = plane.theta[0];
  return is_ok(pose.status);
}
