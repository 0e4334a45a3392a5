// The lens step between warp and taps (simd/lens.hpp). Include before: kernels/sample.inl.
//
// With w = p1 y + p2 x the model is m_d = (s + 2 w) m + r^2 (p2, p1). The pinhole image has the focal lengths
// (fx, fy) (s0 + 2 w0) and shows m0 where the lens does. So what the lens shows at m is a pixel of it, moved by
// fx (change m + (r^2 - |m0|^2) (p2, p1)) in x, change being s + 2 w less that at m0; likewise in y.

// The frame of a fit for a pinhole (fx, fy, cx, cy) and an image of this size. False where float does not hold it.
TEXTPLANE_SIMD_INLINE bool make_lens_frame(const simd::LensFit& fit, const double* camera, int width, int height,
                                           LensFrame* l) noexcept {
  const double fx = camera[0], fy = camera[1], x = fit.m0[0], y = fit.m0[1], p1 = fit.p[0], p2 = fit.p[1];
  const double r0 = fit.r0, s = fit.c[0] + 2 * (p1 * y + p2 * x);
  const double px = fx * (s * x + r0 * p2) + camera[2], py = fy * (s * y + r0 * p1) + camera[3];
  if (!(px > -1e6 && px < 1e6 && py > -1e6 && py < 1e6 && r0 < 1e6)) return false;
  if (!(s > 1e-3 && fx > 1e-20 && fy > 1e-20)) return false;
  l->ox = !(px > 0) ? 0 : px < width - 1 ? static_cast<int>(px + 0.5) : width - 1;
  l->oy = !(py > 0) ? 0 : py < height - 1 ? static_cast<int>(py + 0.5) : height - 1;
  const double x_scale = 1 / (fx * s), y_scale = 1 / (fy * s), ax = px - l->ox, ay = py - l->oy;
  l->camera[0] = fx * s;
  l->camera[1] = fy * s;
  l->camera[2] = px - l->camera[0] * x;
  l->camera[3] = py - l->camera[1] * y;
  l->x_scale = static_cast<float>(x_scale);
  l->y_scale = static_cast<float>(y_scale);
  l->x_shift = static_cast<float>(x - ax * x_scale);
  l->y_shift = static_cast<float>(y - ay * y_scale);
  l->r0 = static_cast<float>(r0);
  l->aspect = static_cast<float>(fy / fx);
  const bool all = fit.terms > 6 || (fit.terms > 3 && (p1 != 0 || p2 != 0));
  l->terms = all ? static_cast<int>(simd::kLensTerms) : fit.terms;
  for (int k = 0; k < l->terms; ++k) {
    l->c[k] = static_cast<float>(fx * fit.c[k + 1]);
    l->slope[k] = static_cast<float>(2 / s * (k + 1) * fit.c[k + 1]);
  }
  l->p1 = static_cast<float>(2 * fx * p1 * y_scale);
  l->p2 = static_cast<float>(2 * fx * p2 * x_scale);
  l->p0 = static_cast<float>(-2 * fx * (p1 * ay * y_scale + p2 * ax * x_scale));
  l->tx = static_cast<float>(fx * p2);
  l->ty = static_cast<float>(fy * p1);
  l->t_low = static_cast<float>(fit.low - r0);
  l->t_high = static_cast<float>(fit.high - r0);
  l->tangential = p1 != 0 || p2 != 0;
  l->on = true;
  return true;
}
// The same image with the origin moved by (dx, dy).
TEXTPLANE_SIMD_INLINE void move_lens_origin(int dx, int dy, LensFrame* l) noexcept {
  const float x = static_cast<float>(dx), y = static_cast<float>(dy);
  l->x_shift += x * l->x_scale;
  l->y_shift += y * l->y_scale;
  l->p0 += l->p2 * x + l->p1 * y;
}

// The constants of a frame in all lanes.
struct LensVectors {
  vf x_scale, x_shift, y_scale, y_shift, r0, aspect, p1, p2, p0, tx, ty;
};
TEXTPLANE_SIMD_INLINE LensVectors broadcast_lens(const LensFrame& l) noexcept {
  return LensVectors{set1(l.x_scale), set1(l.x_shift), set1(l.y_scale), set1(l.y_shift), set1(-l.r0), set1(l.aspect),
                     set1(l.p1),      set1(l.p2),      set1(l.p0),      set1(l.tx),      set1(l.ty)};
}

