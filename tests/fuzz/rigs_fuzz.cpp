// Solvers with several cameras, rolling shutters, and a camera that is unknown: a state that comes back is finite where
// the first one was, an ok status comes with finite numbers, and the cost is never worse than at the start.
#include <vector>

#include "fuzz_solvers.hpp"
#include "fuzz_world.hpp"
#include "textplane/photometry/candidates.hpp"
#include "textplane/photometry/text_batch.hpp"

namespace textplane_fuzz {
namespace {

tp::RowMotion motion(Input& in) {
  tp::RowMotion rows;
  for (int i = 0; i < 6; ++i) rows.velocity[i] = in.number(-1, 1);
  rows.shutter = {in.number(-0.05, 0.05), in.number(0, 47), in.integer(0, 48)};
  return rows;
}

// A camera of any model with its lens, and perhaps with rows. Others point to what it holds, so it stays where it is.
struct Eye {
  tp::AnyCamera<double> model;
  tp::LensMap lens;
  tp::RowMotion rows;
  tp::CameraView view;

  explicit Eye(Input& in) : model(any_camera(in)), lens(model), rows(motion(in)) {
    view = tp::CameraView(model.pinhole(), in.flag() ? &lens : nullptr, in.flag() ? &rows : nullptr);
  }
  Eye(const Eye&) = delete;
  Eye& operator=(const Eye&) = delete;
};

void pose(Input& in) {
  World world(in);
  const Eye left(in), right(in);
  if (in.flag()) world.patch.rows = tp::patch_rows(left.rows, left.view, {in.number(-1, 1), in.number(-1, 1), 1});
  const int cameras = in.integer(0, 2), text_count = in.integer(0, 3), point_count = in.integer(0, 12);
  const tp::PoseCamera rig[] = {{left.view, in.pose(0.3, 0.3), world.target.view()},
                                {right.view, in.pose(0.3, 0.3), in.flag() ? world.host.view() : tp::PyramidView()}};
  std::vector<tp::PoseTextTerm> texts;
  for (int i = 0; i < text_count; ++i) {
    texts.push_back({in.flag() ? &world.patch : nullptr, in.flag() ? world.theta : in.vector(1), in.pose(0.2, 0.3),
                     in.number(0, 2), in.integer(-2, 2)});
    texts.back().camera = in.integer(-1, 2);
  }
  std::vector<tp::PosePointTerm> points;
  for (int i = 0; i < point_count; ++i) {
    points.push_back({tp::Vector3<double>(in.number(-1, 1), in.number(-1, 1), in.number(1, 4)),
                      tp::Vector2<double>(in.number(0, 48), in.number(0, 48)), in.number(0.5, 2)});
    points.back().camera = in.integer(-1, 2);
  }
  tp::PoseOptions options;
  options.coarsest_level = in.integer(-1, 3);
  tp::PoseWorkspace workspace;
  workspace.reserve(texts.data(), text_count, point_count);
  const tp::SE3d start = in.pose(0.3, 0.5);
  std::vector<float> zncc(texts.size()), chi2(points.size());
  on_every_target([&](tp::simd::Target) {
    const tp::PoseFit fit = tp::refine_pose(texts.data(), text_count, points.data(), point_count, rig, cameras, start,
                                            options, workspace, zncc.data(), chi2.data());
    check_pose(fit, start);
  });
}

// Batches of texts and poses through a lens and between rolling shutters.
void batches(Input& in) {
  World world(in);
  const Eye eye(in);
  if (in.flag()) world.patch.rows = tp::patch_rows(eye.rows, eye.view, {in.number(-1, 1), in.number(-1, 1), 1});
  const int level = in.integer(0, 3), host_level = in.integer(0, 2), count = in.integer(0, 18);
  std::vector<tp::TextBatchItem> items;
  std::vector<tp::SE3d> poses;
  for (int i = 0; i < count; ++i) {
    const bool has_level = host_level < world.patch.level_count();
    items.push_back({has_level ? world.patch.levels[static_cast<std::size_t>(host_level)].view() : tp::PatchView(),
                     world.camera.at_level(host_level), in.flag() ? world.theta : in.vector(1),
                     in.flag() ? world.patch.rows : tp::PatchRows()});
    poses.push_back(in.pose(0.2, 0.3));
  }
  const tp::PhotometricInput input = tp::photometric_input(world.patch, level, world.target.view(), eye.view);
  tp::TemplatePatch prepared;
  const bool is_prepared = input.patch.n > 0 && tp::is_ok(prepared.prepare(input.patch));
  tp::PhotometricWorkspace workspace(world.patch.max_pixels());
  const tp::TextBatch batch(items.data(), count);
  tp::TextBatchResult result(batch);
  std::vector<float> zncc(poses.size());
  on_every_target([&](tp::simd::Target) {
    tp::linearise_batch<tp::Parameters::pose_plane>(batch, world.target.view().level[0], eye.view.at_level(level),
                                                    poses.data(), {}, result, level);
    for (int i = 0; i < count; ++i) {
      const auto sums = result.normal_equations<tp::Parameters::pose_plane>(i);
      TEXTPLANE_FUZZ_REQUIRE(tp::all_finite(sums.H) && tp::all_finite(sums.b) && tp::is_finite(sums.cost));
    }
    tp::zncc_candidates(input, world.theta, poses.data(), count, {}, workspace, zncc.data(),
                        is_prepared ? &prepared : nullptr);
    for (const float z : zncc) TEXTPLANE_FUZZ_REQUIRE(z >= -1.0001F && z <= 1.0001F);
  });
}

tp::WindowFrame frame(Input& in, const World& world, const tp::RowMotion& rows, const Eye& eye, int index) {
  tp::WindowFrame out;
  out.T_w_c = in.pose(0.2, 0.5);
  out.fixed = in.integer(0, 3) == 0;
  if (in.flag()) out.image = index % 2 == 0 ? world.host.view() : world.target.view();
  if (in.flag()) out.rows = &rows;
  if (in.integer(0, 3) == 0) out.velocity_sigma = tp::Vector6<double>::Constant(in.number(0.01, 1));
  if (in.integer(0, 3) == 0) out.base = in.integer(-1, index);
  if (in.integer(0, 3) == 0) out.camera = &eye.view;
  out.T_b_c = in.pose(0.2, 0.3);
  return out;
}

tp::WindowCalibration calibration(Input& in) {
  tp::WindowCalibration out;
  out.camera = any_camera(in);
  out.hold();
  for (int i = 0; i < out.sigma.size(); ++i)
    if (in.flag()) out.sigma[i] = in.number(0.01, 10);
  if (in.flag()) out.mean = out.camera.parameters();
  for (int i = 0; i < out.mean.size(); ++i) out.mean[i] += in.number(-0.1, 0.1);
  if (in.integer(0, 7) == 0) out.sigma.setConstant(in.integer(0, tp::WindowCalibration::kMost), 0.5);
  out.one_focal_length = in.flag();
  return out;
}

void window(Input& in) {
  const World world(in);
  const Eye eye(in), other(in);
  tp::WindowCalibration unknown = calibration(in);
  tp::Window w;
  w.camera = eye.view;
  if (in.flag()) w.calibration = &unknown;
  const int frames = in.integer(0, 5), points = in.integer(0, 8), texts = in.integer(0, 2);
  std::vector<tp::RowMotion> rows;
  for (int i = 0; i < frames; ++i) rows.push_back(motion(in));
  bool poses_finite = true;
  for (int i = 0; i < frames; ++i) {
    w.frames.push_back(frame(in, world, rows[static_cast<std::size_t>(i)], other, i));
    poses_finite = poses_finite && tp::all_finite(w.frames.back().T_w_c) && tp::all_finite(w.frames.back().T_b_c);
  }
  for (int i = 0; i < points; ++i) {
    tp::WindowPoint point;
    point.p_w = {in.number(-1, 1), in.number(-1, 1), in.number(1, 4)};
    w.points.push_back(point);
  }
  for (int i = in.integer(0, 40); i > 0 && frames > 0 && points > 0; --i) {
    tp::WindowPointObservation o;
    o.frame = in.integer(0, frames - 1);
    o.point = in.integer(0, points - 1);
    o.px = {in.number(0, 48), in.number(0, 48)};
    w.point_observations.push_back(o);
  }
  for (int i = 0; i < texts && frames > 0; ++i) {
    tp::WindowText text;
    text.host = in.integer(0, frames - 1);
    text.theta = world.theta;
    text.patch = &world.patch;
    w.texts.push_back(text);
    tp::WindowTextObservation o;
    o.text = i;
    o.frame = in.integer(0, frames - 1);
    w.text_observations.push_back(o);
  }
  tp::WindowOptions options;
  options.max_iterations = in.integer(0, 8);
  options.scale_frame_a = in.integer(-1, frames);
  options.scale_frame_b = in.integer(-1, frames);
  const bool camera_finite = unknown.camera.valid();
  tp::WindowWorkspace workspace;
  check_window(tp::solve_window(w, options, workspace), w, poses_finite);
  if (camera_finite && w.calibration)
    TEXTPLANE_FUZZ_REQUIRE(unknown.camera.valid() && tp::all_finite(unknown.covariance));
}

}  // namespace
}  // namespace textplane_fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace textplane_fuzz;
  Input in(data, size);
  const int what = in.integer(0, 2);
  if (what == 0) pose(in);
  if (what == 1) window(in);
  if (what == 2) batches(in);
  return 0;
}
