// Many pixels: unweighted sums in one pass, then the residuals, then a correction for the outliers' weights. See
// simd/residual.hpp. Include before: residual/collect.inl, residual/finish.inl, residual/weights.inl.

// The cost of the host pixels, of which there are at least a.min_visible.
TEXTPLANE_SIMD_ENTRY Status evaluate_large(const simd::ResidualArgs& a, const ResidualFrame& f, const HostPixels& host,
                                           const ResidualArrays& s, simd::ResidualInfo* info) noexcept {
  SampleStrip strip;
  Offsets offsets;
  SideSums sides = no_sides();
  const int n = host.n;
  for (int begin = 0; begin < n; begin += kStrip) {
    const int count = n - begin < kStrip ? n - begin : kStrip;
    collect_values(host, f, begin, count, s, &strip);
    if (begin == 0) offsets = first_offsets(s.i, host.h, count);
    centre_strip(s.i + begin, host.h + begin, s.d + begin, count, offsets, begin + kStrip >= n, &sides);
  }
  Residual r;
  const Status status = make_residual(a, offsets, sides, n, &r, info);
  if (status != Status::ok) return status;
  add_costs(a, s, n, r, nullptr, info);
  return Status::ok;
}

// From sums of rows with 1, I and d to those with 1, n and r.
TEXTPLANE_SIMD_INLINE void unweighted_sums(const double* rows, int form, const Residual& r, double count, double root,
                                           double error, WeightedSums* sums) noexcept {
  const double by_s = 1 / r.i_s, by_root = 1 / root;
  const vd j1 = loadd(rows), ji = loadd(rows + form), jd = loadd(rows + 2 * form);
  const vd jn = maddd(setd(by_s), ji, muld(setd(-r.i_mean * by_s), j1));
  const vd jr = maddd(setd(r.on_d * by_root), jd, maddd(setd(r.on_i * by_root), ji, muld(setd(r.shift * by_root), j1)));
  stored(sums->e, muld(setd(1 / count), j1));
  stored(sums->jn, jn);
  stored(sums->w1, j1);
  stored(sums->wn, jn);
  stored(sums->wr, jr);
  sums->w[0] = count;
  sums->w[1] = 0;
  sums->w[2] = 1;
  sums->w[3] = 0;
  sums->w[4] = -0.5 * error;
}

// Makes weighted sums of the unweighted ones in `total` (products) and `sums`: takes away what the outliers' weights
// do, or sums all pixels again.
TEXTPLANE_SIMD_INLINE void correct_weights(int form, const simd::ResidualArgs& a, const ResidualArrays& s, int n,
                                           int outliers, const Residual& r, double root, const RowConstants& constants,
                                           RowStrip* rows, float* acc, double* total, WeightedSums* sums) noexcept {
  const int products = product_count(form), all = products + 3 * form;
  // If most pixels are outliers, sum them directly: the difference would lose digits.
  const bool direct = outliers > n / 2;
  const int weighted = direct ? n : outliers;
  double w[5] = {0, 0, 0, 0, 0}, other[kMostSums];
  int terms = 0;
  WeightedStrip ws;
  for (int begin = 0; begin < weighted; begin += kStrip) {
    const int m = weighted - begin < kStrip ? weighted - begin : kStrip;
    weigh_strip(a, s, direct ? nullptr : s.list + begin, begin, m, r, root, !direct, &ws, w);
    add_strip_products(form, false, constants, ws.x, ws.y, ws.a, ws.b, m, rows, terms == 0, acc);
    add_strip_weights(form, ws, *rows, m, terms == 0, acc + products * kLanes);
    terms += kStrip / kLanes;
    if (terms >= kFoldTerms || begin + kStrip >= weighted) {
      fold(acc, all, begin < kFoldTerms * kLanes, other);
      terms = 0;
    }
  }
  const double sign = direct ? 1 : -1;
  const vd rest = setd(direct ? 0 : 1), by = setd(sign);
  for (int k = 0; k < products; k += 8) stored(total + k, maddd(by, loadd(other + k), muld(rest, loadd(total + k))));
  stored(sums->w1, maddd(by, loadd(other + products), muld(rest, loadd(sums->w1))));
  stored(sums->wn, maddd(by, loadd(other + products + form), muld(rest, loadd(sums->wn))));
  stored(sums->wr, maddd(by, loadd(other + products + 2 * form), muld(rest, loadd(sums->wr))));
  for (int k = 0; k < 5; ++k) sums->w[k] = (direct ? 0 : sums->w[k]) + sign * w[k];
}

