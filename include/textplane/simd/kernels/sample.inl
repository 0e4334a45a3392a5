// What every kernel that samples an image at scattered points is made of: warp | taps | interpolation, each a short
// loop over a strip (simd/sample.hpp). Output arrays have room for whole vectors. Include before: kernels/tiles.inl.

// kLanes floats of an array that has `left` more. Lanes beyond are 0; their memory is not touched.
TEXTPLANE_SIMD_INLINE vf load_part(const float* p, int left) noexcept {
  return left >= kLanes ? load(p) : load_n(p, left);
}

// Zeroes the lanes beyond n of the last vector of an array.
TEXTPLANE_SIMD_INLINE void zero_tail(float* p, int n) noexcept {
  const int rest = n % kLanes;
  if (rest != 0) store(p + (n - rest), keep(first_n(rest), load(p + (n - rest))));
}

// Neither NaN nor infinite. Tests the bits, so that -ffast-math cannot remove it.
TEXTPLANE_SIMD_INLINE bool finite_d(double x) noexcept {
  std::uint64_t b;
  copy_bytes(&b, &x, 8);
  return (b & 0x7ff0000000000000ULL) != 0x7ff0000000000000ULL;
}

// Bounds of n > 0 points; n = 0 in the result where a coordinate is not finite; the other numbers then mean nothing.
TEXTPLANE_SIMD_INLINE void find_bounds(const float* x, const float* y, int n, simd::PointBounds* out) noexcept {
  vf x_low = set1(x[0]), x_high = x_low, y_low = set1(y[0]), y_high = y_low, nothing = zero();
  for (int i = 0; i < n; i += kLanes) {
    const int left = n - i;
    const vf px = left >= kLanes ? load(x + i) : select(first_n(left), load_n(x + i, left), set1(x[0]));
    const vf py = left >= kLanes ? load(y + i) : select(first_n(left), load_n(y + i, left), set1(y[0]));
    x_low = min_(px, x_low);
    x_high = max_(px, x_high);
    y_low = min_(py, y_low);
    y_high = max_(py, y_high);
    nothing = madd(add(px, py), zero(), nothing);  // the bounds do not see a NaN
  }
  out->x_low = reduce_min(x_low);
  out->x_high = reduce_max(x_high);
  out->y_low = reduce_min(y_low);
  out->y_high = reduce_max(y_high);
  const double all = reduce_sum_double(nothing) + 0.0 * static_cast<double>(out->x_low) +
                     0.0 * static_cast<double>(out->x_high) + 0.0 * static_cast<double>(out->y_low) +
                     0.0 * static_cast<double>(out->y_high);
  out->n = finite_d(all) ? n : 0;
}
TEXTPLANE_SIMD_INLINE float middle_of(float low, float high) noexcept {
  const float middle = 0.5F * low + 0.5F * high;
  return finite_d(static_cast<double>(middle)) ? middle : 0.0F;
}
TEXTPLANE_SIMD_INLINE float middle_x(const simd::PointBounds& b) noexcept { return middle_of(b.x_low, b.x_high); }
TEXTPLANE_SIMD_INLINE float middle_y(const simd::PointBounds& b) noexcept { return middle_of(b.y_low, b.y_high); }

// The homography that takes (u, v), relative to the host centre (hx, hy), to a target pixel, h row-major, around the
// target pixel (ox, oy). False where it cannot be written in float.
TEXTPLANE_SIMD_INLINE bool make_warp_around(const double* h, float hx, float hy, int origin_x, int origin_y,
                                            simd::Warp8* w) noexcept {
  const double x = h[2], y = h[5], z = h[8];
  w->hx = hx;
  w->hy = hy;
  w->ox = origin_x;
  w->oy = origin_y;
  // Any positive scale will do; this one keeps the divisor of a patch of 100 px near 1.
  const double size = (z < 0 ? -z : z) + 50 * ((h[6] < 0 ? -h[6] : h[6]) + (h[7] < 0 ? -h[7] : h[7]));
  const double scale = size > 0 ? 1 / size : 1, ox = w->ox, oy = w->oy;
  const double g0 = (h[0] - ox * h[6]) * scale, g1 = (h[1] - ox * h[7]) * scale, g2 = (x - ox * z) * scale;
  const double g3 = (h[3] - oy * h[6]) * scale, g4 = (h[4] - oy * h[7]) * scale, g5 = (y - oy * z) * scale;
  const double g6 = h[6] * scale, g7 = h[7] * scale, g8 = z * scale;
  w->g[0] = static_cast<float>(g0);
  w->g[1] = static_cast<float>(g1);
  w->g[2] = static_cast<float>(g2);
  w->g[3] = static_cast<float>(g3);
  w->g[4] = static_cast<float>(g4);
  w->g[5] = static_cast<float>(g5);
  w->g[6] = static_cast<float>(g6);
  w->g[7] = static_cast<float>(g7);
  w->g[8] = static_cast<float>(g8);
  const double squares = (g0 * g0 + g1 * g1 + g2 * g2) + (g3 * g3 + g4 * g4 + g5 * g5) + (g6 * g6 + g7 * g7 + g8 * g8);
  return finite_d(size) && finite_d(squares) && !(squares > 1e60);
}

