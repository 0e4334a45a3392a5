// Few pixels: rows of the parameters themselves, projected and weighted pixel by pixel. See simd/residual.hpp.

// Sums of three rows to out[0 .. 2] and with the factor p to out[3 .. 5].
TEXTPLANE_SIMD_ENTRY void row_means(const float* r0, const float* r1, const float* r2, const float* p, int n,
                                    float* out) noexcept {
  vf s0 = zero(), s1 = zero(), s2 = zero(), t0 = zero(), t1 = zero(), t2 = zero();
  for (int i = 0; i < n; i += kLanes) {
    const vf a = load(r0 + i), b = load(r1 + i), c = load(r2 + i), x = load(p + i);
    s0 = add(s0, a);
    s1 = add(s1, b);
    s2 = add(s2, c);
    t0 = madd(a, x, t0);
    t1 = madd(b, x, t1);
    t2 = madd(c, x, t2);
  }
  float eight[8];
  hsum4(s0, s1, s2, t0, eight);
  hsum4(t1, t2, t2, t2, eight + 4);
  for (int k = 0; k < 6; ++k) out[k] = eight[k];
}

// Row j becomes root (j - e - n c), for three rows.
TEXTPLANE_SIMD_ENTRY void project_rows(float* r0, float* r1, float* r2, const float* normalised, const float* root,
                                       int n, const float* e, const float* c) noexcept {
  const vf e0 = set1(e[0]), e1 = set1(e[1]), e2 = set1(e[2]), c0 = set1(c[0]), c1 = set1(c[1]), c2 = set1(c[2]);
  for (int i = 0; i < n; i += kLanes) {
    const vf x = load(normalised + i), w = load(root + i);
    store(r0 + i, mul(w, nmadd(x, c0, sub(load(r0 + i), e0))));
    store(r1 + i, mul(w, nmadd(x, c1, sub(load(r1 + i), e1))));
    store(r2 + i, mul(w, nmadd(x, c2, sub(load(r2 + i), e2))));
  }
}

// Costs; i becomes the normalised intensity n, d becomes r times the root of the weight, and `root` that root; zero beyond n.
TEXTPLANE_SIMD_ENTRY void weigh_few(const Residual& r, bool huber, float delta, int n, float* i, float* d, float* root,
                                    simd::ResidualInfo* info) noexcept {
  const double count = n;
  const vf on_d = set1(static_cast<float>(r.on_d)), on_i = set1(static_cast<float>(r.on_i));
  const vf shift = set1(static_cast<float>(r.shift)), limit = set1(delta), one = set1(1.0F);
  const vf i_mean = set1(static_cast<float>(r.i_mean)), i_scale = set1(static_cast<float>(1 / r.i_s));
  const vf scale = set1(static_cast<float>(1 / sqrt_d(count)));
  vf s = zero(), c = zero();
  for (int k = 0; k < n; k += kLanes) {
    const vf value = load(i + k), e = madd(load(d + k), on_d, madd(value, on_i, shift));
    vf normalised = mul(sub(value, i_mean), i_scale), q = mul(e, scale), w = one, squares = mul(e, e), rho = squares;
    if (huber) {
      const vf size = abs_(e), m = min_(size, limit);
      rho = mul(m, add(size, sub(size, m)));
      w = sqrt_(div(m, max_(size, set1(1e-30F))));
      w = select(gt(size, limit), w, one);
      q = mul(q, w);
    }
    if (n - k < kLanes) {
      const vm counted = first_n(n - k);
      normalised = keep(counted, normalised);
      q = keep(counted, q);
      w = keep(counted, w);
      squares = keep(counted, squares);
      rho = keep(counted, rho);
    }
    s = add(s, squares);
    c = add(c, rho);
    store(i + k, normalised);
    store(d + k, q);
    store(root + k, w);
  }
  info->error = hsum_d(s) / count;
  info->cost = hsum_d(c) / count;
}

