// The kernel of simd/warp_lens.hpp. Include before: kernels/lens.inl.

// Cells of a row of the block, and which of its pixels lie in the source. Returns how many.
TEXTPLANE_SIMD_INLINE int warp_lens_row(const simd::WarpLensArgs& a, const WarpVectors& warp, const LensFrame& lens,
                                        const SampleFrame& f, float row, SampleStrip* strip,
                                        std::int32_t* in) noexcept {
  const CellVectors cells = broadcast_cells(f);
  const vf first = set1(static_cast<float>(a.x)), y = set1(row), one = set1(1.0F);
  int inside = 0;
  for (int i = 0; i < a.columns; i += kLanes) {
    vf px, py, divisor;
    warp_vector(warp, add(add(iota(), set1(static_cast<float>(i))), first), y, &px, &py, &divisor);
    lens_or_outside(lens, px, py, &px, &py);
    const vm seen = and_(inside_vector(f, px, py, divisor), first_n(a.columns - i));
    inside += count_true(seen);
    storei(in + i, to_int(keep(seen, one)));
    cell_vector(cells, px, py, strip, i);
  }
  return inside;
}

TEXTPLANE_SIMD_ENTRY void warp_lens_block(const simd::WarpLensArgs& a, int* inside) noexcept {
  LensFrame lens;
  if (!make_lens_frame(*a.lens, a.camera, a.source.width, a.source.height, &lens)) return;
  // H to the pinhole image, around the block's middle.
  const double *h = a.h, fx = lens.camera[0], fy = lens.camera[1], cx = lens.camera[2], cy = lens.camera[3];
  const float hx = static_cast<float>(a.x) + 0.5F * static_cast<float>(a.columns - 1),
              hy = static_cast<float>(a.y) + 0.5F * static_cast<float>(a.rows - 1);
  const double u = static_cast<double>(hx), v = static_cast<double>(hy), z = h[6] * u + h[7] * v + h[8];
  const double g[9] = {fx * h[0] + cx * h[6],
                       fx * h[1] + cx * h[7],
                       fx * (h[0] * u + h[1] * v + h[2]) + cx * z,
                       fy * h[3] + cy * h[6],
                       fy * h[4] + cy * h[7],
                       fy * (h[3] * u + h[4] * v + h[5]) + cy * z,
                       h[6],
                       h[7],
                       z};
  simd::Warp8 warp;
  SampleFrame f;
  if (!make_warp_around(g, hx, hy, lens.ox, lens.oy, &warp)) return;
  make_sample_frame(a.source, lens.ox, lens.oy, &f);
  const WarpVectors vectors = broadcast_warp(warp);
  const bool paired = f.pairs != nullptr;
  SampleStrip strip;
  std::int32_t in[simd::kLensBlockWidth];
  float values[simd::kLensBlockWidth];
  int count = 0;
  for (int row = 0; row < a.rows; ++row) {
    count += warp_lens_row(a, vectors, lens, f, static_cast<float>(a.y + row), &strip, in);
    fetch_taps(f, 0, a.columns, &strip);
    interpolate_values(strip, a.columns, paired, values);
    for (int i = 0; i < a.columns; i += kLanes)
      store(values + i, select(gt(to_float(loadi(in + i)), zero()), load(values + i), set1(a.fill)));
    std::uint8_t* out = static_cast<std::uint8_t*>(a.out) + row * a.out_stride;
    if (a.bytes) {
      for (int i = 0; i < a.columns; ++i) out[i] = static_cast<std::uint8_t>(values[i] + 0.5F);
    } else {
      copy_bytes(out, values, 4 * a.columns);
    }
    if (!a.mask) continue;
    std::uint8_t* mask = a.mask + row * a.mask_stride;
    for (int i = 0; i < a.columns; ++i) mask[i] = static_cast<std::uint8_t>(in[i]);
  }
  *inside = count;
}
