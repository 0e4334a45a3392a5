// Halving: kBytes pixels of the result at a time. Include before: the operations.
//
// The last vector of a row overlaps the one before it; a row shorter than a vector takes partial loads.

TEXTPLANE_SIMD_INLINE void halve_row_part(const std::uint8_t* upper, const std::uint8_t* lower,
                                          std::uint8_t* out) noexcept {
  storeb(out, mean4b(loadb(upper), loadb(upper + kBytes), loadb(lower), loadb(lower + kBytes)));
}

TEXTPLANE_SIMD_INLINE void halve_short_row(const std::uint8_t* upper, const std::uint8_t* lower, std::uint8_t* out,
                                           int width) noexcept {
  const int first = 2 * width < kBytes ? 2 * width : kBytes, second = 2 * width - first;
  storeb_n(out,
           mean4b(loadb_n(upper, first), loadb_n(upper + first, second), loadb_n(lower, first),
                  loadb_n(lower + first, second)),
           width);
}

TEXTPLANE_SIMD_ENTRY void halve(const simd::HalveArgs& args) noexcept {
  for (int y = 0; y < args.height; ++y) {
    const std::uint8_t* upper = args.src + 2 * y * args.src_stride;
    const std::uint8_t* lower = upper + args.src_stride;
    std::uint8_t* out = args.dst + y * args.dst_stride;
    if (args.width < kBytes) {
      halve_short_row(upper, lower, out, args.width);
      continue;
    }
    int x = 0;
    for (; x + kBytes <= args.width; x += kBytes) halve_row_part(upper + 2 * x, lower + 2 * x, out + x);
    if (x < args.width) {
      x = args.width - kBytes;
      halve_row_part(upper + 2 * x, lower + 2 * x, out + x);
    }
  }
}
