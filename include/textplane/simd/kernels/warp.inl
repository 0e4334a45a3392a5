// The kernels of simd/warp.hpp. Include before: kernels/tiles.inl.
//
// Each block has a frame of reference in double; each of its rows takes a pass over the coordinates and a pass that
// samples. Constant arguments make the variants.

enum WarpKind : int { kWarp8F, kWarp88, kWarpFF };

// A finite double, by its bits: -ffast-math cannot fold it away.
TEXTPLANE_SIMD_INLINE bool warp_finite(double x) noexcept {
  std::uint64_t word = 0;
  TEXTPLANE_SIMD_COPY(&word, &x, sizeof word);
  return (word & 0x7ff0000000000000ULL) != 0x7ff0000000000000ULL;
}

// floor(x) held in [0, last]; 0 for NaN.
TEXTPLANE_SIMD_INLINE int warp_cell(double x, int last) noexcept {
  if (!(x > 0.0)) return 0;
  return x < static_cast<double>(last) ? static_cast<int>(x) : last;
}

// Whether the block lies inside the source, and how its pixels follow each other in a row. (x1, y1, z1) and so on are
// source coordinates and their steps as in WarpBlock, origin (0, 0).
//
// A homography with q_z > 0 maps the block into the convex hull of the images of its corners. Along a row v,
// d(x/z)/du = N(v) / z^2 with N = x1 z - x z1 affine in v and z affine in u and v, so corners bound both.
//
// Positions are made in float, from divisors whose terms add up to `size`: half of the margin is for what float does to
// a position where q_z is small beside that.
TEXTPLANE_SIMD_INLINE void warp_classify(const simd::WarpArgs& a, const double* x, const double* y, const double* z,
                                         double size, WarpBlock* t) noexcept {
  const double left = -(t->columns / 2), right = left + t->columns - 1, top = -(t->rows / 2),
               bottom = top + t->rows - 1;
  const double margin = 1e-3;
  double x_low = 1e300, x_high = -1e300, y_low = 1e300, y_high = -1e300, z_low = 1e300, z_high = -1e300;
  bool inside = true;
  for (int corner = 0; corner < 4; ++corner) {
    const double u = (corner & 1) ? right : left, v = (corner & 2) ? bottom : top;
    const double q = z[0] + u * z[1] + v * z[2], r = q > 0.0 ? 1.0 / q : 0.0;
    const double px = (x[0] + u * x[1] + v * x[2]) * r, py = (y[0] + u * y[1] + v * y[2]) * r;
    const double reach = TEXTPLANE_SIMD_ABS_D(px - t->ox) + TEXTPLANE_SIMD_ABS_D(py - t->oy) + 1.0;
    inside = inside && q * (0.5 * margin) > 3e-7 * size * reach && px >= margin && py >= margin &&
             px <= a.width - 1 - margin && py <= a.height - 1 - margin;
    x_low = px < x_low ? px : x_low;
    x_high = px > x_high ? px : x_high;
    y_low = py < y_low ? py : y_low;
    y_high = py > y_high ? py : y_high;
    z_low = q < z_low ? q : z_low;
    z_high = q > z_high ? q : z_high;
  }
  t->dense = inside;
  const double nx0 = x[1] * (z[0] + top * z[2]) - (x[0] + top * x[2]) * z[1];
  const double nx1 = x[1] * (z[0] + bottom * z[2]) - (x[0] + bottom * x[2]) * z[1];
  const double ny0 = y[1] * (z[0] + top * z[2]) - (y[0] + top * y[2]) * z[1];
  const double ny1 = y[1] * (z[0] + bottom * z[2]) - (y[0] + bottom * y[2]) * z[1];
  t->leftwards = nx0 < 0.0;
  t->upwards = ny0 + ny1 < 0.0;
  const double ax0 = TEXTPLANE_SIMD_ABS_D(nx0), ax1 = TEXTPLANE_SIMD_ABS_D(nx1), ay0 = TEXTPLANE_SIMD_ABS_D(ny0),
               ay1 = TEXTPLANE_SIMD_ABS_D(ny1);
  const double steep = ay0 > ay1 ? ay0 : ay1, wide = ax0 > ax1 ? ax0 : ax1, narrow = ax0 < ax1 ? ax0 : ax1;
  const double z2_low = z_low * z_low, z2_high = z_high * z_high;
  // At most 15 pixels wide over 8 lanes, and far from standing still, where rounding could reverse the order.
  t->tiles = inside && (nx0 < 0.0) == (nx1 < 0.0) && wide <= 1.95 * z2_low && narrow >= 0.125 * z2_high &&
             steep <= 0.14 * z2_low && x_high < a.width - 16 && y_high < a.height - 3;
}

