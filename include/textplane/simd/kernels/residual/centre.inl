// Both sides of the residual, centred and scaled. Include before: kernels/sample.inl.

// The target's and the host's offsets, their means over the first strip; and kappa, the ratio of their contrasts there,
// with which kappa h - i is about as small as the residuals are: its products with rows lose nothing.
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
  reduce_sum4(i1, i2, h1, h2, sum);
  const float by_n = 1.0F / static_cast<float>(n), i_mean = sum[0] * by_n, h_mean = sum[2] * by_n;
  const float i_squares = sum[1] - sum[0] * i_mean, h_squares = sum[3] - sum[2] * h_mean;
  Offsets o;
  o.target = i[0] + i_mean;
  o.host = h[0] + h_mean;
  const double ratio = h_squares > 0 ? static_cast<double>(i_squares) / static_cast<double>(h_squares) : 0;
  o.kappa = ratio > 1e-4 && ratio < 1e4 ? static_cast<float>(sqrt_d(ratio)) : 1.0F;
  return o;
}

// i less its offset, d = kappa (h - offset) - i, and the sums of both sides and their squares: lane by lane, `terms`
// each, and what went to double. Zero beyond n.
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
    sums->i += reduce_sum_double(s.i);
    sums->ii += reduce_sum_double(s.ii);
    sums->h += reduce_sum_double(s.h);
    sums->hh += reduce_sum_double(s.hh);
    s.i = s.ii = s.h = s.hh = zero();
    sums->terms = 0;
  }
  sums->lanes = s;
}

// r sqrt(N) = on_d d + on_i i + shift, and n = (I - mean) / s = (i - i_mean) / i_s.
struct Residual {
  double on_d, on_i, shift, i_mean, i_s;
};

// A side with this sum of squares about its mean has the least contrast. What rounding leaves of a constant side is
// none. (Squares are compared: roots take time.)
TEXTPLANE_SIMD_INLINE bool has_contrast(const simd::ResidualArgs& a, double squares, double mean,
                                        double count) noexcept {
  const double least = a.min_contrast > 0 ? a.min_contrast : 0, floor = 1e-6 * mean;
  return squares > count * (least * least) && squares > count * (floor * floor);
}

// From the sums of both sides, for N pixels. no_contrast where there is none on either; non_finite for host intensities
// that are not, or whose squares are not in float.
TEXTPLANE_SIMD_ENTRY Status make_residual(const simd::ResidualArgs& a, const Offsets& o, const SideSums& sums, int n,
                                          Residual* r, simd::ResidualInfo* info) noexcept {
  const double count = n, i_mean = sums.i / count, i_squares = sums.ii - sums.i * i_mean;
  const double h_mean = sums.h / count, h_squares = sums.hh - sums.h * h_mean;
  if (!finite_d(h_squares)) return Status::non_finite;
  if (!has_contrast(a, i_squares, i_mean + static_cast<double>(o.target), count) ||
      !has_contrast(a, h_squares, h_mean + static_cast<double>(o.host), count))
    return Status::no_contrast;
  const double i_s = sqrt_d(i_squares), h_s = sqrt_d(h_squares), root = sqrt_d(count),
               kappa = static_cast<double>(o.kappa);
  const double i_scale = root / i_s, h_scale = root / h_s;
  r->on_d = h_scale / kappa;
  r->on_i = r->on_d - i_scale;
  r->shift = i_mean * i_scale - h_mean * h_scale;
  r->i_mean = i_mean;
  r->i_s = i_s;
  info->mean = i_mean + static_cast<double>(o.target);
  info->s = i_s;
  return Status::ok;
}
