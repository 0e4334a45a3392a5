// Tiles of int16 cells, out of the operations of avx2 or avx512. Include before: these.

TEXTPLANE_SIMD_INLINE void group_offsets(const std::int16_t* x, const std::int16_t* y, int stride, int* out) noexcept {
  const __m128i cx = load128(x);
  const __m128i cy = load128(y), by = _mm_set1_epi32(stride * 65536 + 1);
  store128(out, _mm_madd_epi16(_mm_unpacklo_epi16(cx, cy), by));
  store128(out + 4, _mm_madd_epi16(_mm_unpackhi_epi16(cx, cy), by));
}

TEXTPLANE_SIMD_INLINE v16 load_group(const std::int16_t* p) noexcept { return from_group(load128(p)); }
TEXTPLANE_SIMD_INLINE void store_group(std::int16_t* p, v16 v) noexcept { store128(p, first_group(v)); }
TEXTPLANE_SIMD_INLINE void fetch_group(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset, v16* a,
                                       v16* b) noexcept {
  __m128i u, l;
  gather_pairs8(upper, lower, offset, &u, &l);
  *a = from_group(u);
  *b = from_group(l);
}

struct TilePlaces {
  std::ptrdiff_t of_group[kGroups];
};
TEXTPLANE_SIMD_INLINE TilePlaces find_tiles(const std::int16_t* x, const std::int16_t* y,
                                            std::ptrdiff_t stride) noexcept {
  TilePlaces at;
  TEXTPLANE_SIMD_UNROLL
  for (int i = 0; i < kGroups; ++i) at.of_group[i] = y[8 * i] * stride + x[8 * i];
  return at;
}
TEXTPLANE_SIMD_INLINE v16 load_tile_rows(const std::uint8_t* p, const TilePlaces& at) noexcept {
  __m128i rows[kGroups];
  TEXTPLANE_SIMD_UNROLL
  for (int i = 0; i < kGroups; ++i) rows[i] = load128(p + at.of_group[i]);
  return join_groups(rows);
}
// The two bytes of the first, or the last, cell of each group, for pick_bytes().
TEXTPLANE_SIMD_INLINE v16 group_ends(bool last) noexcept { return set16(last ? 0x0f0e : 0x0100); }

// Constants of a loop over tiles. `left` and `top` are the guessed numbers of a group's left-most and top-most cell.
struct TileVectors {
  v16 left_ends, top_ends;
  int left, top;
  const std::uint8_t *upper, *middle, *lower;
  std::ptrdiff_t stride;
};
TEXTPLANE_SIMD_INLINE TileVectors broadcast_tiles(const ImageTiles& w) noexcept {
  TileVectors v;
  v.left_ends = group_ends(w.guess.leftwards);
  v.top_ends = group_ends(w.guess.upwards);
  v.left = w.guess.leftwards ? 7 : 0;
  v.top = w.guess.upwards ? 7 : 0;
  v.upper = w.origin;
  v.middle = w.origin + w.stride;
  v.lower = v.middle + w.stride;
  v.stride = w.stride;
  return v;
}

// The pairs (I(x,y), I(x+1,y)) and (I(x,y+1), I(x+1,y+1)) of k16Lanes cells. Bit i of the result: some of the pixels 4
// i .. 4 i + 3 lie outside their tile, and their pairs are arbitrary.
TEXTPLANE_SIMD_INLINE unsigned tile_pairs(const TileVectors& w, const std::int16_t* x, const std::int16_t* y,
                                          v16* first, v16* second) noexcept {
  const TilePlaces at = find_tiles(x + w.left, y + w.top, w.stride);
  const v16 cx = load_cells(x), cy = load_cells(y);
  const v16 px = sub16(cx, pick_bytes(cx, w.left_ends)), py = sub16(cy, pick_bytes(cy, w.top_ends)),
            picks = pair_picks(px);
  const v16 upper = pick_bytes(load_tile_rows(w.upper, at), picks);
  const v16 middle = pick_bytes(load_tile_rows(w.middle, at), picks);
  const v16 lower = pick_bytes(load_tile_rows(w.lower, at), picks);
  *first = choose16(py, upper, middle);
  *second = choose16(py, middle, lower);
  return any_of_four(or16(saturated_sub16(px, 14), saturated_sub16(py, 1)));
}
