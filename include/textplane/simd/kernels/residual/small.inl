// Few pixels: rows of the parameters themselves, projected and weighted pixel by pixel (simd/residual.hpp). Include
// before: residual/collect.inl, residual/rows.inl, residual/centre.inl.
//
// Most of the time goes to what happens once a call, so chains of dependent results are short: sums stay in registers
// to the end, and rows and their sums do without the roots and divisions of the residuals.

// Arrays of at most kRowPixels floats and a vector more, and how far they lie apart.
enum : int { kFewStep = kRowPixels + kMostLanes };

// Of the pixels: intensities less their mean; -r times the root of the weight, and that root over s. With these factors
// the sums of products are H and b themselves.
struct FewPixels {
  float i[kFewStep], e[kFewStep], root[kFewStep];
};

// Both sides less an offset near their means, to p->i and p->e; their sums and sums of squares.
TEXTPLANE_SIMD_INLINE void centre_few(const float* target, const float* host, int n, FewPixels* p, float* sum,
                                      float* i_offset, float* h_offset) noexcept {
  // Offsets near the means: those of the first pixels.
  const int first = n < kMostLanes ? n : static_cast<int>(kMostLanes);
  vf t = zero(), h = zero();
  for (int k = 0; k < first; k += kLanes) {
    t = add(t, load(target + k));
    h = add(h, load_part(host + k, n - k));
  }
  const float share = 1.0F / static_cast<float>(first);
  const float i_first = reduce_sum(t) * share, h_first = reduce_sum(h) * share;
  *i_offset = i_first;
  *h_offset = h_first;
  vf i1 = zero(), i2 = zero(), h1 = zero(), h2 = zero();
  for (int k = 0; k < n; k += kLanes) {
    vf i = sub(load(target + k), set1(i_first)), j = sub(load_part(host + k, n - k), set1(h_first));
    if (n - k < kLanes) {
      i = keep(first_n(n - k), i);
      j = keep(first_n(n - k), j);
    }
    store(p->i + k, i);
    store(p->e + k, j);
    i1 = add(i1, i);
    h1 = add(h1, j);
    i2 = madd(i, i, i2);
    h2 = madd(j, j, h2);
  }
  reduce_sum4(i1, i2, h1, h2, sum);
}

// From n intensities of target and host: residuals, weights, costs. The status is as that of make_residual().
TEXTPLANE_SIMD_ENTRY Status weigh_few(const simd::ResidualArgs& a, const float* target, const float* host, int n,
                                      FewPixels* p, simd::ResidualInfo* info) noexcept {
  const double count = n, by_count = 1 / count;
  float sum[4], i_offset, h_offset;
  centre_few(target, host, n, p, sum, &i_offset, &h_offset);
  const double i_mean = static_cast<double>(sum[0]) * by_count, h_mean = static_cast<double>(sum[2]) * by_count;
  const double i_squares = static_cast<double>(sum[1]) - static_cast<double>(sum[0]) * i_mean,
               h_squares = static_cast<double>(sum[3]) - static_cast<double>(sum[2]) * h_mean;
  if (!finite_d(h_squares)) return Status::non_finite;
  info->mean = i_mean + static_cast<double>(i_offset);
  if (!has_contrast(a, i_squares, info->mean, count) ||
      !has_contrast(a, h_squares, h_mean + static_cast<double>(h_offset), count))
    return Status::no_contrast;
  const double i_s = sqrt_d(i_squares), root = sqrt_d(count), i_scale = root / i_s, h_scale = root / sqrt_d(h_squares);
  info->s = i_s;

  const bool huber = a.robust == RobustKind::huber;
  const float delta = static_cast<float>(a.delta);
  const vf limit = set1(delta > 1e-30F ? delta : 1e-30F), root_limit = sqrt_(limit);
  const vf by_i = set1(static_cast<float>(i_scale));
  const vf by_h = set1(static_cast<float>(h_scale)), mean = set1(static_cast<float>(i_mean));
  const vf shift = set1(static_cast<float>(i_mean * i_scale - h_mean * h_scale));
  const vf by_s = set1(static_cast<float>(1 / i_s)), by_root = set1(static_cast<float>(-1 / root));
  vf squares = zero(), rho = zero();
  for (int k = 0; k < n; k += kLanes) {
    vf i = load(p->i + k), e = madd(load(p->e + k), by_h, nmadd(i, by_i, shift)), w = set1(1.0F);
    i = sub(i, mean);
    if (n - k < kLanes) {
      const vm counted = first_n(n - k);
      i = keep(counted, i);
      e = keep(counted, e);
      w = keep(counted, w);
    }
    squares = madd(e, e, squares);
    if (huber) {
      const vf size = abs_(e), m = min_(size, limit);
      rho = madd(m, add(size, sub(size, m)), rho);
      w = select(gt(size, limit), mul(root_limit, inverse_root(max_(size, limit))), w);
    }
    store(p->i + k, i);
    store(p->e + k, mul(w, mul(e, by_root)));
    store(p->root + k, mul(w, by_s));
  }
  reduce_sum4(squares, huber ? rho : squares, squares, rho, sum);
  info->error = static_cast<double>(sum[0]) * by_count;
  info->cost = static_cast<double>(sum[1]) * by_count;
  return Status::ok;
}

