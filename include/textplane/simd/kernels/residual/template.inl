// Sampling and sums of simd/template.hpp. Include before: residual/template_cells.inl.
//
// A strip of pixels passes through short loops, each near the limit of its ports: divisors | positions, offsets and
// fractions | taps and interpolation | products. One long loop would exceed what the CPU schedules at once.
//
// Range of the sums: a product is at most 8191 * 8160, two of them go to a lane, and a strip has 16 vectors: 2.14e9 <
// 2^31. After a strip the lanes are split into low and high halves, which add up for kTemplateChunk pixels without
// overflow.

// 1 / w of two vectors by one division.
TEXTPLANE_SIMD_INLINE void template_divide(const simd::TemplateArgs& a, int from, int n, TemplateStrip& s) noexcept {
  const vf g6 = set1(a.g[6]), g7 = set1(a.g[7]), one = set1(1.0f);
  const float *u = a.u + from, *v = a.v + from;
  for (int i = 0; i < n; i += k16Lanes) {
    const vf w0 = madd(g6, load(u + i), madd(g7, load(v + i), one));
    const vf w1 = madd(g6, load(u + i + kLanes), madd(g7, load(v + i + kLanes), one));
    const vf r = div(one, mul(w0, w1));
    store(s.inverse + i, mul(r, w1));
    store(s.inverse + i + kLanes, mul(r, w0));
  }
}

// Positions in units of 2^-15 px, split into fractions and offsets of cells, in elements of the image. Offsets are
// clamped to the buffer. With tiles, the cells in place of offsets.
TEXTPLANE_SIMD_INLINE void template_cells(const simd::TemplateArgs& a, const ImageTiles* tiles, int from, int stride,
                                          int low_offset, int high_offset, int n, TemplateStrip& s) noexcept {
  const float scale = 32768.0f;
  const vf g0 = set1(a.g[0] * scale), g1 = set1(a.g[1] * scale), g2 = set1(a.g[2] * scale);
  const vf g3 = set1(a.g[3] * scale), g4 = set1(a.g[4] * scale), g5 = set1(a.g[5] * scale), half = set1(0.5f);
  const vi rows = seti(stride), low = seti(low_offset), high = seti(high_offset);
  const v16 x_high = set16(tiles ? tiles->x_high : 0), y_high = set16(tiles ? tiles->y_high : 0);
  const float *u = a.u + from, *v = a.v + from;
  for (int i = 0; i < n; i += k16Lanes) {
    const vf p0 = load(u + i), q0 = load(v + i), z0 = load(s.inverse + i);
    const vi x0 = to_int(madd(madd(g0, p0, madd(g1, q0, g2)), z0, half));
    const vi y0 = to_int(madd(madd(g3, p0, madd(g4, q0, g5)), z0, half));
    const vf p1 = load(u + i + kLanes), q1 = load(v + i + kLanes), z1 = load(s.inverse + i + kLanes);
    const vi x1 = to_int(madd(madd(g0, p1, madd(g1, q1, g2)), z1, half));
    const vi y1 = to_int(madd(madd(g3, p1, madd(g4, q1, g5)), z1, half));
    template_store(tiles != nullptr, rows, low, high, x_high, y_high, x0, y0, x1, y1, i, s);
  }
}

TEXTPLANE_SIMD_ENTRY void template_tile_cells(const simd::TemplateArgs& a, const ImageTiles& w, int from, int n,
                                              TemplateStrip& s) noexcept {
  template_cells(a, &w, from, 0, 0, 0, n, s);
}

// Two lanes of two pixels each: along f inside them, then along g from the first to the second.
TEXTPLANE_SIMD_INLINE v16 template_value(v16 first, v16 second, v16 f, v16 g) noexcept {
  const v16 a = add16(dot_pair(first, 64, 0), mul15(dot_pair(first, -64, 64), f));
  const v16 b = add16(dot_pair(second, 64, 0), mul15(dot_pair(second, -64, 64), f));
  return sub16(add16(a, mul15(sub16(b, a), g)), set16(8160));
}

