// Geometry and sampling of simd/batch.hpp: one object a lane.

enum : int { kBatchStep = simd::kBatchLanes, kBatchFields = 12, kBatchStrip = 16 };

// Where things lie in the scratch of one pixel, in vectors: rows of dI, then the rest. Weight: 1 where visible.
enum : int { kBatchRow = 0, kBatchTarget = 9, kBatchHost = 10, kBatchWeight = 11 };

TEXTPLANE_SIMD_INLINE double batch_abs(double x) noexcept { return x < 0 ? -x : x; }
// The most that f0 u + f1 v + f2 reaches for |u| <= ru, |v| <= rv.
TEXTPLANE_SIMD_INLINE double batch_most(double f0, double f1, double f2, double ru, double rv) noexcept {
  return f2 + batch_abs(f0) * ru + batch_abs(f1) * rv;
}

// Lane `l` of the frame. A status that is not ok says that no pixel need be looked at.
TEXTPLANE_SIMD_INLINE Status batch_lane(const simd::BatchArgs& a, const simd::BatchObject& o, const double* pose, int l,
                                        BatchFrame* f) noexcept {
  const double fx = a.camera[0], fy = a.camera[1], cx = a.camera[2], cy = a.camera[3];
  const double *R = pose, *t = pose + a.t_offset;
  double S[3][3];
  for (int r = 0; r < 3; ++r) {
    const double h0 = R[r] + t[r] * o.theta[0], h1 = R[3 + r] + t[r] * o.theta[1], h2 = R[6 + r] + t[r] * o.theta[2];
    S[r][0] = h0 * o.ifx;
    S[r][1] = h1 * o.ify;
    S[r][2] = h0 * o.mu + h1 * o.mv + h2;
  }
  const double size = batch_abs(S[2][2]) + 50 * (batch_abs(S[2][0]) + batch_abs(S[2][1]));
  const double scale = 1 / size, z = S[2][2];
  const double inverse = z > 0 ? 1 / z : 0, px = fx * S[0][2] * inverse + cx, py = fy * S[1][2] * inverse + cy;
  const double w1 = a.target.width - 1, h1 = a.target.height - 1;
  const int ox = static_cast<int>(px > 0 ? (px < w1 ? px : w1) : 0), oy = static_cast<int>(py > 0 ? (py < h1 ? py : h1) : 0);
  double g[9];
  for (int k = 0; k < 3; ++k) {
    g[k] = (fx * S[0][k] + (cx - ox) * S[2][k]) * scale;
    g[3 + k] = (fy * S[1][k] + (cy - oy) * S[2][k]) * scale;
    g[6 + k] = S[2][k] * scale;
  }
  const double r0 = o.theta[0] * o.ifx * scale, r1 = o.theta[1] * o.ify * scale;
  const double r2 = (o.theta[0] * o.mu + o.theta[1] * o.mv + o.theta[2]) * scale;
  for (int k = 0; k < 9; ++k) f->g[k][l] = static_cast<float>(g[k]);
  f->rho[0][l] = static_cast<float>(r0);
  f->rho[1][l] = static_cast<float>(r1);
  f->rho[2][l] = static_cast<float>(r2);
  for (int k = 0; k < 3; ++k) f->t[k][l] = static_cast<float>(t[k] * scale);
  f->u0[l] = static_cast<float>((ox - cx) / fx);
  f->v0[l] = static_cast<float>((oy - cy) / fy);
  f->hu[0][l] = static_cast<float>(o.ifx);
  f->hu[1][l] = static_cast<float>(o.mu);
  f->hv[0][l] = static_cast<float>(o.ify);
  f->hv[1][l] = static_cast<float>(o.mv);
  f->x_low[l] = static_cast<float>(-ox);
  f->y_low[l] = static_cast<float>(-oy);
  f->x_high[l] = static_cast<float>(a.target.width - 1 - ox);
  f->y_high[l] = static_cast<float>(a.target.height - 1 - oy);
  f->base[l] = oy * static_cast<int>(a.target.stride) + ox;
  f->n[l] = 0;
  // NaN and overflow: neither is below the bound.
  double sum = size + batch_abs(r2) + batch_abs(r0) + batch_abs(r1) + 1 / size;
  for (int k = 0; k < 9; ++k) sum += batch_abs(g[k]);
  for (int k = 0; k < 3; ++k) sum += batch_abs(t[k]) * scale;
  if (!(sum < 1e30)) return Status::non_finite;
  // Whole patches behind a camera, or beside the image: what is tested is affine in u and v.
  const double ru = o.ru, rv = o.rv, x0 = -ox - 1e-3, y0 = -oy - 1e-3, x1 = w1 - ox + 1e-3, y1 = h1 - oy + 1e-3;
  if (o.n < 1) return Status::too_few;
  if (!(batch_most(g[6], g[7], g[8], ru, rv) > 0) || !(batch_most(r0, r1, r2, ru, rv) > 0)) return Status::behind_camera;
  if (-batch_most(-g[6], -g[7], -g[8], ru, rv) > 0 && -batch_most(-r0, -r1, -r2, ru, rv) > 0 &&
      (!(batch_most(g[0] - x0 * g[6], g[1] - x0 * g[7], g[2] - x0 * g[8], ru, rv) > 0) ||
       !(batch_most(x1 * g[6] - g[0], x1 * g[7] - g[1], x1 * g[8] - g[2], ru, rv) > 0) ||
       !(batch_most(g[3] - y0 * g[6], g[4] - y0 * g[7], g[5] - y0 * g[8], ru, rv) > 0) ||
       !(batch_most(y1 * g[6] - g[3], y1 * g[7] - g[4], y1 * g[8] - g[5], ru, rv) > 0)))
    return Status::out_of_view;
  f->n[l] = o.n;
  return Status::ok;
}

