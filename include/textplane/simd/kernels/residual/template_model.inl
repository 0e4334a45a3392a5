// Costs and normal equations from the exact sums of template.inl, in double (simd/template.hpp). Include before:
// residual/template.inl, residual/weights.inl, residual/finish.inl, residual/host_basis.inl.

// The origin above and to the left of image positions between (x_low, y_low) and (x_high, y_high), relative to the
// frame's; and tiles, where pixels that move by (a du + b dv, c du + d dv) are likely to take them. False where 16 bits
// do not hold the positions.
TEXTPLANE_SIMD_INLINE bool template_origin(const ResidualFrame& f, double x_low, double y_low, double x_high,
                                           double y_high, simd::TemplateArgs* t, int* dx, int* dy) noexcept {
  if (!(x_low > -60000.0 && y_low > -60000.0 && x_high - x_low < 60000.0 && y_high - y_low < 60000.0)) return false;
  *dx = static_cast<int>(x_low + 65536.0) - 65537;
  *dy = static_cast<int>(y_low + 65536.0) - 65537;
  t->ox = f.warp.ox + *dx;
  t->oy = f.warp.oy + *dy;
  return true;
}
TEXTPLANE_SIMD_INLINE bool template_tiles_fit(const ResidualFrame& f, const simd::TemplateArgs& t, double x_low,
                                              double y_low, double x_high, double y_high, ImageTiles* tiles) noexcept {
  // One pixel clear of the borders where a tile would leave the image, so that no cell is clamped.
  const simd::Image8& target = t.target;
  return make_tiles(target.data, target.stride, target.width, target.height, t.ox, t.oy, tiles) && !target.pairs &&
         x_low + f.warp.ox >= 1 && y_low + f.warp.oy >= 1 && x_high + f.warp.ox < target.width - 16 &&
         y_high + f.warp.oy < target.height - 3;
}

// The warp with divisor 1 at the centre, its ninth number.
TEXTPLANE_SIMD_INLINE void unit_warp(const simd::Warp8& w, double* g) noexcept {
  const double scale = 1.0 / static_cast<double>(w.g[8]);
  for (int k = 0; k < 8; ++k) g[k] = static_cast<double>(w.g[k]) * scale;
}
// Such a warp with the origin moved by (dx, dy).
TEXTPLANE_SIMD_INLINE void template_warp(const double* g, int dx, int dy, simd::TemplateArgs* t) noexcept {
  for (int k = 0; k < 3; ++k) {
    const double w = k < 2 ? g[6 + k] : 1.0;
    t->g[k] = static_cast<float>(g[k] - dx * w);
    t->g[3 + k] = static_cast<float>(g[3 + k] - dy * w);
  }
  t->g[6] = static_cast<float>(g[6]);
  t->g[7] = static_cast<float>(g[7]);
}

// The warp with divisor 1 at the centre, and an origin above and to the left of all pixels. False where not all are
// visible.
TEXTPLANE_SIMD_INLINE bool template_frame(const simd::TemplateModel& m, const ResidualFrame& f, simd::TemplateArgs* t,
                                          ImageTiles* tiles) noexcept {
  if (!f.inside) return false;
  double g[8];
  unit_warp(f.warp, g);
  const double u = static_cast<double>(m.bounds.x_high) - static_cast<double>(f.warp.hx),
               v = static_cast<double>(m.bounds.y_high) - static_cast<double>(f.warp.hy);
  double x_low = 1e9, y_low = 1e9, x_high = -1e9, y_high = -1e9;
  for (int corner = 0; corner < 4; ++corner) {
    const double p = corner & 1 ? u : -u, q = corner & 2 ? v : -v, z = 1.0 / (g[6] * p + g[7] * q + 1.0);
    const double x = (g[0] * p + g[1] * q + g[2]) * z, y = (g[3] * p + g[4] * q + g[5]) * z;
    x_low = x < x_low ? x : x_low;
    y_low = y < y_low ? y : y_low;
    x_high = x > x_high ? x : x_high;
    y_high = y > y_high ? y : y_high;
  }
  int dx, dy;
  if (!template_origin(f, x_low, y_low, x_high, y_high, t, &dx, &dy)) return false;
  template_warp(g, dx, dy, t);
  if (template_tiles_fit(f, *t, x_low, y_low, x_high, y_high, tiles)) {
    const float* k = t->g;
    tiles->guess =
        guess_tiles(m.u, m.v, m.n, k[0] - k[2] * k[6], k[1] - k[2] * k[7], k[3] - k[5] * k[6], k[4] - k[5] * k[7]);
  }
  return true;
}