// The same around the pixel of the image nearest to the projected centre, or its middle if the centre is behind.
TEXTPLANE_SIMD_INLINE bool make_centred_warp(const double* h, float hx, float hy, int width, int height,
                                             simd::Warp8* w) noexcept {
  const double x = h[2], y = h[5], z = h[8], iz = z > 0 ? 1 / z : 0, px = x * iz, py = y * iz;
  const int ox = !(z > 0) ? (width - 1) / 2 : !(px > 0) ? 0 : px < width - 1 ? static_cast<int>(px + 0.5) : width - 1;
  const int oy = !(z > 0)          ? (height - 1) / 2
                 : !(py > 0)       ? 0
                 : py < height - 1 ? static_cast<int>(py + 0.5)
                                   : height - 1;
  return make_warp_around(h, hx, hy, ox, oy, w);
}

// The same for h from host pixel to target pixel.
TEXTPLANE_SIMD_INLINE bool make_warp(const double* h, float hx, float hy, int width, int height,
                                     simd::Warp8* w) noexcept {
  const double u = static_cast<double>(hx), v = static_cast<double>(hy);
  const double centred[9] = {h[0], h[1], h[0] * u + h[1] * v + h[2], h[3], h[4], h[3] * u + h[4] * v + h[5],
                             h[6], h[7], h[6] * u + h[7] * v + h[8]};
  return make_centred_warp(centred, hx, hy, width, height, w);
}

// How `image` is read around the pixel (origin_x, origin_y).
TEXTPLANE_SIMD_INLINE void make_sample_frame(const simd::Image8& image, int origin_x, int origin_y,
                                             SampleFrame* f) noexcept {
  const long long ox = origin_x, oy = origin_y;
  f->pairs = image.pairs ? image.pairs + (oy * image.pair_stride + ox) : nullptr;
  f->bytes = image.data + (oy * image.stride + ox);
  f->stride = image.pairs ? image.pair_stride : image.stride;
  f->x_low = static_cast<float>(-origin_x);
  f->y_low = static_cast<float>(-origin_y);
  f->x_high = static_cast<float>(image.width - 2 - origin_x);
  f->y_high = static_cast<float>(image.height - 2 - origin_y);
  f->x_last = static_cast<float>(image.width - 1 - origin_x);
  f->y_last = static_cast<float>(image.height - 1 - origin_y);
}

// The constants of a warp in all lanes. Made before a loop, since g++ would make them again inside.
struct WarpVectors {
  vf hx, hy, g0, g1, g2, g3, g4, g5, g6, g7, g8;
};
TEXTPLANE_SIMD_INLINE WarpVectors broadcast_warp(const simd::Warp8& w) noexcept {
  return WarpVectors{set1(w.hx),   set1(w.hy),   set1(w.g[0]), set1(w.g[1]), set1(w.g[2]), set1(w.g[3]),
                     set1(w.g[4]), set1(w.g[5]), set1(w.g[6]), set1(w.g[7]), set1(w.g[8])};
}

// Target coordinates, relative to the origin, and divisors of kLanes host pixels.
TEXTPLANE_SIMD_INLINE void warp_vector(const WarpVectors& w, vf px, vf py, vf* x, vf* y, vf* divisor) noexcept {
  const vf u = sub(px, w.hx), v = sub(py, w.hy);
  *divisor = madd(w.g6, u, madd(w.g7, v, w.g8));
  const vf inverse = div(set1(1.0F), *divisor);
  *x = mul(madd(w.g0, u, madd(w.g1, v, w.g2)), inverse);
  *y = mul(madd(w.g3, u, madd(w.g4, v, w.g5)), inverse);
}

// In front, and inside [0, width - 1] x [0, height - 1].
TEXTPLANE_SIMD_INLINE vm inside_vector(const SampleFrame& f, vf x, vf y, vf divisor) noexcept {
  const vm across = and_(ge(x, set1(f.x_low)), le(x, set1(f.x_last)));
  const vm down = and_(ge(y, set1(f.y_low)), le(y, set1(f.y_last)));
  return and_(gt(divisor, zero()), and_(across, down));
}

