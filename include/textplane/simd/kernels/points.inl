// warp_points(), sample_points() and prepare_pair16() of simd/sample.hpp. Include before: kernels/sample.inl.

TEXTPLANE_SIMD_ENTRY void point_bounds(const float* x, const float* y, int n, simd::PointBounds* out) noexcept {
  find_bounds(x, y, n, out);
}

TEXTPLANE_SIMD_INLINE bool prepare_points(const simd::PointArgs& a, simd::Warp8* warp, SampleFrame* frame,
                                          simd::PointResult* result) noexcept {
  if (!a.x || !a.y || !a.out_x || !a.out_y || a.n < 0) return false;
  simd::PointBounds bounds = a.bounds;
  if (a.n > 0 && bounds.n != a.n) find_bounds(a.x, a.y, a.n, &bounds);
  if (!make_warp(a.h, middle_x(bounds), middle_y(bounds), a.image.width, a.image.height, warp)) return false;
  make_sample_frame(a.image, warp->ox, warp->oy, frame);
  result->ox = warp->ox;
  result->oy = warp->oy;
  result->inside = 0;
  return true;
}

TEXTPLANE_SIMD_ENTRY void warp_points(const simd::PointArgs& a, simd::PointResult* result) noexcept {
  simd::Warp8 warp;
  SampleFrame frame;
  if (a.image.width < 1 || a.image.height < 1 || !prepare_points(a, &warp, &frame, result)) return;
  if (!a.inside) result->inside = a.n;
  const WarpVectors vectors = broadcast_warp(warp);
  for (int i = 0; i < a.n; i += kLanes) {
    const int left = a.n - i < kLanes ? a.n - i : kLanes;
    vf x, y, divisor;
    warp_vector(vectors, load_part(a.x + i, left), load_part(a.y + i, left), &x, &y, &divisor);
    if (a.inside) {
      const vm in = and_(inside_vector(frame, x, y, divisor), first_n(left));
      result->inside += count_true(in);
      const unsigned b = bits_from_mask(in);
      for (int k = 0; k < left; ++k) a.inside[i + k] = static_cast<std::uint8_t>(b >> k & 1U);
    }
    if (left == kLanes) {
      store(a.out_x + i, x);
      store(a.out_y + i, y);
    } else {
      store_n(a.out_x + i, x, left);
      store_n(a.out_y + i, y, left);
    }
  }
}

// Copies n floats.
TEXTPLANE_SIMD_INLINE void copy_part(float* to, const float* from, int n) noexcept {
  for (int i = 0; i < n; i += kLanes) {
    if (n - i >= kLanes)
      store(to + i, load(from + i));
    else
      store_n(to + i, load(from + i), n - i);
  }
}

TEXTPLANE_SIMD_ENTRY void sample_points(const simd::PointArgs& a, simd::PointResult* result) noexcept {
  simd::Warp8 warp;
  SampleFrame frame;
  if (!simd::readable(a.image) || !a.value || !a.gx || !a.gy || !prepare_points(a, &warp, &frame, result)) return;
  const bool paired = frame.pairs != nullptr;
  const WarpVectors vectors = broadcast_warp(warp);
  const CellVectors cells = broadcast_cells(frame);
  SampleStrip strip;
  for (int begin = 0; begin < a.n; begin += kStrip) {
    const int n = a.n - begin < kStrip ? a.n - begin : kStrip;
    float x[kStrip], y[kStrip], value[kStrip], gx[kStrip], gy[kStrip];
    for (int i = 0; i < n; i += kLanes) {
      vf tx, ty, divisor;
      warp_vector(vectors, load_part(a.x + begin + i, n - i), load_part(a.y + begin + i, n - i), &tx, &ty, &divisor);
      cell_vector(cells, tx, ty, &strip, i);
      const vm in = and_(inside_vector(frame, tx, ty, divisor), first_n(n - i));
      const unsigned b = bits_from_mask(in);
      result->inside += count_true(in);
      store(x + i, tx);
      store(y + i, ty);
      store(gx + i, keep(in, set1(1.0F)));  // which ones count, until their values are known
      if (a.inside)
        for (int k = 0; k < kLanes && i + k < n; ++k) a.inside[begin + i + k] = static_cast<std::uint8_t>(b >> k & 1U);
    }
    fetch_taps(frame, 0, n, &strip);
    for (int i = 0; i < n; i += kLanes) {
      vf v, dx, dy;
      interpolate_vector(strip, i, paired, &v, &dx, &dy);
      const vm in = gt(load(gx + i), zero());
      store(value + i, keep(in, v));
      store(gx + i, keep(in, dx));
      store(gy + i, keep(in, dy));
    }
    copy_part(a.out_x + begin, x, n);
    copy_part(a.out_y + begin, y, n);
    copy_part(a.value + begin, value, n);
    copy_part(a.gx + begin, gx, n);
    copy_part(a.gy + begin, gy, n);
  }
}

TEXTPLANE_SIMD_ENTRY void prepare_pair16(const simd::Image8& image, std::uint16_t* pairs,
                                         std::ptrdiff_t pair_stride) noexcept {
  for (int y = 0; y + 1 < image.height; ++y) {
    const std::uint8_t* TEXTPLANE_SIMD_RESTRICT upper = image.data + y * image.stride;
    const std::uint8_t* TEXTPLANE_SIMD_RESTRICT lower = upper + image.stride;
    std::uint16_t* TEXTPLANE_SIMD_RESTRICT out = pairs + y * pair_stride;
    for (int x = 0; x < image.width; ++x) out[x] = static_cast<std::uint16_t>(upper[x] | lower[x] << 8);
  }
}