// The same behind a lens: the warp to the pinhole image, and the lens relative to that origin.
TEXTPLANE_SIMD_ENTRY bool template_lens_frame(const simd::TemplateModel& m, const ResidualFrame& f,
                                              simd::TemplateArgs* t, LensFrame* lens, ImageTiles* tiles) noexcept {
  if (!f.inside) return false;
  const float* box = f.lens.box;
  const double x_low = static_cast<double>(box[0]), y_low = static_cast<double>(box[1]),
               x_high = static_cast<double>(box[2]), y_high = static_cast<double>(box[3]);
  int dx, dy;
  if (!template_origin(f, x_low, y_low, x_high, y_high, t, &dx, &dy)) return false;
  double g[8];
  unit_warp(f.warp, g);
  template_warp(g, dx, dy, t);
  *lens = f.lens;
  move_lens_origin(dx, dy, lens);
  if (template_tiles_fit(f, *t, x_low, y_low, x_high, y_high, tiles)) {
    const float* k = t->g;
    float a = k[0] - k[2] * k[6], b = k[1] - k[2] * k[7], c = k[3] - k[5] * k[6], d = k[4] - k[5] * k[7];
    lens_turn(f.lens, &a, &b, &c, &d);
    tiles->guess = guess_tiles(m.u, m.v, m.n, a, b, c, d);
  }
  return true;
}

// e = r sqrt(N) in terms of V and column 0, and E. no_contrast where the target has none.
TEXTPLANE_SIMD_INLINE Status template_residual(const simd::TemplateModel& m, const simd::ResidualArgs& a,
                                               const simd::TemplateSums& sums, double* mean, double* norm, Residual* r,
                                               simd::ResidualInfo* info) noexcept {
  const double count = m.n, root = sqrt_d(count), total = static_cast<double>(sums.value);
  *mean = total / count;
  const double squares = static_cast<double>(sums.square) - total * *mean;
  const double least = a.min_contrast > 0 ? a.min_contrast : 0;
  // Rounding alone can leave a standard deviation of one unit.
  const double sigma = squares > 0 ? sqrt_d(squares / count) : 0;
  if (!(sigma > 64 * least) || !(sigma > 1.0) || !(m.s > least * root) || !(m.norm > 0)) return Status::no_contrast;
  *norm = sqrt_d(squares);
  info->mean = *mean / 64 + 127.5;
  info->s = *norm / 64;
  const double product = (static_cast<double>(sums.column[0]) - m.mean * total) / (m.norm * *norm);
  info->error = info->cost = 2 - 2 * product;
  r->on_d = -root / *norm;
  r->on_i = root / m.norm;
  r->shift = root * (*mean / *norm - m.mean / m.norm);
  r->i_mean = m.mean;
  r->i_s = m.norm;
  return Status::ok;
}

TEXTPLANE_SIMD_INLINE void widen_values(const std::int16_t* values, int n, float* out) noexcept {
  for (int i = 0; i < n; i += k16Lanes) {
    const v16 v = load16(values + i);
    store(out + i, to_float(widen_low16(v)));
    if (i + kLanes < n) store(out + i + kLanes, to_float(widen_high16(v)));
  }
}

// The model's pixels as arguments of weigh_strip() and add_costs().
TEXTPLANE_SIMD_INLINE ResidualArrays template_arrays(const simd::TemplateModel& m, float* scratch) noexcept {
  ResidualArrays s;
  make_arrays(scratch, m.n, &s);
  s.x = const_cast<float*>(m.u);
  s.y = const_cast<float*>(m.v);
  s.a = const_cast<float*>(m.gx);
  s.b = const_cast<float*>(m.gy);
  s.i = const_cast<float*>(m.intensity);
  return s;
}

// The model's sums without weights.
TEXTPLANE_SIMD_INLINE void template_unweighted(const simd::TemplateModel& m, const simd::TemplateSums& exact,
                                               double mean, double norm, double error, WeightedSums* sums) noexcept {
  const double count = m.n;
  for (int k = 0; k < 8; ++k) {
    const double with_n = (static_cast<double>(exact.column[k + 1]) * m.step[k] - mean * count * m.e[k]) / norm;
    sums->e[k] = m.e[k];
    sums->jn[k] = sums->wn[k] = m.c[k];
    sums->w1[k] = count * m.e[k];
    sums->wr[k] = m.c[k] - with_n;
    for (int j = 0; j < 8; ++j) sums->S[k][j] = m.S[k][j];
  }
  sums->w[0] = count;
  sums->w[1] = sums->w[3] = 0;
  sums->w[2] = 1;
  sums->w[4] = 0.5 * error;
}

