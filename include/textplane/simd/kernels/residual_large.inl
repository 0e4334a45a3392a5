// Many pixels: unweighted sums in one pass, then the residuals, then what the outliers' weights take away. See simd/residual.hpp.
//
// `form` is 3 (rows of theta), 6 (rows of v and omega) or 8 (rows of the pixel homography). Sums lie as follows, one after the
// other: products of rows (6, 21, 27), then sums with three factors, one for each row: (1, I, d) for all pixels, (w, w n, w r)
// for weighted ones.

TEXTPLANE_SIMD_INLINE int product_count(int form) noexcept { return form == 3 ? 6 : form == 6 ? 21 : 27; }

// Pixels whose sums are taken at once where no rows are stored: what is kept of them fits the first cache.
enum : int { kBlock = 4 * kStrip };

// Everything one strip needs besides its pixels.
struct RowStrip {
  float row[6][kStrip];
};

// Rows of the n pixels x, y, a, b, and to `acc` their products; where `plain`, their sums too. (Where registers hold many sums the
// homography's rows stay there, are made again for each loop, which takes less time than the way through memory, and `rows` is not
// used: n may then exceed a strip.)
TEXTPLANE_SIMD_INLINE void add_strip_products(int form, bool plain, const RowConstants& k, const float* x,
                                              const float* y, const float* a, const float* b, int n, RowStrip* rows,
                                              bool fresh, float* acc) noexcept {
  float(*r)[kStrip] = rows->row;
  float* sums = acc + (plain ? product_count(form) : kMostSums) * kLanes;  // or where nobody reads
  if (form == 3) {
    plane_rows(k, x, y, a, b, n, kStrip, r[0]);
    if (plain)
      add_squares_sums3(r[0], r[1], r[2], n, fresh, acc, sums);
    else
      add_squares3(r[0], r[1], r[2], n, fresh, acc);
  } else if (form == 6) {
    pose_rows(k, x, y, a, b, n, kStrip, r[0]);
    if (plain) {
      add_squares_sums3(r[0], r[1], r[2], n, fresh, acc, sums);
      add_squares_sums3(r[3], r[4], r[5], n, fresh, acc + 6 * kLanes, sums + 3 * kLanes);
    } else {
      add_squares3(r[0], r[1], r[2], n, fresh, acc);
      add_squares3(r[3], r[4], r[5], n, fresh, acc + 6 * kLanes);
    }
    add_products33(r[0], r[1], r[2], r[3], r[4], r[5], n, fresh, acc + 12 * kLanes);
  } else if (kManyRegisters) {
    add_moments(x, y, a, b, n, fresh, acc, sums);
    add_cubic_moments(x, y, a, b, n, fresh, acc + 18 * kLanes, sums + 6 * kLanes);
  } else {
    homography_rows(x, y, a, b, n, r);
    add_squares_sums3(a, r[0], r[1], n, fresh, acc, sums);
    add_squares_sums3(b, r[2], r[3], n, fresh, acc + 6 * kLanes, sums + 3 * kLanes);
    add_mixed(a, r[0], r[1], b, r[2], r[3], r[4], r[5], n, fresh, acc + 12 * kLanes, sums + 6 * kLanes);
    add_cubic(r[0], r[1], r[2], r[3], r[4], r[5], n, fresh, acc + 18 * kLanes);
  }
}

// Sums of the rows of these pixels with the factors p and q, to the sums `first` and `second` of three. Where q is p, `second`
// receives the same or is left as it is.
TEXTPLANE_SIMD_INLINE void add_strip_sums(int form, const float* x, const float* y, const float* a, const float* b,
                                          const RowStrip& rows, const float* p, const float* q, int n, bool fresh,
                                          float* first, float* second) noexcept {
  const float(*r)[kStrip] = rows.row;
  if (form == 3) {
    add_products3(r[0], r[1], r[2], p, q, n, fresh, first, second);
  } else if (form == 6) {
    add_products3(r[0], r[1], r[2], p, q, n, fresh, first, second);
    add_products3(r[3], r[4], r[5], p, q, n, fresh, first + 3 * kLanes, second + 3 * kLanes);
  } else if (kManyRegisters) {
    if (p == q)
      add_products8(x, y, a, b, p, n, fresh, first);
    else
      add_two_products8(x, y, a, b, p, q, n, fresh, first, second);
  } else {
    add_products4(a, r[0], r[1], b, p, q, n, fresh, first, second);
    add_products4(r[2], r[3], r[4], r[5], p, q, n, fresh, first + 4 * kLanes, second + 4 * kLanes);
  }
}