// Prefetches the columns that template_products11() reads, if a block begins at i: the taps take long enough to hide
// the loads. `rows` is null where they are not read.
TEXTPLANE_SIMD_INLINE void fetch_ahead(const std::int16_t* rows, int i) noexcept {
  enum : int { kStep = simd::kTemplateBlock };
  if (!kManyRegisters || !rows || i % kStep != 0) return;
  const std::int16_t* p = rows + i * simd::kTemplateColumns;
  TEXTPLANE_SIMD_PREFETCH(p);
  TEXTPLANE_SIMD_PREFETCH(p + kStep);
  TEXTPLANE_SIMD_PREFETCH(p + 2 * kStep);
  TEXTPLANE_SIMD_PREFETCH(p + 3 * kStep);
  TEXTPLANE_SIMD_PREFETCH(p + 4 * kStep);
  TEXTPLANE_SIMD_PREFETCH(p + 5 * kStep);
  TEXTPLANE_SIMD_PREFETCH(p + 6 * kStep);
  TEXTPLANE_SIMD_PREFETCH(p + 7 * kStep);
  TEXTPLANE_SIMD_PREFETCH(p + 8 * kStep);
}

TEXTPLANE_SIMD_INLINE void template_rows(const simd::TemplateArgs& a, int n, const TemplateStrip& s,
                                         const std::int16_t* rows, std::int16_t* values) noexcept {
  const std::uint8_t* upper = a.target.data + a.oy * a.target.stride + a.ox;
  const std::uint8_t* lower = upper + a.target.stride;
  for (int i = 0; i < n; i += k16Lanes) {
    v16 first, second;
    fetch_ahead(rows, i);
    gather16(upper, lower, s.offset + i, &first, &second);
    store16(values + i, template_value(first, second, load16(s.fx + i), load16(s.fy + i)));
  }
}

// The same by tiles; groups outside their tiles one by one.
TEXTPLANE_SIMD_ENTRY void template_tiles(const ImageTiles& w, int n, const TemplateStrip& s, const std::int16_t* rows,
                                         std::int16_t* values) noexcept {
  const TileVectors v = broadcast_tiles(w);
  std::uint64_t groups = 0;  // bit 2 i + k: group i of the k-th 256 pixels
  for (int begin = 0; begin < n; begin += 256) {
    const int end = n - begin < 256 ? n : begin + 256;
    std::uint64_t fours = 0;
    for (int i = begin; i < end; i += k16Lanes) {
      v16 first, second;
      fetch_ahead(rows, i);
      fours |= static_cast<std::uint64_t>(tile_pairs(v, s.x + i, s.y + i, &first, &second)) << ((i - begin) / 4);
      store16(values + i, template_value(first, second, load16(s.fx + i), load16(s.fy + i)));
    }
    groups |= ((fours | fours >> 1) & 0x5555555555555555ULL) << (begin / 256);
  }
  for (; groups != 0; groups &= groups - 1) {
    const int bit = lowest_bit(groups), i = bit / 2 * 8 + (bit & 1) * 256;
    int offset[8];
    group_offsets(s.x + i, s.y + i, static_cast<int>(w.stride), offset);
    v16 first, second;
    fetch_group(v.upper, v.middle, offset, &first, &second);
    store_group(values + i, template_value(first, second, load_group(s.fx + i), load_group(s.fy + i)));
  }
}

TEXTPLANE_SIMD_INLINE void template_pairs(const simd::TemplateArgs& a, int n, TemplateStrip& s,
                                          const std::int16_t* rows, std::int16_t* values) noexcept {
  const std::uint16_t* origin = a.target.pairs + a.oy * a.target.pair_stride + a.ox;
  for (int i = 0; i < n; i += k16Lanes) {
    fetch_ahead(rows, i);
    const vi p = gather_pairs(origin, s.offset + i), q = gather_pairs(origin, s.offset + i + kLanes);
    store16(values + i, template_value(low16(p, q), high16(p, q), load16(s.fy + i), load16(s.fx + i)));
  }
}