// With L2's weights in p: applies those of Cauchy or Tukey, and their cost.
TEXTPLANE_SIMD_ENTRY void weigh_few_all(const simd::ResidualArgs& a, int n, FewPixels* p,
                                        simd::ResidualInfo* info) noexcept {
  const RobustVectors robust = broadcast_robust(a.robust, a.delta);
  const vf count = set1(static_cast<float>(n));
  vf sum = zero();
  for (int k = 0; k < n; k += kLanes) {
    const vf r = load(p->e + k);
    vf rho, w;
    robust_vector(robust, mul(count, mul(r, r)), &rho, &w);
    store(p->e + k, mul(w, r));
    store(p->root + k, mul(w, load(p->root + k)));
    sum = add(sum, rho);  // rho(0) = 0
  }
  info->cost = static_cast<double>(reduce_sum(sum)) / n;
}

// Three rows become root (row - mean - i (sum i row) / (sum i^2)); with the normalisation held, root row.
TEXTPLANE_SIMD_ENTRY void project_few(const FewPixels& p, int n, bool exact, float by_count, float by_squares,
                                      float* row) noexcept {
  float *r0 = row, *r1 = row + kFewStep, *r2 = row + 2 * kFewStep;
  if (!exact) {
    for (int k = 0; k < n; k += kLanes) {
      const vf w = hold(load(p.root + k));
      store(r0 + k, mul(w, load(r0 + k)));
      store(r1 + k, mul(w, load(r1 + k)));
      store(r2 + k, mul(w, load(r2 + k)));
    }
    return;
  }
  vf s0 = zero(), s1 = zero(), s2 = zero(), t0 = zero(), t1 = zero(), t2 = zero();
  for (int k = 0; k < n; k += kLanes) {
    const vf i = hold(load(p.i + k)), a = hold(load(r0 + k)), b = hold(load(r1 + k)), c = hold(load(r2 + k));
    s0 = add(s0, a);
    s1 = add(s1, b);
    s2 = add(s2, c);
    t0 = madd(a, i, t0);
    t1 = madd(b, i, t1);
    t2 = madd(c, i, t2);
  }
  float sum[8];
  reduce_sum4(s0, s1, s2, s2, sum);
  reduce_sum4(t0, t1, t2, t2, sum + 4);
  const vf mean = set1(by_count), along = set1(by_squares);
  s0 = mul(set1(sum[0]), mean);
  s1 = mul(set1(sum[1]), mean);
  s2 = mul(set1(sum[2]), mean);
  t0 = mul(set1(sum[4]), along);
  t1 = mul(set1(sum[5]), along);
  t2 = mul(set1(sum[6]), along);
  for (int k = 0; k < n; k += kLanes) {
    const vf i = hold(load(p.i + k)), w = hold(load(p.root + k));
    store(r0 + k, mul(w, nmadd(i, t0, sub(load(r0 + k), s0))));
    store(r1 + k, mul(w, nmadd(i, t1, sub(load(r1 + k), s1))));
    store(r2 + k, mul(w, nmadd(i, t2, sub(load(r2 + k), s2))));
  }
}

