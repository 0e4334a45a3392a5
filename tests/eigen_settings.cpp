// Prints numbers of every room that holds matrices: compiled with each of Eigen's settings, the lines are the same
// (eigen_settings.cmake).
#include <cstdint>
#include <cstdio>
#include <vector>

#include <textplane/geometry/plane.hpp>
#include <textplane/geometry/plane_fit.hpp>
#include <textplane/photometry/patch.hpp>
#include <textplane/photometry/pyramid.hpp>
#include <textplane/photometry/residual.hpp>

namespace tp = textplane;

namespace {

// Seven digits: sums of vectors and of numbers one by one differ in the last ones.
template <class Derived>
void print(const char* name, const Eigen::MatrixBase<Derived>& m) {
  std::printf("%s", name);
  for (Eigen::Index r = 0; r < m.rows(); ++r)
    for (Eigen::Index c = 0; c < m.cols(); ++c) std::printf(" %.6e", m(r, c));
  std::printf("\n");
}

std::vector<std::uint8_t> picture(int width, int height) {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) pixels.push_back(static_cast<std::uint8_t>((x * x / 7 + 3 * x * y / 5 + y) % 211));
  return pixels;
}

void print_geometry(const tp::SE3d& T) {
  print("pose", T.R);
  print("adjoint", tp::adjoint(T));
  const std::vector<tp::Vector3<double>> points = {{0, 0, 2}, {1, 0, 2.1}, {0, 1, 2.3}, {1, 1, 2.5}};
  const auto plane = tp::plane_from_points(points);
  print("theta", plane.value);
  print("covariance", plane.covariance);
  tp::Matrix3<double> by_theta;
  tp::FixedMatrix<double, 3, 6> by_pose;
  print("reanchored", tp::reanchor_plane(plane.value, T, &by_theta, &by_pose));
  print("by theta", by_theta);
  print("by pose", by_pose);
}

bool print_photometry(const tp::SE3d& T) {
  const int width = 96, height = 64;
  const std::vector<std::uint8_t> pixels = picture(width, height);
  const tp::ImageView8 image(pixels.data(), width, height);
  const tp::Pinhole<double> camera(100, 90, 48, 32);
  const tp::Quad<double> quad{{tp::Vector2<double>(20, 15), tp::Vector2<double>(60, 17), tp::Vector2<double>(58, 40),
                               tp::Vector2<double>(21, 38)}};
  std::vector<std::vector<tp::Vector2<float>>> inside(1);
  for (int i = 0; i < 18; ++i)
    inside[0].emplace_back(static_cast<float>(23 + 5 * (i % 6)), static_cast<float>(20 + 6 * (i / 6) + i % 3));
  const tp::Pyramid pyramid(image, 1);
  const tp::TextPatch patch = tp::patch_from_pixels(pyramid, camera, quad, inside);
  tp::PhotometricWorkspace workspace;
  workspace.reserve(patch.max_pixels());
  const auto input = tp::photometric_input(patch, 0, pyramid, camera);
  const auto sums = tp::linearise<tp::Parameters::pose_plane>(
      tp::ResidualRequest<std::uint8_t>{input, tp::Vector3<double>(0.1, -0.05, 0.5), T}, workspace);
  print("H", sums.H);
  print("b", sums.b);
  return is_ok(patch.status) && is_ok(sums.status);
}

}  // namespace

int main() {
  tp::Vector6<double> xi;
  xi << 0.01, -0.02, 0.03, 0.02, -0.01, 0.015;
  const tp::SE3d T = tp::se3_exp(xi);
  print_geometry(T);
  return print_photometry(T) ? 0 : 1;
}
