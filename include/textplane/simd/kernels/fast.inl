// FAST-9/16, kBytes pixels at a time. Include before: the operations.
//
// The strength for brighter arcs is (max over the 16 arcs of the least pixel of the arc) - I(p), for darker ones I(p) -
// (min over the arcs of the largest pixel): minima and maxima of bytes, without a branch. Two arcs that differ by a
// step share 8 pixels: max(min(s, a), min(s, b)) = min(s, max(a, b)).

// Loads at p: whole vectors, or n pixels.
TEXTPLANE_SIMD_INLINE vb fast_load(const std::uint8_t* p, bool whole, int n) noexcept {
  return whole ? loadb(p) : loadb_n(p, n);
}

// Strengths of the pixels at p where they exceed `threshold`, which is `least` - 1; 0 elsewhere.
TEXTPLANE_SIMD_INLINE vb fast_strengths(const std::uint8_t* p, std::ptrdiff_t stride, vb least, bool whole,
                                        int n) noexcept {
  const vb none = setb(0);
  const vb centre = fast_load(p, whole, n);
  const vb v0 = fast_load(p + 3 * stride, whole, n), v8 = fast_load(p - 3 * stride, whole, n);
  const vb v4 = fast_load(p + 3, whole, n), v12 = fast_load(p - 3, whole, n);
  // Every arc holds one of each two opposite pixels: a bound on either strength.
  vb low = minb(maxb(v0, v8), maxb(v4, v12)), high = maxb(minb(v0, v8), minb(v4, v12));
  if (!anyb(geb(maxb(subsb(low, centre), subsb(centre, high)), least))) return none;
  const vb v2 = fast_load(p + 2 + 2 * stride, whole, n), v10 = fast_load(p - 2 - 2 * stride, whole, n);
  const vb v6 = fast_load(p + 2 - 2 * stride, whole, n), v14 = fast_load(p - 2 + 2 * stride, whole, n);
  low = minb(low, minb(maxb(v2, v10), maxb(v6, v14)));
  high = maxb(high, maxb(minb(v2, v10), minb(v6, v14)));
  if (!anyb(geb(maxb(subsb(low, centre), subsb(centre, high)), least))) return none;
  const vb v1 = fast_load(p + 1 + 3 * stride, whole, n), v3 = fast_load(p + 3 + stride, whole, n);
  const vb v5 = fast_load(p + 3 - stride, whole, n), v7 = fast_load(p + 1 - 3 * stride, whole, n);
  const vb v9 = fast_load(p - 1 - 3 * stride, whole, n), v11 = fast_load(p - 3 - stride, whole, n);
  const vb v13 = fast_load(p - 3 + stride, whole, n), v15 = fast_load(p - 1 + 3 * stride, whole, n);

  // Least of 2, 4 and 8 pixels from an odd one on, then of the arcs on either side.
  const vb a1 = minb(v1, v2), a3 = minb(v3, v4), a5 = minb(v5, v6), a7 = minb(v7, v8);
  const vb a9 = minb(v9, v10), a11 = minb(v11, v12), a13 = minb(v13, v14), a15 = minb(v15, v0);
  const vb b1 = minb(a1, a3), b3 = minb(a3, a5), b5 = minb(a5, a7), b7 = minb(a7, a9);
  const vb b9 = minb(a9, a11), b11 = minb(a11, a13), b13 = minb(a13, a15), b15 = minb(a15, a1);
  vb bright = minb(minb(b1, b5), maxb(v0, v9));
  bright = maxb(bright, minb(minb(b3, b7), maxb(v2, v11)));
  bright = maxb(bright, minb(minb(b5, b9), maxb(v4, v13)));
  bright = maxb(bright, minb(minb(b7, b11), maxb(v6, v15)));
  bright = maxb(bright, minb(minb(b9, b13), maxb(v8, v1)));
  bright = maxb(bright, minb(minb(b11, b15), maxb(v10, v3)));
  bright = maxb(bright, minb(minb(b13, b1), maxb(v12, v5)));
  bright = maxb(bright, minb(minb(b15, b3), maxb(v14, v7)));

  const vb c1 = maxb(v1, v2), c3 = maxb(v3, v4), c5 = maxb(v5, v6), c7 = maxb(v7, v8);
  const vb c9 = maxb(v9, v10), c11 = maxb(v11, v12), c13 = maxb(v13, v14), c15 = maxb(v15, v0);
  const vb d1 = maxb(c1, c3), d3 = maxb(c3, c5), d5 = maxb(c5, c7), d7 = maxb(c7, c9);
  const vb d9 = maxb(c9, c11), d11 = maxb(c11, c13), d13 = maxb(c13, c15), d15 = maxb(c15, c1);
  vb dark = maxb(maxb(d1, d5), minb(v0, v9));
  dark = minb(dark, maxb(maxb(d3, d7), minb(v2, v11)));
  dark = minb(dark, maxb(maxb(d5, d9), minb(v4, v13)));
  dark = minb(dark, maxb(maxb(d7, d11), minb(v6, v15)));
  dark = minb(dark, maxb(maxb(d9, d13), minb(v8, v1)));
  dark = minb(dark, maxb(maxb(d11, d15), minb(v10, v3)));
  dark = minb(dark, maxb(maxb(d13, d1), minb(v12, v5)));
  dark = minb(dark, maxb(maxb(d15, d3), minb(v14, v7)));

  const vb strength = maxb(subsb(bright, centre), subsb(centre, dark));
  return andb(strength, geb(strength, least));
}

TEXTPLANE_SIMD_ENTRY bool fast_row(const simd::FastRowArgs& args) noexcept {
  const int end = args.width - 3;
  if (args.threshold >= 255) {  // no difference of bytes exceeds it
    for (int x = 3; x < end; ++x) args.scores[x] = 0;
    return false;
  }
  const vb least = setb(args.threshold + 1), less = setb(args.less);
  if (end - 3 < kBytes) {
    const int n = end - 3;
    const vb scores = subsb(fast_strengths(args.row + 3, args.stride, least, false, n), less);
    storeb_n(args.scores + 3, scores, n);
    return anyb(scores);
  }
  vb seen = setb(0);
  for (int x = 3;; x += kBytes) {
    if (x > end - kBytes) x = end - kBytes;  // the last ones again, with some before them
    const vb scores = subsb(fast_strengths(args.row + x, args.stride, least, true, 0), less);
    seen = orb(seen, scores);
    storeb(args.scores + x, scores);
    if (x == end - kBytes) return anyb(seen);
  }
}

TEXTPLANE_SIMD_ENTRY int fast_maxima(const simd::FastMaximaArgs& args) noexcept {
  const vb one = setb(1);
  int n = 0;
  for (int x = args.first; x < args.last; x += kBytes) {
    const vb score = loadb(args.row + x);
    if (!anyb(score)) continue;
    vb least = one;  // that counts: more than every neighbour
    if (args.suppress) {
      const std::uint8_t* above = args.above + x;
      const std::uint8_t* row = args.row + x;
      const std::uint8_t* below = args.below + x;
      vb largest = maxb(maxb(loadb(above - 1), loadb(above)), maxb(loadb(above + 1), loadb(row - 1)));
      largest = maxb(largest, maxb(loadb(row + 1), loadb(below - 1)));
      largest = maxb(largest, maxb(loadb(below), loadb(below + 1)));
      least = addsb(largest, one);
    }
    std::uint64_t bits = bitsb(geb(score, least));
    for (; bits != 0; bits &= bits - 1) {
      const int at = x + lowest_bit(bits);
      if (at < args.last) args.found[n++] = at;
    }
  }
  return n;
}
