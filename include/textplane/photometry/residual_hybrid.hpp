// The double reference of LinearisePolicy::hybrid: its H. residual_request.hpp has the formula.
#ifndef TEXTPLANE_PHOTOMETRY_RESIDUAL_HYBRID_HPP
#define TEXTPLANE_PHOTOMETRY_RESIDUAL_HYBRID_HPP

#include <cstddef>
#include <cstdint>

#include "textplane/photometry/residual_passes.hpp"
#include "textplane/photometry/residual_rows.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {

// Whether the policy hybrid has what it needs; else it is forward.
template <class T>
bool takes_hybrid(const PolicyRequest<T>& q, int visible) noexcept {
  return q.prepared && !q.input.patch.mask && visible > kHybridPixels;
}

// Of the visible pixels, whose weights are in the workspace: the mean weight times sum |J^T a|^2.
template <class T>
double pulled_energy(const PolicyRequest<T>& request, PhotometricWorkspace& workspace) noexcept {
  const auto& in = request.input;
  const Pinhole<double>&h = in.host_camera, &c = in.target_camera;
  const Matrix3<double> H = plane_homography(request.theta, request.T_t_h);
  const Vector3<double> middle = product(H, patch_centre(in));
  FixedMatrix<double, 2, 2> J;
  for (int r = 0; r < 2; ++r) {
    const double ray = middle[r] / middle[2];
    J(r, 0) = (H(r, 0) - ray * H(2, 0)) / (middle[2] * h.fx);
    J(r, 1) = (H(r, 1) - ray * H(2, 1)) / (middle[2] * h.fy);
  }
  const std::uint8_t* visible = workspace.visible();
  const double* w = workspace.intensities();
  double energy = 0, weights = 0;
  int seen = 0;
  for (int i = 0; i < in.patch.n; ++i) {
    if (!visible[i]) continue;
    const Vector3<double> q = product(H, h.unproject({in.patch.x[i], in.patch.y[i]}));
    Vector2<double> m(q[0] / q[2], q[1] / q[2]);
    FixedMatrix<double, 2, 2> D = FixedMatrix<double, 2, 2>::Identity();
    if (in.lens) m = in.lens->distort(m, &D);
    double value, gx, gy;
    sample_inside(in.target, c.fx * m[0] + c.cx, c.fy * m[1] + c.cy, &value, &gx, &gy);
    const double a = gx * c.fx, b = gy * c.fy, by_u = a * D(0, 0) + b * D(1, 0), by_v = a * D(0, 1) + b * D(1, 1);
    for (int j = 0; j < 2; ++j) {
      const double pulled = J(0, j) * by_u + J(1, j) * by_v;
      energy += pulled * pulled;
    }
    weights += w[seen++];
  }
  return weights / seen * energy;
}

// The template's H of the whole patch, times `energy` of the target's normalised gradients over that of the host's. The
// workspace's numbers are lost.
template <int P, class T>
FixedMatrix<double, P, P> hybrid_matrix(const PolicyRequest<T>& request, const Matrix3<double>& inverse, double energy,
                                        PhotometricWorkspace& workspace) noexcept {
  const PatchView& patch = request.input.patch;
  const Pinhole<double>& camera = request.input.host_camera;
  const Matrix3<double> H = plane_homography(request.theta, request.T_t_h);
  const double* t = request.T_t_h.t.data();
  const bool exact = request.options.normalisation == Normalisation::exact;
  double host_energy = 0, mean = 0, squares = 0;
  for (int i = 0; i < patch.n; ++i) mean += static_cast<double>(patch.intensity[i]) / patch.n;
  double *rows = workspace.rows(), *h = workspace.residuals();
  for (int i = 0; i < patch.n; ++i) {
    h[i] = static_cast<double>(patch.intensity[i]) - mean;
    squares += h[i] * h[i];
    const Vector3<double> m = camera.unproject({patch.x[i], patch.y[i]}), q = product(H, m);
    const double gx = static_cast<double>(patch.gx[i]), gy = static_cast<double>(patch.gy[i]);
    host_energy += gx * gx + gy * gy;
    const double au = gx * camera.fx, av = gy * camera.fy, aw = -(au * m[0] + av * m[1]);
    double a[3];
    for (int j = 0; j < 3; ++j) a[j] = au * inverse(0, j) + av * inverse(1, j) + aw * inverse(2, j);
    intensity_row<P>(m[0], m[1], q.data(), request.theta.dot(m), a, t, rows + static_cast<std::ptrdiff_t>(i) * P);
  }
  double e[kLength<P>] = {}, c[kLength<P>] = {};
  for (int i = 0; exact && i < patch.n; ++i)
    for (int j = 0; j < P; ++j) {
      e[j] += rows[i * P + j] / patch.n;
      c[j] += h[i] / squares * rows[i * P + j];
    }
  FixedMatrix<double, P, P> out = FixedMatrix<double, P, P>::Zero();
  for (int i = 0; i < patch.n; ++i) {
    double row[kLength<P>];
    for (int j = 0; j < P; ++j) row[j] = rows[i * P + j] - e[j] - h[i] * c[j];
    for (int r = 0; r < P; ++r)
      for (int k = 0; k < P; ++k) out(r, k) += row[r] * row[k];
  }
  // 1 / s_h^2 of the rows and of the host's energy cancel.
  const double scale = energy / host_energy;
  for (int r = 0; r < P; ++r)
    for (int k = 0; k < P; ++k) out(r, k) *= scale;
  return out;
}

}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_RESIDUAL_HYBRID_HPP
