// Rows of derivatives of the intensity over a strip, from target coordinates x, y (relative to the origin) and gradient A, B.
// X = x - c and Y = y - d are relative to the principal point, D = A X + B Y (docs/equations.md).

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

// What the rows of the parameters need, rounded once: 1 / q_z rho as an affine function of the target pixel, the same for the
// host ray, and constants.
struct RowConstants {
  float c, d, iy2, ix2, aspect;  // principal point, 1 / fy^2, 1 / fx^2, (fx / fy)^2
  float k[3];                    // rho / q_z = k0 x + k1 y + k2
  float p0, p1, t3;              // a.t q_z = A (p0 - t3 x) + B (p1 - t3 y)
  float ray[9];                  // m~ / q_z, row by row
};
TEXTPLANE_SIMD_ENTRY void make_row_constants(const simd::ResidualArgs& a, const ResidualFrame& f,
                                             RowConstants* k) noexcept {
  const double fx = a.target_camera[0], fy = a.target_camera[1];
  k->c = static_cast<float>(f.c);
  k->d = static_cast<float>(f.d);
  k->ix2 = static_cast<float>(1 / (fx * fx));
  k->iy2 = static_cast<float>(1 / (fy * fy));
  k->aspect = static_cast<float>(fx * fx / (fy * fy));
  const double k0 = f.q[0] / fx, k1 = f.q[1] / fy;
  k->k[0] = static_cast<float>(k0);
  k->k[1] = static_cast<float>(k1);
  k->k[2] = static_cast<float>(f.q[2] - k0 * f.c - k1 * f.d);
  k->p0 = static_cast<float>(fx * a.t[0] + a.t[2] * f.c);
  k->p1 = static_cast<float>(fy * a.t[1] + a.t[2] * f.d);
  k->t3 = static_cast<float>(a.t[2]);
  for (int r = 0; r < 3; ++r) {
    const double r0 = f.inverse[3 * r] / fx, r1 = f.inverse[3 * r + 1] / fy;
    k->ray[3 * r] = static_cast<float>(r0);
    k->ray[3 * r + 1] = static_cast<float>(r1);
    k->ray[3 * r + 2] = static_cast<float>(f.inverse[3 * r + 2] - r0 * f.c - r1 * f.d);
  }
}

// Rows of v and omega, each less the factor that pose_scale() gives.
TEXTPLANE_SIMD_ENTRY void pose_rows(const RowConstants& k, const float* x, const float* y, const float* a,
                                    const float* b, int n, float (*TEXTPLANE_SIMD_RESTRICT row)[kStrip]) noexcept {
  for (int i = 0; i < n; i += kLanes) {
    const vf u = load(x + i), v = load(y + i), A = load(a + i), B = load(b + i);
    const vf X = sub(u, set1(k.c)), Y = sub(v, set1(k.d)), D = madd(A, X, mul(B, Y));
    const vf depth = madd(set1(k.k[0]), u, madd(set1(k.k[1]), v, set1(k.k[2])));
    store(row[0] + i, mul(depth, A));
    store(row[1] + i, mul(depth, B));
    store(row[2] + i, mul(depth, D));
    store(row[3] + i, madd(mul(Y, set1(k.iy2)), D, B));
    store(row[4] + i, madd(mul(X, set1(k.ix2)), D, A));
    store(row[5] + i, nmadd(mul(Y, set1(k.aspect)), A, mul(X, B)));
  }
}
TEXTPLANE_SIMD_INLINE void pose_scale(const simd::ResidualArgs& a, double* scale) noexcept {
  const double fx = a.target_camera[0], fy = a.target_camera[1];
  scale[0] = fx;
  scale[1] = fy;
  scale[2] = -1;
  scale[3] = -fy;
  scale[4] = fx;
  scale[5] = fy / fx;
}

// Rows of theta.
TEXTPLANE_SIMD_ENTRY void plane_rows(const RowConstants& k, const float* x, const float* y, const float* a,
                                     const float* b, int n, float (*TEXTPLANE_SIMD_RESTRICT row)[kStrip]) noexcept {
  const float* r = k.ray;
  for (int i = 0; i < n; i += kLanes) {
    const vf u = load(x + i), v = load(y + i), t3 = set1(k.t3);
    const vf T = madd(load(a + i), nmadd(t3, u, set1(k.p0)), mul(load(b + i), nmadd(t3, v, set1(k.p1))));
    store(row[0] + i, mul(T, madd(set1(r[0]), u, madd(set1(r[1]), v, set1(r[2])))));
    store(row[1] + i, mul(T, madd(set1(r[3]), u, madd(set1(r[4]), v, set1(r[5])))));
    store(row[2] + i, mul(T, madd(set1(r[6]), u, madd(set1(r[7]), v, set1(r[8])))));
  }
}
