// The photometric kernels on every target against the double reference: any image, patch, mask, pose and plane. Where
// the input is tame, statuses are equal and numbers agree; where it is not, nothing is read out of bounds and no ok
// status comes with a NaN.
#include <algorithm>
#include <cmath>
#include <vector>

#include "fuzz.hpp"
#include "textplane/geometry/homography.hpp"
#include "textplane/photometry/residual.hpp"

namespace textplane_fuzz {
namespace {

// Ten times what the tests hold the kernels to on images like photographs: noise varies by all of its contrast within a
// px.
constexpr double kEntryBound = 3e-4, kCostBound = 1e-3;
constexpr double kClear = 2e-3;  // px to lines of pixels and to borders

struct Scene {
  FuzzImage image;
  tp::Pinhole<double> host_camera, target_camera;
  tp::SE3d T_t_h;
  tp::Vector3<double> theta;
  tp::PhotometricOptions options;
  std::vector<float> x, y, intensity;
  std::vector<std::uint8_t> mask;
  bool masked;

  explicit Scene(Input& in) : image(in, 0, 48) {
    host_camera = in.camera(48, 48);
    target_camera = in.camera(48, 48);
    T_t_h = in.pose(0.3, 0.5);
    theta = {in.number(-0.3, 0.3), in.number(-0.3, 0.3), in.number(0.1, 1)};
    options.normalisation = in.flag() ? tp::Normalisation::exact : tp::Normalisation::frozen;
    options.robust = {static_cast<tp::RobustKind>(in.integer(0, 3)), in.number(0.05, 2)};
    options.min_visible = in.integer(-1, 20);
    options.min_contrast = in.number(0, 2);
    masked = in.flag();
    const int n = in.integer(0, 80);
    const double x0 = in.number(0, 40), y0 = in.number(0, 40), width = in.number(1, 20), height = in.number(1, 20);
    for (int i = 0; i < n; ++i) {
      x.push_back(static_cast<float>(in.empty() ? x0 + width * (i % 9) / 9 : in.number(x0, x0 + width)));
      y.push_back(static_cast<float>(in.empty() ? y0 + height * (i % 7) / 7 : in.number(y0, y0 + height)));
      intensity.push_back(static_cast<float>(in.empty() ? (i * 37) % 256 : in.number(0, 255)));
      mask.push_back(static_cast<std::uint8_t>(in.empty() ? i % 5 != 0 : in.flag()));
    }
  }

  tp::PhotometricInput input() const {
    tp::PhotometricInput out;
    out.patch.x = x.data();
    out.patch.y = y.data();
    out.patch.intensity = intensity.data();
    out.patch.mask = masked ? mask.data() : nullptr;
    out.patch.n = static_cast<int>(x.size());
    out.host_camera = host_camera;
    out.target_camera = target_camera;
    out.target = image.view();
    return out;
  }