// The block whose first pixel is (first_x, first_y). The scale of H is taken out, so that the floats that follow
// neither overflow nor vanish. The origin is the cell of the projected centre where there is one.
TEXTPLANE_SIMD_INLINE WarpBlock warp_block(const simd::WarpArgs& a, int first_x, int first_y) noexcept {
  WarpBlock t;
  t.columns = a.out_width - first_x < kWarpBlockWidth ? a.out_width - first_x : kWarpBlockWidth;
  t.rows = a.out_height - first_y < kWarpBlockHeight ? a.out_height - first_y : kWarpBlockHeight;
  const double* h = a.h;
  const double cx = first_x + t.columns / 2, cy = first_y + t.rows / 2;
  const double x[3] = {h[0] * cx + h[1] * cy + h[2], h[0], h[1]}, y[3] = {h[3] * cx + h[4] * cy + h[5], h[3], h[4]};
  const double z[3] = {h[6] * cx + h[7] * cy + h[8], h[6], h[7]};
  const double size = TEXTPLANE_SIMD_ABS_D(z[0]) + kWarpBlockWidth * TEXTPLANE_SIMD_ABS_D(z[1]) +
                      kWarpBlockHeight * TEXTPLANE_SIMD_ABS_D(z[2]);
  const double s = size > 0.0 ? 1.0 / size : 0.0;
  const double r = z[0] > 0.0 ? 1.0 / z[0] : 0.0;
  t.ox = z[0] > 0.0 ? warp_cell(x[0] * r, a.width - 2) : a.width / 2;
  t.oy = z[0] > 0.0 ? warp_cell(y[0] * r, a.height - 2) : a.height / 2;
  for (int i = 0; i < 3; ++i) {
    t.x[i] = (x[i] - t.ox * z[i]) * s;
    t.y[i] = (y[i] - t.oy * z[i]) * s;
    t.z[i] = z[i] * s;
  }
  warp_classify(a, x, y, z, size, &t);
  return t;
}

// How a block's pixels find their taps.
enum WarpPath : int {
  kWarpTiles,   // u8: by shuffles of tiles
  kWarpDense,   // one by one
  kWarpSparse,  // one by one, some lie outside
};

// Cells and fractions of the pixels of a block's row, v rows below its centre. Lanes beyond the last column repeat it.
// Pixels outside are flagged and moved to the nearest cell. Returns how many are inside.
TEXTPLANE_SIMD_INLINE int warp_coordinates(const simd::WarpArgs& a, const WarpBlock& t, int v, int pixel, int path,
                                           WarpStrip* TEXTPLANE_SIMD_RESTRICT s) noexcept {
  const int columns = t.columns;
  const vf x0 = set1(static_cast<float>(t.x[0] + v * t.x[2])), x1 = set1(static_cast<float>(t.x[1]));
  const vf y0 = set1(static_cast<float>(t.y[0] + v * t.y[2])), y1 = set1(static_cast<float>(t.y[1]));
  const vf z0 = set1(static_cast<float>(t.z[0] + v * t.z[2])), z1 = set1(static_cast<float>(t.z[1]));
  const vf one = set1(1.0F), last = set1(static_cast<float>(columns - 1 - columns / 2));
  const vf left = set1(static_cast<float>(-t.ox)), right = set1(static_cast<float>(a.width - 1 - t.ox));
  const vf top = set1(static_cast<float>(-t.oy)), bottom = set1(static_cast<float>(a.height - 1 - t.oy));
  const vf step = set1(static_cast<float>(kLanes));
  const vi stride = seti(static_cast<int>(a.source_stride)), size = seti(pixel);
  vf next = add(iota(), set1(static_cast<float>(-(columns / 2))));
  int inside = path == kWarpSparse ? 0 : columns;
  for (int k = 0; k < columns; k += kLanes) {
    const vf u = min_(next, last), r = div(one, madd(z1, u, z0));
    next = add(next, step);
    vf x = mul(madd(x1, u, x0), r), y = mul(madd(y1, u, y0), r), cell_x, cell_y;
    if (path == kWarpSparse) {
      const vm front = gt(madd(z1, u, z0), zero());
      const vm in = and_(front, and_(and_(ge(x, left), le(x, right)), and_(ge(y, top), le(y, bottom))));
      inside += count_true(and_(in, first_n(columns - k)));
      storei(s->inside + k, to_int(keep(in, one)));
      x = min_(max_(x, left), right);  // NaN becomes `left`
      y = min_(max_(y, top), bottom);
      cell_x = min_(floor_(x), sub(right, one));
      cell_y = min_(floor_(y), sub(bottom, one));
    } else {
      cell_x = floor_(x);
      cell_y = floor_(y);
    }
    store(s->dx + k, sub(x, cell_x));
    store(s->dy + k, sub(y, cell_y));
    if (path == kWarpTiles) {
      storei(s->x + k, to_int(cell_x));
      storei(s->y + k, to_int(cell_y));
    } else {
      storei(s->offset + k, addi(muli(to_int(cell_y), stride), muli(to_int(cell_x), size)));
    }
  }
  return inside;
}

