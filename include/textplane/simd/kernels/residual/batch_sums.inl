// Sums of products for simd/batch.hpp: one object a lane, sums in registers, a loop over the pixels. Include before:
// residual/batch_sample.inl.

// residual/batch_sample.inl.

// Three rows from `row` on: their sums over the pixels, and their sums times the target's intensity.
TEXTPLANE_SIMD_INLINE void batch_means(const float* scratch, int n, int row, vf* sum, vf* product) noexcept {
  vf s0 = zero(), s1 = s0, s2 = s0, p0 = s0, p1 = s0, p2 = s0;
  for (int k = 0; k < n; ++k) {
    const float* p = scratch + static_cast<std::ptrdiff_t>(k) * kBatchFields * kLanes;
    const vf i = hold(load(p + kBatchTarget * kLanes));
    const vf a = hold(load(p + row * kLanes)), b = hold(load(p + (row + 1) * kLanes)),
             c = hold(load(p + (row + 2) * kLanes));
    s0 = add(s0, a);
    s1 = add(s1, b);
    s2 = add(s2, c);
    p0 = madd(i, a, p0);
    p1 = madd(i, b, p1);
    p2 = madd(i, c, p2);
  }
  sum[row] = s0;
  sum[row + 1] = s1;
  sum[row + 2] = s2;
  product[row] = p0;
  product[row + 1] = p1;
  product[row + 2] = p2;
}

// Where H(r, c), r <= c, lies in the packed upper triangle.
TEXTPLANE_SIMD_INLINE int batch_at(int parameters, int r, int c) noexcept {
  return r * parameters - r * (r - 1) / 2 + c - r;
}

TEXTPLANE_SIMD_INLINE void batch_put(float* out, int entry, vf value) noexcept {
  store(out + entry * kBatchStep, value);
}

// Products of the rows row .. row + 2 among themselves and with r. Returns a sum that is finite where these are: the
// diagonal bounds the others.
TEXTPLANE_SIMD_INLINE vf batch_square(const float* scratch, int n, int parameters, int row, vf scale, vf scale_b,
                                      float* out) noexcept {
  vf s0 = zero(), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, b0 = s0, b1 = s0, b2 = s0;
  for (int k = 0; k < n; ++k) {
    const float* p = scratch + static_cast<std::ptrdiff_t>(k) * kBatchFields * kLanes;
    const vf a = hold(load(p + row * kLanes)), b = hold(load(p + (row + 1) * kLanes)),
             c = hold(load(p + (row + 2) * kLanes));
    const vf r = hold(load(p + kBatchHost * kLanes));
    s0 = madd(a, a, s0);
    s1 = madd(a, b, s1);
    s2 = madd(a, c, s2);
    s3 = madd(b, b, s3);
    s4 = madd(b, c, s4);
    s5 = madd(c, c, s5);
    b0 = madd(a, r, b0);
    b1 = madd(b, r, b1);
    b2 = madd(c, r, b2);
  }
  batch_put(out, batch_at(parameters, row, row), mul(scale, s0));
  batch_put(out, batch_at(parameters, row, row + 1), mul(scale, s1));
  batch_put(out, batch_at(parameters, row, row + 2), mul(scale, s2));
  batch_put(out, batch_at(parameters, row + 1, row + 1), mul(scale, s3));
  batch_put(out, batch_at(parameters, row + 1, row + 2), mul(scale, s4));
  batch_put(out, batch_at(parameters, row + 2, row + 2), mul(scale, s5));
  float* b_out = out + (parameters * (parameters + 1) / 2 + row) * kBatchStep;
  batch_put(b_out, 0, mul(scale_b, b0));
  batch_put(b_out, 1, mul(scale_b, b1));
  batch_put(b_out, 2, mul(scale_b, b2));
  return madd(scale, add(s0, add(s3, s5)), mul(scale_b, add(b0, add(b1, b2))));
}

// Products of the rows from `row` on with those from `column` on.
TEXTPLANE_SIMD_INLINE void batch_cross(const float* scratch, int n, int parameters, int row, int column, vf scale,
                                       float* out) noexcept {
  vf s0 = zero(), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0, s8 = s0;
  for (int k = 0; k < n; ++k) {
    const float* p = scratch + static_cast<std::ptrdiff_t>(k) * kBatchFields * kLanes;
    const vf a = hold(load(p + row * kLanes)), b = hold(load(p + (row + 1) * kLanes)),
             c = hold(load(p + (row + 2) * kLanes));
    const vf x = hold(load(p + column * kLanes)), y = hold(load(p + (column + 1) * kLanes)),
             z = hold(load(p + (column + 2) * kLanes));
    s0 = madd(a, x, s0);
    s1 = madd(a, y, s1);
    s2 = madd(a, z, s2);
    s3 = madd(b, x, s3);
    s4 = madd(b, y, s4);
    s5 = madd(b, z, s5);
    s6 = madd(c, x, s6);
    s7 = madd(c, y, s7);
    s8 = madd(c, z, s8);
  }
  const int r0 = batch_at(parameters, row, column), r1 = batch_at(parameters, row + 1, column);
  const int r2 = batch_at(parameters, row + 2, column);
  batch_put(out, r0, mul(scale, s0));
  batch_put(out, r0 + 1, mul(scale, s1));
  batch_put(out, r0 + 2, mul(scale, s2));
  batch_put(out, r1, mul(scale, s3));
  batch_put(out, r1 + 1, mul(scale, s4));
  batch_put(out, r1 + 2, mul(scale, s5));
  batch_put(out, r2, mul(scale, s6));
  batch_put(out, r2 + 1, mul(scale, s7));
  batch_put(out, r2 + 2, mul(scale, s8));
}