// Sums of products of three rows among themselves, and with e: nine, in the order of put_square().
TEXTPLANE_SIMD_ENTRY void square_few(const float* row, const float* e, int n, float* out) noexcept {
  const float *r0 = row, *r1 = row + kFewStep, *r2 = row + 2 * kFewStep;
  vf s0 = zero(), s1 = zero(), s2 = zero(), s3 = zero(), s4 = zero(), s5 = zero(), b0 = zero(), b1 = zero(),
     b2 = zero();
  for (int k = 0; k < n; k += kLanes) {
    const vf a = hold(load(r0 + k)), b = hold(load(r1 + k)), c = hold(load(r2 + k)), r = hold(load(e + k));
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
  reduce_sum4(s0, s1, s2, s3, out);
  reduce_sum4(s4, s5, b0, b1, out + 4);
  out[8] = reduce_sum(b2);
}

// Sums of products of three rows with three others: nine.
TEXTPLANE_SIMD_ENTRY void cross_few(const float* row, const float* other, int n, float* out) noexcept {
  const float *r0 = row, *r1 = row + kFewStep, *r2 = row + 2 * kFewStep;
  const float *q0 = other, *q1 = other + kFewStep, *q2 = other + 2 * kFewStep;
  vf s0 = zero(), s1 = zero(), s2 = zero(), s3 = zero(), s4 = zero(), s5 = zero(), s6 = zero(), s7 = zero(),
     s8 = zero();
  for (int k = 0; k < n; k += kLanes) {
    const vf a = hold(load(r0 + k)), b = hold(load(r1 + k)), c = hold(load(r2 + k)), x = hold(load(q0 + k)),
             y = hold(load(q1 + k)), z = hold(load(q2 + k));
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
  reduce_sum4(s0, s1, s2, s3, out);
  reduce_sum4(s4, s5, s6, s7, out + 4);
  out[8] = reduce_sum(s8);
}

// Entries of H (`size` columns): the square at (at, at), the block at (r, c) and its mirror image.
TEXTPLANE_SIMD_INLINE void put_square(const float* p, int at, int size, double* H) noexcept {
  double* q = H + size * at + at;
  q[0] = static_cast<double>(p[0]);
  q[1] = q[size] = static_cast<double>(p[1]);
  q[2] = q[2 * size] = static_cast<double>(p[2]);
  q[size + 1] = static_cast<double>(p[3]);
  q[size + 2] = q[2 * size + 1] = static_cast<double>(p[4]);
  q[2 * size + 2] = static_cast<double>(p[5]);
}
TEXTPLANE_SIMD_INLINE void put_block(const float* p, int r, int c, int size, double* H) noexcept {
  double *q = H + size * r + c, *mirror = H + size * c + r;
  q[0] = mirror[0] = static_cast<double>(p[0]);
  q[1] = mirror[size] = static_cast<double>(p[1]);
  q[2] = mirror[2 * size] = static_cast<double>(p[2]);
  q[size] = mirror[1] = static_cast<double>(p[3]);
  q[size + 1] = mirror[size + 1] = static_cast<double>(p[4]);
  q[size + 2] = mirror[2 * size + 1] = static_cast<double>(p[5]);
  q[2 * size] = mirror[2] = static_cast<double>(p[6]);
  q[2 * size + 1] = mirror[size + 2] = static_cast<double>(p[7]);
  q[2 * size + 2] = mirror[2 * size + 2] = static_cast<double>(p[8]);
}

// The cost of at most kRowPixels host pixels.
TEXTPLANE_SIMD_ENTRY Status evaluate_small(const simd::ResidualArgs& a, const ResidualFrame& f, const HostPixels& host,
                                           const ResidualArrays& s, simd::ResidualInfo* info) noexcept {
  SampleStrip strip;
  collect_values(host, f, 0, host.n, s, &strip);
  FewPixels pixels;
  const Status status = weigh_few(a, s.i, host.h, host.n, &pixels, info);
  if (weighs_all(a.robust) && status == Status::ok) weigh_few_all(a, host.n, &pixels, info);
  return status;
}

// Normal equations of `parameters` (3, 6 or 9) for at most kRowPixels host pixels.
TEXTPLANE_SIMD_INLINE Status linearise_small(int parameters, const simd::ResidualArgs& a, const ResidualFrame& f,
                                             const HostPixels& host, const ResidualArrays& s, simd::ResidualInfo* info,
                                             double* H, double* b) noexcept {
  const int n = host.n;
  SampleStrip strip;
  collect_strip(host, f, 0, n, s, &strip);
  float row[9 * kFewStep];
  RowConstants constants;
  make_row_constants(a, f, &constants);
  if (parameters != 3) pose_rows(constants, s.x, s.y, s.a, s.b, n, kFewStep, row);
  if (parameters != 6) plane_rows(constants, s.x, s.y, s.a, s.b, n, kFewStep, row + (parameters - 3) * kFewStep);
  FewPixels pixels;
  const Status status = weigh_few(a, s.i, host.h, n, &pixels, info);
  if (status != Status::ok) return status;
  if (weighs_all(a.robust)) weigh_few_all(a, n, &pixels, info);

  const float by_count = static_cast<float>(1.0 / n), by_squares = static_cast<float>(1 / (info->s * info->s));
  float *r0 = row, *r1 = row + 3 * kFewStep, *r2 = row + 6 * kFewStep, sum[6][12];
  for (int g = 0; g < parameters; g += 3) project_few(pixels, n, a.exact, by_count, by_squares, row + g * kFewStep);
  square_few(r0, pixels.e, n, sum[0]);
  if (parameters > 3) {
    square_few(r1, pixels.e, n, sum[1]);
    cross_few(r0, r1, n, sum[2]);
  }
  if (parameters > 6) {
    square_few(r2, pixels.e, n, sum[3]);
    cross_few(r0, r2, n, sum[4]);
    cross_few(r1, r2, n, sum[5]);
  }
  put_square(sum[0], 0, parameters, H);
  for (int k = 0; k < 3; ++k) b[k] = static_cast<double>(sum[0][6 + k]);
  if (parameters > 3) {
    put_square(sum[1], 3, parameters, H);
    put_block(sum[2], 0, 3, parameters, H);
    for (int k = 0; k < 3; ++k) b[3 + k] = static_cast<double>(sum[1][6 + k]);
  }
  if (parameters > 6) {
    put_square(sum[3], 6, parameters, H);
    put_block(sum[4], 0, 6, parameters, H);
    put_block(sum[5], 3, 6, parameters, H);
    for (int k = 0; k < 3; ++k) b[6 + k] = static_cast<double>(sum[3][6 + k]);
  }
  // H and b are finite if the squares of the rows and the costs are (Cauchy-Schwarz).
  double squares = 0;
  for (int g = 0; g < parameters; g += 3) {
    const float* p = sum[g / 3 < 2 ? g / 3 : 3];
    squares += (static_cast<double>(p[0]) + static_cast<double>(p[3])) + static_cast<double>(p[5]);
  }
  return finite_d(squares) ? Status::ok : Status::unsupported;
}
