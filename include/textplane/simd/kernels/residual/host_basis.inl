// From rows of a homography in host coordinates to the nine parameters, in double (simd/esm.hpp, docs/equations.md).
// Include before: residual/frame.inl.

// The eight coefficients of the generator left^T right of a homography in pixels, `step` apart: set, and taken away.
TEXTPLANE_SIMD_INLINE void set_generator(const double* left, const double* right, std::ptrdiff_t step,
                                         double* m) noexcept {
  const double corner = left[2] * right[2];
  m[0] = left[0] * right[2];
  m[step] = left[0] * right[0] - corner;
  m[2 * step] = left[0] * right[1];
  m[3 * step] = left[1] * right[2];
  m[4 * step] = left[1] * right[0];
  m[5 * step] = left[1] * right[1] - corner;
  m[6 * step] = -(left[2] * right[0]);
  m[7 * step] = -(left[2] * right[1]);
}
TEXTPLANE_SIMD_INLINE void take_generator(const double* left, const double* right, std::ptrdiff_t step,
                                          double* m) noexcept {
  const double corner = left[2] * right[2];
  m[0] -= left[0] * right[2];
  m[step] -= left[0] * right[0] - corner;
  m[2 * step] -= left[0] * right[1];
  m[3 * step] -= left[1] * right[2];
  m[4 * step] -= left[1] * right[0];
  m[5 * step] -= left[1] * right[1] - corner;
  m[6 * step] += left[2] * right[0];
  m[7 * step] += left[2] * right[1];
}

// M with j_host . M dp = dI, as change_parameters() takes it: the host pixel (u, v), relative to (hx, hy), moves by K_h
// H^-1 dH K_h^-1. Parameters v, omega, theta. With h_k the columns of K_h H^-1 and r_k the rows of H K_h^-1 the
// generators are h_k (theta^T K_h^-1), h_(k+2) r_(k+1) - h_(k+1) r_(k+2), and (K_h H^-1 t) (e_k^T K_h^-1).
TEXTPLANE_SIMD_INLINE void host_matrix(const simd::ResidualArgs& a, const ResidualFrame& f, double (*M)[8]) noexcept {
  const double fx = a.host_camera[0], fy = a.host_camera[1], ifx = 1 / fx, ify = 1 / fy;
  const double c = a.host_camera[2] - static_cast<double>(f.warp.hx),
               d = a.host_camera[3] - static_cast<double>(f.warp.hy), cx = c * ifx, dy = d * ify;
  double column[3][3], row[3][3], back[3];
  for (int k = 0; k < 3; ++k) {
    const double h0 = f.inverse[k], h1 = f.inverse[3 + k], h2 = f.inverse[6 + k];
    column[k][0] = fx * h0 + c * h2;
    column[k][1] = fy * h1 + d * h2;
    column[k][2] = h2;
    const double q0 = a.R[3 * k] + a.t[k] * a.theta[0], q1 = a.R[3 * k + 1] + a.t[k] * a.theta[1];
    const double q2 = a.R[3 * k + 2] + a.t[k] * a.theta[2];
    row[k][0] = q0 * ifx;
    row[k][1] = q1 * ify;
    row[k][2] = q2 - q0 * cx - q1 * dy;
  }
  for (int r = 0; r < 3; ++r) back[r] = column[0][r] * a.t[0] + column[1][r] * a.t[1] + column[2][r] * a.t[2];
  const double theta[3] = {a.theta[0] * ifx, a.theta[1] * ify, a.theta[2] - a.theta[0] * cx - a.theta[1] * dy};
  const double unit[3][3] = {{ifx, 0, -cx}, {0, ify, -dy}, {0, 0, 1}};
  for (int k = 0; k < 3; ++k) {
    const int next = k < 2 ? k + 1 : 0, last = k > 0 ? k - 1 : 2;
    set_generator(column[k], theta, 8, &M[0][k]);
    set_generator(column[last], row[next], 8, &M[0][3 + k]);
    take_generator(column[next], row[last], 8, &M[0][3 + k]);
  }
  set_generator(back, unit[0], 8, &M[0][6]);
  set_generator(back, unit[1], 8, &M[0][7]);
  set_generator(back, unit[2], 1, M[8]);
}
