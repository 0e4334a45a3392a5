// The kernel of simd/hybrid.hpp. Include before: residual/large.inl, residual/host_basis.inl.
//
// e = r sqrt(N) of a pixel is pulled to w e by the robust cost. With the projections through mean and norm taken from
// it, one factor f a pixel is left, and b is a sum of rows times f:
//
//   f = w e - T0 / N - Tn n,   T0 = sum w e,  Tn = sum w e n,   b8 = -sum f j / (s sqrt(N))

// Sums over all pixels, in the order in which they lie in an array of doubles: of e^2 and rho(e^2); of w e, w e i and
// w; of A A, A B and B B.
enum : int { kPullSums = 8 };

// Residuals become w e in s.d. The sums of costs are those of add_costs(), to the bit: trials are compared with them.
// `all`: Cauchy and Tukey, which weigh every pixel.
TEXTPLANE_SIMD_INLINE void pull_by(bool all, const simd::ResidualArgs& a, const ResidualArrays& s, int n,
                                   const Residual& r, double* sums) noexcept {
  const RobustVectors robust =
      all ? broadcast_robust(a.robust, a.delta) : RobustVectors{zero(), zero(), RobustKind::l2};
  const vf on_d = set1(static_cast<float>(r.on_d)), on_i = set1(static_cast<float>(r.on_i));
  const vf shift = set1(static_cast<float>(r.shift));
  const vf limit = set1(a.robust == RobustKind::huber ? static_cast<float>(a.delta) : 3.0e38F);
  for (int k = 0; k < kPullSums; ++k) sums[k] = 0;
  for (int begin = 0; begin < n; begin += kFoldTerms * kLanes) {
    const int end = n - begin < kFoldTerms * kLanes ? n : begin + kFoldTerms * kLanes;
    CostSums cost = {zero(), zero()};
    vf s0 = zero(), s1 = s0, s2 = s0, e0 = s0, e1 = s0, e2 = s0;
    for (int k = begin; k < end; k += kLanes) {
      const vf i = load(s.i + k), A = load(s.a + k), B = load(s.b + k);
      vf e = madd(load(s.d + k), on_d, madd(i, on_i, shift)), w;
      if (end - k < kLanes) e = keep(first_n(end - k), e);
      if (all) {
        const vf square = mul(e, e);
        vf rho, root;
        robust_vector(robust, square, &rho, &root);
        cost.squares = add(cost.squares, square);
        cost.rho = add(cost.rho, rho);
        w = mul(root, root);
      } else {
        const vf size = abs_(e), m = min_(size, limit);
        cost.squares = madd(e, e, cost.squares);
        cost.rho = madd(m, add(size, sub(size, m)), cost.rho);
        w = div(limit, max_(size, limit));
      }
      if (end - k < kLanes) w = keep(first_n(end - k), w);
      const vf we = mul(w, e);
      store(s.d + k, we);
      s0 = add(s0, we);
      s1 = madd(we, i, s1);
      s2 = add(s2, w);
      e0 = madd(A, A, e0);
      e1 = madd(A, B, e1);
      e2 = madd(B, B, e2);
    }
    const vf all_sums[kPullSums] = {cost.squares, cost.rho, s0, s1, s2, e0, e1, e2};
    for (int k = 0; k < kPullSums; ++k) sums[k] += reduce_sum_double(all_sums[k]);
  }
}
TEXTPLANE_SIMD_ENTRY void pull_huber(const simd::ResidualArgs& a, const ResidualArrays& s, int n, const Residual& r,
                                     double* sums) noexcept {
  pull_by(false, a, s, n, r, sums);
}
TEXTPLANE_SIMD_ENTRY void pull_all(const simd::ResidualArgs& a, const ResidualArrays& s, int n, const Residual& r,
                                   double* sums) noexcept {
  pull_by(true, a, s, n, r, sums);
}

// Sums of the eight rows times f = w e - k0 - k1 i over the pixels from `begin` to `end`. Rows are zero beyond the
// last.
TEXTPLANE_SIMD_ENTRY void add_hybrid(const ResidualArrays& s, int begin, int end, float k0, float k1,
                                     float* acc) noexcept {
  const vf constant = set1(k0), on_i = set1(-k1);
  vf s0 = zero(), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
  for (int k = begin; k < end; k += kLanes) {
    const vf x = load(s.x + k), y = load(s.y + k);
    const vf f = madd(on_i, load(s.i + k), sub(load(s.d + k), constant));
    const vf fA = mul(f, load(s.a + k)), fB = mul(f, load(s.b + k)), fC = madd(fA, x, mul(fB, y));
    s0 = add(s0, fA);
    s1 = madd(fA, x, s1);
    s2 = madd(fA, y, s2);
    s3 = add(s3, fB);
    s4 = madd(fB, x, s4);
    s5 = madd(fB, y, s5);
    s6 = madd(fC, x, s6);
    s7 = madd(fC, y, s7);
  }
  put3(acc, s0, s1, s2);
  put3(acc + 3 * kLanes, s3, s4, s5);
  store(acc + 6 * kLanes, s6);
  store(acc + 7 * kLanes, s7);
}

