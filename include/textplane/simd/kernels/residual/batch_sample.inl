// Geometry and sampling of simd/batch.hpp: one object a lane. Include before: kernels/sample.inl.

enum : int { kBatchStep = simd::kBatchLanes, kBatchFields = 12, kBatchStrip = 16 };

// Where things lie in the scratch of one pixel, in vectors: rows of dI, then the rest. Weight: 1 where visible.
enum : int { kBatchRow = 0, kBatchTarget = 9, kBatchHost = 10, kBatchWeight = 11 };

// The most that f0 u + f1 v + f2 reaches for |u| <= ru, |v| <= rv.
TEXTPLANE_SIMD_INLINE vp batch_most(vp f0, vp f1, vp f2, vp ru, vp rv) noexcept {
  return madd_p(abs_p(f0), ru, madd_p(abs_p(f1), rv, f2));
}

// What decides about a lane before its pixels are looked at. `size` is below 1e30 for finite input; the others are the
// most and the least that the depths reach, and the most of the distances from the image's borders, times the depth.
// `whole` is positive where, for finite input, all pixels are certainly visible.
struct BatchVerdict {
  double size[simd::kBatchLanes], most[simd::kBatchLanes], least[simd::kBatchLanes], inside[simd::kBatchLanes],
      whole[simd::kBatchLanes];
};

// What the corners of kDoubles patches say of depths and of the image's borders.
TEXTPLANE_SIMD_INLINE void batch_borders(const vp* g, vp r0, vp r1, vp r2, vp ox, vp oy, vp w1, vp h1, vp ru, vp rv,
                                         int l, BatchVerdict* verdict) noexcept {
  // What is tested is affine in u and v.
  const vp margin = set_p(1e-3), x0 = add_p(ox, margin), y0 = add_p(oy, margin);
  const vp x1 = add_p(sub_p(w1, ox), margin), y1 = add_p(sub_p(h1, oy), margin);
  const vp left2 = madd_p(x0, g[8], g[2]), upper2 = madd_p(y0, g[8], g[5]);
  const vp right2 = sub_p(mul_p(x1, g[8]), g[2]), lower2 = sub_p(mul_p(y1, g[8]), g[5]);
  const vp left = batch_most(madd_p(x0, g[6], g[0]), madd_p(x0, g[7], g[1]), left2, ru, rv);
  const vp upper = batch_most(madd_p(y0, g[6], g[3]), madd_p(y0, g[7], g[4]), upper2, ru, rv);
  const vp right = batch_most(sub_p(mul_p(x1, g[6]), g[0]), sub_p(mul_p(x1, g[7]), g[1]), right2, ru, rv);
  const vp lower = batch_most(sub_p(mul_p(y1, g[6]), g[3]), sub_p(mul_p(y1, g[7]), g[4]), lower2, ru, rv);
  const vp front = batch_most(g[6], g[7], g[8], ru, rv), front_h = batch_most(r0, r1, r2, ru, rv);
  const vp back = batch_most(sub_p(set_p(0.0), g[6]), g[7], sub_p(set_p(0.0), g[8]), ru, rv);
  const vp back_h = batch_most(sub_p(set_p(0.0), r0), r1, sub_p(set_p(0.0), r2), ru, rv);
  store_p(verdict->most + l, min_p(front, front_h));
  const vp least = sub_p(set_p(0.0), max_p(back, back_h));
  store_p(verdict->least + l, least);
  store_p(verdict->inside + l, min_p(min_p(left, right), min_p(upper, lower)));
  // The least is as far below the middle as the most is above; the margin counts the other way now.
  const vp across = min_p(sub_p(add_p(left2, left2), left), sub_p(add_p(right2, right2), right));
  const vp down = min_p(sub_p(add_p(upper2, upper2), upper), sub_p(add_p(lower2, lower2), lower));
  store_p(verdict->whole + l, min_p(sub_p(min_p(across, down), mul_p(add_p(margin, margin), front)), least));
}

