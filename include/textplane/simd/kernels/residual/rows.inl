// Rows of derivatives of the intensity over a strip, from target coordinates x, y (relative to the origin) and gradient
// A, B. X = x - c and Y = y - d are relative to the principal point, D = A X + B Y (docs/equations.md). Include before:
// residual/frame.inl.

// Rows of the pixel homography: Ax, Ay, Bx, By, Cx, Cy with C = Ax + By; A and B themselves are rows already.
TEXTPLANE_SIMD_ENTRY void homography_rows(const float* x, const float* y, const float* a, const float* b, int n,
                                          float (*TEXTPLANE_SIMD_RESTRICT row)[kStrip]) noexcept {
  for (int i = 0; i < n; i += kLanes) {
    const vf u = load(x + i), v = load(y + i), A = load(a + i), B = load(b + i);
    const vf Ax = mul(A, u), By = mul(B, v), C = add(Ax, By);
    store(row[0] + i, Ax);
    store(row[1] + i, mul(A, v));
    store(row[2] + i, mul(B, u));
    store(row[3] + i, By);
    store(row[4] + i, mul(C, u));
    store(row[5] + i, mul(C, v));
  }
}

// What the rows of the parameters need, rounded once: 1 / q_z rho as an affine function of the target pixel, the same
// for the host ray, and constants.
struct RowConstants {
  float fx, fy, ifx, ify, mu, mv;  // normalised target coordinates: x ifx + mu, y ify + mv
  float k[3];                      // rho / q_z = k0 x + k1 y + k2
  float p0, p1, t3;                // a.t q_z = A (p0 - t3 x) + B (p1 - t3 y)
  float ray[9];                    // m~ / q_z, row by row
};
TEXTPLANE_SIMD_ENTRY void make_row_constants(const simd::ResidualArgs& a, const ResidualFrame& f,
                                             RowConstants* k) noexcept {
  const double fx = f.fx, fy = f.fy, ix = f.ifx, iy = f.ify, mu = -f.c * ix, mv = -f.d * iy;
  k->fx = static_cast<float>(fx);
  k->fy = static_cast<float>(fy);
  k->ifx = static_cast<float>(ix);
  k->ify = static_cast<float>(iy);
  k->mu = static_cast<float>(mu);
  k->mv = static_cast<float>(mv);
  k->k[0] = static_cast<float>(f.q[0] * ix);
  k->k[1] = static_cast<float>(f.q[1] * iy);
  k->k[2] = static_cast<float>(f.q[2] + f.q[0] * mu + f.q[1] * mv);
  k->p0 = static_cast<float>(fx * a.t[0] + a.t[2] * f.c);
  k->p1 = static_cast<float>(fy * a.t[1] + a.t[2] * f.d);
  k->t3 = static_cast<float>(a.t[2]);
  for (int r = 0; r < 9; r += 3) {
    const double r0 = f.inverse[r], r1 = f.inverse[r + 1];
    k->ray[r] = static_cast<float>(r0 * ix);
    k->ray[r + 1] = static_cast<float>(r1 * iy);
    k->ray[r + 2] = static_cast<float>(f.inverse[r + 2] + r0 * mu + r1 * mv);
  }
}

// Rows of v and omega.
TEXTPLANE_SIMD_ENTRY void pose_rows(const RowConstants& k, const float* x, const float* y, const float* a,
                                    const float* b, int n, std::ptrdiff_t step,
                                    float* TEXTPLANE_SIMD_RESTRICT row) noexcept {
  for (int i = 0; i < n; i += kLanes) {
    const vf u = load(x + i), v = load(y + i), A = mul(load(a + i), set1(k.fx)), B = mul(load(b + i), set1(k.fy));
    const vf X = madd(u, set1(k.ifx), set1(k.mu)), Y = madd(v, set1(k.ify), set1(k.mv)), D = neg(madd(A, X, mul(B, Y)));
    const vf depth = madd(set1(k.k[0]), u, madd(set1(k.k[1]), v, set1(k.k[2])));
    float* out = row + i;
    store(out, mul(depth, A));
    store(out + step, mul(depth, B));
    store(out + 2 * step, mul(depth, D));
    store(out + 3 * step, sub(mul(Y, D), B));
    store(out + 4 * step, nmadd(X, D, A));
    store(out + 5 * step, nmadd(Y, A, mul(X, B)));
  }
}

// Rows of theta.
TEXTPLANE_SIMD_ENTRY void plane_rows(const RowConstants& k, const float* x, const float* y, const float* a,
                                     const float* b, int n, std::ptrdiff_t step,
                                     float* TEXTPLANE_SIMD_RESTRICT row) noexcept {
  const float* r = k.ray;
  for (int i = 0; i < n; i += kLanes) {
    const vf u = load(x + i), v = load(y + i), t3 = set1(k.t3);
    const vf T = madd(load(a + i), nmadd(t3, u, set1(k.p0)), mul(load(b + i), nmadd(t3, v, set1(k.p1))));
    float* out = row + i;
    store(out, mul(T, madd(set1(r[0]), u, madd(set1(r[1]), v, set1(r[2])))));
    store(out + step, mul(T, madd(set1(r[3]), u, madd(set1(r[4]), v, set1(r[5])))));
    store(out + 2 * step, mul(T, madd(set1(r[6]), u, madd(set1(r[7]), v, set1(r[8])))));
  }
}