// Adds the partial sums to the totals, or, where `first`, makes them these; `sums` is rounded up to a multiple of eight.
TEXTPLANE_SIMD_ENTRY void fold(const float* acc, int sums, bool first, double* total) noexcept {
  for (int k = 0; k < sums; k += 8) {
    const vd eight = hsum8(acc + k * kLanes);
    stored(total + k, first ? eight : maddd(setd(1.0), eight, loadd(total + k)));
  }
}
// Zeroes what fold() reads beyond the sums.
TEXTPLANE_SIMD_INLINE void zero_rest(int sums, float* acc) noexcept {
  for (int k = sums; k % 8 != 0; ++k) store(acc + k * kLanes, zero());
}

// The target's and the host's offsets, their means over the first strip; and kappa, the ratio of their contrasts there, with which
// kappa h - i is about as small as the residuals are: its products with rows lose nothing.
struct Offsets {
  float target, host, kappa;
};
TEXTPLANE_SIMD_ENTRY Offsets first_offsets(const float* i, const float* h, int n) noexcept {
  const vf i_first = set1(i[0]), h_first = set1(h[0]);
  vf i1 = zero(), i2 = zero(), h1 = zero(), h2 = zero();
  for (int k = 0; k < n; k += kLanes) {
    vf p = sub(load(i + k), i_first), q = sub(load_part(h + k, n - k), h_first);
    if (n - k < kLanes) {
      p = keep(first_n(n - k), p);
      q = keep(first_n(n - k), q);
    }
    i1 = add(i1, p);
    h1 = add(h1, q);
    i2 = madd(p, p, i2);
    h2 = madd(q, q, h2);
  }
  float sum[4];
  hsum4(i1, i2, h1, h2, sum);
  const float by_n = 1.0F / static_cast<float>(n), i_mean = sum[0] * by_n, h_mean = sum[2] * by_n;
  const float i_squares = sum[1] - sum[0] * i_mean, h_squares = sum[3] - sum[2] * h_mean;
  Offsets o;
  o.target = i[0] + i_mean;
  o.host = h[0] + h_mean;
  const double ratio = h_squares > 0 ? static_cast<double>(i_squares) / static_cast<double>(h_squares) : 0;
  o.kappa = ratio > 1e-4 && ratio < 1e4 ? static_cast<float>(sqrt_d(ratio)) : 1.0F;
  return o;
}

// i less its offset, d = kappa (h - offset) - i, and the sums of both sides and their squares: lane by lane, `terms` each, and
// what went to double. Zero beyond n.
struct CentredSums {
  vf i, ii, h, hh;
};
struct SideSums {
  CentredSums lanes;
  int terms;
  double i, ii, h, hh;
};
TEXTPLANE_SIMD_INLINE SideSums no_sides() noexcept { return SideSums{{zero(), zero(), zero(), zero()}, 0, 0, 0, 0, 0}; }
TEXTPLANE_SIMD_INLINE void centre_vector(vf i, vf h, vf kappa, float* target, float* difference,
                                         CentredSums* s) noexcept {
  store(target, i);
  store(difference, sub(mul(kappa, h), i));
  s->i = add(s->i, i);
  s->h = add(s->h, h);
  s->ii = madd(i, i, s->ii);
  s->hh = madd(h, h, s->hh);
}
TEXTPLANE_SIMD_ENTRY void centre_strip(float* TEXTPLANE_SIMD_RESTRICT target, const float* TEXTPLANE_SIMD_RESTRICT host,
                                       float* TEXTPLANE_SIMD_RESTRICT difference, int n, const Offsets& o, bool last,
                                       SideSums* sums) noexcept {
  CentredSums s = sums->lanes;
  const vf kappa = set1(o.kappa), i_offset = set1(o.target), h_offset = set1(o.host);
  int k = 0;
  for (; k + kLanes <= n; k += kLanes)
    centre_vector(sub(load(target + k), i_offset), sub(load(host + k), h_offset), kappa, target + k, difference + k,
                  &s);
  if (k < n) {
    const vm counted = first_n(n - k);
    centre_vector(keep(counted, sub(load(target + k), i_offset)), keep(counted, sub(load_n(host + k, n - k), h_offset)),
                  kappa, target + k, difference + k, &s);
  }
  sums->terms += kStrip / kLanes;
  if (last || sums->terms >= kFoldTerms) {
    sums->i += hsum_d(s.i);
    sums->ii += hsum_d(s.ii);
    sums->h += hsum_d(s.h);
    sums->hh += hsum_d(s.hh);
    s.i = s.ii = s.h = s.hh = zero();
    sums->terms = 0;
  }
  sums->lanes = s;
}