// Takes from the sums what the weights of the outliers in the list take away; where `direct`, sets them to those of all
// pixels.
TEXTPLANE_SIMD_INLINE void template_outliers(const simd::ResidualArgs& a, const ResidualArrays& s, int outliers,
                                             bool direct, const Residual& r, double root, WeightedSums* sums) noexcept {
  enum : int { kProducts = 27, kAll = 51 };
  float acc[(kMostSums + 8) * kMostLanes], unused_sums[8 * kMostLanes];
  double other[kMostSums], w[5] = {0, 0, 0, 0, 0}, S[8][8];
  zero_rest(kAll, acc);
  WeightedStrip ws;
  RowStrip rows;
  RowConstants unused;
  for (int begin = 0; begin < outliers; begin += kStrip) {
    const int m = outliers - begin < kStrip ? outliers - begin : kStrip;
    if (direct)
      weigh_all(a, s, begin, m, r, root, &ws, w);
    else
      weigh_huber(a, s, s.list + begin, begin, m, r, root, true, &ws, w);
    add_strip_products(8, false, unused, ws.x, ws.y, ws.a, ws.b, m, &rows, true, acc);
    add_strip_sums(8, ws.x, ws.y, ws.a, ws.b, rows, ws.p, ws.q, m, true, acc + kProducts * kLanes,
                   acc + (kProducts + 8) * kLanes);
    add_strip_sums(8, ws.x, ws.y, ws.a, ws.b, rows, ws.r, ws.r, m, true, acc + (kProducts + 16) * kLanes, unused_sums);
    fold(acc, kAll, begin == 0, other);
  }
  if (direct) {
    unpack_products(8, other, sums->S);
    stored(sums->w1, loadd(other + kProducts));
    stored(sums->wn, loadd(other + kProducts + 8));
    stored(sums->wr, loadd(other + kProducts + 16));
    for (int k = 0; k < 5; ++k) sums->w[k] = w[k];
    return;
  }
  unpack_products(8, other, S);
  for (int k = 0; k < 8; ++k) {
    sums->w1[k] -= other[kProducts + k];
    sums->wn[k] -= other[kProducts + 8 + k];
    sums->wr[k] -= other[kProducts + 16 + k];
    for (int j = 0; j < 8; ++j) sums->S[k][j] -= S[k][j];
  }
  for (int k = 0; k < 5; ++k) sums->w[k] -= w[k];
}

// Samples and judges; where `derivatives`, normal equations.
TEXTPLANE_SIMD_INLINE void template_any(const simd::TemplateModel& m, const simd::ResidualArgs& a, std::int16_t* values,
                                        bool derivatives, simd::ResidualInfo* info, double* H, double* b) noexcept {
  ResidualFrame f;
  info->status = Status::unsupported;
  if (m.bounds.n != a.n || m.n != a.n || !make_frame(a, m.bounds, &f)) return;
  simd::TemplateArgs t;
  t.target = a.target;
  ImageTiles tiles;
  LensFrame lens;
  info->status = Status::unsupported;
  if (f.lens.on ? !template_lens_frame(m, f, &t, &lens, &tiles) : !template_frame(m, f, &t, &tiles)) return;
  info->candidates = info->visible = m.n;
  if (a.flags) set_all(a.flags, a.n);
  info->status = Status::too_few;
  if (m.n < 1 || m.n < a.min_visible) return;
  t.u = m.u;
  t.v = m.v;
  t.rows = m.rows;
  t.n = m.n;
  t.values = values;
  simd::TemplateSums exact;
  template_run(t, tiles.guess.likely ? &tiles : nullptr, f.lens.on ? &lens : nullptr, derivatives, exact);

  Residual r;
  double mean, norm;
  info->status = template_residual(m, a, exact, &mean, &norm, &r, info);
  if (info->status != Status::ok) return;
  const double count = m.n, root = sqrt_d(count);
  const ResidualArrays s = template_arrays(m, a.scratch);
  int outliers = 0;
  if (a.robust != RobustKind::l2) {
    const double error = info->error;
    widen_values(values, m.n, s.d);
    outliers = add_costs(a, s, m.n, r, derivatives ? s.list : nullptr, info);
    info->error = error;  // exact, not that of the float residuals
  }
  if (!derivatives) return;

  double M[9][8];
  host_matrix(a, f, M);
  if (outliers == 0) {
    // H is the model's, and K^T r = K^T h - K^T n.
    double g[8];
    const double unit = 1 / m.s, on_c = a.exact ? 1 - 0.5 * info->error : 1.0;
    for (int k = 0; k < 8; ++k) {
      const double with_n = (static_cast<double>(exact.column[k + 1]) * m.step[k] - mean * count * m.e[k]) / norm;
      g[k] = (with_n - on_c * m.c[k]) * unit;
    }
    change_parameters(M, a.exact ? m.H_exact : m.H_frozen, g, H, b);
    return;
  }

  WeightedSums sums;
  template_unweighted(m, exact, mean, norm, info->error, &sums);
  template_outliers(a, s, outliers, weighs_all(a.robust), r, root, &sums);
  project_sums(8, a.exact, m.s, &sums);
  change_parameters(M, sums.S, sums.wr, H, b);
}

TEXTPLANE_SIMD_ENTRY void linearise_template(const simd::TemplateModel& m, const simd::ResidualArgs& a,
                                             std::int16_t* values, simd::ResidualInfo* info, double* H,
                                             double* b) noexcept {
  template_any(m, a, values, true, info, H, b);
  if (info->status == Status::ok && !finite_sums(9, *info, H, b)) info->status = Status::unsupported;
}
TEXTPLANE_SIMD_ENTRY void evaluate_template(const simd::TemplateModel& m, const simd::ResidualArgs& a,
                                            std::int16_t* values, simd::ResidualInfo* info) noexcept {
  template_any(m, a, values, false, info, nullptr, nullptr);
}
