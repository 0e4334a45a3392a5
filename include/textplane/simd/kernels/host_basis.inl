// From rows of a homography in host coordinates to the nine parameters, in double: see simd/esm.hpp and docs/equations.md.

// M with j_host . M dp = dI: the host pixel (u, v), relative to (hx, hy), moves by K_h H^-1 dH K_h^-1. Columns v, omega, theta.
TEXTPLANE_SIMD_INLINE void host_matrix(const simd::ResidualArgs& a, const ResidualFrame& f, double (*M)[9]) noexcept {
  double H[9], back[3];
  for (int r = 0; r < 3; ++r) {
    for (int k = 0; k < 3; ++k) H[3 * r + k] = a.R[3 * r + k] + a.t[r] * a.theta[k];
    back[r] = f.inverse[3 * r] * a.t[0] + f.inverse[3 * r + 1] * a.t[1] + f.inverse[3 * r + 2] * a.t[2];
  }
  const double fx = a.host_camera[0], fy = a.host_camera[1];
  const double c = a.host_camera[2] - f.warp.hx, d = a.host_camera[3] - f.warp.hy;
  const double fxy = fx / fy, fyx = fy / fx, cx = c / fx, dy = d / fy;
  for (int k = 0; k < 9; ++k) {
    double G[9];  // H^-1 dH
    for (int r = 0; r < 3; ++r)
      for (int j = 0; j < 3; ++j) {
        const int p = (k + 1) % 3, q = (k + 2) % 3;
        if (k < 3) G[3 * r + j] = f.inverse[3 * r + k] * a.theta[j];
        else if (k < 6) G[3 * r + j] = f.inverse[3 * r + q] * H[3 * p + j] - f.inverse[3 * r + p] * H[3 * q + j];
        else G[3 * r + j] = j == k - 6 ? back[r] : 0.0;
      }
    const double m1 = G[0] - G[8], m2 = G[1], m4 = G[3], m5 = G[4] - G[8], m6 = -G[6], m7 = -G[7];
    M[0][k] = fx * G[2] - c * m1 - fxy * d * m2 + c * (cx * m6 + dy * m7);
    M[1][k] = m1 - 2 * cx * m6 - dy * m7;
    M[2][k] = fxy * m2 - c / fy * m7;
    M[3][k] = fy * G[5] - fyx * c * m4 - d * m5 + d * (cx * m6 + dy * m7);
    M[4][k] = fyx * m4 - d / fx * m6;
    M[5][k] = m5 - cx * m6 - 2 * dy * m7;
    M[6][k] = m6 / fx;
    M[7][k] = m7 / fy;
  }
}
