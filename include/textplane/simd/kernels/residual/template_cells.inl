// Where the pixels of a template kernel find their taps: cells and fractions in units of 2^-15 px, without a lens and
// behind one. Include before: kernels/lens.inl.

enum : int {
  kTemplateStrip = 16 * k16Lanes,
  kTemplateChunk = 512 * kTemplateStrip,
  kTemplateSums = 11,
};

// Between the loops: divisors, then offsets or, for tiles, cells, and fractions.
struct TemplateStrip {
  float inverse[kTemplateStrip];
  std::int32_t offset[kTemplateStrip];
  std::int16_t x[kTemplateStrip], y[kTemplateStrip];
  std::int16_t fx[kTemplateStrip], fy[kTemplateStrip];
};

// Fractions, and offsets or cells, of pixels i to i + k16Lanes - 1 from positions in units of 2^-15 px.
TEXTPLANE_SIMD_INLINE void template_store(bool tiles, vi rows, vi low, vi high, v16 x_high, v16 y_high, vi x0, vi y0,
                                          vi x1, vi y1, int i, TemplateStrip& s) noexcept {
  const vi fraction = seti(32767);
  if (tiles) {
    store16(s.x + i, min_unsigned16(pack16(shr(x0, 15), shr(x1, 15)), x_high));
    store16(s.y + i, min_unsigned16(pack16(shr(y0, 15), shr(y1, 15)), y_high));
  } else {
    const vi o0 = addi(muli(shr(y0, 15), rows), shr(x0, 15)), o1 = addi(muli(shr(y1, 15), rows), shr(x1, 15));
    storei(s.offset + i, mini(maxi(o0, low), high));
    storei(s.offset + i + kLanes, mini(maxi(o1, low), high));
  }
  store16(s.fx + i, pack16(andi(x0, fraction), andi(x1, fraction)));
  store16(s.fy + i, pack16(andi(y0, fraction), andi(y1, fraction)));
}

// The cells of n pixels behind a lens.
TEXTPLANE_SIMD_INLINE void template_lens_loop(const simd::TemplateArgs& a, const LensFrame& l, int kind,
                                              const ImageTiles* tiles, int from, int stride, int low_offset,
                                              int high_offset, int n, TemplateStrip& s) noexcept {
  const vi rows = seti(stride), low = seti(low_offset), high = seti(high_offset);
  const v16 x_high = set16(tiles ? tiles->x_high : 0), y_high = set16(tiles ? tiles->y_high : 0);
  const LensVectors lens = broadcast_lens(l);
  const vf g0 = set1(a.g[0]), g1 = set1(a.g[1]), g2 = set1(a.g[2]), g3 = set1(a.g[3]), g4 = set1(a.g[4]),
           g5 = set1(a.g[5]), half = set1(0.5f), scale = set1(32768.0f);
  vi at[4];
  for (int i = 0; i < n; i += k16Lanes) {
    TEXTPLANE_SIMD_UNROLL
    for (int k = 0; k < 2; ++k) {
      const int j = i + k * kLanes;
      const vf u = load(a.u + from + j), v = load(a.v + from + j), z = load(s.inverse + j);
      vf x, y, unused_t, unused_s, unused_slope;
      lens_vector(l, lens, kind, false, mul(madd(g0, u, madd(g1, v, g2)), z), mul(madd(g3, u, madd(g4, v, g5)), z), &x,
                  &y, &unused_t, &unused_s, &unused_slope);
      at[2 * k] = to_int(madd(x, scale, half));
      at[2 * k + 1] = to_int(madd(y, scale, half));
    }
    template_store(tiles != nullptr, rows, low, high, x_high, y_high, at[0], at[1], at[2], at[3], i, s);
  }
}
TEXTPLANE_SIMD_ENTRY void template_lens_cells(const simd::TemplateArgs& a, const LensFrame& l, const ImageTiles* tiles,
                                              int from, int stride, int low_offset, int high_offset, int n,
                                              TemplateStrip& s) noexcept {
  const int low = low_offset, high = high_offset;
  switch (lens_kind(l)) {
    case kLensShort: return template_lens_loop(a, l, kLensShort, tiles, from, stride, low, high, n, s);
    case kLensTangential: return template_lens_loop(a, l, kLensTangential, tiles, from, stride, low, high, n, s);
    case kLensMiddle: return template_lens_loop(a, l, kLensMiddle, tiles, from, stride, low, high, n, s);
    default: return template_lens_loop(a, l, kLensLong, tiles, from, stride, low, high, n, s);
  }
}
