// Costs and weights of the residuals of many pixels. Include before: residual/centre.inl, residual/strip_sums.inl.

// Costs of all n pixels: sums of e^2 and rho(e^2), e = r sqrt(N). For L2 and Huber. `list`, where given, gets the
// pixels with |e| > delta, padded to a full vector with a valid index; returns how many.
struct CostSums {
  vf squares, rho;
};
TEXTPLANE_SIMD_INLINE unsigned cost_vector(vf e, vf limit, CostSums* sums) noexcept {
  const vf size = abs_(e), m = min_(size, limit);
  sums->squares = madd(e, e, sums->squares);
  sums->rho = madd(m, add(size, sub(size, m)), sums->rho);
  return bits_from_mask(gt(size, limit));
}
TEXTPLANE_SIMD_ENTRY int add_huber_costs(const float* d, const float* i, int n, const Residual& r, bool huber,
                                         float delta, std::int32_t* list, double* squares, double* rho) noexcept {
  const vf limit = set1(huber ? delta : 3.0e38F), shift = set1(static_cast<float>(r.shift));
  const vf on_d = set1(static_cast<float>(r.on_d)), on_i = set1(static_cast<float>(r.on_i));
  int listed = 0;
  for (int begin = 0; begin < n; begin += kFoldTerms * kLanes) {
    const int end = n - begin < kFoldTerms * kLanes ? n : begin + kFoldTerms * kLanes;
    CostSums sums = {zero(), zero()};
    // 64 pixels at a time: their outliers are the bits of a number.
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
    *squares += reduce_sum_double(sums.squares);
    *rho += reduce_sum_double(sums.rho);
  }
  if (list) storei(list + listed, seti(0));
  return listed;
}

// The same for Cauchy and Tukey.
TEXTPLANE_SIMD_ENTRY void add_weighted_costs(const float* d, const float* i, int n, const Residual& r, RobustKind kind,
                                             double delta, double* squares, double* rho) noexcept {
  const RobustVectors robust = broadcast_robust(kind, delta);
  const vf shift = set1(static_cast<float>(r.shift));
  const vf on_d = set1(static_cast<float>(r.on_d)), on_i = set1(static_cast<float>(r.on_i));
  for (int begin = 0; begin < n; begin += kFoldTerms * kLanes) {
    const int end = n - begin < kFoldTerms * kLanes ? n : begin + kFoldTerms * kLanes;
    CostSums sums = {zero(), zero()};
    for (int k = begin; k < end; k += kLanes) {
      const vf e = keep(first_n(end - k), madd(load(d + k), on_d, madd(load(i + k), on_i, shift))), square = mul(e, e);
      vf cost, root;
      robust_vector(robust, square, &cost, &root);
      sums.squares = add(sums.squares, square);
      sums.rho = add(sums.rho, cost);
    }
    *squares += reduce_sum_double(sums.squares);
    *rho += reduce_sum_double(sums.rho);
  }
}

// Costs of all n pixels, to `info`. Returns how many need weights: none for L2; the outliers, which go to `list` if
// given, for Huber; all for Cauchy and Tukey.
TEXTPLANE_SIMD_INLINE int add_costs(const simd::ResidualArgs& a, const ResidualArrays& s, int n, const Residual& r,
                                    std::int32_t* list, simd::ResidualInfo* info) noexcept {
  double squares = 0, rho = 0;
  int weighted = n;
  if (weighs_all(a.robust))
    add_weighted_costs(s.d, s.i, n, r, a.robust, a.delta, &squares, &rho);
  else
    weighted = add_huber_costs(s.d, s.i, n, r, a.robust == RobustKind::huber, static_cast<float>(a.delta), list,
                               &squares, &rho);
  info->error = squares / n;
  info->cost = rho / n;
  return weighted;
}

// n <= kStrip pixels that are given weights: coordinates, and gradient and factors times the root of the weight.
struct WeightedStrip {
  float x[kStrip], y[kStrip], a[kStrip], b[kStrip], p[kStrip], q[kStrip],
      r[kStrip];  // p = 1, q = n, r = r, times the root
};

