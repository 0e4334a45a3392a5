// The kernel of simd/esm.hpp. Include before: residual/large.inl, residual/host_basis.inl.
//
// Arrays of the scratch: x and y become host coordinates relative to the patch's centre; a and b the target's gradient
// by them, then its scaled mean with the host's; i and d are those of residual/centre.inl.

// The visible pixels' values of p, closed up into `out`.
TEXTPLANE_SIMD_INLINE void close_up_like(const std::uint8_t* flags, const float* p, int n, float* out) noexcept {
  int visible = 0;
  for (int i = 0; i < n; ++i) {
    out[visible] = p[i];
    visible += flags[i];
  }
}

// (x, y, a, b) of a strip: target coordinates and gradient become host coordinates and the gradient by them.
TEXTPLANE_SIMD_INLINE void pull_back(const simd::Warp8& w, const float* px, const float* py, int n, float* x, float* y,
                                     float* a, float* b) noexcept {
  for (int i = 0; i < n; i += kLanes) {
    const vm counted = first_n(n - i);
    const vf u = sub(load_part(px + i, n - i), set1(w.hx)), v = sub(load_part(py + i, n - i), set1(w.hy));
    const vf z = div(set1(1.0F), madd(set1(w.g[6]), u, madd(set1(w.g[7]), v, set1(w.g[8]))));
    const vf gx = mul(load(a + i), z), gy = mul(load(b + i), z);
    const vf along = neg(madd(gx, load(x + i), mul(gy, load(y + i))));
    store(a + i, keep(counted, madd(gx, set1(w.g[0]), madd(gy, set1(w.g[3]), mul(along, set1(w.g[6]))))));
    store(b + i, keep(counted, madd(gx, set1(w.g[1]), madd(gy, set1(w.g[4]), mul(along, set1(w.g[7]))))));
    store(x + i, keep(counted, u));
    store(y + i, keep(counted, v));
  }
}

// a <- on_target a + on_host g; host <- on_host g. Zero beyond n.
TEXTPLANE_SIMD_INLINE void mix_gradients(float on_target, float on_host, const float* g, int n, float* a,
                                         float* host) noexcept {
  for (int i = 0; i < n; i += kLanes) {
    const vf h = mul(set1(on_host), load_part(g + i, n - i));
    store(host + i, h);
    store(a + i, madd(set1(on_target), load(a + i), h));
  }
}

// Sums of rows with 1, n, r from those with 1, i, d.
TEXTPLANE_SIMD_INLINE void residual_sums(const Residual& r, double root, const double* one, const double* i,
                                         const double* d, double* with_n, double* with_r) noexcept {
  for (int k = 0; k < 8; ++k) {
    with_n[k] = (i[k] - r.i_mean * one[k]) / r.i_s;
    with_r[k] = (d[k] * r.on_d + i[k] * r.on_i + one[k] * r.shift) / root;
  }
}

// Weighted sums for rows j - (1, n, r) . (e, cn, cr): products S, sums X with w (1, n, r), and W of w (1, n, r)(1, n,
// r)^T.
struct EsmSums {
  double S[8][8], X[3][8], W[3][3];
};

TEXTPLANE_SIMD_INLINE void project_esm(const double (*c)[8], EsmSums* k) noexcept {
  double WC[3][8];
  for (int p = 0; p < 3; ++p)
    for (int i = 0; i < 8; ++i) WC[p][i] = k->W[p][0] * c[0][i] + k->W[p][1] * c[1][i] + k->W[p][2] * c[2][i];
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      for (int p = 0; p < 3; ++p) k->S[i][j] += c[p][i] * (WC[p][j] - k->X[p][j]) - k->X[p][i] * c[p][j];
  for (int i = 0; i < 8; ++i) k->X[2][i] -= WC[2][i];
}

