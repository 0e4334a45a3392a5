// One call of each kernel for callgrind to count the instructions of: see tests/budgets/check.sh.
//
// Outside of valgrind the client requests do nothing, and the program only shows that the calls succeed.
#include <valgrind/callgrind.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "support/text_wall.hpp"
#include "textplane/features/align.hpp"
#include "textplane/features/fast.hpp"
#include "textplane/photometry/candidates.hpp"
#include "textplane/photometry/residual.hpp"
#include "textplane/photometry/residual_policy.hpp"
#include "textplane/photometry/text_batch.hpp"
#include "textplane/photometry/warp_patch.hpp"
#include "textplane/simd/sample.hpp"

namespace tp = textplane;

namespace {

int failures = 0;

// Counts the second call: the first one resolves the target and touches the memory.
template <class Call>
void count(const std::string& name, const Call& call) {
  bool good = call();
  CALLGRIND_START_INSTRUMENTATION;
  CALLGRIND_ZERO_STATS;
  good &= call();
  CALLGRIND_DUMP_STATS_AT(name.c_str());
  CALLGRIND_STOP_INSTRUMENTATION;
  if (!good) std::printf("%s failed\n", name.c_str());
  failures += good ? 0 : 1;
}

float intensity(double x, double y) {
  return static_cast<float>(128 + 55 * std::sin(0.31 * x + 0.11 * y) + 55 * std::sin(0.07 * x - 0.23 * y + 1));
}

struct Scene {
  static constexpr int kWidth = 320, kHeight = 240;
  tp::Image<std::uint8_t> image{kWidth, kHeight};
  tp::Image<float> image_f{kWidth, kHeight};
  tp::Pinhole<double> camera{300, 300, 159.5, 119.5};
  tp::Vector3<double> theta{0.1, -0.05, 0.5};
  tp::SE3d T_t_h = tp::se3_exp<double>((tp::Vector6<double>() << 0.02, -0.01, 0.03, 0.01, -0.02, 0.015).finished());

  Scene() {
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        image_f(x, y) = intensity(x, y);
        image(x, y) = static_cast<std::uint8_t>(image_f(x, y));
      }
  }
};

// n scattered pixels of a rectangle of 100 x 40, one in ten of them an outlier.
struct Pixels {
  std::vector<float> x, y, value, gx, gy;
  explicit Pixels(int n) {
    for (int i = 0; i < n; ++i) {
      const int cell = static_cast<int>((static_cast<long>(i) * 2654435761L) % 4000);
      x.push_back(static_cast<float>(110 + cell % 100));
      y.push_back(static_cast<float>(100 + cell / 100));
      value.push_back(intensity(x.back(), y.back()) + (i % 10 == 9 ? 70.0F : 0.0F));
      gx.push_back(intensity(x.back() + 0.5, y.back()) - intensity(x.back() - 0.5, y.back()));
      gy.push_back(intensity(x.back(), y.back() + 0.5) - intensity(x.back(), y.back() - 0.5));
    }
  }
  tp::PhotometricInput input(const Scene& scene) const {
    tp::PhotometricInput in;
    in.patch.x = x.data();
    in.patch.y = y.data();
    in.patch.intensity = value.data();
    in.patch.n = static_cast<int>(x.size());
    in.patch.gx = gx.data();
    in.patch.gy = gy.data();
    in.patch.bounds = tp::simd::point_bounds(x.data(), y.data(), in.patch.n);
    in.host_camera = in.target_camera = scene.camera;
    in.target = scene.image.view();
    return in;
  }
};