// Fills the strip with the pixels list[0 .. n-1], or, where list is null, those from `begin` on. The weight is the
// robust cost's w, or, for Huber (complement), 1 - w. Adds up sums of w, w n, w n^2, w r, w n r.
TEXTPLANE_SIMD_INLINE void weigh_strip_by(bool all, const simd::ResidualArgs& args, const ResidualArrays& s,
                                          const std::int32_t* list, int begin, int n, const Residual& res, double root,
                                          bool complement, WeightedStrip* w, double* sums) noexcept {
  const RobustVectors robust =
      all ? broadcast_robust(args.robust, args.delta) : RobustVectors{zero(), zero(), RobustKind::l2};
  const vf on_d = set1(static_cast<float>(res.on_d)), on_i = set1(static_cast<float>(res.on_i));
  const vf shift = set1(static_cast<float>(res.shift)), limit = set1(static_cast<float>(args.delta));
  const vf i_mean = set1(static_cast<float>(res.i_mean)), i_scale = set1(static_cast<float>(1 / res.i_s));
  const vf e_scale = set1(static_cast<float>(1 / root)), one = set1(1.0F);
  vf s0 = zero(), s1 = zero(), s2 = zero(), s3 = zero(), s4 = zero();
  for (int j = 0; j < n; j += kLanes) {
    const std::int32_t* at = list ? list + j : nullptr;
    const int k = begin + j;
    const vf i = at ? gather(s.i, at) : load(s.i + k), d = at ? gather(s.d, at) : load(s.d + k);
    const vf x = at ? gather(s.x, at) : load(s.x + k), y = at ? gather(s.y, at) : load(s.y + k);
    const vf a = at ? gather(s.a, at) : load(s.a + k), b = at ? gather(s.b, at) : load(s.b + k);
    const vf e = madd(d, on_d, madd(i, on_i, shift));
    vf weight, p;
    if (all) {
      vf rho;
      robust_vector(robust, mul(e, e), &rho, &p);
      if (n - j < kLanes) p = keep(first_n(n - j), p);
      weight = mul(p, p);
    } else {
      const vf size = abs_(e), inner = min_(size, limit), least = max_(size, set1(1e-30F));
      weight = div(complement ? sub(size, inner) : inner, least);
      if (!complement) weight = select(gt(size, limit), weight, one);
      if (n - j < kLanes) weight = keep(first_n(n - j), weight);
      p = sqrt_(weight);
    }
    const vf nn = mul(sub(i, i_mean), i_scale), rr = mul(e, e_scale);
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
  sums[0] += reduce_sum_double(s0);
  sums[1] += reduce_sum_double(s1);
  sums[2] += reduce_sum_double(s2);
  sums[3] += reduce_sum_double(s3);
  sums[4] += reduce_sum_double(s4);
}

TEXTPLANE_SIMD_ENTRY void weigh_huber(const simd::ResidualArgs& a, const ResidualArrays& s, const std::int32_t* list,
                                      int begin, int n, const Residual& r, double root, bool complement,
                                      WeightedStrip* w, double* sums) noexcept {
  weigh_strip_by(false, a, s, list, begin, n, r, root, complement, w, sums);
}
TEXTPLANE_SIMD_ENTRY void weigh_all(const simd::ResidualArgs& a, const ResidualArrays& s, int begin, int n,
                                    const Residual& r, double root, WeightedStrip* w, double* sums) noexcept {
  weigh_strip_by(true, a, s, nullptr, begin, n, r, root, false, w, sums);
}
TEXTPLANE_SIMD_INLINE void weigh_strip(const simd::ResidualArgs& a, const ResidualArrays& s, const std::int32_t* list,
                                       int begin, int n, const Residual& r, double root, bool complement,
                                       WeightedStrip* w, double* sums) noexcept {
  if (weighs_all(a.robust))
    weigh_all(a, s, begin, n, r, root, w, sums);
  else
    weigh_huber(a, s, list, begin, n, r, root, complement, w, sums);
}

// Sums of the rows with the factors p, q and r of the strip, one after the other.
TEXTPLANE_SIMD_INLINE void add_strip_weights(int form, const WeightedStrip& w, const RowStrip& rows, int n, bool fresh,
                                             float* acc) noexcept {
  add_strip_sums(form, w.x, w.y, w.a, w.b, rows, w.p, w.q, n, fresh, acc, acc + form * kLanes);
  float* last = acc + 2 * form * kLanes;
  add_strip_sums(form, w.x, w.y, w.a, w.b, rows, w.r, w.r, n, fresh, last, last);  // twice the same, stored once more
}
