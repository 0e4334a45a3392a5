// Written as a careful SLAM author writes it, and built -O3 -march=native. collect() warps each pixel, samples value
// and gradient, and keeps its row of dI. accumulate() weights the rows and sums J^T W J: as Eigen's matrix product over
// chunks of rows, or as one rank-one update a pixel, whichever is faster for the number of parameters.
#include "peers/eigen.hpp"

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
using Row = Eigen::Matrix<double, P, 1>;
template <int P>
using Pixels = std::vector<Pixel<P>, Eigen::aligned_allocator<Pixel<P>>>;

// What the means, the norms and their derivatives need.
template <int P>
struct Sums {
  int n = 0;
  double host = 0, host2 = 0, target = 0, target2 = 0;
  Row<P> J = Row<P>::Zero(), IJ = Row<P>::Zero();
};

template <int P>
Sums<P> collect(const Problem& p, Pixels<P>& pixels) {
  using Mat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Mat3 R = Eigen::Map<const Mat3>(p.R);
  const Eigen::Vector3d t = Eigen::Map<const Eigen::Vector3d>(p.t), theta = Eigen::Map<const Eigen::Vector3d>(p.theta);
  const Mat3 homography = R + t * theta.transpose();
  const double ifx = 1 / p.fx, ify = 1 / p.fy;
  Sums<P> sums;
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
    Pixel<P>& pixel = pixels[static_cast<std::size_t>(sums.n++)];
    Row<P>& J = pixel.J;
    J.template head<3>() = rho * a;
    J.template segment<3>(3) = q.cross(a);
    if constexpr (P == 9) J.template tail<3>() = a.dot(t) * m;
    pixel.host = static_cast<double>(p.intensity[i]);
    pixel.target = value;
    sums.host += pixel.host;
    sums.host2 += pixel.host * pixel.host;
    sums.target += value;
    sums.target2 += value * value;
    sums.J += J;
    sums.IJ += value * J;
  }
  return sums;
}

template <int P>
void accumulate(const Problem& p, const Pixels<P>& pixels, const Sums<P>& sums, Equations* out) {
  using Square = Eigen::Matrix<double, P, P>;
  const double N = sums.n, mean_host = sums.host / N, mean_target = sums.target / N;
  const double is_host = 1 / std::sqrt(sums.host2 - N * mean_host * mean_host);
  const double is_target = 1 / std::sqrt(sums.target2 - N * mean_target * mean_target);
  const Row<P> e = sums.J / N, c = is_target * (sums.IJ - mean_target * sums.J);
  const double threshold = p.delta / std::sqrt(N);
  constexpr int kChunk = P == 9 ? 64 : 1;
  Eigen::Matrix<double, P, kChunk> J, wJ;
  Square H = Square::Zero();
  Row<P> b = Row<P>::Zero();
  double cost = 0;
  for (int first = 0; first < sums.n; first += kChunk) {
    const int count = std::min(kChunk, sums.n - first);
    for (int k = 0; k < count; ++k) {
      const Pixel<P>& pixel = pixels[static_cast<std::size_t>(first + k)];
      const double normalised = (pixel.target - mean_target) * is_target;
      const double r = (pixel.host - mean_host) * is_host - normalised, size = std::abs(r);
      const double w = size <= threshold ? 1 : threshold / size;
      const Row<P> j = -is_target * (pixel.J - e - normalised * c), wj = w * j;
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
  Eigen::Map<Square>(out->H) = H;  // symmetric: the order of its entries does not matter
  Eigen::Map<Row<P>>(out->b) = b;
  out->cost = cost;
  out->visible = sums.n;
}

template <int P>
void baseline(const Problem& problem, Equations* out) {
  static thread_local Pixels<P> pixels;
  if (pixels.size() < static_cast<std::size_t>(problem.n)) pixels.resize(static_cast<std::size_t>(problem.n));
  accumulate(problem, pixels, collect<P>(problem, pixels), out);
}

}  // namespace

void baseline_pose_plane(const Problem& problem, Equations* out) { baseline<9>(problem, out); }
void baseline_pose(const Problem& problem, Equations* out) { baseline<6>(problem, out); }

}  // namespace textplane_bench