// How a lens is evaluated: by so many terms, with a tangential part or without.
enum LensKind : int { kLensShort, kLensTangential, kLensMiddle, kLensLong };
TEXTPLANE_SIMD_INLINE int lens_kind(const LensFrame& l) noexcept {
  return l.terms > 6 ? kLensLong : l.terms > 3 ? kLensMiddle : l.tangential ? kLensTangential : kLensShort;
}

// Image positions of kLanes pixels (ex, ey) of the pinhole image, and their t. With `slopes`, what LensStrip holds of
// them.
TEXTPLANE_SIMD_INLINE void lens_vector(const LensFrame& l, const LensVectors& v, int kind, bool slopes, vf ex, vf ey,
                                       vf* out_x, vf* out_y, vf* out_t, vf* s, vf* slope) noexcept {
  const int terms = kind == kLensLong ? static_cast<int>(simd::kLensTerms) : kind == kLensMiddle ? 6 : 3;
  const bool tangential = kind == kLensLong || kind == kLensTangential;
  const vf x = madd(v.x_scale, ex, v.x_shift), y = madd(v.y_scale, ey, v.y_shift);
  const vf t = madd(x, x, madd(y, y, v.r0));
  vf change = set1(l.c[terms - 1]);
  TEXTPLANE_SIMD_UNROLL
  for (int k = terms - 2; k >= 0; --k) change = madd(change, t, set1(l.c[k]));
  change = tangential ? madd(change, t, madd(v.p1, ey, madd(v.p2, ex, v.p0))) : mul(change, t);
  *out_x = madd(change, x, tangential ? madd(v.tx, t, ex) : ex);
  *out_y = madd(mul(change, v.aspect), y, tangential ? madd(v.ty, t, ey) : ey);
  *out_t = t;
  if (!slopes) return;
  vf derivative = set1(l.slope[terms - 1]);
  TEXTPLANE_SIMD_UNROLL
  for (int k = terms - 2; k >= 0; --k) derivative = madd(derivative, t, set1(l.slope[k]));
  *s = madd(change, v.x_scale, set1(1.0F));
  *slope = derivative;
}

// One vector of positions; where the lens has no pixel for them, far outside of every image.
TEXTPLANE_SIMD_ENTRY void lens_or_outside(const LensFrame& l, vf ex, vf ey, vf* out_x, vf* out_y) noexcept {
  const LensVectors v = broadcast_lens(l);
  vf x, y, t, unused_s, unused_slope;
  switch (lens_kind(l)) {
    case kLensShort: lens_vector(l, v, kLensShort, false, ex, ey, &x, &y, &t, &unused_s, &unused_slope); break;
    case kLensTangential:
      lens_vector(l, v, kLensTangential, false, ex, ey, &x, &y, &t, &unused_s, &unused_slope);
      break;
    case kLensMiddle: lens_vector(l, v, kLensMiddle, false, ex, ey, &x, &y, &t, &unused_s, &unused_slope); break;
    default: lens_vector(l, v, kLensLong, false, ex, ey, &x, &y, &t, &unused_s, &unused_slope);
  }
  const vm held = and_(ge(t, set1(l.t_low)), le(t, set1(l.t_high)));
  *out_x = select(held, x, set1(-1e9F));
  *out_y = select(held, y, set1(-1e9F));
}

// Pixels of the pinhole image of n <= kStrip host pixels. Whole vectors are written. (One loop for this and the lens
// measured slower.)
TEXTPLANE_SIMD_INLINE void warp_before_lens(const simd::Warp8& w, const float* TEXTPLANE_SIMD_RESTRICT px,
                                            const float* TEXTPLANE_SIMD_RESTRICT py, int n,
                                            float* TEXTPLANE_SIMD_RESTRICT x,
                                            float* TEXTPLANE_SIMD_RESTRICT y) noexcept {
  const WarpVectors warp = broadcast_warp(w);
  for (int i = 0; i < n; i += kLanes) {
    vf ex, ey, divisor;
    warp_vector(warp, load_part(px + i, n - i), load_part(py + i, n - i), &ex, &ey, &divisor);
    store(x + i, ex);
    store(y + i, ey);
  }
}