// `first`: the sums are not set yet. (Compilers would zero the arrays by a string instruction, which takes longer than
// a strip.)
TEXTPLANE_SIMD_INLINE void template_flush(vi sum, bool first, vi* low, vi* high) noexcept {
  const vi lower = andi(sum, seti(65535)), upper = shr(sum, 16);
  *low = first ? lower : addi(*low, lower);
  *high = first ? upper : addi(*high, upper);
}

// Sums of V, V^2 and V times the first column of the rows.
TEXTPLANE_SIMD_INLINE void template_products(const std::int16_t* rows, const std::int16_t* values, int n, bool first,
                                             vi* low, vi* high) noexcept {
  vi total = seti(0), square = total, host = total;
  const v16 ones = set16(1);
  for (int i = 0; i < n; i += simd::kTemplateBlock, rows += simd::kTemplateColumns * simd::kTemplateBlock) {
    for (int j = 0; j < simd::kTemplateBlock; j += k16Lanes) {
      const v16 value = load16(values + i + j);
      total = add_dot16(total, value, ones);
      square = add_dot16(square, value, value);
      host = add_dot16(host, value, load16(rows + j));
    }
  }
  template_flush(total, first, low, high);
  template_flush(square, first, low + 1, high + 1);
  template_flush(host, first, low + 2, high + 2);
}

// Sums of V times the four columns from `rows` on.
TEXTPLANE_SIMD_INLINE void template_products4(const std::int16_t* rows, const std::int16_t* values, int n, bool first,
                                              vi* low, vi* high) noexcept {
  vi c0 = seti(0), c1 = c0, c2 = c0, c3 = c0;
  for (int i = 0; i < n; i += simd::kTemplateBlock, rows += simd::kTemplateColumns * simd::kTemplateBlock) {
    for (int j = 0; j < simd::kTemplateBlock; j += k16Lanes) {
      const v16 value = load16(values + i + j);
      c0 = add_dot16(c0, value, load16(rows + j));
      c1 = add_dot16(c1, value, load16(rows + j + simd::kTemplateBlock));
      c2 = add_dot16(c2, value, load16(rows + j + 2 * simd::kTemplateBlock));
      c3 = add_dot16(c3, value, load16(rows + j + 3 * simd::kTemplateBlock));
    }
  }
  template_flush(c0, first, low, high);
  template_flush(c1, first, low + 1, high + 1);
  template_flush(c2, first, low + 2, high + 2);
  template_flush(c3, first, low + 3, high + 3);
}

// All of them in one loop, for kManyRegisters.
TEXTPLANE_SIMD_ENTRY void template_products11(const std::int16_t* rows, const std::int16_t* values, int n, bool first,
                                              vi* low, vi* high) noexcept {
  enum : int { kStep = simd::kTemplateBlock };
  vi total = seti(0), square = total, host = total;
  vi c0 = total, c1 = total, c2 = total, c3 = total, c4 = total, c5 = total, c6 = total, c7 = total;
  const v16 ones = set16(1);
  for (int i = 0; i < n; i += kStep, rows += simd::kTemplateColumns * kStep) {
    for (int j = 0; j < kStep; j += k16Lanes) {
      const v16 value = load16(values + i + j);
      total = add_dot16(total, value, ones);
      square = add_dot16(square, value, value);
      host = add_dot16(host, value, load16(rows + j));
      c0 = add_dot16(c0, value, load16(rows + j + kStep));
      c1 = add_dot16(c1, value, load16(rows + j + 2 * kStep));
      c2 = add_dot16(c2, value, load16(rows + j + 3 * kStep));
      c3 = add_dot16(c3, value, load16(rows + j + 4 * kStep));
      c4 = add_dot16(c4, value, load16(rows + j + 5 * kStep));
      c5 = add_dot16(c5, value, load16(rows + j + 6 * kStep));
      c6 = add_dot16(c6, value, load16(rows + j + 7 * kStep));
      c7 = add_dot16(c7, value, load16(rows + j + 8 * kStep));
    }
  }
  template_flush(total, first, low, high);
  template_flush(square, first, low + 1, high + 1);
  template_flush(host, first, low + 2, high + 2);
  template_flush(c0, first, low + 3, high + 3);
  template_flush(c1, first, low + 4, high + 4);
  template_flush(c2, first, low + 5, high + 5);
  template_flush(c3, first, low + 6, high + 6);
  template_flush(c4, first, low + 7, high + 7);
  template_flush(c5, first, low + 8, high + 8);
  template_flush(c6, first, low + 9, high + 9);
  template_flush(c7, first, low + 10, high + 10);
}

