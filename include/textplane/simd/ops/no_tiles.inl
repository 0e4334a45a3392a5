// For targets without tiles of int16 cells: what the bodies of kernels name, and never call. Include before: the int16
// operations of the target.

enum : int { kInt16Tiles = 0 };
TEXTPLANE_SIMD_INLINE v16 min_unsigned16(v16 v, v16) noexcept { return v; }
TEXTPLANE_SIMD_INLINE v16 load_group(const std::int16_t* p) noexcept { return load16(p); }
TEXTPLANE_SIMD_INLINE void store_group(std::int16_t*, v16) noexcept {}
TEXTPLANE_SIMD_INLINE void group_offsets(const std::int16_t*, const std::int16_t*, int, int*) noexcept {}
TEXTPLANE_SIMD_INLINE void fetch_group(const std::uint8_t*, const std::uint8_t*, const int*, v16* a, v16* b) noexcept {
  *a = *b = set16(0);
}
TEXTPLANE_SIMD_INLINE void store_taps(std::uint32_t*, v16, v16) noexcept {}
struct TileVectors {
  const std::uint8_t *upper, *middle;
};
TEXTPLANE_SIMD_INLINE TileVectors broadcast_tiles(const ImageTiles& w) noexcept {
  return TileVectors{w.origin, w.origin};
}
TEXTPLANE_SIMD_INLINE unsigned tile_pairs(const TileVectors&, const std::int16_t*, const std::int16_t*, v16* first,
                                          v16* second) noexcept {
  *first = *second = set16(0);
  return 0;
}
