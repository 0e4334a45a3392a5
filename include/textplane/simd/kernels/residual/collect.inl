// From host pixels to sampled target pixels (simd/residual.hpp). Include before: residual/frame.inl.

TEXTPLANE_SIMD_INLINE void make_arrays(float* scratch, int n, ResidualArrays* s) noexcept {
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(simd::residual_scratch(n) / 10);
  s->x = scratch;
  s->y = scratch + step;
  s->a = scratch + 2 * step;
  s->b = scratch + 3 * step;
  s->i = scratch + 4 * step;
  s->d = scratch + 5 * step;
  s->hx = scratch + 6 * step;
  s->hy = scratch + 7 * step;
  s->h = scratch + 8 * step;
  s->list = reinterpret_cast<std::int32_t*>(scratch + 9 * step);
}

// True if none of n bytes is zero.
TEXTPLANE_SIMD_INLINE bool all_set(const std::uint8_t* p, int n) noexcept {
  int i = 0;
  for (; i + 8 <= n; i += 8) {
    std::uint64_t w;
    copy_bytes(&w, p + i, 8);
    if (((w - 0x0101010101010101ULL) & ~w & 0x8080808080808080ULL) != 0) return false;
  }
  for (; i < n; ++i)
    if (p[i] == 0) return false;
  return true;
}

// Sets n bytes to 1.
TEXTPLANE_SIMD_INLINE void set_all(std::uint8_t* p, int n) noexcept {
  enum : int { kSize = 4 * kLanes };
  const vi ones = seti(0x01010101);
  int i = 0;
  for (; i + kSize <= n; i += kSize) copy_bytes(p + i, &ones, kSize);
  if (i > 0) {
    copy_bytes(p + (n - kSize), &ones, kSize);  // some a second time
    return;
  }
  for (; i < n; ++i) p[i] = 1;
}

// Closes up the visible pixels into hx, hy, h; counts; flags.
TEXTPLANE_SIMD_ENTRY void close_up(const simd::ResidualArgs& a, const ResidualFrame& f, const ResidualArrays& s,
                                   simd::ResidualInfo* info) noexcept {
  const WarpVectors warp = broadcast_warp(f.warp);
  int candidates = 0, front = 0, visible = 0;
  for (int i = 0; i < a.n; i += kLanes) {
    const int left = a.n - i < kLanes ? a.n - i : kLanes;
    unsigned b = (1U << left) - 1U;
    if (a.mask)
      for (int k = 0; k < left; ++k) b &= ~(static_cast<unsigned>(a.mask[i + k] == 0) << k);
    if (a.on_set)
      for (int k = 0; k < left; ++k) b &= ~(static_cast<unsigned>(a.on_set[i + k] == 0) << k);
    const vf px = load_part(a.x + i, left), py = load_part(a.y + i, left), h = load_part(a.intensity + i, left);
    vf x, y, divisor;
    warp_vector(warp, px, py, &x, &y, &divisor);
    const vf u = sub(px, set1(f.warp.hx)), v = sub(py, set1(f.warp.hy));
    const vf rho = madd(set1(f.rho[0]), u, madd(set1(f.rho[1]), v, set1(f.rho[2])));
    const vm ahead = and_(gt(rho, zero()), gt(divisor, zero()));
    if (f.lens.on) lens_or_outside(f.lens, x, y, &x, &y);
    const vm finite = le(abs_(h), set1(3.0e38F));
    const unsigned in_front = b & bits_from_mask(ahead),
                   seen = in_front & bits_from_mask(and_(inside_vector(f.sample, x, y, divisor), finite));
    if (seen == (1U << kLanes) - 1U) {
      store(s.hx + visible, px);
      store(s.hy + visible, py);
      store(s.h + visible, h);
      visible += kLanes;
    } else {
      for (int k = 0; k < left; ++k) {
        s.hx[visible] = a.x[i + k];
        s.hy[visible] = a.y[i + k];
        s.h[visible] = a.intensity[i + k];
        visible += static_cast<int>(seen >> k & 1U);
      }
    }
    if (a.flags)
      for (int k = 0; k < left; ++k) a.flags[i + k] = static_cast<std::uint8_t>(seen >> k & 1U);
    for (int k = 0; k < left; ++k) {
      candidates += static_cast<int>(b >> k & 1U);
      front += static_cast<int>(in_front >> k & 1U);
    }
  }
  info->candidates = candidates;
  info->behind = candidates - front;
  info->visible = visible;
}

// Where the host pixels of the strips come from. Sets the counts and the flags.
struct HostPixels {
  const float *x, *y, *h;
  int n;
};
// All of them, where the frame and the masks allow it; else (and where `close`) the visible ones, closed up.
TEXTPLANE_SIMD_INLINE HostPixels host_pixels(const simd::ResidualArgs& a, const ResidualFrame& f, bool close,
                                             const ResidualArrays& s, simd::ResidualInfo* info) noexcept {
  if (!close && f.inside && (!a.mask || all_set(a.mask, a.n)) && (!a.on_set || all_set(a.on_set, a.n))) {
    info->candidates = info->visible = a.n;
    info->behind = 0;
    if (a.flags) set_all(a.flags, a.n);
    return HostPixels{a.x, a.y, a.intensity, a.n};
  }
  close_up(a, f, s, info);
  return HostPixels{s.hx, s.hy, s.h, info->visible};
}

