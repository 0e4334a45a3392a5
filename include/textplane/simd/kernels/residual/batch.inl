// Weights, statuses and entry points of simd/batch.hpp. Include before: residual/batch_sums.inl, kernels/robust.inl.

// Scratch: intensities become centred, sums of their squares.
TEXTPLANE_SIMD_INLINE void batch_centre(float* scratch, int n, vf target_mean, vf host_mean, vf* target,
                                        vf* host) noexcept {
  vf t = zero(), h = zero();
  for (int k = 0; k < n; ++k) {
    float* p = scratch + static_cast<std::ptrdiff_t>(k) * kBatchFields * kLanes;
    const vf w = load(p + kBatchWeight * kLanes);
    const vf a = mul(w, sub(load(p + kBatchTarget * kLanes), target_mean));
    const vf b = mul(w, sub(load(p + kBatchHost * kLanes), host_mean));
    store(p + kBatchTarget * kLanes, a);
    store(p + kBatchHost * kLanes, b);
    t = madd(a, a, t);
    h = madd(b, b, h);
  }
  *target = t;
  *host = h;
}

// The host's centred intensities become e = r sqrt(N) times the root of the weight; rows become root (row - mean - i
// c). Costs. `kind`: l2, huber, or cauchy for all that weigh all.
TEXTPLANE_SIMD_INLINE void batch_weigh(float* scratch, int n, int parameters, RobustKind kind, const simd::BatchArgs& a,
                                       vf host_scale, vf target_scale, const vf* mean, const vf* along, vf* cost,
                                       vf* error) noexcept {
  const bool huber = kind == RobustKind::huber, all = kind == RobustKind::cauchy;
  const RobustVectors robust =
      all ? broadcast_robust(a.robust, a.delta) : RobustVectors{zero(), zero(), RobustKind::l2};
  const vf limit = set1(huber ? static_cast<float>(a.delta) : 0.0F), root_limit = sqrt_(limit);
  vf c = zero(), s = zero();
  for (int k = 0; k < n; ++k) {
    float* p = scratch + static_cast<std::ptrdiff_t>(k) * kBatchFields * kLanes;
    const vf i = hold(load(p + kBatchTarget * kLanes)),
             e = nmadd(i, target_scale, mul(load(p + kBatchHost * kLanes), host_scale));
    vf root = load(p + kBatchWeight * kLanes);
    s = madd(e, e, s);
    if (huber) {
      const vf size = abs_(e), m = min_(size, limit);
      c = madd(m, add(size, sub(size, m)), c);
      root = select(gt(size, limit), mul(root_limit, inverse_root(max_(size, limit))), root);
    } else if (all) {
      vf rho, weight;
      robust_vector(robust, mul(e, e), &rho, &weight);
      c = add(c, rho);
      root = mul(root, weight);
    }
    if (parameters == 0) continue;
    store(p + kBatchHost * kLanes, huber || all ? mul(root, e) : e);
    for (int j = 0; j < parameters; j += 3) {
      float* row = p + j * kLanes;
      store(row, mul(root, nmadd(i, along[j], sub(load(row), mean[j]))));
      store(row + kLanes, mul(root, nmadd(i, along[j + 1], sub(load(row + kLanes), mean[j + 1]))));
      store(row + 2 * kLanes, mul(root, nmadd(i, along[j + 2], sub(load(row + 2 * kLanes), mean[j + 2]))));
    }
  }
  *cost = huber || all ? c : s;
  *error = s;
}

// Not inline: one copy for all numbers of parameters.
TEXTPLANE_SIMD_ENTRY void batch_weigh_all(const simd::BatchArgs& a, int n, int parameters, const vf* scales,
                                          const vf* mean, const vf* along, vf* cost, vf* error) noexcept {
  batch_weigh(a.scratch, n, parameters, RobustKind::cauchy, a, scales[0], scales[1], mean, along, cost, error);
}

// Samples all pixels of a vector of objects, strip by strip.
TEXTPLANE_SIMD_INLINE void batch_strips(const simd::BatchArgs& a, const BatchFrame& f, int lane, bool whole,
                                        int parameters, const float* pixels, int n, BatchStripMemory* strip,
                                        BatchCounts* counts) noexcept {
  const int stride = static_cast<int>(a.target.stride);
  for (int k = 0; k < n; k += kBatchStrip) {
    const int m = n - k < kBatchStrip ? n - k : kBatchStrip;
    if (whole)
      batch_warp(f, lane, true, pixels, k, m, stride, strip, a.scratch, counts);
    else
      batch_warp(f, lane, false, pixels, k, m, stride, strip, a.scratch, counts);
    fetch_rows(a.target.data, a.target.stride, strip->offset, m * kLanes, strip->taps);
    if (whole)
      batch_rows(a, f, lane, true, parameters, pixels, k, m, *strip, a.scratch, counts);
    else
      batch_rows(a, f, lane, false, parameters, pixels, k, m, *strip, a.scratch, counts);
  }
}