// Between the loops over a strip of pixels of each lane.
struct BatchStripMemory {
  float x[kBatchStrip][simd::kBatchLanes], y[kBatchStrip][simd::kBatchLanes], inverse[kBatchStrip][simd::kBatchLanes];
  float fx[kBatchStrip][simd::kBatchLanes], fy[kBatchStrip][simd::kBatchLanes];
  std::int32_t offset[kBatchStrip * simd::kBatchLanes];
  std::uint32_t taps[kBatchStrip * simd::kBatchLanes];
};

// Sums over the pixels of each lane.
struct BatchCounts {
  vf visible, behind, target, host;
};

// Warp of `m` pixels of the lanes from pixel `k` on; weights, host intensities and counts.
TEXTPLANE_SIMD_INLINE void batch_warp(const BatchFrame& f, int lane, const float* pixels, int k, int m, int stride,
                                      BatchStripMemory* s, float* scratch, BatchCounts* counts) noexcept {
  const vf g0 = load(f.g[0] + lane), g1 = load(f.g[1] + lane), g2 = load(f.g[2] + lane);
  const vf g3 = load(f.g[3] + lane), g4 = load(f.g[4] + lane), g5 = load(f.g[5] + lane);
  const vf g6 = load(f.g[6] + lane), g7 = load(f.g[7] + lane), g8 = load(f.g[8] + lane);
  const vf r0 = load(f.rho[0] + lane), r1 = load(f.rho[1] + lane), r2 = load(f.rho[2] + lane);
  const vf x_low = load(f.x_low + lane), x_high = load(f.x_high + lane), y_low = load(f.y_low + lane);
  const vf y_high = load(f.y_high + lane), one = set1(1.0F), n = to_float(loadi(f.n + lane));
  const vi base = loadi(f.base + lane), rows = seti(stride);
  for (int i = 0; i < m; ++i) {
    const float* p = pixels + static_cast<std::ptrdiff_t>(k + i) * 3 * kBatchStep + lane;
    const vf u = load(p), v = load(p + kBatchStep);
    const vf divisor = madd(g6, u, madd(g7, v, g8)), inverse = div(one, divisor);
    const vf x = mul(madd(g0, u, madd(g1, v, g2)), inverse), y = mul(madd(g3, u, madd(g4, v, g5)), inverse);
    const vf rho = madd(r0, u, madd(r1, v, r2));
    const vm exists = lt(set1(static_cast<float>(k + i)), n);
    const vm ahead = and_(gt(rho, zero()), gt(divisor, zero()));
    const vm inside = and_(and_(ge(x, x_low), le(x, x_high)), and_(ge(y, y_low), le(y, y_high)));
    const vm seen = and_(and_(exists, ahead), inside);
    // Clamped twice: to a cell of the image whatever the coordinates.
    const vf last = sub(x_high, one), below = sub(y_high, one);
    const vf cx = min_(max_(floor_(x), x_low), last), cy = min_(max_(floor_(y), y_low), below);
    store(s->x[i] + lane, x);
    store(s->y[i] + lane, y);
    store(s->inverse[i] + lane, keep(seen, inverse));
    store(s->fx[i] + lane, keep(seen, sub(x, cx)));
    store(s->fy[i] + lane, keep(seen, sub(y, cy)));
    storei(s->offset + i * kLanes, addi(addi(muli(to_int(cy), rows), to_int(cx)), base));
    const vf weight = keep(seen, one), host = keep(seen, load(p + 2 * kBatchStep));
    float* out = scratch + static_cast<std::ptrdiff_t>(k + i) * kBatchFields * kLanes;
    store(out + kBatchWeight * kLanes, weight);
    store(out + kBatchHost * kLanes, host);
    counts->visible = add(counts->visible, weight);
    counts->behind = add(counts->behind, keep(andnot_(ahead, exists), one));
    counts->host = add(counts->host, host);
  }
}

