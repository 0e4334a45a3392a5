// The solvers on any input: a pose that comes back is finite where the first one was, an ok status comes with finite
// numbers, and the cost is never worse than at the start.
#include <vector>

#include "fuzz_solvers.hpp"
#include "fuzz_world.hpp"
#include "textplane/solver/plane.hpp"

namespace textplane_fuzz {
namespace {

void pose(Input& in) {
  const World world(in);
  std::vector<tp::PoseTextTerm> texts;
  const int text_count = in.integer(0, 3), point_count = in.integer(0, 12);
  for (int i = 0; i < text_count; ++i)
    texts.push_back({in.flag() ? &world.patch : nullptr, in.flag() ? world.theta : in.vector(1), in.pose(0.2, 0.3),
                     in.number(0, 2), in.integer(-2, 2)});
  std::vector<tp::PosePointTerm> points;
  for (int i = 0; i < point_count; ++i)
    points.push_back({tp::Vector3<double>(in.number(-1, 1), in.number(-1, 1), in.number(1, 4)),
                      tp::Vector2<double>(in.number(0, 48), in.number(0, 48)), in.number(0.5, 2)});
  tp::PoseOptions options;
  options.sigma_photo = in.number(0.1, 1);
  options.sigma_rep = in.number(0.5, 2);
  options.coarsest_level = in.integer(-1, 3);
  options.weighting = static_cast<tp::Weighting>(in.integer(0, 1));
  options.policy = static_cast<tp::LinearisePolicy>(in.integer(0, 4));
  tp::PoseWorkspace workspace;
  workspace.reserve(texts.data(), text_count, point_count);
  const tp::SE3d start = in.pose(0.3, 0.5);
  std::vector<float> zncc(static_cast<std::size_t>(text_count)), chi2(static_cast<std::size_t>(point_count));
  on_every_target([&](tp::simd::Target) {
    const tp::PoseFit fit = tp::refine_pose(texts.data(), text_count, points.data(), point_count, world.target.view(),
                                            world.camera, start, options, workspace, zncc.data(), chi2.data());
    check_pose(fit, start);
    if (!tp::is_ok(fit.status)) return;
    if (text_count > 0 || options.coarsest_level > 0) return;  // the visible pixels may differ,
    for (const float c : chi2)
      if (c < 0) return;  // and a point behind the camera may come before it
    const tp::PoseFit again = tp::refine_pose(nullptr, 0, points.data(), point_count, world.target.view(), world.camera,
                                              fit.T_t_w, options, workspace);
    TEXTPLANE_FUZZ_REQUIRE(!tp::is_ok(again.status) || again.cost <= fit.cost * (1 + 1e-9) + 1e-12);
  });
}

void plane(Input& in) {
  const World world(in);
  std::vector<tp::PlaneTarget> targets;
  const int count = in.integer(0, 3);
  for (int i = 0; i < count; ++i) targets.push_back({world.target.view(), in.pose(0.2, 0.5), in.integer(-2, 2)});
  tp::PlaneOptions options;
  options.coarsest_level = in.integer(-1, 3);
  tp::PlaneWorkspace workspace;
  workspace.reserve(world.patch, count);
  on_every_target([&](tp::simd::Target) {
    const auto fit =
        tp::refine_plane(world.patch, world.theta, targets.data(), count, world.camera, options, workspace);
    const bool start_finite =
        tp::is_finite(world.theta.x()) && tp::is_finite(world.theta.y()) && tp::is_finite(world.theta.z());
    for (int i = 0; i < 3 && start_finite; ++i) TEXTPLANE_FUZZ_REQUIRE(tp::is_finite(fit.theta[i]));
    if (tp::is_ok(fit.status))
      TEXTPLANE_FUZZ_REQUIRE(tp::is_finite(fit.cost) && tp::is_finite(fit.covariance(0, 0)) &&
                             fit.covariance(0, 0) >= 0);
  });
}

void window(Input& in) {
  const World world(in);
  tp::Window w;
  w.camera = world.camera;
  const int frames = in.integer(0, 4), points = in.integer(0, 8), texts = in.integer(0, 2);
  bool poses_finite = true;
  for (int i = 0; i < frames; ++i) {
    tp::WindowFrame frame;
    frame.T_w_c = in.pose(0.2, 0.5);
    poses_finite = poses_finite && tp::all_finite(frame.T_w_c);
    frame.fixed = in.flag();
    if (in.flag()) frame.image = i % 2 == 0 ? world.host.view() : world.target.view();
    w.frames.push_back(frame);
  }
  for (int i = 0; i < points; ++i) {
    tp::WindowPoint point;
    point.p_w = {in.number(-1, 1), in.number(-1, 1), in.number(1, 4)};
    point.fixed = in.integer(0, 7) == 0;
    w.points.push_back(point);
  }
  for (int i = in.integer(0, 30); i > 0; --i) {
    tp::WindowPointObservation o;
    o.frame = in.integer(-1, frames);
    o.point = in.integer(-1, points);
    o.px = {in.number(0, 48), in.number(0, 48)};
    o.sigma = in.number(0.5, 2);
    w.point_observations.push_back(o);
  }
  for (int i = 0; i < texts; ++i) {
    tp::WindowText text;
    text.host = in.integer(-1, frames);
    text.theta = in.flag() ? world.theta : in.vector(1);
    text.patch = in.flag() ? &world.patch : nullptr;
    w.texts.push_back(text);
  }
  for (int i = in.integer(0, 5); i > 0; --i) {
    tp::WindowTextObservation o;
    o.text = in.integer(-1, texts);
    o.frame = in.integer(-1, frames);
    o.weight = in.number(0, 2);
    o.scale_shift = in.integer(-2, 2);
    w.text_observations.push_back(o);
  }
  tp::WindowOptions options;
  options.max_iterations = in.integer(-1, 8);
  options.sigma_photo = in.number(0.1, 1);
  options.scale_frame_a = in.integer(-2, frames);
  options.scale_frame_b = in.integer(-2, frames);
  options.text_level = in.integer(-1, 3);
  tp::WindowWorkspace workspace;
  check_window(tp::solve_window(w, options, workspace), w, poses_finite);
}

}  // namespace
}  // namespace textplane_fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace textplane_fuzz;
  Input in(data, size);
  const int what = in.integer(0, 2);
  if (what == 0) pose(in);
  if (what == 1) plane(in);
  if (what == 2) window(in);
  return 0;
}
