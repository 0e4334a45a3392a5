// Sums of products of rows over a strip. Include before: the operations.
//
// A row is an array of n floats, zero up to the next whole vector. `acc` points to the sums, of kLanes partial sums
// each. Where `fresh`, they begin at zero and are not read: clearing them first takes longer. At most 12 sums a loop
// stay in registers.
TEXTPLANE_SIMD_INLINE vf so_far(bool fresh, const float* p) noexcept { return fresh ? zero() : load(p); }
TEXTPLANE_SIMD_INLINE void put3(float* p, vf a, vf b, vf c) noexcept {
  store(p, a);
  store(p + kLanes, b);
  store(p + 2 * kLanes, c);
}

// r0 r0, r0 r1, r0 r2, r1 r1, r1 r2, r2 r2.
TEXTPLANE_SIMD_ENTRY void add_squares3(const float* r0, const float* r1, const float* r2, int n, bool fresh,
                                       float* acc) noexcept {
  vf s0 = so_far(fresh, acc), s1 = so_far(fresh, acc + kLanes), s2 = so_far(fresh, acc + 2 * kLanes);
  vf s3 = so_far(fresh, acc + 3 * kLanes), s4 = so_far(fresh, acc + 4 * kLanes), s5 = so_far(fresh, acc + 5 * kLanes);
  for (int i = 0; i < n; i += kLanes) {
    const vf a = hold(load(r0 + i)), b = hold(load(r1 + i)), c = hold(load(r2 + i));
    s0 = madd(a, a, s0);
    s1 = madd(a, b, s1);
    s2 = madd(a, c, s2);
    s3 = madd(b, b, s3);
    s4 = madd(b, c, s4);
    s5 = madd(c, c, s5);
  }
  put3(acc, s0, s1, s2);
  put3(acc + 3 * kLanes, s3, s4, s5);
}

// The same, and to `sums` r0, r1, r2 themselves.
TEXTPLANE_SIMD_ENTRY void add_squares_sums3(const float* r0, const float* r1, const float* r2, int n, bool fresh,
                                            float* acc, float* sums) noexcept {
  vf s0 = so_far(fresh, acc), s1 = so_far(fresh, acc + kLanes), s2 = so_far(fresh, acc + 2 * kLanes);
  vf s3 = so_far(fresh, acc + 3 * kLanes), s4 = so_far(fresh, acc + 4 * kLanes), s5 = so_far(fresh, acc + 5 * kLanes);
  vf t0 = so_far(fresh, sums), t1 = so_far(fresh, sums + kLanes), t2 = so_far(fresh, sums + 2 * kLanes);
  for (int i = 0; i < n; i += kLanes) {
    const vf a = hold(load(r0 + i)), b = hold(load(r1 + i)), c = hold(load(r2 + i));
    s0 = madd(a, a, s0);
    s1 = madd(a, b, s1);
    s2 = madd(a, c, s2);
    s3 = madd(b, b, s3);
    s4 = madd(b, c, s4);
    s5 = madd(c, c, s5);
    t0 = add(t0, a);
    t1 = add(t1, b);
    t2 = add(t2, c);
  }
  put3(acc, s0, s1, s2);
  put3(acc + 3 * kLanes, s3, s4, s5);
  put3(sums, t0, t1, t2);
}