TEXTPLANE_SIMD_INLINE void batch_taps(const simd::Image8& image, int m, BatchStripMemory* s) noexcept {
  const std::uint8_t *upper = image.data, *lower = image.data + image.stride;
  for (int i = 0; i < m * kLanes; ++i) {
    const std::ptrdiff_t offset = s->offset[i];
    s->taps[i] = two_bytes(upper + offset) | two_bytes(lower + offset) << 16;
  }
}

// Intensities of the strip, and rows of dI for `parameters`: v and omega (6), and theta (9).
TEXTPLANE_SIMD_INLINE void batch_rows(const simd::BatchArgs& a, const BatchFrame& f, int lane, int parameters,
                                      const float* pixels, int k, int m, const BatchStripMemory& s, float* scratch,
                                      BatchCounts* counts) noexcept {
  const vf r0 = load(f.rho[0] + lane), r1 = load(f.rho[1] + lane), r2 = load(f.rho[2] + lane);
  const vf t0 = load(f.t[0] + lane), t1 = load(f.t[1] + lane), t2 = load(f.t[2] + lane);
  const vf u0 = load(f.u0 + lane), v0 = load(f.v0 + lane);
  const vf fx = set1(static_cast<float>(a.camera[0])), fy = set1(static_cast<float>(a.camera[1]));
  const vf ifx = set1(static_cast<float>(1 / a.camera[0])), ify = set1(static_cast<float>(1 / a.camera[1]));
  for (int i = 0; i < m; ++i) {
    float* out = scratch + static_cast<std::ptrdiff_t>(k + i) * kBatchFields * kLanes;
    const taps_t taps = load_taps(s.taps + i * kLanes);
    const vf dx = load(s.fx[i] + lane), dy = load(s.fy[i] + lane), dxy = tap_dxy(taps), along = tap_dx(taps);
    const vf gx = madd(dy, dxy, along), gy = madd(dx, dxy, tap_dy(taps));
    const vf weight = load(out + kBatchWeight * kLanes);
    const vf value = mul(weight, madd(dy, gy, madd(dx, along, tap_value(taps))));
    store(out + kBatchTarget * kLanes, value);
    counts->target = add(counts->target, value);
    if (parameters == 0) continue;

    const float* p = pixels + static_cast<std::ptrdiff_t>(k + i) * 3 * kBatchStep + lane;
    const vf u = load(p), v = load(p + kBatchStep), inverse = load(s.inverse[i] + lane);
    const vm seen = gt(weight, zero());
    const vf tu = keep(seen, madd(load(s.x[i] + lane), ifx, u0)), tv = keep(seen, madd(load(s.y[i] + lane), ify, v0));
    const vf a0 = mul(mul(weight, gx), fx), a1 = mul(mul(weight, gy), fy), a2 = neg(madd(a0, tu, mul(a1, tv)));
    const vf depth = mul(madd(r0, u, madd(r1, v, r2)), inverse);
    store(out, mul(depth, a0));
    store(out + kLanes, mul(depth, a1));
    store(out + 2 * kLanes, mul(depth, a2));
    store(out + 3 * kLanes, sub(mul(tv, a2), a1));
    store(out + 4 * kLanes, nmadd(tu, a2, a0));
    store(out + 5 * kLanes, sub(mul(tu, a1), mul(tv, a0)));
    if (parameters == 6) continue;
    const vf at = mul(madd(a0, t0, madd(a1, t1, mul(a2, t2))), inverse);
    store(out + 6 * kLanes, mul(at, madd(u, load(f.hu[0] + lane), load(f.hu[1] + lane))));
    store(out + 7 * kLanes, mul(at, madd(v, load(f.hv[0] + lane), load(f.hv[1] + lane))));
    store(out + 8 * kLanes, at);
  }
}