void count_residual(const Scene& scene, int n) {
  const Pixels pixels(n);
  tp::PhotometricWorkspace workspace(n);
  const tp::PhotometricInput input = pixels.input(scene);
  const tp::ResidualRequest request{input, scene.theta, scene.T_t_h};
  const std::string size = "/" + std::to_string(n);
  count("pose" + size, [&] { return is_ok(tp::linearise<tp::Parameters::pose>(request, workspace).status); });
  count("plane" + size, [&] { return is_ok(tp::linearise<tp::Parameters::plane>(request, workspace).status); });
  count("pose_plane" + size,
        [&] { return is_ok(tp::linearise<tp::Parameters::pose_plane>(request, workspace).status); });
  count("cost" + size, [&] { return is_ok(tp::evaluate(request, workspace).status); });
}

void count_policies(const Scene& scene, int n) {
  const Pixels pixels(n);
  tp::PhotometricWorkspace workspace(n);
  const tp::PhotometricInput input = pixels.input(scene);
  tp::TemplatePatch prepared;
  prepared.prepare(input.patch);
  const std::string size = "/" + std::to_string(n);
  tp::PhotometricOptions l2;
  l2.robust.kind = tp::RobustKind::l2;
  const auto count_by = [&](const char* name, tp::LinearisePolicy policy, const tp::PhotometricOptions& options) {
    const auto request = tp::ResidualRequest{input, scene.theta, scene.T_t_h, options}.by(policy, &prepared);
    count(name + size, [&] { return is_ok(tp::linearise<tp::Parameters::pose_plane>(request, workspace).status); });
  };
  count_by("template_l2", tp::LinearisePolicy::template_jacobian, l2);
  count_by("template_huber", tp::LinearisePolicy::template_jacobian, {});
  count_by("esm", tp::LinearisePolicy::esm, {});
  if (n > tp::kHybridPixels) count_by("hybrid", tp::LinearisePolicy::hybrid, {});
  const std::vector<tp::SE3d> poses(16, scene.T_t_h);
  std::vector<float> zncc(16);
  count("zncc_16" + size, [&] {
    return is_ok(tp::zncc_candidates(input, scene.theta, poses.data(), 16, l2, workspace, zncc.data(), &prepared));
  });
}

void count_batch(const Scene& scene, int n) {
  constexpr int kObjects = 16;
  const Pixels pixels(n);
  const std::vector<tp::TextBatchItem> items(kObjects, {pixels.input(scene).patch, scene.camera, scene.theta});
  const std::vector<tp::SE3d> poses(kObjects, scene.T_t_h);
  const tp::TextBatch batch(items.data(), kObjects);
  tp::TextBatchResult result(batch);
  const std::string size = "/" + std::to_string(n);
  count("batch16_pose" + size, [&] {
    return is_ok(
        tp::linearise_batch<tp::Parameters::pose>(batch, scene.image.view(), scene.camera, poses.data(), {}, result));
  });
  count("batch16_pose_plane" + size, [&] {
    return is_ok(tp::linearise_batch<tp::Parameters::pose_plane>(batch, scene.image.view(), scene.camera, poses.data(),
                                                                 {}, result));
  });
}

// The same 4000 pixels behind a lens, as it shows them.
template <class Model>
void count_lens(const Scene& scene, const Model& model) {
  constexpr int kPixels = 4000;
  const tp::LensMap lens{model};
  Pixels pixels(kPixels);
  tp::PhotometricInput input = pixels.input(scene);
  if (!model.is_pinhole()) input.lens = &lens;
  const tp::CameraView camera(input.target_camera, input.lens);
  for (std::size_t i = 0; i < kPixels; ++i) {
    const tp::Vector3<double> m =
        input.host_camera.unproject({static_cast<double>(pixels.x[i]), static_cast<double>(pixels.y[i])});
    const tp::Vector2<double> px = camera.project(scene.T_t_h.R * m + scene.T_t_h.t * scene.theta.dot(m));
    tp::sample_bilinear(input.target, static_cast<float>(px[0]), static_cast<float>(px[1]), &pixels.value[i]);
    if (i % 10 == 9) pixels.value[i] += 70.0F;
  }
  tp::PhotometricWorkspace workspace(kPixels);
  tp::TemplatePatch prepared;
  prepared.prepare(input.patch);
  const tp::ResidualRequest request{input, scene.theta, scene.T_t_h};
  const auto name = [](const char* kernel) { return std::string(kernel) + "_" + Model::kName + "/4000"; };
  const auto by_kernel = [](const auto& result) { return is_ok(result.status) && result.path == tp::Path::kernel; };
  count(name("pose"), [&] { return by_kernel(tp::linearise<tp::Parameters::pose>(request, workspace)); });
  count(name("pose_plane"), [&] { return by_kernel(tp::linearise<tp::Parameters::pose_plane>(request, workspace)); });
  count(name("cost"), [&] { return by_kernel(tp::evaluate(request, workspace)); });
  count(name("template_huber"), [&] {
    return by_kernel(tp::linearise<tp::Parameters::pose_plane>(
        request.by(tp::LinearisePolicy::template_jacobian, &prepared), workspace));
  });
}

