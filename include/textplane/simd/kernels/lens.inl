// The lens step between warp and taps (simd/lens.hpp). Include before: kernels/sample.inl.
//
// With w = p1 y + p2 x the model is m_d = (s + 2 w) m + r^2 (p2, p1). Relative to m0: d = m - m0, change = s + 2 w less
// that at m0; then m_d moves by change m + (s0 + 2 w0) d + (r^2 - |m0|^2) (p2, p1).

// The frame of a fit for a pinhole (fx, fy, cx, cy) and an image of this size. False where that is too far out for
// float.
TEXTPLANE_SIMD_INLINE bool make_lens_frame(const simd::LensFit& fit, const double* camera, int width, int height,
                                           LensFrame* l) noexcept {
  const double fx = camera[0], fy = camera[1], x = fit.m0[0], y = fit.m0[1], p1 = fit.p[0], p2 = fit.p[1];
  const double r0 = fit.r0, s = fit.c[0] + 2 * (p1 * y + p2 * x);
  const double px = fx * (s * x + r0 * p2) + camera[2], py = fy * (s * y + r0 * p1) + camera[3];
  if (!(px > -1e6 && px < 1e6 && py > -1e6 && py < 1e6 && r0 < 1e6)) return false;
  l->ox = !(px > 0) ? 0 : px < width - 1 ? static_cast<int>(px + 0.5) : width - 1;
  l->oy = !(py > 0) ? 0 : py < height - 1 ? static_cast<int>(py + 0.5) : height - 1;
  l->mx = static_cast<float>(x);
  l->my = static_cast<float>(y);
  l->r0 = static_cast<float>(r0);
  l->sx = static_cast<float>(fx * s);
  l->sy = static_cast<float>(fy * s);
  l->aspect = static_cast<float>(fy / fx);
  l->ax = static_cast<float>(px - l->ox);
  l->ay = static_cast<float>(py - l->oy);
  for (int k = 0; k < simd::kLensTerms; ++k) {
    l->c[k] = static_cast<float>(fx * fit.c[k + 1]);
    l->slope[k] = static_cast<float>(2 * fx * (k + 1) * fit.c[k + 1]);
  }
  l->p1 = static_cast<float>(2 * fx * p1);
  l->p2 = static_cast<float>(2 * fx * p2);
  l->tx = static_cast<float>(fx * p2);
  l->ty = static_cast<float>(fy * p1);
  l->t_low = static_cast<float>(fit.low - r0);
  l->t_high = static_cast<float>(fit.high - r0);
  l->tangential = p1 != 0 || p2 != 0;
  l->terms = !l->tangential || fit.terms <= 3 ? fit.terms : static_cast<int>(simd::kLensTerms);
  l->on = true;
  return true;
}

// The constants of a frame in all lanes.
struct LensVectors {
  vf mx, my, r0, sx, sy, aspect, ax, ay, p1, p2, tx, ty;
};
TEXTPLANE_SIMD_INLINE LensVectors broadcast_lens(const LensFrame& l) noexcept {
  return LensVectors{set1(l.mx), set1(l.my), set1(-l.r0), set1(l.sx), set1(l.sy), set1(l.aspect),
                     set1(l.ax), set1(l.ay), set1(l.p1),  set1(l.p2), set1(l.tx), set1(l.ty)};
}

// How a lens is evaluated: by so many terms, with a tangential part or without.
enum LensKind : int { kLensShort, kLensTangential, kLensMiddle, kLensLong };
TEXTPLANE_SIMD_INLINE int lens_kind(const LensFrame& l) noexcept {
  return l.terms > 6 ? kLensLong : l.terms > 3 ? kLensMiddle : l.tangential ? kLensTangential : kLensShort;
}

// Image positions of kLanes rays m0 + (dx, dy), and their t. With `slopes`, what LensStrip holds of them.
TEXTPLANE_SIMD_INLINE void lens_vector(const LensFrame& l, const LensVectors& v, int kind, bool slopes, vf dx, vf dy,
                                       vf* out_x, vf* out_y, vf* out_t, vf* s, vf* slope) noexcept {
  const int terms = kind == kLensLong ? static_cast<int>(simd::kLensTerms) : kind == kLensMiddle ? 6 : 3;
  const bool tangential = kind == kLensLong || kind == kLensTangential;
  const vf x = add(dx, v.mx), y = add(dy, v.my), t = madd(x, x, madd(y, y, v.r0));
  vf change = set1(l.c[terms - 1]);
  TEXTPLANE_SIMD_UNROLL
  for (int k = terms - 2; k >= 0; --k) change = madd(change, t, set1(l.c[k]));
  change = mul(change, t);
  if (tangential) change = madd(v.p1, dy, madd(v.p2, dx, change));
  vf at_x = madd(v.sx, dx, v.ax), at_y = madd(v.sy, dy, v.ay);
  if (tangential) {
    at_x = madd(v.tx, t, at_x);
    at_y = madd(v.ty, t, at_y);
  }
  *out_x = madd(change, x, at_x);
  *out_y = madd(mul(change, v.aspect), y, at_y);
  *out_t = t;
  if (!slopes) return;
  vf derivative = set1(l.slope[terms - 1]);
  TEXTPLANE_SIMD_UNROLL
  for (int k = terms - 2; k >= 0; --k) derivative = madd(derivative, t, set1(l.slope[k]));
  *s = add(v.sx, change);
  *slope = derivative;
}