// Statuses of the lanes from their counts and sums. Returns the lanes that have a result.
TEXTPLANE_SIMD_INLINE unsigned batch_judge(const simd::BatchArgs& a, const BatchFrame& f, int lane, int lanes,
                                           bool whole, const BatchCounts& counts, vf target, vf host, vf target_s,
                                           vf host_s, vf target_mean, vf host_mean, vf root, unsigned all_lanes,
                                           Status* status) noexcept {
  // What rounding leaves of a constant side is no contrast either.
  const vf least = mul(root, set1(static_cast<float>(a.min_contrast > 0 ? a.min_contrast : 0))), floor = set1(1e-6F),
           one = set1(1.0F);
  const vm contrast = and_(and_(gt(target_s, least), gt(target_s, mul(root, mul(floor, abs_(target_mean))))),
                           and_(gt(host_s, least), gt(host_s, mul(root, mul(floor, abs_(host_mean))))));
  const vm enough = and_(ge(counts.visible, set1(static_cast<float>(a.min_visible))), ge(counts.visible, one));
  const vm finite = lt(add(target, host), set1(3e38F));
  const unsigned good = bits_from_mask(and_(and_(contrast, enough), finite)), many = bits_from_mask(enough),
                 sane = bits_from_mask(finite);
  const unsigned none = bits_from_mask(lt(counts.visible, one));
  const unsigned behind = bits_from_mask(ge(counts.behind, to_float(loadi(f.n + lane))));
  const bool easy = whole && (good & many) == all_lanes;
  unsigned keep_lanes = easy ? all_lanes : 0;
  for (int l = 0; l < lanes && !easy; ++l) {
    if (status[l] != Status::ok) continue;
    const unsigned bit = 1U << l;
    if (!(many & bit))
      status[l] = !(none & bit) ? Status::too_few : behind & bit ? Status::behind_camera : Status::out_of_view;
    else if (!(sane & bit))
      status[l] = Status::non_finite;
    else if (!(good & bit))
      status[l] = Status::no_contrast;
    else
      keep_lanes |= bit;
  }
  return keep_lanes;
}

// H and b from the weighted rows. Returns the lanes where they are finite.
TEXTPLANE_SIMD_INLINE unsigned batch_products(const float* scratch, int n, int parameters, vf target_s, vf root,
                                              float* out) noexcept {
  const vf inverse_s = div(set1(1.0F), max_(target_s, set1(1e-30F))), scale = mul(inverse_s, inverse_s);
  const vf scale_b = neg(div(inverse_s, max_(root, set1(1.0F))));
  // Not a loop: with constants for rows, where things lie is known when this is compiled.
  vf all = batch_square(scratch, n, parameters, 0, scale, scale_b, out);
  all = add(all, batch_square(scratch, n, parameters, 3, scale, scale_b, out));
  batch_cross(scratch, n, parameters, 0, 3, scale, out);
  if (parameters > 6) {
    all = add(all, batch_square(scratch, n, parameters, 6, scale, scale_b, out));
    batch_cross(scratch, n, parameters, 0, 6, scale, out);
    batch_cross(scratch, n, parameters, 3, 6, scale, out);
  }
  return bits_from_mask(lt(abs_(all), set1(3e38F)));
}