// Bounds of the cells and the stride in all lanes.
struct CellVectors {
  vf x_low, y_low, x_high, y_high;
  vi stride;
};
TEXTPLANE_SIMD_INLINE CellVectors broadcast_cells(const SampleFrame& f) noexcept {
  return CellVectors{set1(f.x_low), set1(f.y_low), set1(f.x_high), set1(f.y_high), seti(static_cast<int>(f.stride))};
}

// Cell of kLanes target points, clamped to the image (a NaN too): its offset and the position in it.
TEXTPLANE_SIMD_INLINE void cell_vector(const CellVectors& c, vf x, vf y, SampleStrip* s, int i) noexcept {
  const vf cx = min_(max_(floor_(x), c.x_low), c.x_high);
  const vf cy = min_(max_(floor_(y), c.y_low), c.y_high);
  store(s->fx + i, sub(x, cx));
  store(s->fy + i, sub(y, cy));
  storei(s->offset + i, addi(muli(to_int(cy), c.stride), to_int(cx)));
}

// Warp of the host pixels px, py from `i` on, n <= kStrip in all: target coordinates to x and y, cells to the strip.
TEXTPLANE_SIMD_INLINE void warp_strip(const simd::Warp8& w, const SampleFrame& f,
                                      const float* TEXTPLANE_SIMD_RESTRICT px, const float* TEXTPLANE_SIMD_RESTRICT py,
                                      int i, int n, float* TEXTPLANE_SIMD_RESTRICT x, float* TEXTPLANE_SIMD_RESTRICT y,
                                      SampleStrip* TEXTPLANE_SIMD_RESTRICT s) noexcept {
  const WarpVectors warp = broadcast_warp(w);
  const CellVectors cells = broadcast_cells(f);
  vf tx, ty, divisor;
  for (; i + kLanes <= n; i += kLanes) {
    warp_vector(warp, load(px + i), load(py + i), &tx, &ty, &divisor);
    cell_vector(cells, tx, ty, s, i);
    store(x + i, tx);
    store(y + i, ty);
  }
  if (i >= n) return;
  warp_vector(warp, load_n(px + i, n - i), load_n(py + i, n - i), &tx, &ty, &divisor);
  cell_vector(cells, tx, ty, s, i);
  store(x + i, tx);
  store(y + i, ty);
}

// The same of the first n pixels, whole v16, for tiles.
TEXTPLANE_SIMD_INLINE vf tile_cell(vf x, vf low, vf high, float* fraction) noexcept {
  const vf cell = min_(max_(floor_(x), low), high);
  store(fraction, sub(x, cell));
  return cell;
}
TEXTPLANE_SIMD_INLINE void warp_to_tiles(const simd::Warp8& w, const SampleFrame& f, const ImageTiles& tiles,
                                         const float* TEXTPLANE_SIMD_RESTRICT px,
                                         const float* TEXTPLANE_SIMD_RESTRICT py, int n,
                                         float* TEXTPLANE_SIMD_RESTRICT x, float* TEXTPLANE_SIMD_RESTRICT y,
                                         SampleStrip* TEXTPLANE_SIMD_RESTRICT s) noexcept {
  const WarpVectors warp = broadcast_warp(w);
  const vf x_low = set1(f.x_low), x_high = set1(static_cast<float>(tiles.x_high));
  const vf y_low = set1(f.y_low), y_high = set1(static_cast<float>(tiles.y_high));
  for (int i = 0; i < n; i += k16Lanes) {
    const int j = i + kLanes;
    vf x0, y0, x1, y1, divisor;
    warp_vector(warp, load(px + i), load(py + i), &x0, &y0, &divisor);
    store(x + i, x0);
    store(y + i, y0);
    const vi a0 = to_int(tile_cell(x0, x_low, x_high, s->fx + i)), b0 = to_int(tile_cell(y0, y_low, y_high, s->fy + i));
    warp_vector(warp, load(px + j), load(py + j), &x1, &y1, &divisor);
    store(x + j, x1);
    store(y + j, y1);
    const vi a1 = to_int(tile_cell(x1, x_low, x_high, s->fx + j)), b1 = to_int(tile_cell(y1, y_low, y_high, s->fy + j));
    store16(s->x + i, pack16(a0, a1));
    store16(s->y + i, pack16(b0, b1));
  }
}