// One vector of positions; where the lens has no pixel for them, far outside of every image.
TEXTPLANE_SIMD_ENTRY void lens_or_outside(const LensFrame& l, vf dx, vf dy, vf* out_x, vf* out_y) noexcept {
  const LensVectors v = broadcast_lens(l);
  vf x, y, t, unused_s, unused_slope;
  switch (lens_kind(l)) {
    case kLensShort: lens_vector(l, v, kLensShort, false, dx, dy, &x, &y, &t, &unused_s, &unused_slope); break;
    case kLensTangential:
      lens_vector(l, v, kLensTangential, false, dx, dy, &x, &y, &t, &unused_s, &unused_slope);
      break;
    case kLensMiddle: lens_vector(l, v, kLensMiddle, false, dx, dy, &x, &y, &t, &unused_s, &unused_slope); break;
    default: lens_vector(l, v, kLensLong, false, dx, dy, &x, &y, &t, &unused_s, &unused_slope);
  }
  const vm held = and_(ge(t, set1(l.t_low)), le(t, set1(l.t_high)));
  *out_x = select(held, x, set1(-1e9F));
  *out_y = select(held, y, set1(-1e9F));
}

// Warp and lens of n <= kStrip host pixels: rays to x and y, cells of their image positions to the strip; the first
// `held`, whole v16, as cells of tiles. Whole vectors are written.
TEXTPLANE_SIMD_INLINE void lens_loop(const simd::Warp8& w, const SampleFrame& f, const LensFrame& l, int kind,
                                     bool slopes, const ImageTiles& tiles, int held,
                                     const float* TEXTPLANE_SIMD_RESTRICT px, const float* TEXTPLANE_SIMD_RESTRICT py,
                                     int n, float* TEXTPLANE_SIMD_RESTRICT x, float* TEXTPLANE_SIMD_RESTRICT y,
                                     SampleStrip* TEXTPLANE_SIMD_RESTRICT strip,
                                     LensStrip* TEXTPLANE_SIMD_RESTRICT lens) noexcept {
  const WarpVectors warp = broadcast_warp(w);
  const LensVectors v = broadcast_lens(l);
  vf dx, dy, divisor, at_x, at_y, unused_t, s, slope;
  if (kInt16Tiles != 0 && held > 0) {
    const vf x_low = set1(f.x_low), x_high = set1(static_cast<float>(tiles.x_high));
    const vf y_low = set1(f.y_low), y_high = set1(static_cast<float>(tiles.y_high));
    vi a[2], b[2];
    for (int i = 0; i < held; i += k16Lanes) {
      TEXTPLANE_SIMD_UNROLL
      for (int k = 0; k < 2; ++k) {
        const int j = i + k * kLanes;
        warp_vector(warp, load(px + j), load(py + j), &dx, &dy, &divisor);
        lens_vector(l, v, kind, slopes, dx, dy, &at_x, &at_y, &unused_t, &s, &slope);
        store(x + j, dx);
        store(y + j, dy);
        if (slopes) {
          store(lens->s + j, s);
          store(lens->slope + j, slope);
        }
        a[k] = to_int(tile_cell(at_x, x_low, x_high, strip->fx + j));
        b[k] = to_int(tile_cell(at_y, y_low, y_high, strip->fy + j));
      }
      store16(strip->x + i, pack16(a[0], a[1]));
      store16(strip->y + i, pack16(b[0], b[1]));
    }
  }
  const CellVectors cells = broadcast_cells(f);
  for (int i = held; i < n; i += kLanes) {
    warp_vector(warp, load_part(px + i, n - i), load_part(py + i, n - i), &dx, &dy, &divisor);
    lens_vector(l, v, kind, slopes, dx, dy, &at_x, &at_y, &unused_t, &s, &slope);
    store(x + i, dx);
    store(y + i, dy);
    if (slopes) {
      store(lens->s + i, s);
      store(lens->slope + i, slope);
    }
    cell_vector(cells, at_x, at_y, strip, i);
  }
}
TEXTPLANE_SIMD_INLINE void lens_strip(const simd::Warp8& w, const SampleFrame& f, const LensFrame& l, bool slopes,
                                      const ImageTiles& tiles, int held, const float* px, const float* py, int n,
                                      float* x, float* y, SampleStrip* strip, LensStrip* lens) noexcept {
  switch (lens_kind(l)) {
    case kLensShort: return lens_loop(w, f, l, kLensShort, slopes, tiles, held, px, py, n, x, y, strip, lens);
    case kLensTangential: return lens_loop(w, f, l, kLensTangential, slopes, tiles, held, px, py, n, x, y, strip, lens);
    case kLensMiddle: return lens_loop(w, f, l, kLensMiddle, slopes, tiles, held, px, py, n, x, y, strip, lens);
    default: return lens_loop(w, f, l, kLensLong, slopes, tiles, held, px, py, n, x, y, strip, lens);
  }
}

