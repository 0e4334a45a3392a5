// Prints what the library computes on a made-up scene, as hexadecimal floating point: a name and its numbers a line.
// The Python package must compute the same to the bit: numbers_test.py. With the argument `time`: what calls take, ns,
// for overhead.py.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <vector>

#include "textplane/textplane.hpp"

namespace tp = textplane;

namespace {

void print(const char* name, const double* values, std::ptrdiff_t n) {
  std::printf("%s", name);
  for (std::ptrdiff_t i = 0; i < n; ++i) std::printf(" %a", values[i]);
  std::printf("\n");
}
void print(const char* name, std::initializer_list<double> values) {
  print(name, values.begin(), static_cast<std::ptrdiff_t>(values.size()));
}
// Row by row, as NumPy has it.
template <class Matrix>
void print_matrix(const char* name, const Matrix& m) {
  std::vector<double> values;
  for (Eigen::Index r = 0; r < m.rows(); ++r)
    for (Eigen::Index c = 0; c < m.cols(); ++c) values.push_back(static_cast<double>(m(r, c)));
  print(name, values.data(), static_cast<std::ptrdiff_t>(values.size()));
}
void print_pose(const char* name, const tp::SE3d& T) {
  print_matrix((std::string(name) + ".R").c_str(), T.R);
  print_matrix((std::string(name) + ".t").c_str(), T.t);
}

// A triangle wave.
int wave(int at, int period) { return std::abs(at % period - period / 2); }

// The scene of scene.py.
struct Scene {
  tp::Pinhole<double> camera{500, 500, 319.5, 239.5};
  tp::Vector3<double> theta{0.05, -0.1, 0.5};
  tp::SE3d T_t_h;
  tp::Quad<double> quad;
  tp::Image<std::uint8_t> host{640, 480}, target{640, 480};