// Entries of H (`size` columns) times the scales of their row and column: the square at (at, at), and the block at (r, c) with its
// mirror image.
TEXTPLANE_SIMD_INLINE void put_pair(double value, int r, int c, int size, const double* scale, double* H) noexcept {
  H[size * r + c] = H[size * c + r] = scale[r] * scale[c] * value;
}
TEXTPLANE_SIMD_INLINE void put_square(const float* p, int at, int size, const double* scale, double* H) noexcept {
  put_pair(p[0], at, at, size, scale, H);
  put_pair(p[1], at, at + 1, size, scale, H);
  put_pair(p[2], at, at + 2, size, scale, H);
  put_pair(p[3], at + 1, at + 1, size, scale, H);
  put_pair(p[4], at + 1, at + 2, size, scale, H);
  put_pair(p[5], at + 2, at + 2, size, scale, H);
}
TEXTPLANE_SIMD_INLINE void put_block(const float* p, int r, int c, int size, const double* scale, double* H) noexcept {
  for (int j = 0; j < 3; ++j) {
    put_pair(p[3 * j], r + j, c, size, scale, H);
    put_pair(p[3 * j + 1], r + j, c + 1, size, scale, H);
    put_pair(p[3 * j + 2], r + j, c + 2, size, scale, H);
  }
}

// Normal equations of `parameters` (3, 6 or 9) for at most kRowPixels host pixels.
TEXTPLANE_SIMD_INLINE Status linearise_small(int parameters, const simd::ResidualArgs& a, const ResidualFrame& f,
                                             const HostPixels& host, const ResidualArrays& s, simd::ResidualInfo* info,
                                             double* H, double* b) noexcept {
  const int n = host.n, groups = parameters / 3;
  SampleStrip strip;
  collect_strip(host, f, 0, n, s, &strip);
  SideSums sides = {0, 0, 0, 0};
  const Offsets offsets = plain_offsets(s.i, host.h, n);
  centre_strip(s.i, host.h, s.d, n, offsets, &sides);
  Residual r;
  const Status status = make_residual(a, offsets, sides, n, &r, info);
  if (status != Status::ok) return status;
  float root[kStrip], row[9][kStrip];
  weigh_few(r, a.huber, static_cast<float>(a.delta), n, s.i, s.d, root, info);

  RowConstants constants;
  make_row_constants(a, f, &constants);
  if (parameters != 3) pose_rows(constants, s.x, s.y, s.a, s.b, n, row);
  if (parameters != 6) plane_rows(constants, s.x, s.y, s.a, s.b, n, row + (parameters - 3));
  float acc[56 * kMostLanes];  // 45 products of rows, 9 with r, and two of nobody
  for (int g = 0; g < groups; ++g) {
    float *r0 = row[3 * g], *r1 = row[3 * g + 1], *r2 = row[3 * g + 2];
    float m[6] = {0, 0, 0, 0, 0, 0};
    if (a.exact) {
      row_means(r0, r1, r2, s.i, n, m);
      for (int k = 0; k < 3; ++k) m[k] /= static_cast<float>(n);
    }
    project_rows(r0, r1, r2, s.i, root, n, m, m + 3);
  }
  const int products = parameters * (parameters + 1) / 2, sums = products + parameters;
  for (int k = 0; k < (sums + 3) / 4 * 4; ++k) store(acc + k * kLanes, zero());
  float* p = acc;
  for (int g = 0; g < groups; ++g, p += 6 * kLanes) add_squares3(row[3 * g], row[3 * g + 1], row[3 * g + 2], n, p);
  for (int g = 0; g < groups; ++g)
    for (int k = g + 1; k < groups; ++k, p += 9 * kLanes)
      add_products33(row[3 * g], row[3 * g + 1], row[3 * g + 2], row[3 * k], row[3 * k + 1], row[3 * k + 2], n, p);
  for (int g = 0; g < groups; ++g, p += 3 * kLanes)
    add_products3(row[3 * g], row[3 * g + 1], row[3 * g + 2], s.d, s.d, n, p, p);  // twice the same, stored once more
  float total[56];
  for (int k = 0; k < sums; k += 4) {
    const float* q = acc + k * kLanes;
    hsum4(load(q), load(q + kLanes), load(q + 2 * kLanes), load(q + 3 * kLanes), total + k);
  }

  double scale[9] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
  if (parameters != 3) pose_scale(a, scale);
  const double is = 1 / r.i_s;
  for (int k = 0; k < parameters; ++k) {
    scale[k] *= is;
    b[k] = -scale[k] * static_cast<double>(total[products + k]);
  }
  const float* next = total;
  for (int g = 0; g < groups; ++g, next += 6) put_square(next, 3 * g, parameters, scale, H);
  for (int g = 0; g < groups; ++g)
    for (int k = g + 1; k < groups; ++k, next += 9) put_block(next, 3 * g, 3 * k, parameters, scale, H);
  return Status::ok;
}