// The four pixels of each cell as a word: I(x,y), I(x+1,y), I(x,y+1), I(x+1,y+1) from the lowest byte on; out of pairs
// the middle two are exchanged. Faster than gathers, and it reads these pixels only.
TEXTPLANE_SIMD_INLINE void fetch_rows(const std::uint8_t* upper, std::ptrdiff_t stride,
                                      const std::int32_t* TEXTPLANE_SIMD_RESTRICT offset, int n,
                                      std::uint32_t* TEXTPLANE_SIMD_RESTRICT taps) noexcept {
  const std::uint8_t* lower = upper + stride;
  int i = 0;
  for (; i + 4 <= n; i += 4) fetch_four(upper, lower, offset + i, taps + i);
  for (; i < n; ++i) {
    const std::ptrdiff_t at = offset[i];
    taps[i] = load_u16(upper + at) | load_u16(lower + at) << 16;
  }
}
TEXTPLANE_SIMD_INLINE std::uint32_t two_pairs(const std::uint16_t* p) noexcept {
  return static_cast<std::uint32_t>(p[0]) | static_cast<std::uint32_t>(p[1]) << 16;  // one 32-bit load
}
TEXTPLANE_SIMD_INLINE void fetch_pairs(const SampleFrame& f, int n, SampleStrip* TEXTPLANE_SIMD_RESTRICT s) noexcept {
  int i = 0;
  for (; i + 4 <= n; i += 4) {
    s->taps[i] = two_pairs(f.pairs + s->offset[i]);
    s->taps[i + 1] = two_pairs(f.pairs + s->offset[i + 1]);
    s->taps[i + 2] = two_pairs(f.pairs + s->offset[i + 2]);
    s->taps[i + 3] = two_pairs(f.pairs + s->offset[i + 3]);
  }
  for (; i < n; ++i) s->taps[i] = two_pairs(f.pairs + s->offset[i]);
}
// The same of n cells, whole v16, by tiles, and then of the groups that these do not hold.
TEXTPLANE_SIMD_INLINE void fetch_tiles(const ImageTiles& w, int n, SampleStrip* TEXTPLANE_SIMD_RESTRICT s) noexcept {
  const TileVectors v = broadcast_tiles(w);
  std::uint64_t fours = 0;
  for (int i = 0; i < n; i += k16Lanes) {
    v16 first, second;
    fours |= static_cast<std::uint64_t>(tile_pairs(v, s->x + i, s->y + i, &first, &second)) << (i / 4);
    store_taps(s->taps + i, first, second);
  }
  for (std::uint64_t groups = (fours | fours >> 1) & 0x5555555555555555ULL; groups != 0; groups &= groups - 1) {
    const int i = 4 * lowest_bit(groups);
    group_offsets(s->x + i, s->y + i, static_cast<int>(w.stride), s->offset + i);
    fetch_four(v.upper, v.middle, s->offset + i, s->taps + i);
    fetch_four(v.upper, v.middle, s->offset + i + 4, s->taps + i + 4);
  }
}
// Those of the cells `from` on, n in all.
TEXTPLANE_SIMD_INLINE void fetch_taps(const SampleFrame& f, int from, int n, SampleStrip* s) noexcept {
  // Whole vectors are read later: those beyond n repeat the first.
  if (f.pairs)
    fetch_pairs(f, n, s);
  else
    fetch_rows(f.bytes, f.stride, s->offset + from, n - from, s->taps + from);
  for (int i = n; i % kLanes != 0; ++i) s->taps[i] = s->taps[0];
}

// Value and gradient of kLanes cells of the strip. `paired`: the taps are from pairs.
TEXTPLANE_SIMD_INLINE void interpolate_vector(const SampleStrip& s, int i, bool paired, vf* value, vf* gx,
                                              vf* gy) noexcept {
  const taps_t t = load_taps(s.taps + i);
  const vf fx = load(s.fx + i), fy = load(s.fy + i), dxy = tap_dxy(t);
  const vf dx = paired ? tap_dy(t) : tap_dx(t), dy = paired ? tap_dx(t) : tap_dy(t);
  *gx = madd(fy, dxy, dx);
  *gy = madd(fx, dxy, dy);
  *value = madd(fy, *gy, madd(fx, dx, tap_value(t)));
}
// n values and gradients to arrays.
TEXTPLANE_SIMD_INLINE void interpolate_strip(const SampleStrip& s, int n, bool paired,
                                             float* TEXTPLANE_SIMD_RESTRICT value, float* TEXTPLANE_SIMD_RESTRICT gx,
                                             float* TEXTPLANE_SIMD_RESTRICT gy) noexcept {
  for (int i = 0; i < n; i += kLanes) {
    vf v, a, b;
    interpolate_vector(s, i, paired, &v, &a, &b);
    store(value + i, v);
    store(gx + i, a);
    store(gy + i, b);
  }
}
// n values alone.
TEXTPLANE_SIMD_INLINE void interpolate_values(const SampleStrip& s, int n, bool paired,
                                              float* TEXTPLANE_SIMD_RESTRICT value) noexcept {
  for (int i = 0; i < n; i += kLanes) {
    vf v, a, b;
    interpolate_vector(s, i, paired, &v, &a, &b);
    store(value + i, v);
  }
}