// One vector of objects, of which the first `lanes` exist. Statuses that are ok on entry are those of lanes with
// pixels.
TEXTPLANE_SIMD_INLINE void batch_vector(const simd::BatchArgs& a, const BatchFrame& f, int lane, int parameters,
                                        const float* pixels, int n, Status* status, int lanes, float* out) noexcept {
  BatchStripMemory strip;
  BatchCounts counts = {zero(), zero(), zero(), zero()};
  bool whole = true;
  for (int l = lane; l < lane + kLanes; ++l) whole = whole && f.whole[l] && f.n[l] == n;
  batch_strips(a, f, lane, whole, parameters, pixels, n, &strip, &counts);
  const vf one = set1(1.0F), inverse_n = div(one, max_(counts.visible, one)), root = sqrt_(counts.visible);
  const vf target_mean = mul(counts.target, inverse_n), host_mean = mul(counts.host, inverse_n);
  vf target, host, cost, error;
  batch_centre(a.scratch, n, target_mean, host_mean, &target, &host);
  const vf tiny = set1(1e-30F), target_s = sqrt_(target), host_s = sqrt_(host);
  const vf target_scale = div(root, max_(target_s, tiny)), host_scale = div(root, max_(host_s, tiny));

  const unsigned all_lanes = 1U << (kLanes - 1) | ((1U << (kLanes - 1)) - 1U);
  unsigned keep_lanes = batch_judge(a, f, lane, lanes, whole, counts, target, host, target_s, host_s, target_mean,
                                    host_mean, root, all_lanes, status);

  const int head = parameters * (parameters + 1) / 2 + parameters;
  if (keep_lanes != 0) {
    vf e[9], c[9];
    if (parameters > 0) {
      batch_means(a.scratch, n, 0, e, c);
      batch_means(a.scratch, n, 3, e, c);
      if (parameters > 6) batch_means(a.scratch, n, 6, e, c);
      const vf square = div(one, max_(target, tiny));
      for (int j = 0; j < parameters; ++j) {
        e[j] = a.exact ? mul(e[j], inverse_n) : zero();
        c[j] = a.exact ? mul(c[j], square) : zero();
      }
    }
    const vf scales[2] = {host_scale, target_scale};
    if (a.robust == RobustKind::huber)
      batch_weigh(a.scratch, n, parameters, RobustKind::huber, a, host_scale, target_scale, e, c, &cost, &error);
    else if (weighs_all(a.robust))
      batch_weigh_all(a, n, parameters, scales, parameters > 0 ? e : nullptr, parameters > 0 ? c : nullptr, &cost,
                      &error);
    else
      batch_weigh(a.scratch, n, parameters, RobustKind::l2, a, host_scale, target_scale, e, c, &cost, &error);
    if (parameters > 0) {
      const unsigned finite = batch_products(a.scratch, n, parameters, target_s, root, out);
      for (int l = 0; (keep_lanes & ~finite) != 0 && l < lanes; ++l)
        if (keep_lanes & ~finite & 1U << l) status[l] = Status::non_finite;
      keep_lanes &= finite;
    }
    float* tail = out + head * kBatchStep;
    batch_put(tail, static_cast<int>(simd::BatchEntry::cost), mul(cost, inverse_n));
    batch_put(tail, static_cast<int>(simd::BatchEntry::error), mul(error, inverse_n));
    batch_put(tail, static_cast<int>(simd::BatchEntry::mean), target_mean);
    batch_put(tail, static_cast<int>(simd::BatchEntry::s), target_s);
  }
  const int visible = head + static_cast<int>(simd::BatchEntry::visible);
  batch_put(out, visible, counts.visible);
  if (keep_lanes != all_lanes)
    for (int l = 0; l < kLanes; ++l)
      if (!(keep_lanes >> l & 1U))
        for (int entry = 0; entry < visible; ++entry) out[entry * kBatchStep + l] = 0.0F;
}

TEXTPLANE_SIMD_INLINE void batch_any(const simd::BatchArgs& a, int parameters) noexcept {
  const int entries = simd::batch_entries(parameters);
  for (int group = 0, first = 0; first < a.count; ++group, first += kBatchStep) {
    const int members = a.count - first < kBatchStep ? a.count - first : static_cast<int>(kBatchStep);
    float* out = a.out + static_cast<std::ptrdiff_t>(group) * entries * kBatchStep;
    BatchFrame frame;
    batch_group(a, a.groups[group], first, members, &frame);
    for (int lane = 0; lane < kBatchStep; lane += kLanes) {
      int n = 0;
      for (int l = lane; l < lane + kLanes; ++l) n = frame.n[l] > n ? frame.n[l] : n;
      const int lanes = members - lane < kLanes ? members - lane : static_cast<int>(kLanes);
      if (n == 0) {
        for (int entry = 0; entry < entries; ++entry) batch_put(out + lane, entry, zero());
        continue;
      }
      batch_vector(a, frame, lane, parameters, a.pixels + a.groups[group].start, n, a.status + first + lane, lanes,
                   out + lane);
    }
  }
}

TEXTPLANE_SIMD_ENTRY void batch_evaluate(const simd::BatchArgs& a) noexcept { batch_any(a, 0); }
TEXTPLANE_SIMD_ENTRY void batch_linearise_pose(const simd::BatchArgs& a) noexcept { batch_any(a, 6); }
TEXTPLANE_SIMD_ENTRY void batch_linearise_pose_plane(const simd::BatchArgs& a) noexcept { batch_any(a, 9); }
