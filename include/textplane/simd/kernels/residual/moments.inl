// Sums of products of the rows of a homography over a strip, for targets with 32 registers (kManyRegisters): more sums
// a loop than in sums.inl, of rows that never leave the registers. Include before: residual/sums.inl.

// The products of (A, Ax, Ay), those of (B, Bx, By), and the mixed ones, in the order of add_squares3() and
// add_mixed(); and the sums of the six rows.
TEXTPLANE_SIMD_ENTRY void add_moments(const float* x, const float* y, const float* a, const float* b, int n, bool fresh,
                                      float* acc, float* sums) noexcept {
  vf s0 = so_far(fresh, acc), s1 = so_far(fresh, acc + kLanes), s2 = so_far(fresh, acc + 2 * kLanes);
  vf s3 = so_far(fresh, acc + 3 * kLanes), s4 = so_far(fresh, acc + 4 * kLanes), s5 = so_far(fresh, acc + 5 * kLanes);
  vf s6 = so_far(fresh, acc + 6 * kLanes), s7 = so_far(fresh, acc + 7 * kLanes), s8 = so_far(fresh, acc + 8 * kLanes);
  vf s9 = so_far(fresh, acc + 9 * kLanes), s10 = so_far(fresh, acc + 10 * kLanes),
     s11 = so_far(fresh, acc + 11 * kLanes);
  vf s12 = so_far(fresh, acc + 12 * kLanes), s13 = so_far(fresh, acc + 13 * kLanes),
     s14 = so_far(fresh, acc + 14 * kLanes);
  vf s15 = so_far(fresh, acc + 15 * kLanes), s16 = so_far(fresh, acc + 16 * kLanes),
     s17 = so_far(fresh, acc + 17 * kLanes);
  vf t0 = so_far(fresh, sums), t1 = so_far(fresh, sums + kLanes), t2 = so_far(fresh, sums + 2 * kLanes);
  vf t3 = so_far(fresh, sums + 3 * kLanes), t4 = so_far(fresh, sums + 4 * kLanes),
     t5 = so_far(fresh, sums + 5 * kLanes);
  for (int i = 0; i < n; i += kLanes) {
    const vf u = load(x + i), v = load(y + i), A = load(a + i), B = load(b + i);
    const vf Ax = mul(A, u), Ay = mul(A, v), Bx = mul(B, u), By = mul(B, v);
    s0 = madd(A, A, s0);
    s1 = madd(A, Ax, s1);
    s2 = madd(A, Ay, s2);
    s3 = madd(Ax, Ax, s3);
    s4 = madd(Ax, Ay, s4);
    s5 = madd(Ay, Ay, s5);
    s6 = madd(B, B, s6);
    s7 = madd(B, Bx, s7);
    s8 = madd(B, By, s8);
    s9 = madd(Bx, Bx, s9);
    s10 = madd(Bx, By, s10);
    s11 = madd(By, By, s11);
    s12 = madd(A, B, s12);
    s13 = madd(A, Bx, s13);
    s14 = madd(A, By, s14);
    s15 = madd(Ax, Bx, s15);
    s16 = madd(Ax, By, s16);
    s17 = madd(Ay, By, s17);
    t0 = add(t0, A);
    t1 = add(t1, Ax);
    t2 = add(t2, Ay);
    t3 = add(t3, B);
    t4 = add(t4, Bx);
    t5 = add(t5, By);
  }
  put3(acc, s0, s1, s2);
  put3(acc + 3 * kLanes, s3, s4, s5);
  put3(acc + 6 * kLanes, s6, s7, s8);
  put3(acc + 9 * kLanes, s9, s10, s11);
  put3(acc + 12 * kLanes, s12, s13, s14);
  put3(acc + 15 * kLanes, s15, s16, s17);
  put3(sums, t0, t1, t2);
  put3(sums + 3 * kLanes, t3, t4, t5);
}