// Values of n cells, and gradients by m: the transpose of the lens's derivative turns those of the image. x, y are
// rays.
TEXTPLANE_SIMD_INLINE void interpolate_behind(const LensFrame& l, bool tangential, bool paired,
                                              const SampleStrip& strip, const LensStrip& lens,
                                              const float* TEXTPLANE_SIMD_RESTRICT x,
                                              const float* TEXTPLANE_SIMD_RESTRICT y, int n,
                                              float* TEXTPLANE_SIMD_RESTRICT value, float* TEXTPLANE_SIMD_RESTRICT a,
                                              float* TEXTPLANE_SIMD_RESTRICT b) noexcept {
  const vf mx = set1(l.mx), my = set1(l.my), aspect = set1(l.aspect), p1 = set1(l.p1), p2 = set1(l.p2);
  for (int i = 0; i < n; i += kLanes) {
    vf here, gx, gy;
    interpolate_vector(strip, i, paired, &here, &gx, &gy);
    const vf X = add(load(x + i), mx), Y = add(load(y + i), my), s = load(lens.s + i);
    gy = mul(gy, aspect);
    const vf out = madd(gx, X, mul(gy, Y));
    vf along = mul(load(lens.slope + i), out), ga, gb;
    if (tangential) {
      along = madd(p2, gx, madd(p1, gy, along));
      ga = madd(along, X, madd(s, gx, mul(p2, out)));
      gb = madd(along, Y, madd(s, gy, mul(p1, out)));
    } else {
      ga = madd(along, X, mul(s, gx));
      gb = madd(along, Y, mul(s, gy));
    }
    store(value + i, here);
    store(a + i, ga);
    store(b + i, gb);
  }
}

// Columns (a, c) and (b, d) of a derivative of rays become those of image positions, at m0.
TEXTPLANE_SIMD_INLINE void lens_turn(const LensFrame& l, float* a, float* b, float* c, float* d) noexcept {
  const float slope = l.slope[0], x = l.mx, y = l.my, r = l.aspect;
  const float xx = l.sx + x * (slope * x + l.p2) + 2.0F * l.tx * x, xy = x * (slope * y + l.p1) + 2.0F * l.tx * y;
  const float yx = r * y * (slope * x + l.p2) + 2.0F * l.ty * x,
              yy = l.sy + r * y * (slope * y + l.p1) + 2.0F * l.ty * y;
  const float a0 = *a, b0 = *b, c0 = *c, d0 = *d;
  *a = xx * a0 + xy * c0;
  *b = xx * b0 + xy * d0;
  *c = yx * a0 + yy * c0;
  *d = yx * b0 + yy * d0;
}

// Points on each side of a box, corners included once: how finely its border is looked at.
enum : int { kBorderSide = 4, kBorder = 4 * kBorderSide };

// Bounds of image positions of a patch from those of its border, which bound them: the lens has an inverse where it
// holds. What the border does between two points, a share of its second difference says.
TEXTPLANE_SIMD_INLINE void bound_border(const float* x, const float* y, float* box) noexcept {
  float bend = 0.0F;
  for (int axis = 0; axis < 2; ++axis) {
    const float* p = axis == 0 ? x : y;
    float low = p[0], high = p[0];
    for (int k = 0; k < kBorder; ++k) {
      const float here = p[k];
      low = here < low ? here : low;
      high = here > high ? here : high;
      if (k % kBorderSide == 0) continue;  // a corner
      const float turn = p[k - 1] - 2.0F * here + p[k + 1 < kBorder ? k + 1 : 0], size = turn < 0 ? -turn : turn;
      bend = size > bend ? size : bend;
    }
    box[axis] = low;
    box[2 + axis] = high;
  }
  const float margin = 0.5F * bend;
  box[0] -= margin;
  box[1] -= margin;
  box[2] += margin;
  box[3] += margin;
}
