// Prints random states and what the library says of their derivatives, as JSON, for check.py.
#include <array>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "textplane/geometry/homography.hpp"
#include "textplane/geometry/plane.hpp"
#include "textplane/photometry/residual.hpp"

namespace {

namespace tp = textplane;
using Vec3 = tp::Vector3<double>;

std::mt19937 draw(7);
double uniform(double low, double high) { return low + (high - low) * (static_cast<double>(draw()) / 4294967296.0); }
Vec3 vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
tp::SE3d pose(double turn, double shift) { return {tp::so3_exp<double>(vector(turn)), vector(shift)}; }

template <class Matrix>
std::string rows(const Matrix& m) {
  std::string out = "[";
  char number[32];
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    out += i > 0 ? ",[" : "[";
    for (Eigen::Index j = 0; j < m.cols(); ++j) {
      std::snprintf(number, sizeof number, "%s%.17g", j > 0 ? "," : "", m(i, j));
      out += number;
    }
    out += "]";
  }
  return out + "]";
}

template <class Matrix>
void field(const char* name, const Matrix& m, const char* end = ",") {
  std::printf("\"%s\":%s%s\n", name, rows(m).c_str(), end);
}

// The image that check.py knows by the same formula.
constexpr int kStates = 3;
constexpr int kSide = 24;
std::uint8_t pixel(int x, int y) {
  return static_cast<std::uint8_t>((x * x * 3 + y * y * 5 + x * y * 7 + 11 * x) % 251);
}

void geometry(const Vec3& theta, const Vec3& m, const tp::SE3d& T, const tp::SE3d& T_w_h, const tp::SE3d& T_w_t) {
  field("R", T.R);
  field("t", T.t);
  field("theta", theta);
  field("m", m);
  tp::Vector2<double> warped;
  tp::WarpJacobians<double> warp;
  tp::warp_point(theta, T, m, &warped, &warp);
  field("warp_pose", warp.pose);
  field("warp_theta", warp.theta);
  Vec3 moved;
  tp::Matrix3<double> by_theta;
  Eigen::Matrix<double, 3, 6> by_pose;
  tp::reanchor_plane(theta, T, &moved, &by_theta, &by_pose);
  field("reanchor_theta", by_theta);
  field("reanchor_pose", by_pose);
  field("R_w_h", T_w_h.R);
  field("t_w_h", T_w_h.t);
  field("R_w_t", T_w_t.R);
  field("t_w_t", T_w_t.t);
  const auto left = tp::relative_pose_jacobians(T_w_h, T_w_t, tp::PerturbationSide::left);
  const auto right = tp::relative_pose_jacobians(T_w_h, T_w_t, tp::PerturbationSide::right);
  field("left_host", left.host);
  field("left_target", left.target);
  field("right_host", right.host);
  field("right_target", right.target);
}

void residual(const Vec3& theta) {
  std::vector<std::uint8_t> bytes;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) bytes.push_back(pixel(x, y));
  constexpr int kPixels = 6;
  Eigen::Matrix<float, kPixels, 1> x, y, intensity;
  for (int i = 0; i < kPixels; ++i) {
    x[i] = static_cast<float>(uniform(8, 15));
    y[i] = static_cast<float>(uniform(8, 15));
    intensity[i] = static_cast<float>(uniform(20, 230));
  }
  tp::PhotometricInput in;
  in.patch.x = x.data();
  in.patch.y = y.data();
  in.patch.intensity = intensity.data();
  in.patch.n = kPixels;
  in.host_camera = {40, 42, 11.5, 11.25};
  in.target_camera = {38, 41, 12.25, 11.75};
  in.target = tp::ImageView8(bytes.data(), kSide, kSide, kSide);
  tp::PhotometricOptions options;
  options.min_visible = 1;
  options.robust = {tp::RobustKind::l2, 1};
  tp::PhotometricWorkspace workspace(kPixels);
  const tp::SE3d near{tp::so3_exp<double>(vector(0.02)), vector(0.05)};
  field("near_R", near.R);
  field("near_t", near.t);
  field("x", x);
  field("y", y);
  field("intensity", intensity);
  for (const bool exact : {true, false}) {
    options.normalisation = exact ? tp::Normalisation::exact : tp::Normalisation::frozen;
    const auto e =
        tp::reference::linearise<tp::Parameters::pose_plane>(tp::ResidualRequest{in, theta, near, options}, workspace);
    field(exact ? "exact_H" : "frozen_H", e.H);
    field(exact ? "exact_b" : "frozen_b", e.b);
  }
}

void state(bool last) {
  const tp::SE3d T = pose(0.3, 0.2), T_w_h = pose(1, 2), T_w_t = pose(1, 2);
  const Vec3 theta(uniform(-0.2, 0.2), uniform(-0.2, 0.2), uniform(0.3, 0.6)),
      m(uniform(-0.3, 0.3), uniform(-0.3, 0.3), 1);
  std::printf("{");
  geometry(theta, m, T, T_w_h, T_w_t);
  residual(theta);
  std::printf("\"status\":\"ok\"}%s\n", last ? "" : ",");
}

}  // namespace

int main() {
  std::printf("[");
  for (int i = 0; i < kStates; ++i) state(i == kStates - 1);
  std::printf("]\n");
}