// Without weights, from the sums of rows (`total`) and of the host's rows; and the projections c.
TEXTPLANE_SIMD_INLINE void unweighted_esm(const double* total, const double* total_host, const Residual& r,
                                          double count, double root, double error, EsmSums* sums,
                                          double (*c)[8]) noexcept {
  unpack_products(8, total, sums->S);
  const double* j1 = total + 27;
  residual_sums(r, root, j1, j1 + 8, j1 + 16, sums->X[1], sums->X[2]);
  double host_n[8], host_r[8];
  residual_sums(r, root, total_host, total_host + 8, total_host + 16, host_n, host_r);
  for (int k = 0; k < 8; ++k) {
    sums->X[0][k] = j1[k];
    c[0][k] = j1[k] / count;
    c[1][k] = sums->X[1][k] + host_r[k];
    c[2][k] = host_n[k] + host_r[k];
  }
  const double w_all[9] = {count, 0, 0, 0, 1, -0.5 * error, 0, -0.5 * error, error};
  for (int k = 0; k < 9; ++k) sums->W[k / 3][k % 3] = w_all[k];
}

// As correct_weights().
TEXTPLANE_SIMD_INLINE void correct_esm(const simd::ResidualArgs& a, const ResidualArrays& s, int n, int outliers,
                                       const Residual& r, double root, RowStrip* rows, float* acc, float* unused_sums,
                                       EsmSums* sums) noexcept {
  enum : int { kProducts = 27, kAll = 51 };
  const bool direct = outliers > n / 2;
  const int weighted = direct ? n : outliers;
  double w[5] = {0, 0, 0, 0, 0}, w_rr = 0, other[kMostSums];
  RowConstants unused;
  WeightedStrip ws;
  for (int begin = 0; begin < weighted; begin += kStrip) {
    const int m = weighted - begin < kStrip ? weighted - begin : kStrip;
    weigh_strip(a, s, direct ? nullptr : s.list + begin, begin, m, r, root, !direct, &ws, w);
    vf rr = zero();
    for (int k = 0; k < m; k += kLanes) rr = madd(load(ws.r + k), load(ws.r + k), rr);
    w_rr += reduce_sum_double(rr);
    add_strip_products(8, false, unused, ws.x, ws.y, ws.a, ws.b, m, rows, true, acc);
    add_strip_sums(8, ws.x, ws.y, ws.a, ws.b, *rows, ws.p, ws.q, m, true, acc + kProducts * kLanes,
                   acc + (kProducts + 8) * kLanes);
    add_strip_sums(8, ws.x, ws.y, ws.a, ws.b, *rows, ws.r, ws.r, m, true, acc + (kProducts + 16) * kLanes, unused_sums);
    fold(acc, kAll, begin == 0, other);
  }
  double S[8][8];
  unpack_products(8, other, S);
  const double keep_all = direct ? 0 : 1, sign = direct ? 1 : -1;
  const double w_some[9] = {w[0], w[1], w[3], w[1], w[2], w[4], w[3], w[4], w_rr};
  for (int k = 0; k < 9; ++k) sums->W[k / 3][k % 3] = keep_all * sums->W[k / 3][k % 3] + sign * w_some[k];
  for (int k = 0; k < 8; ++k) {
    for (int p = 0; p < 3; ++p) sums->X[p][k] = keep_all * sums->X[p][k] + sign * other[kProducts + 8 * p + k];
    for (int j = 0; j < 8; ++j) sums->S[k][j] = keep_all * sums->S[k][j] + sign * S[k][j];
  }
}