  // Positions that float and double put into the same cell of pixels, under a warp that is none too strong.
  bool tame() const {
    const tp::Matrix3<double> H = tp::plane_homography(theta, T_t_h);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const tp::Vector3<double> q = H * host_camera.unproject({x[i], y[i]});
      if (!(q.z() > 0.3) || !(q.z() < 3)) return false;
      const tp::Vector2<double> px = target_camera.pixel(tp::Vector2<double>(q.x() / q.z(), q.y() / q.z()));
      for (const double value : {px.x(), px.y()})
        if (!(std::abs(value) < 500) || std::abs(value - std::round(value)) < kClear) return false;
    }
    return true;
  }
};

template <int P>
tp::NormalEquations<P> equations(const tp::PhotometricInput& in, const Scene& s, const tp::PhotometricOptions& o,
                                 tp::PhotometricWorkspace& workspace, bool reference) {
  constexpr tp::Parameters kUnknowns = P == 3   ? tp::Parameters::plane
                                       : P == 6 ? tp::Parameters::pose
                                                : tp::Parameters::pose_plane;
  const tp::ResidualRequest request{in, s.theta, s.T_t_h, o};
  return reference ? tp::reference::linearise<kUnknowns>(request, workspace)
                   : tp::linearise<kUnknowns>(request, workspace);
}

template <int P>
bool sound(const tp::NormalEquations<P>& e) {
  if (!tp::is_ok(e.status)) return e.cost == 0 && e.error == 0 && (e.H.array() == 0).all() && (e.b.array() == 0).all();
  for (int i = 0; i < P; ++i) {
    if (!tp::is_finite(e.b[i]) || !(e.H(i, i) >= 0)) return false;
    for (int j = 0; j < P; ++j)
      if (!tp::is_finite(e.H(i, j))) return false;
  }
  return e.cost >= 0 && tp::is_finite(e.cost) && e.error >= 0 && e.error <= 4 && e.zncc >= -1 && e.zncc <= 1;
}

template <int P>
void compare(const Scene& scene, bool tame) {
  const tp::PhotometricInput in = scene.input();
  tp::PhotometricWorkspace workspace(in.patch.n);
  const auto exact = equations<P>(in, scene, scene.options, workspace, true);
  TEXTPLANE_FUZZ_REQUIRE(sound<P>(exact));
  tp::PhotometricOptions held = scene.options;
  held.normalisation = tp::Normalisation::frozen;
  const auto frozen = equations<P>(in, scene, held, workspace, true);
  // A weight that nearly leaves a pixel out has the error of one that does not.
  if (tp::weighs_all(held.robust.kind)) held.robust.kind = tp::RobustKind::l2;
  const auto unweighted = equations<P>(in, scene, held, workspace, true);
  // Contrast near the limit, or a norm so small that float's steps show in it, may fall either way.
  const bool judged = tame && (!tp::is_ok(exact.status) || exact.s > 10 * std::sqrt(exact.visible)) &&
                      exact.status != tp::Status::no_contrast && scene.options.robust.delta > 0.05;
  on_every_target([&](tp::simd::Target) {
    const auto fast = equations<P>(in, scene, scene.options, workspace, false);
    TEXTPLANE_FUZZ_REQUIRE(sound<P>(fast));
    if (!judged) return;
    TEXTPLANE_FUZZ_REQUIRE(fast.status == exact.status && fast.visible == exact.visible);
    if (!tp::is_ok(exact.status)) return;
    TEXTPLANE_FUZZ_REQUIRE(std::abs(fast.cost - exact.cost) <= kCostBound * (exact.cost + 0.01));
    // The mean's derivative is subtracted: it makes an entry small against its terms or, where the robust weight leaves
    // out the steepest pixel, large.
    for (int i = 0; i < P; ++i) {
      const double scale = std::max({frozen.H(i, i), exact.H(i, i), unweighted.H(i, i)});
      TEXTPLANE_FUZZ_REQUIRE(std::abs(fast.H(i, i) - exact.H(i, i)) <= kEntryBound * scale + 1e-9);
    }
  });
}

}  // namespace
}  // namespace textplane_fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace textplane_fuzz;
  Input in(data, size);
  const Scene scene(in);
  const bool tame = !in.wild() && scene.tame();
  compare<3>(scene, tame);
  compare<6>(scene, tame);
  compare<9>(scene, tame);

  const tp::PhotometricInput input = scene.input();
  tp::PhotometricWorkspace workspace(input.patch.n);
  on_every_target([&](tp::simd::Target) {
    const auto cost = tp::evaluate(tp::ResidualRequest{input, scene.theta, scene.T_t_h, scene.options}, workspace);
    TEXTPLANE_FUZZ_REQUIRE(tp::is_finite(cost.cost) && tp::is_finite(cost.error) && cost.visible >= 0);
    TEXTPLANE_FUZZ_REQUIRE(tp::is_ok(cost.status) || (cost.cost == 0 && cost.zncc == 0));
  });
  return 0;
}
