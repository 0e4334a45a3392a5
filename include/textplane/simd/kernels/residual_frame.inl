// Geometry of one residual call, in double: see simd/residual.hpp.

TEXTPLANE_SIMD_INLINE double abs_d(double x) noexcept { return x < 0 ? -x : x; }

// The least value of f0 u + f1 v + f2 for |u| <= ru, |v| <= rv.
TEXTPLANE_SIMD_INLINE double least_in_box(double f0, double f1, double f2, double ru, double rv) noexcept {
  return f2 - abs_d(f0) * ru - abs_d(f1) * rv;
}

// False where float or H^-1 do not carry the case.
TEXTPLANE_SIMD_ENTRY bool make_frame(const simd::ResidualArgs& a, const simd::PointBounds& bounds,
                                     ResidualFrame* f) noexcept {
  const double *p = a.theta, *R = a.R, *t = a.t;
  const double H[9] = {R[0] + t[0] * p[0], R[1] + t[0] * p[1], R[2] + t[0] * p[2],
                       R[3] + t[1] * p[0], R[4] + t[1] * p[1], R[5] + t[1] * p[2],
                       R[6] + t[2] * p[0], R[7] + t[2] * p[1], R[8] + t[2] * p[2]};
  const double adj[9] = {H[4] * H[8] - H[5] * H[7], H[2] * H[7] - H[1] * H[8], H[1] * H[5] - H[2] * H[4],
                         H[5] * H[6] - H[3] * H[8], H[0] * H[8] - H[2] * H[6], H[2] * H[3] - H[0] * H[5],
                         H[3] * H[7] - H[4] * H[6], H[1] * H[6] - H[0] * H[7], H[0] * H[4] - H[1] * H[3]};
  const double det = H[0] * adj[0] + H[1] * adj[3] + H[2] * adj[6];
  if (!(abs_d(det) > 1e-9)) return false;
  const double idet = 1 / det;
  for (int k = 0; k < 9; ++k) f->inverse[k] = adj[k] * idet;
  for (int k = 0; k < 3; ++k) f->q[k] = p[0] * f->inverse[k] + p[1] * f->inverse[3 + k] + p[2] * f->inverse[6 + k];

  // G = K_t H K_h^-1, and rho as a function of the host pixel.
  const double ifx = 1 / a.host_camera[0], ify = 1 / a.host_camera[1], hcx = a.host_camera[2], hcy = a.host_camera[3];
  const double fx = a.target_camera[0], fy = a.target_camera[1], cx = a.target_camera[2], cy = a.target_camera[3];
  const double s0 = H[0] * ifx, s1 = H[1] * ify, s2 = H[2] - s0 * hcx - s1 * hcy;
  const double s3 = H[3] * ifx, s4 = H[4] * ify, s5 = H[5] - s3 * hcx - s4 * hcy;
  const double s6 = H[6] * ifx, s7 = H[7] * ify, s8 = H[8] - s6 * hcx - s7 * hcy;
  const double G[9] = {fx * s0 + cx * s6,
                       fx * s1 + cx * s7,
                       fx * s2 + cx * s8,
                       fy * s3 + cy * s6,
                       fy * s4 + cy * s7,
                       fy * s5 + cy * s8,
                       s6,
                       s7,
                       s8};
  // Larger patches, and those with a position at infinity, float cannot centre. (A NaN compares false.)
  const double wide = static_cast<double>(bounds.x_high) - static_cast<double>(bounds.x_low);
  const double high = static_cast<double>(bounds.y_high) - static_cast<double>(bounds.y_low);
  if (!finite_d(wide) || !finite_d(high) || wide > 32768 || high > 32768) return false;
  const float hx = middle_x(bounds), hy = middle_y(bounds);
  if (!make_warp(G, hx, hy, a.target.width, a.target.height, &f->warp)) return false;
  make_sample_frame(a.target, f->warp, &f->sample);
  f->c = cx - f->warp.ox;
  f->d = cy - f->warp.oy;
  const double r0 = p[0] * ifx, r1 = p[1] * ify, r2 = p[2] + r0 * (hx - hcx) + r1 * (hy - hcy);
  f->rho[0] = static_cast<float>(r0);
  f->rho[1] = static_cast<float>(r1);
  f->rho[2] = static_cast<float>(r2);
  if (!(abs_d(r0) < 1e30 && abs_d(r1) < 1e30 && abs_d(r2) < 1e30)) return false;

  // All of the patch is visible if its corners are: what must be positive is affine in u and v.
  const double ru = static_cast<double>(bounds.x_high) - hx + 1e-3, rv = static_cast<double>(bounds.y_high) - hy + 1e-3;
  const float* g = f->warp.g;
  const double margin = 1e-3, g6 = g[6], g7 = g[7], g8 = g[8];
  const double x0 = f->sample.x_low + margin, x1 = f->sample.x_last - margin;
  const double y0 = f->sample.y_low + margin, y1 = f->sample.y_last - margin;
  f->inside = bounds.n == a.n && least_in_box(g6, g7, g8, ru, rv) > 1e-3 &&
              least_in_box(r0, r1, r2, ru, rv) > 1e-6 * abs_d(r2) &&
              least_in_box(g[0] - x0 * g6, g[1] - x0 * g7, g[2] - x0 * g8, ru, rv) > 0 &&
              least_in_box(x1 * g6 - g[0], x1 * g7 - g[1], x1 * g8 - g[2], ru, rv) > 0 &&
              least_in_box(g[3] - y0 * g6, g[4] - y0 * g7, g[5] - y0 * g8, ru, rv) > 0 &&
              least_in_box(y1 * g6 - g[3], y1 * g7 - g[4], y1 * g8 - g[5], ru, rv) > 0;
  return true;
}