// The lens of n such pixels x, y: cells of their image positions to the strip; the first `held`, whole v16, as cells of
// tiles. Whole vectors are written.
TEXTPLANE_SIMD_INLINE void lens_loop(const SampleFrame& f, const LensFrame& l, int kind, bool slopes,
                                     const ImageTiles& tiles, int held, int n, const float* TEXTPLANE_SIMD_RESTRICT x,
                                     const float* TEXTPLANE_SIMD_RESTRICT y, SampleStrip* TEXTPLANE_SIMD_RESTRICT strip,
                                     LensStrip* TEXTPLANE_SIMD_RESTRICT lens) noexcept {
  const LensVectors v = broadcast_lens(l);
  vf at_x, at_y, unused_t, s, slope;
  if (kInt16Tiles != 0 && held > 0) {
    const vf x_low = set1(f.x_low), x_high = set1(static_cast<float>(tiles.x_high));
    const vf y_low = set1(f.y_low), y_high = set1(static_cast<float>(tiles.y_high));
    vi a[2], b[2];
    for (int i = 0; i < held; i += k16Lanes) {
      TEXTPLANE_SIMD_UNROLL
      for (int k = 0; k < 2; ++k) {
        const int j = i + k * kLanes;
        lens_vector(l, v, kind, slopes, load(x + j), load(y + j), &at_x, &at_y, &unused_t, &s, &slope);
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
    lens_vector(l, v, kind, slopes, load(x + i), load(y + i), &at_x, &at_y, &unused_t, &s, &slope);
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
  warp_before_lens(w, px, py, n, x, y);
  switch (lens_kind(l)) {
    case kLensShort: return lens_loop(f, l, kLensShort, slopes, tiles, held, n, x, y, strip, lens);
    case kLensTangential: return lens_loop(f, l, kLensTangential, slopes, tiles, held, n, x, y, strip, lens);
    case kLensMiddle: return lens_loop(f, l, kLensMiddle, slopes, tiles, held, n, x, y, strip, lens);
    default: return lens_loop(f, l, kLensLong, slopes, tiles, held, n, x, y, strip, lens);
  }
}

// Values of n cells, and gradients by e: the transpose of the lens's derivative turns those of the image. x, y are
// pixels of the pinhole image. With S = 1 + x_scale change and out = x gx + aspect y gy the gradient is
// S (gx, gy) + along (x, y / aspect) + (p2, p1) out, along = slope out + 2 x_scale (tx gx + ty gy).
TEXTPLANE_SIMD_INLINE void interpolate_behind(const LensFrame& l, bool tangential, bool paired,
                                              const SampleStrip& strip, const LensStrip& lens,
                                              const float* TEXTPLANE_SIMD_RESTRICT x,
                                              const float* TEXTPLANE_SIMD_RESTRICT y, int n,
                                              float* TEXTPLANE_SIMD_RESTRICT value, float* TEXTPLANE_SIMD_RESTRICT a,
                                              float* TEXTPLANE_SIMD_RESTRICT b) noexcept {
  const float wide = 1.0F / l.aspect;
  const vf x_scale = set1(l.x_scale), x_shift = set1(l.x_shift), out_scale = set1(l.y_scale * l.aspect),
           out_shift = set1(l.y_shift * l.aspect), along_scale = set1(l.y_scale * wide),
           along_shift = set1(l.y_shift * wide), p1 = set1(l.p1), p2 = set1(l.p2), tx = set1(2.0F * l.x_scale * l.tx),
           ty = set1(2.0F * l.x_scale * l.ty);
  for (int i = 0; i < n; i += kLanes) {
    vf here, gx, gy;
    interpolate_vector(strip, i, paired, &here, &gx, &gy);
    const vf ey = load(y + i), X = madd(x_scale, load(x + i), x_shift), s = load(lens.s + i);
    const vf out = madd(gx, X, mul(gy, madd(out_scale, ey, out_shift))), Y = madd(along_scale, ey, along_shift);
    vf along = mul(load(lens.slope + i), out), ga, gb;
    if (tangential) {
      along = madd(tx, gx, madd(ty, gy, along));
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

// Columns (a, c) and (b, d) of a derivative of e become those of image positions, at m0.
TEXTPLANE_SIMD_INLINE void lens_turn(const LensFrame& l, float* a, float* b, float* c, float* d) noexcept {
  const float x = l.x_shift, y = l.y_shift, r = l.aspect, slope = l.slope[0];
  const float by_x = slope * x + l.p2, by_y = slope * y / r + l.p1;
  const float xx = 1.0F + x * by_x + 2.0F * l.tx * x * l.x_scale, xy = x * by_y + 2.0F * l.tx * y * l.y_scale;
  const float yx = r * y * by_x + 2.0F * l.ty * x * l.x_scale, yy = 1.0F + r * y * by_y + 2.0F * l.ty * y * l.y_scale;
  const float a0 = *a, b0 = *b, c0 = *c, d0 = *d;
  *a = xx * a0 + xy * c0;
  *b = xx * b0 + xy * d0;
  *c = yx * a0 + yy * c0;
  *d = yx * b0 + yy * d0;
}
