// Cameras with any parameters: what they say is ok is finite, and leads back where it came from; kernels behind their
// lenses read nothing out of bounds, and no ok comes with a NaN.
#include <cmath>
#include <vector>

#include "fuzz_world.hpp"
#include "textplane/photometry/lens/warp_lens.hpp"
#include "textplane/photometry/residual.hpp"

namespace textplane_fuzz {
namespace {

// A model and its map say no more than they know.
void check_camera(Input& in, const tp::AnyCamera<double>& camera, const tp::CameraView& view) {
  TEXTPLANE_FUZZ_REQUIRE(tp::is_finite(view.lens->max_r2()) && view.lens->max_r2() >= 0);
  TEXTPLANE_FUZZ_REQUIRE(camera.valid() || !view.valid());
  // A division by zero is an infinity, and its status non_finite: right, but the sanitizer stops at it.
  if (camera.pinhole().fx == 0 || camera.pinhole().fy == 0) return;
  for (int i = 0; i < 6; ++i) {
    const tp::Vector2<double> px(in.number(-20, 70), in.number(-20, 70));
    tp::Vector3<double> m(7, 7, 7), ray(7, 7, 7), seen(7, 7, 7);
    const tp::Status point = camera.unproject(px, &m), bearing = camera.unproject_ray(px, &ray);
    const tp::Status by_view = view.unproject(px, &seen);
    TEXTPLANE_FUZZ_REQUIRE(tp::is_ok(point) ? tp::all_finite(m) && m[2] == 1 : m[0] == 7);
    TEXTPLANE_FUZZ_REQUIRE(tp::is_ok(bearing) ? std::abs(ray.norm() - 1) < 1e-6 : ray[0] == 7);
    TEXTPLANE_FUZZ_REQUIRE(tp::is_ok(by_view) ? tp::all_finite(seen) && seen[2] == 1 : seen[0] == 7);
    if (in.wild() || !tp::is_ok(by_view) || !view.valid() || !view.in_domain(seen)) continue;
    TEXTPLANE_FUZZ_REQUIRE((view.project(seen) - px).norm() < 1e-6);
  }
}

struct Patch {
  std::vector<float> x, y, intensity;
  explicit Patch(Input& in) {
    const int n = in.integer(0, 60);
    const double x0 = in.number(0, 40), y0 = in.number(0, 40), width = in.number(1, 20), height = in.number(1, 20);
    for (int i = 0; i < n; ++i) {
      x.push_back(static_cast<float>(x0 + width * (i % 9) / 9));
      y.push_back(static_cast<float>(y0 + height * (i % 7) / 7));
      intensity.push_back(static_cast<float>(in.empty() ? (i * 37) % 256 : in.number(0, 255)));
    }
  }
};

template <class Result>
void check_sums(const Result& e) {
  const bool finite = tp::is_finite(e.cost) && tp::all_finite(e.H) && tp::all_finite(e.b);
  TEXTPLANE_FUZZ_REQUIRE(finite && (tp::is_ok(e.status) || (e.cost == 0 && (e.H.array() == 0).all())));
}

void check_kernels(Input& in, const FuzzImage& image, const tp::CameraView& view) {
  const Patch patch(in);
  tp::PhotometricInput input;
  input.patch = {patch.x.data(), patch.y.data(), patch.intensity.data(), nullptr, static_cast<int>(patch.x.size())};
  input.host_camera = in.camera(48, 48);
  input.target_camera = view.pinhole;
  input.lens = view.lens;
  input.target = image.view();
  const tp::SE3d T_t_h = in.pose(0.3, 0.5);
  const tp::Vector3<double> theta(in.number(-0.3, 0.3), in.number(-0.3, 0.3), in.number(0.1, 1));
  tp::PhotometricOptions options;
  options.min_visible = in.integer(-1, 20);
  const tp::ResidualRequest request{input, theta, T_t_h, options};
  tp::PhotometricWorkspace workspace(input.patch.n);
  check_sums(tp::reference::linearise<tp::Parameters::pose_plane>(request, workspace));
  tp::Image<std::uint8_t> out(in.integer(1, 40), in.integer(1, 40));
  tp::Matrix3<double> H;
  for (int i = 0; i < 9; ++i) H(i / 3, i % 3) = i % 4 == 0 ? in.number(0.001, 0.05) : in.number(-0.5, 0.5);
  on_every_target([&](tp::simd::Target) {
    check_sums(tp::linearise<tp::Parameters::pose_plane>(request, workspace));
    check_sums(tp::linearise<tp::Parameters::pose>(request, workspace));
    const tp::PhotometricCost cost = tp::evaluate(request, workspace);
    TEXTPLANE_FUZZ_REQUIRE(tp::is_finite(cost.cost) && (tp::is_ok(cost.status) || cost.cost == 0));
    const tp::WarpSummary warp = tp::warp_patch<std::uint8_t>(image.view(), view, H, out.view());
    TEXTPLANE_FUZZ_REQUIRE(warp.inside >= 0 && warp.inside <= out.width() * out.height());
  });
}

}  // namespace
}  // namespace textplane_fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace textplane_fuzz;
  Input in(data, size);
  const FuzzImage image(in, 0, 48);
  const tp::AnyCamera<double> camera = any_camera(in);
  const tp::LensMap lens(camera);
  const tp::CameraView view(camera.pinhole(), &lens);
  check_camera(in, camera, view);
  check_kernels(in, image, view);
  return 0;
}