TEXTPLANE_SIMD_INLINE Status esm_pixels(const simd::EsmArgs& e, const ResidualFrame& f, const HostPixels& host,
                                        const float* gx, const float* gy, const ResidualArrays& s,
                                        simd::ResidualInfo* info, double* H, double* b) noexcept {
  const simd::ResidualArgs& a = e.base;
  enum : int { kProducts = 27, kAll = 51 };
  const int n = host.n;
  SampleStrip strip;
  Offsets offsets;
  SideSums sides = no_sides();
  for (int begin = 0; begin < n; begin += kStrip) {
    const int count = n - begin < kStrip ? n - begin : kStrip;
    collect_strip(host, f, begin, count, s, &strip);
    if (begin == 0) offsets = first_offsets(s.i, host.h, count);
    centre_strip(s.i + begin, host.h + begin, s.d + begin, count, offsets, begin + kStrip >= n, &sides);
    pull_back(f.warp, host.x + begin, host.y + begin, count, s.x + begin, s.y + begin, s.a + begin, s.b + begin);
  }
  Residual r;
  const Status status = make_residual(a, offsets, sides, n, &r, info);
  if (status != Status::ok) return status;
  const double count = n, root = sqrt_d(count), host_s = root / (static_cast<double>(offsets.kappa) * r.on_d);
  const float on_target = e.average ? static_cast<float>(0.5 / r.i_s) : 0.0F;
  const float on_host = static_cast<float>((e.average ? 0.5 : 1.0) / host_s);

  float acc[(kMostSums + 8) * kMostLanes], acc_host[32 * kMostLanes], ones[kStrip], ha[kStrip], hb[kStrip];
  double total[kMostSums], total_host[32];
  zero_rest(kAll, acc);
  for (int k = 0; k < kStrip; k += kLanes) store(ones + k, set1(1.0F));
  RowConstants unused;
  RowStrip rows;
  for (int begin = 0; begin < n; begin += kStrip) {
    const int m = n - begin < kStrip ? n - begin : kStrip;
    const float *x = s.x + begin, *y = s.y + begin, *i = s.i + begin, *d = s.d + begin;
    mix_gradients(on_target, on_host, gx + begin, m, s.a + begin, ha);
    mix_gradients(on_target, on_host, gy + begin, m, s.b + begin, hb);
    const bool fresh = (begin / kStrip) % kLanes == 0;
    add_strip_products(8, true, unused, x, y, s.a + begin, s.b + begin, m, &rows, fresh, acc);
    add_strip_sums(8, x, y, s.a + begin, s.b + begin, rows, i, d, m, fresh, acc + (kProducts + 8) * kLanes,
                   acc + (kProducts + 16) * kLanes);
    if (!kManyRegisters) homography_rows(x, y, ha, hb, m, rows.row);  // else as in add_strip_products()
    add_strip_sums(8, x, y, ha, hb, rows, ones, ones, m, fresh, acc_host, acc_host + 24 * kLanes);
    add_strip_sums(8, x, y, ha, hb, rows, i, d, m, fresh, acc_host + 8 * kLanes, acc_host + 16 * kLanes);
    if ((begin / kStrip) % kLanes == kLanes - 1 || begin + kStrip >= n) {
      fold(acc, kAll, begin < kLanes * kStrip, total);
      fold(acc_host, 32, begin < kLanes * kStrip, total_host);
    }
  }

  const int outliers = add_costs(a, s, n, r, s.list, info);

  EsmSums sums;
  double c[3][8];
  unweighted_esm(total, total_host, r, count, root, info->error, &sums, c);
  if (outliers > 0) correct_esm(a, s, n, outliers, r, root, &rows, acc, acc_host, &sums);
  if (a.exact) project_esm(c, &sums);
  double g[8], M[9][8];
  for (int k = 0; k < 8; ++k) g[k] = -sums.X[2][k];
  host_matrix(a, f, M);
  change_parameters(M, sums.S, g, H, b);
  return Status::ok;
}

TEXTPLANE_SIMD_ENTRY void linearise_esm(const simd::EsmArgs& e, simd::ResidualInfo* info, double* H,
                                        double* b) noexcept {
  const simd::ResidualArgs& a = e.base;
  simd::PointBounds bounds = a.bounds;
  if (bounds.n != a.n) find_bounds(a.x, a.y, a.n, &bounds);
  ResidualFrame f;
  info->status = Status::unsupported;
  if (!make_frame(a, bounds, &f)) return;
  ResidualArrays s;
  make_arrays(a.scratch, a.n, &s);
  float *cx = e.scratch, *cy = e.scratch + simd::esm_scratch(a.n) / 2;
  // As residual_any().
  for (int attempt = 0; attempt < 2; ++attempt) {
    const HostPixels pixels = host_pixels(a, f, attempt == 1, s, info);
    if (kInt16Tiles != 0 && pixels.n > kRowPixels) choose_tiles(a, bounds, pixels, &f);
    info->status = Status::too_few;
    if (pixels.n < 1 || pixels.n < a.min_visible) return;
    const bool closed = pixels.x != a.x;
    if (closed) {
      close_up_like(a.flags, e.gx, a.n, cx);
      close_up_like(a.flags, e.gy, a.n, cy);
    }
    info->status = esm_pixels(e, f, pixels, closed ? cx : e.gx, closed ? cy : e.gy, s, info, H, b);
    if (info->status == Status::ok && !finite_sums(9, *info, H, b)) info->status = Status::unsupported;
    if (info->status != Status::non_finite) return;
  }
  info->status = Status::unsupported;
}