// r sqrt(N) = on_d d + on_i i + shift, and n = (I - mean) / s = (i - i_mean) / i_s.
struct Residual {
  double on_d, on_i, shift, i_mean, i_s;
};

// A side with this sum of squares about its mean has the least contrast. What rounding leaves of a constant side is none. (Squares
// are compared: roots take time.)
TEXTPLANE_SIMD_INLINE bool has_contrast(const simd::ResidualArgs& a, double squares, double mean,
                                        double count) noexcept {
  const double least = a.min_contrast > 0 ? a.min_contrast : 0, floor = 1e-6 * mean;
  return squares > count * (least * least) && squares > count * (floor * floor);
}

// From the sums of both sides, for N pixels. no_contrast where there is none on either; non_finite for host intensities that are
// not, or whose squares are not in float.
TEXTPLANE_SIMD_ENTRY Status make_residual(const simd::ResidualArgs& a, const Offsets& o, const SideSums& sums, int n,
                                          Residual* r, simd::ResidualInfo* info) noexcept {
  const double count = n, i_mean = sums.i / count, i_squares = sums.ii - sums.i * i_mean;
  const double h_mean = sums.h / count, h_squares = sums.hh - sums.h * h_mean;
  if (!finite_d(h_squares)) return Status::non_finite;
  if (!has_contrast(a, i_squares, i_mean + o.target, count) || !has_contrast(a, h_squares, h_mean + o.host, count))
    return Status::no_contrast;
  const double i_s = sqrt_d(i_squares), h_s = sqrt_d(h_squares), root = sqrt_d(count), kappa = o.kappa;
  const double i_scale = root / i_s, h_scale = root / h_s;
  r->on_d = h_scale / kappa;
  r->on_i = r->on_d - i_scale;
  r->shift = i_mean * i_scale - h_mean * h_scale;
  r->i_mean = i_mean;
  r->i_s = i_s;
  info->mean = i_mean + o.target;
  info->s = i_s;
  return Status::ok;
}

// Costs of all n pixels: sum of e^2 and rho(e^2), e = r sqrt(N). `list`, where given, gets the pixels with |e| > delta, and up
// to a whole vector some pixel; returns how many.
struct CostSums {
  vf squares, rho;
};
TEXTPLANE_SIMD_INLINE unsigned cost_vector(vf e, vf limit, CostSums* sums) noexcept {
  const vf size = abs_(e), m = min_(size, limit);
  sums->squares = madd(e, e, sums->squares);
  sums->rho = madd(m, add(size, sub(size, m)), sums->rho);
  return bits(gt(size, limit));
}
TEXTPLANE_SIMD_ENTRY int add_costs(const float* d, const float* i, int n, const Residual& r, bool huber, float delta,
                                   std::int32_t* list, double* squares, double* rho) noexcept {
  const vf limit = set1(huber ? delta : 3.0e38F), shift = set1(static_cast<float>(r.shift));
  const vf on_d = set1(static_cast<float>(r.on_d)), on_i = set1(static_cast<float>(r.on_i));
  int listed = 0;
  for (int begin = 0; begin < n; begin += kFoldTerms * kLanes) {
    const int end = n - begin < kFoldTerms * kLanes ? n : begin + kFoldTerms * kLanes;
    CostSums sums = {zero(), zero()};
    // 64 pixels at a time: their outliers are the bits of a word.
    for (int k = begin; k < end; k += 64) {
      std::uint64_t word = 0;
      if (end - k >= 64) {
        for (int j = k; j < k + 64; j += kLanes) {
          const vf e = madd(load(d + j), on_d, madd(load(i + j), on_i, shift));
          word |= static_cast<std::uint64_t>(cost_vector(e, limit, &sums)) << (j - k);
        }
      } else {
        for (int j = k; j < end; j += kLanes) {
          const vf e = madd(load(d + j), on_d, madd(load(i + j), on_i, shift));
          word |= static_cast<std::uint64_t>(cost_vector(keep(first_n(end - j), e), limit, &sums)) << (j - k);
        }
      }
      if (!list) continue;
      for (; word != 0; word &= word - 1) list[listed++] = k + lowest_bit(word);
    }
    *squares += hsum_d(sums.squares);
    *rho += hsum_d(sums.rho);
  }
  if (list) storei(list + listed, seti(0));
  return listed;
}