// The word of taps whose first pixel is p.
TEXTPLANE_SIMD_INLINE std::uint32_t warp_cell_taps(const std::uint8_t* p, std::ptrdiff_t stride) noexcept {
  const std::uint8_t* q = p + stride;
  const std::uint32_t upper = p[0] | static_cast<std::uint32_t>(p[1]) << 8;
  const std::uint32_t lower = q[0] | static_cast<std::uint32_t>(q[1]) << 8;
  return upper | lower << 16;
}

// Taps of pixels k to k + kLanes - 1 by shuffles, `origin` being the address of the block's origin. The left-most and
// the top-most pixel of a tile is its first or its last. *rows collects the rows that pixels lie below the top-most.
TEXTPLANE_SIMD_INLINE taps_t warp_tile_taps(const WarpBlock& t, const std::uint8_t* origin, std::ptrdiff_t stride,
                                            int k, const WarpStrip* s, vi* rows) noexcept {
  enum : int { kStep = kTileLanes > 0 ? kTileLanes : 1, kTiles = kLanes / kStep };
  const int *left = s->x + k + (t.leftwards ? kStep - 1 : 0), *top = s->y + k + (t.upwards ? kStep - 1 : 0);
  const std::uint8_t* corner[kTiles];
  for (int i = 0; i < kTiles; ++i) corner[i] = origin + top[i * kStep] * stride + left[i * kStep];
  const vi x = subi(loadi(s->x + k), per_tile(left)), y = subi(loadi(s->y + k), per_tile(top));
  *rows = ori(*rows, y);
  return tile_taps(corner, stride, x, y);
}

// Fetches the taps of a row one by one. A pass of its own: vector loads right behind the stores that they need would
// wait.
TEXTPLANE_SIMD_INLINE void warp_fetch(const std::uint8_t* origin, std::ptrdiff_t stride, int columns, int kind,
                                      WarpStrip* TEXTPLANE_SIMD_RESTRICT s) noexcept {
  // Lanes beyond the last column repeat it.
  const int n = (columns + kLanes - 1) / kLanes * kLanes;
  for (int i = 0; i < n; ++i) {
    const std::uint8_t* p = origin + s->offset[i];
    if (kind == kWarpFF) {
      TEXTPLANE_SIMD_COPY(s->upper + 2 * i, p, 8);
      TEXTPLANE_SIMD_COPY(s->lower + 2 * i, p + stride, 8);
    } else {
      s->taps[i] = warp_cell_taps(p, stride);
    }
  }
}

// Interpolated values of pixels k to k + kLanes - 1 of a row.
TEXTPLANE_SIMD_INLINE vf warp_values(const WarpBlock& t, const std::uint8_t* origin, std::ptrdiff_t stride, float fill,
                                     int k, int kind, int path, const WarpStrip* s, vi* rows) noexcept {
  const vf dx = load(s->dx + k), dy = load(s->dy + k);
  vf value;
  if (kind == kWarpFF) {
    vf i00, i10, i01, i11;
    load2(s->upper + 2 * k, &i00, &i10);
    load2(s->lower + 2 * k, &i01, &i11);
    const vf upper = madd(dx, sub(i10, i00), i00), lower = madd(dx, sub(i11, i01), i01);
    value = madd(dy, sub(lower, upper), upper);
  } else {
    const taps_t taps = path == kWarpTiles ? warp_tile_taps(t, origin, stride, k, s, rows) : load_taps(s->taps + k);
    value = madd(dy, madd(dx, tap_dxy(taps), tap_dy(taps)), madd(dx, tap_dx(taps), tap_value(taps)));
  }
  return path == kWarpSparse ? select(gt(to_float(loadi(s->inside + k)), zero()), value, set1(fill)) : value;
}