TEXTPLANE_SIMD_INLINE void template_run(const simd::TemplateArgs& a, const ImageTiles* tiles, const LensFrame* lens,
                                        bool derivatives, simd::TemplateSums& out) noexcept {
  const int padded = (a.n + simd::kTemplateBlock - 1) / simd::kTemplateBlock * simd::kTemplateBlock;
  const int used = derivatives ? kTemplateSums : 3;
  const bool paired = a.target.pairs != nullptr;
  const int stride = static_cast<int>(paired ? a.target.pair_stride : a.target.stride);
  const int low_offset = -(a.oy * stride + a.ox);
  const int high_offset = (a.target.height - 2) * stride + a.target.width - 2 + low_offset;
  for (int k = 0; k < simd::kTemplateColumns; ++k) out.column[k] = 0;
  out.value = out.square = 0;
  TemplateStrip strip;
  for (int begin = 0; begin < padded; begin += kTemplateChunk) {
    const int end = padded - begin < kTemplateChunk ? padded : begin + kTemplateChunk;
    vi low[kTemplateSums], high[kTemplateSums];
    for (int from = begin; from < end; from += kTemplateStrip) {
      const int n = end - from < kTemplateStrip ? end - from : kTemplateStrip;
      std::int16_t* values = a.values + from;
      const std::int16_t* rows = a.rows + static_cast<std::ptrdiff_t>(from) * simd::kTemplateColumns;
      const std::int16_t* ahead = derivatives ? rows : nullptr;
      template_divide(a, from, n, strip);
      if (lens) template_lens_cells(a, *lens, tiles, from, stride, low_offset, high_offset, n, strip);
      if (kInt16Tiles != 0 && tiles) {
        if (!lens) template_tile_cells(a, *tiles, from, n, strip);
        template_tiles(*tiles, n, strip, ahead, values);
      } else {
        if (!lens) template_cells(a, nullptr, from, stride, low_offset, high_offset, n, strip);
        if (paired)
          template_pairs(a, n, strip, ahead, values);
        else
          template_rows(a, n, strip, ahead, values);
      }
      if (a.n - from < n) zero16(values, a.n - from, n);
      if (kManyRegisters && derivatives) {
        template_products11(rows, values, n, from == begin, low, high);
        continue;
      }
      template_products(rows, values, n, from == begin, low, high);
      if (derivatives) {
        template_products4(rows + simd::kTemplateBlock, values, n, from == begin, low + 3, high + 3);
        template_products4(rows + 5 * simd::kTemplateBlock, values, n, from == begin, low + 7, high + 7);
      }
    }
    std::int64_t total[kTemplateSums];
    for (int k = 0; k < used; ++k)
      total[k] = reduce_sum_int(low[k]) + static_cast<std::int64_t>(reduce_sum_int(high[k])) * 65536;
    out.value += total[0];
    out.square += total[1];
    for (int k = 2; k < used; ++k) out.column[k - 2] += total[k];
  }
}

TEXTPLANE_SIMD_ENTRY void template_sums(const simd::TemplateArgs& a, simd::TemplateSums& out) noexcept {
  template_run(a, nullptr, nullptr, true, out);
}

TEXTPLANE_SIMD_ENTRY void template_correlation(const simd::TemplateArgs& a, simd::TemplateSums& out) noexcept {
  template_run(a, nullptr, nullptr, false, out);
}
