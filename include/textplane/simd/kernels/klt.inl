// KLT: a strip of kShorts columns goes down the rows of a patch; the row below of one step is the row above of the
// next. Include before: the operations.
//
// mix_pairs() interpolates along x exactly, in 1/64 grey level; mulhrsh() along y, rounded to 1/64; halving leaves
// 1/32, so |v| <= 4096. A lane of a sum takes at most 2 products of each row of each strip: 2 * 21 * 3 * 2^24 < 2^31.

constexpr int kKltCopyStride = 48;  // bytes; at least kPairsReach from the last strip of a row on

// `window` with room to read whole strips: itself, or a copy in `copy`, kKltCopyStride (kKltSide + 3) bytes.
TEXTPLANE_SIMD_INLINE simd::KltWindow klt_roomy(const simd::KltWindow& window, std::uint8_t* copy) noexcept {
  const int strips = (window.columns + kShorts - 1) / kShorts;
  if ((strips - 1) * kShorts + kPairsReach <= window.readable) return window;
  for (int y = 0; y <= window.rows; ++y) {
    const std::uint8_t* from = window.data + y * window.stride;
    std::uint8_t* to = copy + y * kKltCopyStride;
    for (int x = 0; x <= window.columns; ++x) to[x] = from[x];
    for (int x = window.columns + 1; x < kKltCopyStride; ++x) to[x] = 0;
  }
  return simd::KltWindow{copy, kKltCopyStride, kKltCopyStride, window.columns, window.rows, window.fx, window.fy};
}

// Between the interpolated rows `above` and `below`, in 1/32 grey level; minus_fy: -fy / 64 in units of 2^-15.
TEXTPLANE_SIMD_INLINE vh klt_between(vh above, vh below, vh minus_fy) noexcept {
  return halfh(addh(above, mulhrsh(subh(above, below), minus_fy)));
}

// The inner samples of `padded`, their gradients and the sums over them.
TEXTPLANE_SIMD_INLINE simd::KltPatchSums klt_gradients(const std::int16_t* padded, int columns, int rows,
                                                       simd::KltPatch& patch) noexcept {
  const vh one = seth(1);
  vw v_sum = zerow(), vv = zerow(), x_sum = zerow(), y_sum = zerow(), vx = zerow(), vy = zerow(), xx = zerow(),
     xy = zerow(), yy = zerow();
  for (int first = 0; first < columns; first += kShorts) {
    const vh mask = firsth(columns - first);
    for (int y = 0; y < rows; ++y) {
      const std::int16_t* row = padded + (y + 1) * simd::kKltStride + first;
      const int at = y * simd::kKltStride + first;
      const vh v = andh(loadh(row + 1), mask);
      const vh x = andh(halfh(subh(loadh(row + 2), loadh(row))), mask);
      const vh down = subh(loadh(row + 1 + simd::kKltStride), loadh(row + 1 - simd::kKltStride));
      const vh g = andh(halfh(down), mask);
      storeh(patch.value + at, v);
      storeh(patch.gx + at, x);
      storeh(patch.gy + at, g);
      v_sum = dotw(v_sum, v, one);
      vv = dotw(vv, v, v);
      x_sum = dotw(x_sum, x, one);
      y_sum = dotw(y_sum, g, one);
      vx = dotw(vx, v, x);
      vy = dotw(vy, v, g);
      xx = dotw(xx, x, x);
      xy = dotw(xy, x, g);
      yy = dotw(yy, g, g);
    }
  }
  return simd::KltPatchSums{sumw(v_sum), sumw(vv), sumw(x_sum), sumw(y_sum), sumw(vx),
                            sumw(vy),    sumw(xx), sumw(xy),    sumw(yy)};
}

TEXTPLANE_SIMD_ENTRY simd::KltPatchSums klt_from_grey(const float* padded, int columns, int rows,
                                                      simd::KltPatch& patch) noexcept {
  std::int16_t samples[simd::kKltPadded];
  const int used = (rows + 2) * simd::kKltStride + 16;
  for (int i = 0; i < used; i += kShorts) storeh(samples + i, grey_to_fixed(padded + i));
  return klt_gradients(samples, columns, rows, patch);
}

TEXTPLANE_SIMD_ENTRY simd::KltPatchSums klt_extract(const simd::KltWindow& window, simd::KltPatch& patch) noexcept {
  std::uint8_t copy[kKltCopyStride * (simd::kKltSide + 3)];
  std::int16_t padded[simd::kKltPadded];
  const simd::KltWindow w = klt_roomy(window, copy);
  const vh weights = pair_weights(simd::kKltSubpixels - w.fx, w.fx), minus_fy = seth(-512 * w.fy), none = seth(0);
  for (int first = 0; first < simd::kKltStride; first += kShorts) {
    std::int16_t* out = padded + first;
    if (first >= w.columns) {  // the gradients read these, and leave them out
      for (int y = 0; y < w.rows; ++y) storeh(out + y * simd::kKltStride, none);
      continue;
    }
    const std::uint8_t* p = w.data + first;
    vh above = mix_pairs(p, weights);
    for (int y = 0; y < w.rows; ++y) {
      p += w.stride;
      const vh below = mix_pairs(p, weights);
      storeh(out + y * simd::kKltStride, klt_between(above, below, minus_fy));
      above = below;
    }
  }
  for (int i = w.rows * simd::kKltStride; i < w.rows * simd::kKltStride + 16; i += kShorts) storeh(padded + i, none);
  return klt_gradients(padded, w.columns - 2, w.rows - 2, patch);
}

TEXTPLANE_SIMD_ENTRY simd::KltSums klt_sums(const simd::KltWindow& window, const simd::KltPatch& patch) noexcept {
  std::uint8_t copy[kKltCopyStride * (simd::kKltSide + 3)];
  const simd::KltWindow w = klt_roomy(window, copy);
  const vh minus_fy = seth(-512 * w.fy), one = seth(1);
  vw v_sum = zerow(), vv = zerow(), tv = zerow(), xv = zerow(), yv = zerow();
  for (int first = 0; first < w.columns; first += kShorts) {
    // Without weight, the samples past the last column are 0.
    const vh weights = andh(pair_weights(simd::kKltSubpixels - w.fx, w.fx), firsth(w.columns - first));
    const std::uint8_t* p = w.data + first;
    vh above = mix_pairs(p, weights);
    for (int y = 0; y < w.rows; ++y) {
      p += w.stride;
      const vh below = mix_pairs(p, weights);
      const vh v = klt_between(above, below, minus_fy);
      above = below;
      const int at = y * simd::kKltStride + first;
      v_sum = dotw(v_sum, v, one);
      vv = dotw(vv, v, v);
      tv = dotw(tv, v, loadh(patch.value + at));
      xv = dotw(xv, v, loadh(patch.gx + at));
      yv = dotw(yv, v, loadh(patch.gy + at));
    }
  }
  return simd::KltSums{sumw(v_sum), sumw(vv), sumw(tv), sumw(xv), sumw(yv)};
}