// Interpolates a row of the block and writes it to `out`. False, and to be done by another path, where tiles did not
// suffice: rounding moved a pixel of a nearly level row across a pixel line.
TEXTPLANE_SIMD_INLINE bool warp_row(const WarpBlock& t, const std::uint8_t* origin, std::ptrdiff_t stride, float fill,
                                    void* TEXTPLANE_SIMD_RESTRICT out, int kind, int path,
                                    const WarpStrip* TEXTPLANE_SIMD_RESTRICT s) noexcept {
  float* floats = static_cast<float*>(out);
  std::uint8_t* bytes = static_cast<std::uint8_t*>(out);
  const vf half = set1(0.5F);
  vi rows = seti(0);
  int k = 0;
  for (; k + kLanes <= t.columns; k += kLanes) {
    const vf value = warp_values(t, origin, stride, fill, k, kind, path, s, &rows);
    if (kind == kWarp88) {
      store_u8(bytes + k, to_int(add(value, half)));
    } else {
      store(floats + k, value);
    }
  }
  if (k < t.columns) {
    const vf value = warp_values(t, origin, stride, fill, k, kind, path, s, &rows);
    if (kind == kWarp88) {
      std::uint8_t last[kLanes];
      store_u8(last, to_int(add(value, half)));
      for (int i = 0; k + i < t.columns; ++i) bytes[k + i] = last[i];
    } else {
      store_n(floats + k, value, t.columns - k);
    }
  }
  return path != kWarpTiles || in_two_rows(rows);
}

// One block by one path. Returns how many pixels are inside.
TEXTPLANE_SIMD_INLINE int warp_block_by(const simd::WarpArgs& a, const WarpBlock& t, int first_x, int first_y, int kind,
                                        int path, WarpStrip* s) noexcept {
  const int pixel = kind == kWarpFF ? 4 : 1, out_pixel = kind == kWarp88 ? 1 : 4;
  const std::ptrdiff_t stride = a.source_stride;
  const std::uint8_t* origin = static_cast<const std::uint8_t*>(a.source) + t.oy * stride + t.ox * pixel;
  const float fill = a.fill;
  int inside = 0;
  for (int row = 0; row < t.rows; ++row) {
    const int y = first_y + row;
    inside += warp_coordinates(a, t, row - t.rows / 2, pixel, path, s);
    if (path != kWarpTiles) warp_fetch(origin, stride, t.columns, kind, s);
    std::uint8_t* out = static_cast<std::uint8_t*>(a.out) + y * a.out_stride + first_x * out_pixel;
    if (!warp_row(t, origin, stride, fill, out, kind, path, s)) {
      warp_coordinates(a, t, row - t.rows / 2, pixel, kWarpDense, s);
      warp_fetch(origin, stride, t.columns, kind, s);
      warp_row(t, origin, stride, fill, out, kind, kWarpDense, s);
    }
    if (a.mask == nullptr) continue;
    std::uint8_t* mask = a.mask + y * a.mask_stride + first_x;
    for (int k = 0; k < t.columns; ++k) mask[k] = static_cast<std::uint8_t>(path == kWarpSparse ? s->inside[k] : 1);
  }
  return inside;
}

TEXTPLANE_SIMD_INLINE int warp(const simd::WarpArgs& a, int kind) noexcept {
  bool valid = a.width >= 2 && a.height >= 2 && a.source_stride <= 0x7fffffff / a.height;
  for (int i = 0; i < 9; ++i) valid = valid && warp_finite(a.h[i]);
  if (!valid) return -1;
  WarpStrip strip;
  int inside = 0;
  // Blocks are of one size whatever the target, so that all targets round alike.
  for (int y = 0; y < a.out_height; y += kWarpBlockHeight)
    for (int x = 0; x < a.out_width; x += kWarpBlockWidth) {
      const WarpBlock block = warp_block(a, x, y);
      if (kind != kWarpFF && kTileLanes > 0 && block.tiles) {
        inside += warp_block_by(a, block, x, y, kind, kWarpTiles, &strip);
      } else if (block.dense) {
        inside += warp_block_by(a, block, x, y, kind, kWarpDense, &strip);
      } else {
        inside += warp_block_by(a, block, x, y, kind, kWarpSparse, &strip);
      }
    }
  return inside;
}

TEXTPLANE_SIMD_ENTRY int warp_u8_f32(const simd::WarpArgs& a) noexcept { return warp(a, kWarp8F); }
TEXTPLANE_SIMD_ENTRY int warp_u8_u8(const simd::WarpArgs& a) noexcept { return warp(a, kWarp88); }
TEXTPLANE_SIMD_ENTRY int warp_f32_f32(const simd::WarpArgs& a) noexcept { return warp(a, kWarpFF); }