// n <= kStrip pixels that are given weights: coordinates, and gradient and factors times the root of the weight.
struct WeightedStrip {
  float x[kStrip], y[kStrip], a[kStrip], b[kStrip], p[kStrip], q[kStrip],
      r[kStrip];  // p = 1, q = n, r = r, times the root
};

// Fills the strip with the pixels list[0 .. n-1], or, where list is null, those from `begin` on. The weight is Huber's w, or
// (complement) 1 - w. Adds up sums of w, w n, w n^2, w r, w n r.
TEXTPLANE_SIMD_ENTRY void weigh_strip(const ResidualArrays& s, const std::int32_t* list, int begin, int n,
                                      const Residual& res, double root, float delta, bool complement, WeightedStrip* w,
                                      double* sums) noexcept {
  const vf on_d = set1(static_cast<float>(res.on_d)), on_i = set1(static_cast<float>(res.on_i));
  const vf shift = set1(static_cast<float>(res.shift)), limit = set1(delta);
  const vf i_mean = set1(static_cast<float>(res.i_mean)), i_scale = set1(static_cast<float>(1 / res.i_s));
  const vf e_scale = set1(static_cast<float>(1 / root)), one = set1(1.0F);
  vf s0 = zero(), s1 = zero(), s2 = zero(), s3 = zero(), s4 = zero();
  for (int j = 0; j < n; j += kLanes) {
    const std::int32_t* at = list ? list + j : nullptr;
    const int k = begin + j;
    const vf i = at ? gather(s.i, at) : load(s.i + k), d = at ? gather(s.d, at) : load(s.d + k);
    const vf x = at ? gather(s.x, at) : load(s.x + k), y = at ? gather(s.y, at) : load(s.y + k);
    const vf a = at ? gather(s.a, at) : load(s.a + k), b = at ? gather(s.b, at) : load(s.b + k);
    const vf e = madd(d, on_d, madd(i, on_i, shift)), size = abs_(e);
    const vf inner = min_(size, limit), least = max_(size, set1(1e-30F));
    vf weight = div(complement ? sub(size, inner) : inner, least);
    if (!complement) weight = select(gt(size, limit), weight, one);
    if (n - j < kLanes) weight = keep(first_n(n - j), weight);
    const vf p = sqrt_(weight), nn = mul(sub(i, i_mean), i_scale), rr = mul(e, e_scale);
    const vf q = mul(p, nn), r = mul(p, rr);
    store(w->x + j, x);
    store(w->y + j, y);
    store(w->a + j, mul(p, a));
    store(w->b + j, mul(p, b));
    store(w->p + j, p);
    store(w->q + j, q);
    store(w->r + j, r);
    s0 = add(s0, weight);
    s1 = madd(p, q, s1);
    s2 = madd(q, q, s2);
    s3 = madd(p, r, s3);
    s4 = madd(q, r, s4);
  }
  sums[0] += hsum_d(s0);
  sums[1] += hsum_d(s1);
  sums[2] += hsum_d(s2);
  sums[3] += hsum_d(s3);
  sums[4] += hsum_d(s4);
}