// r_j q_k, j the slower index.
TEXTPLANE_SIMD_ENTRY void add_products33(const float* r0, const float* r1, const float* r2, const float* q0,
                                         const float* q1, const float* q2, int n, bool fresh, float* acc) noexcept {
  vf s0 = so_far(fresh, acc), s1 = so_far(fresh, acc + kLanes), s2 = so_far(fresh, acc + 2 * kLanes);
  vf s3 = so_far(fresh, acc + 3 * kLanes), s4 = so_far(fresh, acc + 4 * kLanes), s5 = so_far(fresh, acc + 5 * kLanes);
  vf s6 = so_far(fresh, acc + 6 * kLanes), s7 = so_far(fresh, acc + 7 * kLanes), s8 = so_far(fresh, acc + 8 * kLanes);
  for (int i = 0; i < n; i += kLanes) {
    const vf a = hold(load(r0 + i)), b = hold(load(r1 + i)), c = hold(load(r2 + i)), x = hold(load(q0 + i)),
             y = hold(load(q1 + i)), z = hold(load(q2 + i));
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
  put3(acc, s0, s1, s2);
  put3(acc + 3 * kLanes, s3, s4, s5);
  put3(acc + 6 * kLanes, s6, s7, s8);
}

// r_j p to `acc`, r_j q to `acc2`, for the three rows of j.
TEXTPLANE_SIMD_ENTRY void add_products3(const float* r0, const float* r1, const float* r2, const float* p,
                                        const float* q, int n, bool fresh, float* acc, float* acc2) noexcept {
  vf s0 = so_far(fresh, acc), s1 = so_far(fresh, acc + kLanes), s2 = so_far(fresh, acc + 2 * kLanes);
  vf t0 = so_far(fresh, acc2), t1 = so_far(fresh, acc2 + kLanes), t2 = so_far(fresh, acc2 + 2 * kLanes);
  for (int i = 0; i < n; i += kLanes) {
    const vf a = hold(load(r0 + i)), b = hold(load(r1 + i)), c = hold(load(r2 + i)), x = hold(load(p + i)),
             y = hold(load(q + i));
    s0 = madd(a, x, s0);
    s1 = madd(b, x, s1);
    s2 = madd(c, x, s2);
    t0 = madd(a, y, t0);
    t1 = madd(b, y, t1);
    t2 = madd(c, y, t2);
  }
  put3(acc, s0, s1, s2);
  put3(acc2, t0, t1, t2);
}

// r_j p to `acc`, r_j q to `acc2`, for four rows.
TEXTPLANE_SIMD_ENTRY void add_products4(const float* r0, const float* r1, const float* r2, const float* r3,
                                        const float* p, const float* q, int n, bool fresh, float* acc,
                                        float* acc2) noexcept {
  vf s0 = so_far(fresh, acc), s1 = so_far(fresh, acc + kLanes), s2 = so_far(fresh, acc + 2 * kLanes),
     s3 = so_far(fresh, acc + 3 * kLanes);
  vf t0 = so_far(fresh, acc2), t1 = so_far(fresh, acc2 + kLanes), t2 = so_far(fresh, acc2 + 2 * kLanes),
     t3 = so_far(fresh, acc2 + 3 * kLanes);
  for (int i = 0; i < n; i += kLanes) {
    const vf a = hold(load(r0 + i)), b = hold(load(r1 + i)), c = hold(load(r2 + i)), d = hold(load(r3 + i)),
             x = hold(load(p + i)), y = hold(load(q + i));
    s0 = madd(a, x, s0);
    s1 = madd(b, x, s1);
    s2 = madd(c, x, s2);
    s3 = madd(d, x, s3);
    t0 = madd(a, y, t0);
    t1 = madd(b, y, t1);
    t2 = madd(c, y, t2);
    t3 = madd(d, y, t3);
  }
  put3(acc, s0, s1, s2);
  store(acc + 3 * kLanes, s3);
  put3(acc2, t0, t1, t2);
  store(acc2 + 3 * kLanes, t3);
}

// The products of (A, Ax, Ay) and (B, Bx, By) and the sums of Cx, Cy: six and two.
TEXTPLANE_SIMD_ENTRY void add_mixed(const float* a, const float* ax, const float* ay, const float* b, const float* bx,
                                    const float* by, const float* cx, const float* cy, int n, bool fresh, float* acc,
                                    float* sums) noexcept {
  vf s0 = so_far(fresh, acc), s1 = so_far(fresh, acc + kLanes), s2 = so_far(fresh, acc + 2 * kLanes);
  vf s3 = so_far(fresh, acc + 3 * kLanes), s4 = so_far(fresh, acc + 4 * kLanes), s5 = so_far(fresh, acc + 5 * kLanes);
  vf t0 = so_far(fresh, sums), t1 = so_far(fresh, sums + kLanes);
  for (int i = 0; i < n; i += kLanes) {
    const vf A = hold(load(a + i)), Ax = hold(load(ax + i)), B = hold(load(b + i)), Bx = hold(load(bx + i)),
             By = hold(load(by + i));
    s0 = madd(A, B, s0);
    s1 = madd(A, Bx, s1);
    s2 = madd(A, By, s2);
    s3 = madd(Ax, Bx, s3);
    s4 = madd(Ax, By, s4);
    s5 = madd(load(ay + i), By, s5);
    t0 = add(t0, load(cx + i));
    t1 = add(t1, load(cy + i));
  }
  put3(acc, s0, s1, s2);
  put3(acc + 3 * kLanes, s3, s4, s5);
  store(sums, t0);
  store(sums + kLanes, t1);
}

// The products with Cx, Cy: of (Ax, Ay), of (Bx, By), and their own; xx, xy, yy of each.
TEXTPLANE_SIMD_ENTRY void add_cubic(const float* ax, const float* ay, const float* bx, const float* by, const float* cx,
                                    const float* cy, int n, bool fresh, float* acc) noexcept {
  vf s0 = so_far(fresh, acc), s1 = so_far(fresh, acc + kLanes), s2 = so_far(fresh, acc + 2 * kLanes);
  vf s3 = so_far(fresh, acc + 3 * kLanes), s4 = so_far(fresh, acc + 4 * kLanes), s5 = so_far(fresh, acc + 5 * kLanes);
  vf s6 = so_far(fresh, acc + 6 * kLanes), s7 = so_far(fresh, acc + 7 * kLanes), s8 = so_far(fresh, acc + 8 * kLanes);
  for (int i = 0; i < n; i += kLanes) {
    const vf Cx = hold(load(cx + i)), Cy = hold(load(cy + i)), Ax = hold(load(ax + i)), Bx = hold(load(bx + i));
    s0 = madd(Ax, Cx, s0);
    s1 = madd(Ax, Cy, s1);
    s2 = madd(load(ay + i), Cy, s2);
    s3 = madd(Bx, Cx, s3);
    s4 = madd(Bx, Cy, s4);
    s5 = madd(load(by + i), Cy, s5);
    s6 = madd(Cx, Cx, s6);
    s7 = madd(Cx, Cy, s7);
    s8 = madd(Cy, Cy, s8);
  }
  put3(acc, s0, s1, s2);
  put3(acc + 3 * kLanes, s3, s4, s5);
  put3(acc + 6 * kLanes, s6, s7, s8);
}