  Scene() {
    tp::Vector6<double> xi;
    xi << 0.05, -0.02, 0.03, 0.01, -0.02, 0.03;
    T_t_h = tp::se3_exp(xi);
    quad.corner = {tp::Vector2<double>(200, 150), {420, 160}, {415, 330}, {205, 320}};
    for (int y = 0; y < 480; ++y)
      for (int x = 0; x < 640; ++x)
        host(x, y) = static_cast<std::uint8_t>(60 + 4 * wave(x, 41) + 3 * wave(y, 37) + 2 * wave(x + 2 * y, 53));
    tp::Matrix3<double> H;
    tp::plane_homography_inverse(theta, T_t_h, &H);
    tp::warp_patch(tp::ImageView8(host.view()), tp::pixel_homography(H, camera, camera), target.view());
  }
};

void print_patch(const tp::TextPatch& patch) {
  for (const tp::PatchLevel& level : patch.levels)
    for (const auto* values : {&level.x, &level.y, &level.intensity, &level.gx, &level.gy}) {
      const std::vector<double> wide(values->begin(), values->end());
      print("patch", wide.data(), static_cast<std::ptrdiff_t>(wide.size()));
    }
}

template <tp::Parameters Unknowns>
void print_equations(const char* name, const tp::ResidualRequest<std::uint8_t>& request) {
  tp::PhotometricWorkspace workspace(request.input.patch.n);
  const auto out = tp::linearise<Unknowns>(request, workspace);
  print_matrix(name, out.H);
  print_matrix(name, out.b);
  print(name, {out.cost, out.error, out.zncc, static_cast<double>(out.visible), out.mean, out.s});
}

void print_solves(const Scene& scene, const tp::TextPatch& patch, const tp::Pyramid& pyramid) {
  tp::Vector6<double> error;
  error << 0.004, -0.003, 0.004, 0.002, -0.001, 0.003;
  const tp::SE3d guess = tp::se3_exp(error) * scene.T_t_h;
  const auto fit = tp::align_pose(patch, scene.theta, guess, pyramid, scene.camera);
  print_pose("align_pose", fit.T_t_h);
  print_matrix("align_pose.information", fit.information);
  print("align_pose",
        {fit.cost, fit.zncc, static_cast<double>(fit.visible_pixels), static_cast<double>(fit.iterations)});

  const tp::Vector3<double> start(0.04, -0.08, 0.49);
  const auto plane = tp::align_plane(patch, start, scene.T_t_h, pyramid, scene.camera);
  print_matrix("align_plane", plane.theta);
  print_matrix("align_plane.covariance", plane.covariance);
  print("align_plane", {plane.cost, plane.zncc, plane.residual_variance, static_cast<double>(plane.iterations)});

  const tp::PhotometricInput in = tp::photometric_input(patch, 1, pyramid, scene.camera);
  const tp::ResidualRequest<std::uint8_t> request{in, scene.theta, guess, {}};
  print_equations<tp::Parameters::pose>("linearise_pose", request);
  print_equations<tp::Parameters::plane>("linearise_plane", request);
  print_equations<tp::Parameters::pose_plane>("linearise_pose_plane", request);
  const tp::SE3d T_w_h = tp::se3_exp(error);
  print_equations<tp::Parameters::host_target_plane>(
      "linearise_host_target_plane",
      tp::world_request(in, scene.theta, T_w_h, T_w_h * guess.inverse(), tp::PerturbationSide::right));
  tp::PhotometricWorkspace workspace(in.patch.n);
  std::vector<double> r(static_cast<std::size_t>(in.patch.n)), J(r.size() * 9);
  tp::reference::residuals<tp::Parameters::pose_plane>(request, workspace, r.data(), J.data());
  print("residuals", r.data(), in.patch.n);
  print("residuals", J.data(), 9 * static_cast<std::ptrdiff_t>(in.patch.n));
}

void print_geometry(const Scene& scene) {
  print_pose("T_t_h", scene.T_t_h);
  print_matrix("log", tp::se3_log(scene.T_t_h));
  print_matrix("adjoint", tp::adjoint(scene.T_t_h));
  print_matrix("plane_homography", tp::plane_homography(scene.theta, scene.T_t_h));
  print_matrix("reanchor_plane", tp::reanchor_plane(scene.theta, scene.T_t_h));
  std::vector<tp::Vector3<double>> host, target;
  for (const tp::Vector2<double>& corner : scene.quad.corner) {
    host.push_back(scene.camera.unproject(corner));
    tp::Vector2<double> m(0, 0);
    tp::warp_point(scene.theta, scene.T_t_h, host.back(), &m);
    target.push_back({m[0] + 1e-4 * static_cast<double>(host.size()), m[1], 1.0});
  }
  const auto fit = tp::plane_from_matches(host, target, scene.T_t_h);
  print_matrix("plane_from_matches", fit.value);
  print_matrix("plane_from_matches", fit.covariance);
  print("plane_from_matches", {fit.condition, fit.sigma});
}

// The least ns a call of 300 repetitions of `calls`.
template <class F>
void print_time(const char* name, int calls, F f) {
  double least = 1e30;
  for (int repetition = 0; repetition < 300; ++repetition) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) f();
    const std::chrono::duration<double, std::nano> passed = std::chrono::steady_clock::now() - start;
    least = passed.count() / calls < least ? passed.count() / calls : least;
  }
  std::printf("%s %.1f\n", name, least);
}

void print_times(const Scene& scene, const tp::TextPatch& patch, const tp::Pyramid& pyramid) {
  volatile double sink = 0;  // what is computed is used
  tp::Vector6<double> error;
  error << 0.004, -0.003, 0.004, 0.002, -0.001, 0.003;
  const tp::SE3d guess = tp::se3_exp(error) * scene.T_t_h;
  print_time("plane_homography", 5000, [&] { sink = tp::plane_homography(scene.theta, scene.T_t_h)(0, 0); });
  const tp::ResidualRequest<std::uint8_t> request{
      tp::photometric_input(patch, 0, pyramid, scene.camera), scene.theta, guess, {}};
  tp::PhotometricWorkspace workspace(patch.max_pixels());
  print_time("linearise_pose", 200, [&] { sink = tp::linearise<tp::Parameters::pose>(request, workspace).cost; });
  print_time("evaluate", 200, [&] { sink = tp::evaluate(request, workspace).cost; });
  print_time("align_pose", 5, [&] { sink = tp::align_pose(patch, scene.theta, guess, pyramid, scene.camera).cost; });
}

}  // namespace

int main(int argc, char** argv) {
  const Scene scene;
  const tp::TextPatch patch = tp::make_patch(scene.host.view(), scene.camera, scene.quad);
  const tp::Pyramid pyramid(scene.target.view());
  if (argc > 1 && std::string(argv[1]) == "time") {
    print_times(scene, patch, pyramid);
    return 0;
  }
  print_geometry(scene);
  print_patch(patch);
  print_solves(scene, patch, pyramid);
}