// Normal equations of `parameters` (3, 6 or 9) for the host pixels, of which there are at least a.min_visible.
TEXTPLANE_SIMD_INLINE Status linearise_large(int parameters, const simd::ResidualArgs& a, const ResidualFrame& f,
                                             const HostPixels& host, const ResidualArrays& s, simd::ResidualInfo* info,
                                             double* H, double* b) noexcept {
  const int form = parameters == 9 ? 8 : parameters, products = product_count(form), all = products + 3 * form;
  const int n = host.n;
  double total[kMostSums];
  float acc[(kMostSums + 8) * kMostLanes], *sum_i = acc + (products + form) * kLanes, *sum_d = sum_i + form * kLanes;
  zero_rest(all, acc);
  RowConstants constants;
  if (form != 8) make_row_constants(a, f, &constants);

  SampleStrip strip;
  RowStrip rows;
  Offsets offsets;
  SideSums sides = no_sides();
  const int block = kManyRegisters && form == 8 ? kBlock : static_cast<int>(kStrip);
  int terms = 0;
  for (int begin = 0; begin < n; begin += kStrip) {
    const int count = n - begin < kStrip ? n - begin : kStrip;
    collect_strip(host, f, begin, count, s, &strip);
    if (begin == 0) offsets = first_offsets(s.i, host.h, count);
    centre_strip(s.i + begin, host.h + begin, s.d + begin, count, offsets, begin + kStrip >= n, &sides);
    const int end = begin + count, from = begin / block * block;
    if (end % block != 0 && end < n) continue;
    const float *x = s.x + from, *y = s.y + from, *ga = s.a + from, *gb = s.b + from, *i = s.i + from, *d = s.d + from;
    const bool fresh = terms == 0;
    add_strip_products(form, true, constants, x, y, ga, gb, end - from, &rows, fresh, acc);
    add_strip_sums(form, x, y, ga, gb, rows, i, d, end - from, fresh, sum_i, sum_d);
    terms += block / kLanes;
    if (terms >= kFoldTerms || end == n) {
      fold(acc, all, end <= kFoldTerms * kLanes, total);
      terms = 0;
    }
  }

  Residual r;
  const Status status = make_residual(a, offsets, sides, n, &r, info);
  if (status != Status::ok) return status;
  const double root = sqrt_d(n);
  const int outliers = add_costs(a, s, n, r, s.list, info);

  WeightedSums sums;
  unweighted_sums(total + products, form, r, n, root, info->error, &sums);

  if (outliers > 0) correct_weights(form, a, s, n, outliers, r, root, constants, &rows, acc, total, &sums);
  unpack_products(form, total, sums.S);
  project_sums(form, a.exact, r.i_s, &sums);
  if (form == 8) {
    double M[9][8];
    parameter_matrix(a, f, M);
    change_parameters(M, sums.S, sums.wr, H, b);
  } else {
    for (int i = 0; i < form; ++i) {
      b[i] = sums.wr[i];
      // The two of an off-diagonal pair round differently.
      for (int j = i; j < form; ++j) H[form * i + j] = H[form * j + i] = sums.S[i][j];
    }
  }
  return finite_sums(parameters, *info, H, b) ? Status::ok : Status::unsupported;
}
