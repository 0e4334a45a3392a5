// Written as a careful SLAM author writes it, and built -O3 -march=native. First pass: warp, bilinear value and gradient, row of
// dI, and the sums that mean, norm and their derivatives need. Second pass: residual, Huber weight, row of dr, and J^T W J as
// Eigen's matrix product over chunks of rows, or one rank-one update a pixel, whichever is faster for the number of parameters.
// Rows are kept between the passes in memory that is reused.
#include "baseline_eigen.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace textplane_bench {

namespace {

// A pixel whose point is in front of the camera and inside the image.
template <int P>
struct Pixel {
  Eigen::Matrix<double, P, 1> J;
  double host, target;
};

template <int P>
void baseline(const Problem& p, Equations* out) {
  using Row = Eigen::Matrix<double, P, 1>;
  using Square = Eigen::Matrix<double, P, P>;
  using Mat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  static thread_local std::vector<Pixel<P>, Eigen::aligned_allocator<Pixel<P>>> pixels;
  if (pixels.size() < static_cast<std::size_t>(p.n)) pixels.resize(static_cast<std::size_t>(p.n));

  const Mat3 R = Eigen::Map<const Mat3>(p.R);
  const Eigen::Vector3d t = Eigen::Map<const Eigen::Vector3d>(p.t), theta = Eigen::Map<const Eigen::Vector3d>(p.theta);
  const Mat3 homography = R + t * theta.transpose();
  const double ifx = 1 / p.fx, ify = 1 / p.fy;

  int n = 0;
  double sum_host = 0, sum_host2 = 0, sum_target = 0, sum_target2 = 0;
  Row sum_J = Row::Zero(), sum_IJ = Row::Zero();
  for (int i = 0; i < p.n; ++i) {
    const Eigen::Vector3d m((static_cast<double>(p.x[i]) - p.cx) * ifx, (static_cast<double>(p.y[i]) - p.cy) * ify, 1);
    const double rho = theta.dot(m);
    const Eigen::Vector3d q = homography * m;
    if (!(rho > 0) || !(q[2] > 0)) continue;
    const double iz = 1 / q[2], u = q[0] * iz, v = q[1] * iz, x = p.fx * u + p.cx, y = p.fy * v + p.cy;
    if (!(x >= 0 && y >= 0 && x <= p.width - 1 && y <= p.height - 1)) continue;
    const int x0 = std::min(static_cast<int>(x), p.width - 2), y0 = std::min(static_cast<int>(y), p.height - 2);
    const std::uint8_t* upper = p.target + y0 * p.stride + x0;
    const std::uint8_t* lower = upper + p.stride;
    const double dx = x - x0, dy = y - y0;
    const double along = upper[1] - upper[0], down = lower[0] - upper[0], twist = lower[1] - lower[0] - along;
    const double gx = along + dy * twist, gy = down + dx * twist;
    const double value = upper[0] + dx * along + dy * gy;

    const double au = gx * p.fx * iz, av = gy * p.fy * iz;
    const Eigen::Vector3d a(au, av, -(au * u + av * v));
    Pixel<P>& pixel = pixels[static_cast<std::size_t>(n++)];
    Row& J = pixel.J;
    J.template head<3>() = rho * a;
    J.template segment<3>(3) = q.cross(a);
    if constexpr (P == 9) J.template tail<3>() = a.dot(t) * m;
    pixel.host = static_cast<double>(p.intensity[i]);
    pixel.target = value;
    sum_host += pixel.host;
    sum_host2 += pixel.host * pixel.host;
    sum_target += value;
    sum_target2 += value * value;
    sum_J += J;
    sum_IJ += value * J;
  }

  const double N = n, mean_host = sum_host / N, mean_target = sum_target / N;
  const double is_host = 1 / std::sqrt(sum_host2 - N * mean_host * mean_host);
  const double is_target = 1 / std::sqrt(sum_target2 - N * mean_target * mean_target);
  const Row e = sum_J / N, c = is_target * (sum_IJ - mean_target * sum_J);
  const double threshold = p.delta / std::sqrt(N);
  constexpr int kChunk = P == 9 ? 64 : 1;
  Eigen::Matrix<double, P, kChunk> J, wJ;
  Square H = Square::Zero();
  Row b = Row::Zero();
  double cost = 0;
  for (int first = 0; first < n; first += kChunk) {
    const int count = std::min(kChunk, n - first);
    for (int k = 0; k < count; ++k) {
      const Pixel<P>& pixel = pixels[static_cast<std::size_t>(first + k)];
      const double normalised = (pixel.target - mean_target) * is_target;
      const double r = (pixel.host - mean_host) * is_host - normalised, size = std::abs(r);
      const double w = size <= threshold ? 1 : threshold / size;
      const Row j = -is_target * (pixel.J - e - normalised * c), wj = w * j;
      if constexpr (P == 9) {
        J.col(k) = j;
        wJ.col(k) = wj;
      } else {
        H.noalias() += wj * j.transpose();
      }
      b += r * wj;
      cost += w * r * r * (2 - w);
    }
    if constexpr (P == 9) {
      if (count == kChunk) {
        H.noalias() += wJ * J.transpose();
      } else {
        H.noalias() += wJ.leftCols(count) * J.leftCols(count).transpose();
      }
    }
  }
  Eigen::Map<Square> H_out(out->H);  // symmetric: its order does not matter
  H_out = H;
  Eigen::Map<Row> b_out(out->b);
  b_out = b;
  out->cost = cost;
  out->visible = n;
}

}  // namespace

void baseline_pose_plane(const Problem& problem, Equations* out) { baseline<9>(problem, out); }
void baseline_pose(const Problem& problem, Equations* out) { baseline<6>(problem, out); }

}  // namespace textplane_bench