// Decides whether these host pixels take tiles. Where they do, no cell is closer to the right or the lower border than
// a tile and a pixel.
TEXTPLANE_SIMD_ENTRY void choose_tiles(const simd::ResidualArgs& a, const simd::PointBounds& bounds,
                                       const HostPixels& host, ResidualFrame* f) noexcept {
  const float *g = f->warp.g, z = 1 / g[8], x = g[2] * z, y = g[5] * z;
  if (!f->inside || a.target.pairs) return;
  float a0 = (g[0] - x * g[6]) * z, b0 = (g[1] - x * g[7]) * z, c0 = (g[3] - y * g[6]) * z, d0 = (g[4] - y * g[7]) * z;
  if (f->lens.on) lens_turn(f->lens, &a0, &b0, &c0, &d0);
  const TileGuess guess = guess_tiles(host.x, host.y, host.n, a0, b0, c0, d0);
  const simd::Image8& t = a.target;
  if (!guess.likely || !make_tiles(t.data, t.stride, t.width, t.height, f->warp.ox, f->warp.oy, &f->tiles)) return;
  SampleFrame inner = f->sample;
  inner.x_last = static_cast<float>(f->tiles.x_high);
  inner.y_last = static_cast<float>(f->tiles.y_high);
  if (box_inside(*f, inner, bounds)) f->tiles.guess = guess;
}

// Target coordinates, fractions and taps of n pixels, whole v16, by tiles. (Inlined, it would slow down what is
// without.)
TEXTPLANE_SIMD_ENTRY void collect_tiles(const ResidualFrame& f, const float* px, const float* py, int n, float* x,
                                        float* y, SampleStrip* strip) noexcept {
  warp_to_tiles(f.warp, f.sample, f.tiles, px, py, n, x, y, strip);
  fetch_tiles(f.tiles, n, strip);
}

// Strip of n host pixels from `begin` on: target coordinates, intensities, gradients (unless `values` alone are
// wanted). Whole vectors are written, zero beyond n.
TEXTPLANE_SIMD_INLINE void collect_any(const HostPixels& host, const ResidualFrame& f, int begin, int n, bool values,
                                       const ResidualArrays& s, SampleStrip* strip) noexcept {
  const float *px = host.x + begin, *py = host.y + begin;
  int held = 0;
  if (kInt16Tiles != 0 && f.tiles.guess.likely) {
    held = n / k16Lanes * k16Lanes;
    collect_tiles(f, px, py, held, s.x + begin, s.y + begin, strip);
  }
  warp_strip(f.warp, f.sample, px, py, held, n, s.x + begin, s.y + begin, strip);
  fetch_taps(f.sample, held, n, strip);
  const bool paired = f.sample.pairs != nullptr;
  if (values) {
    if (paired)
      interpolate_values(*strip, n, true, s.i + begin);
    else
      interpolate_values(*strip, n, false, s.i + begin);
  } else {
    if (paired)
      interpolate_strip(*strip, n, true, s.i + begin, s.a + begin, s.b + begin);
    else
      interpolate_strip(*strip, n, false, s.i + begin, s.a + begin, s.b + begin);
    zero_tail(s.x + begin, n);
    zero_tail(s.y + begin, n);
    zero_tail(s.a + begin, n);
    zero_tail(s.b + begin, n);
  }
  zero_tail(s.i + begin, n);
}

// The same behind a lens: pixels of its pinhole image, intensities, gradients by them.
TEXTPLANE_SIMD_INLINE void collect_behind(const HostPixels& host, const ResidualFrame& f, int begin, int n, bool values,
                                          const ResidualArrays& s, SampleStrip* strip) noexcept {
  LensStrip lens;
  float *x = s.x + begin, *y = s.y + begin;
  const int held = kInt16Tiles != 0 && f.tiles.guess.likely ? n / k16Lanes * k16Lanes : 0;
  lens_strip(f.warp, f.sample, f.lens, !values, f.tiles, held, host.x + begin, host.y + begin, n, x, y, strip, &lens);
  if (held > 0) fetch_tiles(f.tiles, held, strip);
  fetch_taps(f.sample, held, n, strip);
  const bool paired = f.sample.pairs != nullptr;
  if (values) {
    interpolate_values(*strip, n, paired, s.i + begin);
  } else {
    if (f.lens.tangential)
      interpolate_behind(f.lens, true, paired, *strip, lens, x, y, n, s.i + begin, s.a + begin, s.b + begin);
    else
      interpolate_behind(f.lens, false, paired, *strip, lens, x, y, n, s.i + begin, s.a + begin, s.b + begin);
    zero_tail(x, n);
    zero_tail(y, n);
    zero_tail(s.a + begin, n);
    zero_tail(s.b + begin, n);
  }
  zero_tail(s.i + begin, n);
}
TEXTPLANE_SIMD_ENTRY void collect_lens_strip(const HostPixels& host, const ResidualFrame& f, int begin, int n,
                                             const ResidualArrays& s, SampleStrip* strip) noexcept {
  collect_behind(host, f, begin, n, false, s, strip);
}
TEXTPLANE_SIMD_ENTRY void collect_lens_values(const HostPixels& host, const ResidualFrame& f, int begin, int n,
                                              const ResidualArrays& s, SampleStrip* strip) noexcept {
  collect_behind(host, f, begin, n, true, s, strip);
}

TEXTPLANE_SIMD_ENTRY void collect_strip(const HostPixels& host, const ResidualFrame& f, int begin, int n,
                                        const ResidualArrays& s, SampleStrip* strip) noexcept {
  if (f.lens.on) return collect_lens_strip(host, f, begin, n, s, strip);
  collect_any(host, f, begin, n, false, s, strip);
}
TEXTPLANE_SIMD_ENTRY void collect_values(const HostPixels& host, const ResidualFrame& f, int begin, int n,
                                         const ResidualArrays& s, SampleStrip* strip) noexcept {
  if (f.lens.on) return collect_lens_values(host, f, begin, n, s, strip);
  collect_any(host, f, begin, n, true, s, strip);
}
