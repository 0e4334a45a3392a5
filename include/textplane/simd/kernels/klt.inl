// KLT: a strip of k16Lanes columns goes down the rows of a patch; the row below of one step is the row above of the
// next. Include before: the operations.
//
// mix_pairs() interpolates along x exactly, in 1/64 grey level; mul15() along y, rounded to 1/64; halving leaves
// 1/32, so |v| <= 4096. A lane of a sum takes at most 2 products of each row of each strip: 2 * 21 * 3 * 2^24 < 2^31.

constexpr int kKltCopyStride = 48;  // bytes; at least kPairsReach from the last strip of a row on

// `window` with room to read whole strips: itself, or a copy in `copy`, kKltCopyStride (kKltSide + 3) bytes.
TEXTPLANE_SIMD_INLINE simd::KltWindow klt_roomy(const simd::KltWindow& window, std::uint8_t* copy) noexcept {
  const int strips = (window.columns + k16Lanes - 1) / k16Lanes;
  if ((strips - 1) * k16Lanes + kPairsReach <= window.readable) return window;
  for (int y = 0; y <= window.rows; ++y) {
    const std::uint8_t* from = window.data + y * window.stride;
    std::uint8_t* to = copy + y * kKltCopyStride;
    for (int x = 0; x <= window.columns; ++x) to[x] = from[x];
    for (int x = window.columns + 1; x < kKltCopyStride; ++x) to[x] = 0;
  }
  return simd::KltWindow{copy, kKltCopyStride, kKltCopyStride, window.columns, window.rows, window.fx, window.fy};
}

// Between the interpolated rows `above` and `below`, in 1/32 grey level; minus_fy: -fy / 64 in units of 2^-15.
TEXTPLANE_SIMD_INLINE v16 klt_between(v16 above, v16 below, v16 minus_fy) noexcept {
  return half16(add16(above, mul15(sub16(above, below), minus_fy)));
}

// The inner samples of `padded`, their gradients and the sums over them.
TEXTPLANE_SIMD_INLINE simd::KltPatchSums klt_gradients(const std::int16_t* padded, int columns, int rows,
                                                       simd::KltPatch& patch) noexcept {
  const v16 one = set16(1);
  vw v_sum{}, vv{}, x_sum{}, y_sum{}, vx{}, vy{}, xx{}, xy{}, yy{};
  for (int first = 0; first < columns; first += k16Lanes) {
    const v16 mask = first16(columns - first);
    for (int y = 0; y < rows; ++y) {
      const std::int16_t* row = padded + (y + 1) * simd::kKltStride + first;
      const int at = y * simd::kKltStride + first;
      const v16 v = and16(load16(row + 1), mask);
      const v16 x = and16(half16(sub16(load16(row + 2), load16(row))), mask);
      const v16 down = sub16(load16(row + 1 + simd::kKltStride), load16(row + 1 - simd::kKltStride));
      const v16 g = and16(half16(down), mask);
      store16(patch.value + at, v);
      store16(patch.gx + at, x);
      store16(patch.gy + at, g);
      v_sum = add_dot16(v_sum, v, one);
      vv = add_dot16(vv, v, v);
      x_sum = add_dot16(x_sum, x, one);
      y_sum = add_dot16(y_sum, g, one);
      vx = add_dot16(vx, v, x);
      vy = add_dot16(vy, v, g);
      xx = add_dot16(xx, x, x);
      xy = add_dot16(xy, x, g);
      yy = add_dot16(yy, g, g);
    }
  }
  return simd::KltPatchSums{sumw(v_sum), sumw(vv), sumw(x_sum), sumw(y_sum), sumw(vx),
                            sumw(vy),    sumw(xx), sumw(xy),    sumw(yy)};
}

TEXTPLANE_SIMD_ENTRY simd::KltPatchSums klt_from_grey(const float* padded, int columns, int rows,
                                                      simd::KltPatch& patch) noexcept {
  std::int16_t samples[simd::kKltPadded];
  const int used = (rows + 2) * simd::kKltStride + simd::kKltSlack;
  for (int i = 0; i < used; i += k16Lanes) store16(samples + i, grey_to_fixed(padded + i));
  return klt_gradients(samples, columns, rows, patch);
}

TEXTPLANE_SIMD_ENTRY simd::KltPatchSums klt_extract(const simd::KltWindow& window, simd::KltPatch& patch) noexcept {
  std::uint8_t copy[kKltCopyStride * (simd::kKltSide + 3)];
  std::int16_t padded[simd::kKltPadded];
  const simd::KltWindow w = klt_roomy(window, copy);
  const v16 weights = pair_weights(simd::kKltSubpixels - w.fx, w.fx), minus_fy = set16(-512 * w.fy), none = set16(0);
  for (int first = 0; first < simd::kKltStride; first += k16Lanes) {
    std::int16_t* out = padded + first;
    if (first >= w.columns) {  // the gradients read these, and leave them out
      for (int y = 0; y < w.rows; ++y) store16(out + y * simd::kKltStride, none);
      continue;
    }
    const std::uint8_t* p = w.data + first;
    v16 above = mix_pairs(p, weights);
    for (int y = 0; y < w.rows; ++y) {
      p += w.stride;
      const v16 below = mix_pairs(p, weights);
      store16(out + y * simd::kKltStride, klt_between(above, below, minus_fy));
      above = below;
    }
  }
  for (int i = w.rows * simd::kKltStride; i < w.rows * simd::kKltStride + simd::kKltSlack; i += k16Lanes)
    store16(padded + i, none);
  return klt_gradients(padded, w.columns - 2, w.rows - 2, patch);
}

TEXTPLANE_SIMD_ENTRY simd::KltSums klt_sums(const simd::KltWindow& window, const simd::KltPatch& patch) noexcept {
  std::uint8_t copy[kKltCopyStride * (simd::kKltSide + 3)];
  const simd::KltWindow w = klt_roomy(window, copy);
  const v16 minus_fy = set16(-512 * w.fy), one = set16(1);
  vw v_sum{}, vv{}, tv{}, xv{}, yv{};
  for (int first = 0; first < w.columns; first += k16Lanes) {
    // Without weight, the samples past the last column are 0.
    const v16 weights = and16(pair_weights(simd::kKltSubpixels - w.fx, w.fx), first16(w.columns - first));
    const std::uint8_t* p = w.data + first;
    v16 above = mix_pairs(p, weights);
    for (int y = 0; y < w.rows; ++y) {
      p += w.stride;
      const v16 below = mix_pairs(p, weights);
      const v16 v = klt_between(above, below, minus_fy);
      above = below;
      const int at = y * simd::kKltStride + first;
      v_sum = add_dot16(v_sum, v, one);
      vv = add_dot16(vv, v, v);
      tv = add_dot16(tv, v, load16(patch.value + at));
      xv = add_dot16(xv, v, load16(patch.gx + at));
      yv = add_dot16(yv, v, load16(patch.gy + at));
    }
  }
  return simd::KltSums{sumw(v_sum), sumw(vv), sumw(tv), sumw(xv), sumw(yv)};
}