template <class S, class D>
void count_warp(const char* name, const tp::Image<S>& image) {
  const tp::Matrix3<double> H =
      (tp::Matrix3<double>() << 1.02, 0.05, 90.3, -0.03, 0.98, 80.7, 1e-4, -5e-5, 1).finished();
  tp::Image<D> out(100, 40);
  count(name, [&] { return is_ok(tp::warp_patch<S, D>(image.view(), H, out.view()).status); });
}

void count_features(const Scene& scene) {
  tp::Image<std::uint8_t> half(Scene::kWidth / 2, Scene::kHeight / 2);
  count("halve/320x240", [&] { return is_ok(tp::halve(scene.image.view(), half.view())); });

  std::vector<std::uint8_t> scratch(tp::fast_scratch_size(Scene::kWidth));
  std::vector<tp::Corner> corners(5000);
  count("fast/320x240", [&] {
    int found = 0;
    return is_ok(tp::detect_fast(scene.image.view(), 10, true, scratch.data(), corners.data(), 5000, &found));
  });

  tp::PointPatch patch;
  count("klt_template/21x21", [&] {
    return is_ok(
        tp::extract_point_patch(scene.image.view(), {150.3F, 110.6F}, Eigen::Matrix2f::Identity(), 10, &patch));
  });
  count("klt_align/21x21", [&] {
    return is_ok(tp::align_point_patch(patch, scene.image.view(), {151.1F, 110.0F}).status);
  });
}

// A frame with twenty signs in view and two hundred points, against maps of so many texts.
void count_track() {
  const textplane_test::TextWall wall;
  for (const int texts : {20, 1000}) {
    tp::TextMap map(wall.camera);
    wall.fill(map, texts);
    count("track_20/" + std::to_string(texts),
          [&] { return map.track(wall.frame, wall.start, wall.points).texts == textplane_test::TextWall::kInView; });
  }
}

}  // namespace

int main() {
  const Scene scene;
  for (const int n : {15, 64, 256, 1000, 4000}) count_residual(scene, n);
  for (const int n : {15, 256, 4000}) count_policies(scene, n);
  count_lens(scene, tp::Pinhole<double>());
  count_lens(scene, tp::RadialTangential<double>{{}, -0.28, 0.07, 1e-3, -5e-4, 0});
  count_lens(scene, tp::KannalaBrandt<double>{{}, 0.01, -0.003, 0.002, -0.001});
  count_lens(scene, tp::DoubleSphere<double>{{}, -0.2, 0.6});
  count_batch(scene, 15);
  count_warp<std::uint8_t, float>("warp_u8_f32/100x40", scene.image);
  count_warp<std::uint8_t, std::uint8_t>("warp_u8_u8/100x40", scene.image);
  count_warp<float, float>("warp_f32_f32/100x40", scene.image_f);
  count_features(scene);
  count_track();
  return failures == 0 ? 0 : 1;
}