// kDoubles lanes of the frame from `l` on. `pose`: R of each lane, column by column, t a.t_offset numbers from there
// on.
TEXTPLANE_SIMD_INLINE void batch_lanes(const simd::BatchArgs& a, const simd::BatchGroup& o, const double* const* pose,
                                       int l, BatchFrame* f, BatchVerdict* verdict) noexcept {
  const vp fx = set_p(a.camera[0]), fy = set_p(a.camera[1]), cx = set_p(a.camera[2]), cy = set_p(a.camera[3]);
  const vp one = set_p(1.0), none = set_p(0.0), ifx = load_p(o.ifx + l), ify = load_p(o.ify + l), mu = load_p(o.mu + l),
           mv = load_p(o.mv + l);
  const vp p0 = load_p(o.theta[0] + l), p1 = load_p(o.theta[1] + l), p2 = load_p(o.theta[2] + l);
  const vp ru = load_p(o.ru + l), rv = load_p(o.rv + l);
  vp S[3][3], t[3];
  for (int r = 0; r < 3; ++r) {
    t[r] = from_p(pose + l, a.t_offset + r);
    const vp h0 = madd_p(t[r], p0, from_p(pose + l, r)), h1 = madd_p(t[r], p1, from_p(pose + l, 3 + r));
    S[r][0] = mul_p(h0, ifx);
    S[r][1] = mul_p(h1, ify);
    S[r][2] = madd_p(h0, mu, madd_p(h1, mv, madd_p(t[r], p2, from_p(pose + l, 6 + r))));
  }
  const vp z = S[2][2], size = madd_p(set_p(50.0), add_p(abs_p(S[2][0]), abs_p(S[2][1])), abs_p(z)),
           scale = div_p(one, size);
  const vp inverse = positive_p(z, div_p(one, z), none);
  const vp w1 = set_p(a.target.width - 1), h1 = set_p(a.target.height - 1);
  // The origin; in this order a NaN becomes 0.
  const vp ox = trunc_p(min_p(max_p(madd_p(mul_p(fx, S[0][2]), inverse, cx), none), w1));
  const vp oy = trunc_p(min_p(max_p(madd_p(mul_p(fy, S[1][2]), inverse, cy), none), h1));
  const vp du = sub_p(cx, ox), dv = sub_p(cy, oy);
  vp g[9];
  for (int k = 0; k < 3; ++k) {
    g[k] = mul_p(madd_p(fx, S[0][k], mul_p(du, S[2][k])), scale);
    g[3 + k] = mul_p(madd_p(fy, S[1][k], mul_p(dv, S[2][k])), scale);
    g[6 + k] = mul_p(S[2][k], scale);
  }
  const vp r0 = mul_p(mul_p(p0, ifx), scale), r1 = mul_p(mul_p(p1, ify), scale),
           r2 = mul_p(madd_p(p0, mu, madd_p(p1, mv, p2)), scale);
  vp sum = add_p(add_p(size, div_p(one, size)), add_p(abs_p(r0), add_p(abs_p(r1), abs_p(r2))));
  for (int k = 0; k < 9; ++k) {
    store_as_float(f->g[k] + l, g[k]);
    sum = add_p(sum, abs_p(g[k]));
  }
  for (int k = 0; k < 3; ++k) {
    store_as_float(f->t[k] + l, mul_p(t[k], scale));
    sum = madd_p(abs_p(t[k]), scale, sum);
  }
  store_as_float(f->rho[0] + l, r0);
  store_as_float(f->rho[1] + l, r1);
  store_as_float(f->rho[2] + l, r2);
  store_as_float(f->u0 + l, div_p(sub_p(none, du), fx));
  store_as_float(f->v0 + l, div_p(sub_p(none, dv), fy));
  store_as_float(f->hu[0] + l, ifx);
  store_as_float(f->hu[1] + l, mu);
  store_as_float(f->hv[0] + l, ify);
  store_as_float(f->hv[1] + l, mv);
  store_as_float(f->x_low + l, sub_p(none, ox));
  store_as_float(f->y_low + l, sub_p(none, oy));
  store_as_float(f->x_high + l, sub_p(w1, ox));
  store_as_float(f->y_high + l, sub_p(h1, oy));
  store_p(verdict->size + l, sum);
  batch_borders(g, r0, r1, r2, ox, oy, w1, h1, ru, rv, l, verdict);
}