// The energy of the target's gradients, pulled back to the host by the warp's derivative at the patch's centre.
TEXTPLANE_SIMD_INLINE double pulled_energy(const simd::Warp8& w, const double* sums) noexcept {
  const double z = 1 / static_cast<double>(w.g[8]), x = static_cast<double>(w.g[2]) * z,
               y = static_cast<double>(w.g[5]) * z;
  double energy = 0;
  for (int k = 0; k < 2; ++k) {
    const double along = static_cast<double>(w.g[6 + k]);
    const double p = (static_cast<double>(w.g[k]) - x * along) * z,
                 q = (static_cast<double>(w.g[3 + k]) - y * along) * z;
    energy += p * p * sums[0] + 2 * p * q * sums[1] + q * q * sums[2];
  }
  return energy;
}

TEXTPLANE_SIMD_INLINE Status hybrid_pixels(const simd::TemplateModel& m, const simd::ResidualArgs& a,
                                           const ResidualFrame& f, const HostPixels& host, const ResidualArrays& s,
                                           simd::ResidualInfo* info, double* H, double* b) noexcept {
  const int n = host.n;
  SampleStrip strip;
  Offsets offsets;
  SideSums sides = no_sides();
  for (int begin = 0; begin < n; begin += kStrip) {
    const int count = n - begin < kStrip ? n - begin : kStrip;
    collect_strip(host, f, begin, count, s, &strip);
    if (begin == 0) offsets = first_offsets(s.i, host.h, count);
    centre_strip(s.i + begin, host.h + begin, s.d + begin, count, offsets, begin + kStrip >= n, &sides);
  }
  Residual r;
  const Status status = make_residual(a, offsets, sides, n, &r, info);
  if (status != Status::ok) return status;
  double pulls[kPullSums], k0 = 0, k1 = 0;
  if (weighs_all(a.robust))
    pull_all(a, s, n, r, pulls);
  else
    pull_huber(a, s, n, r, pulls);
  info->error = pulls[0] / n;
  info->cost = pulls[1] / n;
  if (a.exact) {
    k1 = (pulls[3] - r.i_mean * pulls[2]) / (r.i_s * r.i_s);
    k0 = pulls[2] / n - k1 * r.i_mean;
  }
  float acc[8 * kMostLanes];
  double total[8];
  for (int begin = 0; begin < n; begin += kFoldTerms * kLanes) {
    const int end = n - begin < kFoldTerms * kLanes ? n : begin + kFoldTerms * kLanes;
    add_hybrid(s, begin, end, static_cast<float>(k0), static_cast<float>(k1), acc);
    fold(acc, 8, begin == 0, total);
  }

  const double energy = pulls[4] / n * pulled_energy(f.warp, pulls + 5) / (r.i_s * r.i_s);
  const double ratio = energy * (m.s * m.s) / (m.S[0][0] + m.S[3][3]);
  double M[9][8], S[8][8], g[8], unused[9];
  for (int k = 0; k < 8; ++k) {
    g[k] = total[k] * (-1 / (r.i_s * sqrt_d(n)));
    for (int j = 0; j < 8; ++j) S[k][j] = ratio * (a.exact ? m.H_exact[k][j] : m.H_frozen[k][j]);
  }
  host_matrix(a, f, M);
  change_parameters(M, S, g, H, unused);
  parameter_matrix(a, f, M);
  stored(b, row_product(g, 1, M));
  b[8] = 0;
  for (int k = 0; k < 8; ++k) b[8] += g[k] * M[8][k];
  return finite_sums(9, *info, H, b) ? Status::ok : Status::unsupported;
}

TEXTPLANE_SIMD_ENTRY void linearise_hybrid(const simd::TemplateModel& m, const simd::ResidualArgs& a,
                                           simd::ResidualInfo* info, double* H, double* b) noexcept {
  ResidualFrame f;
  info->status = Status::unsupported;
  if (m.bounds.n != a.n || m.n != a.n || !make_frame(a, m.bounds, &f)) return;
  ResidualArrays s;
  make_arrays(a.scratch, a.n, &s);
  const HostPixels pixels = host_pixels(a, f, false, s, info);
  info->status = Status::unsupported;
  if (pixels.n <= kRowPixels || pixels.n < a.min_visible) return;
  if (kInt16Tiles != 0) choose_tiles(a, m.bounds, pixels, &f);
  info->status = hybrid_pixels(m, a, f, pixels, s, info, H, b);
  if (info->status == Status::non_finite) info->status = Status::unsupported;
}