// Sums of the rows with the factors p, q and r of the strip, one after the other.
TEXTPLANE_SIMD_INLINE void add_strip_weights(int form, const WeightedStrip& w, const RowStrip& rows, int n, bool fresh,
                                             float* acc) noexcept {
  add_strip_sums(form, w.x, w.y, w.a, w.b, rows, w.p, w.q, n, fresh, acc, acc + form * kLanes);
  float* last = acc + 2 * form * kLanes;
  add_strip_sums(form, w.x, w.y, w.a, w.b, rows, w.r, w.r, n, fresh, last, last);  // twice the same, stored once more
}

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
  double squares = 0, rho = 0;
  add_costs(s.d, s.i, n, r, a.huber, static_cast<float>(a.delta), nullptr, &squares, &rho);
  info->error = squares / n;
  info->cost = rho / n;
  return Status::ok;
}

// Normal equations of `parameters` (3, 6 or 9) for the host pixels, of which there are at least a.min_visible.
TEXTPLANE_SIMD_INLINE Status linearise_large(int parameters, const simd::ResidualArgs& a, const ResidualFrame& f,
                                             const HostPixels& host, const ResidualArrays& s, simd::ResidualInfo* info,
                                             double* H, double* b) noexcept {
  const int form = parameters == 9 ? 8 : parameters, products = product_count(form), all = products + 3 * form;
  const int n = host.n;
  float acc[(kMostSums + 8) * kMostLanes];
  double total[kMostSums], other[kMostSums];
  zero_rest(all, acc);
  float *sum_i = acc + (products + form) * kLanes, *sum_d = acc + (products + 2 * form) * kLanes;
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
  const double count = n, root = sqrt_d(count);
  double squares = 0, rho = 0;
  const float delta = static_cast<float>(a.delta);
  const int outliers = add_costs(s.d, s.i, n, r, a.huber, delta, s.list, &squares, &rho);
  info->error = squares / count;
  info->cost = rho / count;

  WeightedSums sums;
  const double by_s = 1 / r.i_s, by_root = 1 / root;
  const vd j1 = loadd(total + products), ji = loadd(total + products + form), jd = loadd(total + products + 2 * form);
  const vd jn = maddd(setd(by_s), ji, muld(setd(-r.i_mean * by_s), j1));
  const vd jr = maddd(setd(r.on_d * by_root), jd, maddd(setd(r.on_i * by_root), ji, muld(setd(r.shift * by_root), j1)));
  stored(sums.e, muld(setd(1 / count), j1));
  stored(sums.jn, jn);
  stored(sums.w1, j1);
  stored(sums.wn, jn);
  stored(sums.wr, jr);
  sums.w[0] = count;
  sums.w[1] = 0;
  sums.w[2] = 1;
  sums.w[3] = 0;
  sums.w[4] = -0.5 * info->error;

  if (outliers > 0) {
    // Where most pixels are outliers their weighted sums are taken directly: little would be left of the others.
    const bool direct = outliers > n / 2;
    const int weighted = direct ? n : outliers;
    double w[5] = {0, 0, 0, 0, 0};
    WeightedStrip ws;
    for (int begin = 0; begin < weighted; begin += kStrip) {
      const int m = weighted - begin < kStrip ? weighted - begin : kStrip;
      weigh_strip(s, direct ? nullptr : s.list + begin, begin, m, r, root, delta, !direct, &ws, w);
      add_strip_products(form, false, constants, ws.x, ws.y, ws.a, ws.b, m, &rows, terms == 0, acc);
      add_strip_weights(form, ws, rows, m, terms == 0, acc + products * kLanes);
      terms += kStrip / kLanes;
      if (terms >= kFoldTerms || begin + kStrip >= weighted) {
        fold(acc, all, begin < kFoldTerms * kLanes, other);
        terms = 0;
      }
    }
    const double sign = direct ? 1 : -1;
    const vd rest = setd(direct ? 0 : 1), by = setd(sign);
    for (int k = 0; k < products; k += 8) stored(total + k, maddd(by, loadd(other + k), muld(rest, loadd(total + k))));
    stored(sums.w1, maddd(by, loadd(other + products), muld(rest, j1)));
    stored(sums.wn, maddd(by, loadd(other + products + form), muld(rest, jn)));
    stored(sums.wr, maddd(by, loadd(other + products + 2 * form), muld(rest, jr)));
    for (int k = 0; k < 5; ++k) sums.w[k] = (direct ? 0 : sums.w[k]) + sign * w[k];
  }
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
  return finite_sums(parameters, *info, H, b) ? Status::ok : Status::rank_deficient;
}