// The frame of a group, and what is known of its objects already. A status that is not ok: its pixels need not be
// looked at.
TEXTPLANE_SIMD_INLINE void batch_group(const simd::BatchArgs& a, const simd::BatchGroup& o, int first, int members,
                                       BatchFrame* f) noexcept {
  const double* pose[simd::kBatchLanes];
  for (int l = 0; l < simd::kBatchLanes; ++l) pose[l] = a.pose + (first + (l < members ? l : 0)) * a.pose_step;
  BatchVerdict verdict;
  for (int l = 0; l < simd::kBatchLanes; l += kDoubles) batch_lanes(a, o, pose, l, f, &verdict);
  for (int l = 0; l < simd::kBatchLanes; ++l) {
    f->whole[l] = verdict.whole[l] > 0 && verdict.size[l] < 1e30;
    f->n[l] = l < members && f->whole[l] ? o.n[l] : 0;
    Status status = Status::ok;
    if (f->n[l] > 0) {
      a.status[first + l] = status;
      continue;
    }
    if (l >= members) continue;
    if (!(verdict.size[l] < 1e30))
      status = Status::non_finite;
    else if (o.n[l] < 1)
      status = Status::too_few;
    else if (!(verdict.most[l] > 0))
      status = Status::behind_camera;
    else if (verdict.least[l] > 0 && !(verdict.inside[l] > 0))
      status = Status::out_of_view;
    else
      f->n[l] = o.n[l];
    a.status[first + l] = status;
  }
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

// Warp of `m` pixels of the lanes from pixel `k` on; weights, host intensities and counts. `whole`: all of them are
// visible.
TEXTPLANE_SIMD_INLINE void batch_warp(const BatchFrame& f, int lane, bool whole, const float* pixels, int k, int m,
                                      int stride, BatchStripMemory* s, float* scratch, BatchCounts* counts) noexcept {
  const vf g0 = load(f.g[0] + lane), g1 = load(f.g[1] + lane), g2 = load(f.g[2] + lane);
  const vf g3 = load(f.g[3] + lane), g4 = load(f.g[4] + lane), g5 = load(f.g[5] + lane);
  const vf g6 = load(f.g[6] + lane), g7 = load(f.g[7] + lane), g8 = load(f.g[8] + lane);
  const vf r0 = load(f.rho[0] + lane), r1 = load(f.rho[1] + lane), r2 = load(f.rho[2] + lane);
  const vf x_low = load(f.x_low + lane), x_high = load(f.x_high + lane), y_low = load(f.y_low + lane);
  const vf y_high = load(f.y_high + lane), one = set1(1.0F), n = to_float(loadi(f.n + lane));
  const vi rows = seti(stride), base = addi(muli(to_int(y_low), rows), to_int(x_low));  // both are exact
  for (int i = 0; i < m; ++i) {
    const float* p = pixels + static_cast<std::ptrdiff_t>(k + i) * 3 * kBatchStep + lane;
    const vf u = load(p), v = load(p + kBatchStep);
    const vf divisor = madd(g6, u, madd(g7, v, g8)), inverse = div(one, divisor);
    const vf x = mul(madd(g0, u, madd(g1, v, g2)), inverse), y = mul(madd(g3, u, madd(g4, v, g5)), inverse);
    float* out = scratch + static_cast<std::ptrdiff_t>(k + i) * kBatchFields * kLanes;
    store(s->x[i] + lane, x);
    store(s->y[i] + lane, y);
    // Clamped twice: to a cell of the image whatever the coordinates.
    const vf last = sub(x_high, one), below = sub(y_high, one);
    const vf cx = min_(max_(floor_(x), x_low), last), cy = min_(max_(floor_(y), y_low), below);
    storei(s->offset + i * kLanes, subi(addi(muli(to_int(cy), rows), to_int(cx)), base));
    if (whole) {
      const vf host = load(p + 2 * kBatchStep);
      store(s->inverse[i] + lane, inverse);
      store(s->fx[i] + lane, sub(x, cx));
      store(s->fy[i] + lane, sub(y, cy));
      store(out + kBatchHost * kLanes, host);
      counts->host = add(counts->host, host);
      continue;
    }
    const vf rho = madd(r0, u, madd(r1, v, r2));
    const vm exists = lt(set1(static_cast<float>(k + i)), n);
    const vm ahead = and_(gt(rho, zero()), gt(divisor, zero()));
    const vm inside = and_(and_(ge(x, x_low), le(x, x_high)), and_(ge(y, y_low), le(y, y_high)));
    const vm seen = and_(and_(exists, ahead), inside);
    store(s->inverse[i] + lane, keep(seen, inverse));
    store(s->fx[i] + lane, keep(seen, sub(x, cx)));
    store(s->fy[i] + lane, keep(seen, sub(y, cy)));
    const vf weight = keep(seen, one), host = keep(seen, load(p + 2 * kBatchStep));
    store(out + kBatchWeight * kLanes, weight);
    store(out + kBatchHost * kLanes, host);
    counts->visible = add(counts->visible, weight);
    counts->behind = add(counts->behind, keep(andnot_(ahead, exists), one));
    counts->host = add(counts->host, host);
  }
  if (whole) counts->visible = add(counts->visible, set1(static_cast<float>(m)));
}

// Intensities of the strip, and rows of dI for `parameters`: v and omega (6), and theta (9).
TEXTPLANE_SIMD_INLINE void batch_rows(const simd::BatchArgs& a, const BatchFrame& f, int lane, bool whole,
                                      int parameters, const float* pixels, int k, int m, const BatchStripMemory& s,
                                      float* scratch, BatchCounts* counts) noexcept {
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
    const vf weight = whole ? set1(1.0F) : load(out + kBatchWeight * kLanes),
             here = madd(dy, gy, madd(dx, along, tap_value(taps)));
    const vf value = whole ? here : mul(weight, here);
    if (whole) store(out + kBatchWeight * kLanes, weight);
    store(out + kBatchTarget * kLanes, value);
    counts->target = add(counts->target, value);
    if (parameters == 0) continue;

    const float* p = pixels + static_cast<std::ptrdiff_t>(k + i) * 3 * kBatchStep + lane;
    const vf u = load(p), v = load(p + kBatchStep), inverse = load(s.inverse[i] + lane);
    vf tu = madd(load(s.x[i] + lane), ifx, u0), tv = madd(load(s.y[i] + lane), ify, v0);
    if (!whole) {
      const vm seen = gt(weight, zero());
      tu = keep(seen, tu);
      tv = keep(seen, tv);
    }
    const vf a0 = mul(whole ? gx : mul(weight, gx), fx), a1 = mul(whole ? gy : mul(weight, gy), fy);
    const vf a2 = neg(madd(a0, tu, mul(a1, tv)));
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
