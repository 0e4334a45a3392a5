// The passes over the pixels that the double reference is made of (docs/equations.md):
//
//   collect      warp, sample, intensity derivatives; keeps the visible pixels only, closed up
//   normalise    mean and norm of both sides, then residuals and normalised target intensities in place
//   project      derivatives of intensities -> derivatives of residuals
//   accumulate   weighted sums
//
// Everything here works on the caller's PhotometricWorkspace and allocates nothing.
#ifndef TEXTPLANE_PHOTOMETRY_RESIDUAL_PASSES_HPP
#define TEXTPLANE_PHOTOMETRY_RESIDUAL_PASSES_HPP

#include <cstddef>
#include <cstdint>
#include <utility>

#include "textplane/core/se3.hpp"
#include "textplane/photometry/photometric_workspace.hpp"
#include "textplane/photometry/residual_request.hpp"
#include "textplane/photometry/residual_result.hpp"
#include "textplane/photometry/sample.hpp"
#include "textplane/photometry/zncc.hpp"

TEXTPLANE_BEGIN_NAMESPACE

namespace detail {

// Parameters of a row: P = 0 none, 3 theta, 6 pose (v, omega), 9 (v, omega, theta).

inline Status check_camera(const Pinhole<double>& camera) noexcept {
  if (!is_finite(camera.fx) || !is_finite(camera.fy) || !is_finite(camera.cx) || !is_finite(camera.cy))
    return Status::non_finite;
  return camera.valid() ? Status::ok : Status::invalid_argument;
}

TEXTPLANE_DEFERRED
inline Status check_camera(const CameraView& camera) noexcept {
  const Status status = check_camera(camera.pinhole);
  return is_ok(status) && !camera.valid() ? Status::invalid_argument : status;
}

// What is wrong with a request, if anything.
template <class T>
Status check_request(const ResidualRequest<T>& q, const PhotometricWorkspace& workspace) noexcept {
  const PatchView& p = q.input.patch;
  if (!p.x || !p.y || !p.intensity || p.n < 0 || p.n > workspace.capacity()) return Status::invalid_argument;
  if (!q.input.target.valid() || !q.options.valid()) return Status::invalid_argument;
  for (const Pinhole<double>* camera : {&q.input.host_camera, &q.input.target_camera}) {
    const Status status = check_camera(*camera);
    if (!is_ok(status)) return status;
  }
  if (q.input.lens && !(q.input.lens->max_r2() > 0)) return Status::invalid_argument;
  return all_finite(q.T_t_h) && all_finite(q.theta) ? Status::ok : Status::non_finite;
}

struct Collected {
  int candidates = 0;  // pixels that the mask and the given set let through
  int behind = 0;      // of these: behind one of the cameras
  int visible = 0;
};

// Row of dI for one pixel. m = (mx, my, 1), q = H m~, a = dI/dq, rho = theta^T m~, t the translation:
// dI/dv = rho a, dI/domega = q x a, dI/dtheta = (a . t) m~.
template <int P>
void intensity_row(double mx, double my, const double* q, double rho, const double* a, const double* t,
                   double* row) noexcept {
  if constexpr (P >= 6) {
    row[0] = rho * a[0];
    row[1] = rho * a[1];
    row[2] = rho * a[2];
    row[3] = q[1] * a[2] - q[2] * a[1];
    row[4] = q[2] * a[0] - q[0] * a[2];
    row[5] = q[0] * a[1] - q[1] * a[0];
  }
  if constexpr (P == 3 || P == 9) {
    const double at = a[0] * t[0] + a[1] * t[1] + a[2] * t[2];
    row[P - 3] = at * mx;
    row[P - 2] = at * my;
    row[P - 1] = at;
  }
}

// Visits the pixels of the patch (of `on_set`, where given) and writes host intensity, target intensity and row of each
// visible one to the workspace, closed up. A pixel is visible when its plane point lies in front of both cameras, it
// projects into the target, and both intensities are finite. `flags`, where given, receives one byte a pixel.
template <int P, class T>
Collected collect(const ResidualRequest<T>& request, const std::uint8_t* on_set, std::uint8_t* flags,
                  PhotometricWorkspace& workspace) noexcept {
  // Plain locals: the compiler must not fear that a store to the workspace changes them.
  const SE3d& T_t_h = request.T_t_h;
  const Vector3<double>& theta = request.theta;
  double H[9];
  for (int k = 0; k < 9; ++k) H[k] = T_t_h.R(k / 3, k % 3) + T_t_h.t[k / 3] * theta[k % 3];
  [[maybe_unused]] const double t[3] = {T_t_h.t[0], T_t_h.t[1], T_t_h.t[2]}, p[3] = {theta[0], theta[1], theta[2]};
  const Pinhole<double> h = request.input.host_camera, c = request.input.target_camera;
  const PatchView patch = request.input.patch;
  const ImageView<const T> image = request.input.target;
  const LensMap* lens = request.input.lens;
  const double ifx = 1.0 / h.fx, ify = 1.0 / h.fy, x_max = image.width() - 1, y_max = image.height() - 1;
  double *host = workspace.residuals(), *target = workspace.intensities(), *row = workspace.rows();

  int candidates = 0, behind = 0, visible = 0;
  for (int i = 0; i < patch.n; ++i) {
    if (flags) flags[i] = 0;
    if ((patch.mask && !patch.mask[i]) || (on_set && !on_set[i])) continue;
    ++candidates;
    const double mx = (static_cast<double>(patch.x[i]) - h.cx) * ifx;
    const double my = (static_cast<double>(patch.y[i]) - h.cy) * ify;
    const double rho = p[0] * mx + p[1] * my + p[2];
    const double q[3] = {H[0] * mx + H[1] * my + H[2], H[3] * mx + H[4] * my + H[5], H[6] * mx + H[7] * my + H[8]};
    if (!(rho > 0.0) || !(q[2] > 0.0)) {
      ++behind;
      continue;
    }
    const double iz = 1.0 / q[2], u = q[0] * iz, v = q[1] * iz;
    Vector2<double> m(u, v);
    FixedMatrix<double, 2, 2> D;
    if (lens) {
      if (!(m.squaredNorm() <= lens->max_r2())) continue;
      m = lens->distort(m, &D);
    }
    const double x = c.fx * m[0] + c.cx, y = c.fy * m[1] + c.cy;
    if (!is_finite(x) || !is_finite(y) || !(x >= 0.0 && y >= 0.0 && x <= x_max && y <= y_max)) continue;
    double value, gx, gy;
    sample_inside(image, x, y, &value, &gx, &gy);
    const double host_value = static_cast<double>(patch.intensity[i]);
    if (!is_finite(value) || !is_finite(host_value)) continue;

    if constexpr (P > 0) {
      double au = gx * c.fx * iz, av = gy * c.fy * iz;
      if (lens) {
        const double bent = au * D(0, 0) + av * D(1, 0);
        av = au * D(0, 1) + av * D(1, 1);
        au = bent;
      }
      const double a[3] = {au, av, -(au * u + av * v)};
      intensity_row<P>(mx, my, q, rho, a, t, row + static_cast<std::ptrdiff_t>(visible) * P);
    }
    host[visible] = host_value;
    target[visible] = value;
    ++visible;
    if (flags) flags[i] = 1;
  }
  return {candidates, behind, visible};
}

// Why a set is too small: no pixel in front of the cameras, none in the image, or just not enough.
inline Status visibility_status(const Collected& c, int min_visible) noexcept {
  if (c.visible > 0 && c.visible >= min_visible) return Status::ok;
  if (c.visible > 0 || c.candidates == 0) return Status::too_few;
  return c.behind == c.candidates ? Status::behind_camera : Status::out_of_view;
}

// Turns the workspace's host intensities into residuals r and its target intensities into normalised ones.
inline Status normalise(int n, double min_contrast, PhotometricWorkspace& workspace, IntensityStats* target,
                        IntensityStats* host) noexcept {
  double *r = workspace.residuals(), *normalised = workspace.intensities();
  *target = intensity_stats(normalised, nullptr, n, 1, min_contrast);
  if (!is_ok(target->status)) return target->status;
  *host = intensity_stats(r, nullptr, n, 1, min_contrast);
  if (!is_ok(host->status)) return host->status;
  const double host_scale = 1.0 / host->s, target_scale = 1.0 / target->s;
  for (int k = 0; k < n; ++k) {
    normalised[k] = (normalised[k] - target->mean) * target_scale;
    r[k] = (r[k] - host->mean) * host_scale - normalised[k];
  }
  return Status::ok;
}

// e = sum dI / N and c = sum I~ dI, the columns unrolled so that the accumulators stay in registers.
template <int P, int... K>
void row_sums(int n, const double* target, const double* row, double* e, double* c,
              std::integer_sequence<int, K...>) noexcept {
  double sum[kLength<P>] = {}, product[kLength<P>] = {};
  for (int k = 0; k < n; ++k, row += P) {
    const double i = target[k];
    ((sum[K] += row[K], product[K] += i * row[K]), ...);
  }
  ((e[K] = sum[K] / n, c[K] = product[K]), ...);
}

// Turns the rows dI into rows of dr = -dI~, in place: -(1/s) (dI - e - I~ c), or -dI / s with the normalisation frozen.
template <int P>
void project(int n, double s, Normalisation normalisation, PhotometricWorkspace& workspace) noexcept {
  double e[kLength<P>] = {}, c[kLength<P>] = {};
  const double scale = -1.0 / s;
  const double* target = workspace.intensities();
  double* row = workspace.rows();
  if (normalisation == Normalisation::exact) row_sums<P>(n, target, row, e, c, std::make_integer_sequence<int, P>());
  for (int k = 0; k < n; ++k, row += P) {
    const double i = target[k];
    for (int j = 0; j < P; ++j) row[j] = scale * (row[j] - e[j] - i * c[j]);
  }
}

// Robust cost of the residuals; their weights replace the (no longer needed) target intensities.
struct WeightedCost {
  double cost = 0.0, error = 0.0;
};
inline WeightedCost weigh(int n, const Robust& robust, PhotometricWorkspace& workspace) noexcept {
  const double *r = workspace.residuals(), count = n;
  double* w = workspace.intensities();
  WeightedCost out;
  for (int k = 0; k < n; ++k) {
    const double r2 = r[k] * r[k];
    w[k] = robust.weight(count * r2);
    out.cost += robust.rho(count * r2);
    out.error += r2;
  }
  out.cost /= count;
  return out;
}

// Row I of the upper triangle of sum w j j^T, columns I to P - 1, and sum w r j_I. A pass over all pixels for each row
// keeps its accumulators in registers.
template <int P, int I, int... K>
void accumulate_row(int n, const double* w, const double* r, const double* row, FixedMatrix<double, P, P>* H,
                    Eigen::Matrix<double, P, 1>* b, std::integer_sequence<int, K...>) noexcept {
  double h[sizeof...(K)] = {}, g = 0.0;
  for (int k = 0; k < n; ++k, row += P) {
    const double wj = w[k] * row[I];
    g += wj * r[k];
    ((h[K] += wj * row[I + K]), ...);
  }
  (((*H)(I, I + K) = h[K], (*H)(I + K, I) = h[K]), ...);
  (*b)[I] = g;
}

// H = sum w j j^T, b = sum w r j.
template <int P, int... I>
void accumulate_rows(int n, PhotometricWorkspace& workspace, FixedMatrix<double, P, P>* H,
                     Eigen::Matrix<double, P, 1>* b, std::integer_sequence<int, I...>) noexcept {
  (accumulate_row<P, I>(n, workspace.intensities(), workspace.residuals(), workspace.rows(), H, b,
                        std::make_integer_sequence<int, P - I>()),
   ...);
}
template <int P>
void accumulate(int n, PhotometricWorkspace& workspace, FixedMatrix<double, P, P>* H,
                Eigen::Matrix<double, P, 1>* b) noexcept {
  accumulate_rows<P>(n, workspace, H, b, std::make_integer_sequence<int, P>());
}

}  // namespace detail

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_RESIDUAL_PASSES_HPP
