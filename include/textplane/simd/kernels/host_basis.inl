// From rows of a homography in host coordinates to the nine parameters, in double: see simd/esm.hpp and docs/equations.md.

// The eight coefficients of the generator left^T right of a homography in pixels.
TEXTPLANE_SIMD_INLINE void generator(const double* left, const double* right, double* m) noexcept {
  const double corner = left[2] * right[2];
  m[0] = left[0] * right[2];
  m[1] = left[0] * right[0] - corner;
  m[2] = left[0] * right[1];
  m[3] = left[1] * right[2];
  m[4] = left[1] * right[0];
  m[5] = left[1] * right[1] - corner;
  m[6] = -(left[2] * right[0]);
  m[7] = -(left[2] * right[1]);
}

// M with j_host . M dp = dI, as change_parameters() takes it: the host pixel (u, v), relative to (hx, hy), moves by
// K_h H^-1 dH K_h^-1. Parameters v, omega, theta. With h_k the columns of K_h H^-1 and r_k the rows of H K_h^-1 the generators
// are h_k (theta^T K_h^-1), h_(k+2) r_(k+1) - h_(k+1) r_(k+2), and (K_h H^-1 t) (e_k^T K_h^-1).
TEXTPLANE_SIMD_INLINE void host_matrix(const simd::ResidualArgs& a, const ResidualFrame& f, double (*M)[8]) noexcept {
  const double fx = a.host_camera[0], fy = a.host_camera[1], ifx = 1 / fx, ify = 1 / fy;
  const double c = a.host_camera[2] - f.warp.hx, d = a.host_camera[3] - f.warp.hy, cx = c * ifx, dy = d * ify;
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
  double m[9][8], other[3][8];
  generator(column[0], theta, m[0]);
  generator(column[1], theta, m[1]);
  generator(column[2], theta, m[2]);
  generator(column[2], row[1], m[3]);
  generator(column[1], row[2], other[0]);
  generator(column[0], row[2], m[4]);
  generator(column[2], row[0], other[1]);
  generator(column[1], row[0], m[5]);
  generator(column[0], row[1], other[2]);
  generator(back, unit[0], m[6]);
  generator(back, unit[1], m[7]);
  generator(back, unit[2], m[8]);
  for (int e = 0; e < 8; ++e) {
    for (int k = 0; k < 3; ++k) {
      M[e][k] = m[k][e];
      M[e][3 + k] = m[3 + k][e] - other[k][e];
    }
    M[e][6] = m[6][e];
    M[e][7] = m[7][e];
    M[8][e] = m[8][e];
  }
}