// The products of add_cubic(), and the sums of Cx, Cy.
TEXTPLANE_SIMD_ENTRY void add_cubic_moments(const float* x, const float* y, const float* a, const float* b, int n,
                                            bool fresh, float* acc, float* sums) noexcept {
  vf s0 = so_far(fresh, acc), s1 = so_far(fresh, acc + kLanes), s2 = so_far(fresh, acc + 2 * kLanes);
  vf s3 = so_far(fresh, acc + 3 * kLanes), s4 = so_far(fresh, acc + 4 * kLanes), s5 = so_far(fresh, acc + 5 * kLanes);
  vf s6 = so_far(fresh, acc + 6 * kLanes), s7 = so_far(fresh, acc + 7 * kLanes), s8 = so_far(fresh, acc + 8 * kLanes);
  vf t0 = so_far(fresh, sums), t1 = so_far(fresh, sums + kLanes);
  for (int i = 0; i < n; i += kLanes) {
    const vf u = load(x + i), v = load(y + i), A = load(a + i), B = load(b + i);
    const vf Ax = mul(A, u), Ay = mul(A, v), Bx = mul(B, u), By = mul(B, v), C = add(Ax, By), Cx = mul(C, u),
             Cy = mul(C, v);
    s0 = madd(Ax, Cx, s0);
    s1 = madd(Ax, Cy, s1);
    s2 = madd(Ay, Cy, s2);
    s3 = madd(Bx, Cx, s3);
    s4 = madd(Bx, Cy, s4);
    s5 = madd(By, Cy, s5);
    s6 = madd(Cx, Cx, s6);
    s7 = madd(Cx, Cy, s7);
    s8 = madd(Cy, Cy, s8);
    t0 = add(t0, Cx);
    t1 = add(t1, Cy);
  }
  put3(acc, s0, s1, s2);
  put3(acc + 3 * kLanes, s3, s4, s5);
  put3(acc + 6 * kLanes, s6, s7, s8);
  store(sums, t0);
  store(sums + kLanes, t1);
}

// The eight rows times p to `acc`, and, where q is given, times q to `acc2`. With the factor inside, products are
// shared: half of the additions then go to ports that multiply nothing.
TEXTPLANE_SIMD_INLINE void products8(const float* x, const float* y, const float* a, const float* b, const float* p,
                                     const float* q, int n, bool fresh, float* acc, float* acc2) noexcept {
  vf s0 = so_far(fresh, acc), s1 = so_far(fresh, acc + kLanes), s2 = so_far(fresh, acc + 2 * kLanes);
  vf s3 = so_far(fresh, acc + 3 * kLanes), s4 = so_far(fresh, acc + 4 * kLanes), s5 = so_far(fresh, acc + 5 * kLanes);
  vf s6 = so_far(fresh, acc + 6 * kLanes), s7 = so_far(fresh, acc + 7 * kLanes);
  const bool none = fresh || !q;
  vf t0 = so_far(none, acc2), t1 = so_far(none, acc2 + kLanes), t2 = so_far(none, acc2 + 2 * kLanes);
  vf t3 = so_far(none, acc2 + 3 * kLanes), t4 = so_far(none, acc2 + 4 * kLanes), t5 = so_far(none, acc2 + 5 * kLanes);
  vf t6 = so_far(none, acc2 + 6 * kLanes), t7 = so_far(none, acc2 + 7 * kLanes);
  for (int i = 0; i < n; i += kLanes) {
    const vf u = load(x + i), v = load(y + i), A = load(a + i), B = load(b + i), f = load(p + i);
    const vf fA = mul(f, A), fB = mul(f, B), fAx = mul(fA, u), fBy = mul(fB, v), fC = add(fAx, fBy);
    s0 = add(s0, fA);
    s1 = add(s1, fAx);
    s2 = madd(fA, v, s2);
    s3 = add(s3, fB);
    s4 = madd(fB, u, s4);
    s5 = add(s5, fBy);
    s6 = madd(fC, u, s6);
    s7 = madd(fC, v, s7);
    if (!q) continue;
    const vf g = load(q + i);
    const vf gA = mul(g, A), gB = mul(g, B), gAx = mul(gA, u), gBy = mul(gB, v), gC = add(gAx, gBy);
    t0 = add(t0, gA);
    t1 = add(t1, gAx);
    t2 = madd(gA, v, t2);
    t3 = add(t3, gB);
    t4 = madd(gB, u, t4);
    t5 = add(t5, gBy);
    t6 = madd(gC, u, t6);
    t7 = madd(gC, v, t7);
  }
  put3(acc, s0, s1, s2);
  put3(acc + 3 * kLanes, s3, s4, s5);
  store(acc + 6 * kLanes, s6);
  store(acc + 7 * kLanes, s7);
  if (!q) return;
  put3(acc2, t0, t1, t2);
  put3(acc2 + 3 * kLanes, t3, t4, t5);
  store(acc2 + 6 * kLanes, t6);
  store(acc2 + 7 * kLanes, t7);
}
TEXTPLANE_SIMD_ENTRY void add_two_products8(const float* x, const float* y, const float* a, const float* b,
                                            const float* p, const float* q, int n, bool fresh, float* acc,
                                            float* acc2) noexcept {
  products8(x, y, a, b, p, q, n, fresh, acc, acc2);
}
TEXTPLANE_SIMD_ENTRY void add_products8(const float* x, const float* y, const float* a, const float* b, const float* p,
                                        int n, bool fresh, float* acc) noexcept {
  products8(x, y, a, b, p, nullptr, n, fresh, acc, acc);
}
