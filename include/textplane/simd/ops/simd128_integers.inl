// Bytes and int16 of the simd128 target. ops/scalar.inl defines the operations.
// Include before: the int32 operations of ops/simd128.inl.

// --- bytes ---
constexpr int kBytes = 16;
using vb = v128_t;

TEXTPLANE_SIMD_INLINE vb setb(int value) noexcept { return wasm_i8x16_splat(static_cast<std::int8_t>(value)); }
TEXTPLANE_SIMD_INLINE vb loadb(const std::uint8_t* p) noexcept { return wasm_v128_load(p); }
TEXTPLANE_SIMD_INLINE void storeb(std::uint8_t* p, vb a) noexcept { wasm_v128_store(p, a); }

TEXTPLANE_SIMD_INLINE vb addsb(vb a, vb b) noexcept { return wasm_u8x16_add_sat(a, b); }
TEXTPLANE_SIMD_INLINE vb subsb(vb a, vb b) noexcept { return wasm_u8x16_sub_sat(a, b); }
TEXTPLANE_SIMD_INLINE vb minb(vb a, vb b) noexcept { return wasm_u8x16_min(a, b); }
TEXTPLANE_SIMD_INLINE vb maxb(vb a, vb b) noexcept { return wasm_u8x16_max(a, b); }
TEXTPLANE_SIMD_INLINE vb andb(vb a, vb b) noexcept { return wasm_v128_and(a, b); }
TEXTPLANE_SIMD_INLINE vb orb(vb a, vb b) noexcept { return wasm_v128_or(a, b); }
// (a + b + 2) / 4 of neighbouring bytes.
TEXTPLANE_SIMD_INLINE v128_t quarter_of_pairs(vb a, vb b) noexcept {
  const v128_t sum = wasm_i16x8_add(wasm_u16x8_extadd_pairwise_u8x16(a), wasm_u16x8_extadd_pairwise_u8x16(b));
  return wasm_u16x8_shr(wasm_i16x8_add(sum, wasm_i16x8_splat(2)), 2);
}
TEXTPLANE_SIMD_INLINE vb mean4b(vb upper0, vb upper1, vb lower0, vb lower1) noexcept {
  return wasm_u8x16_narrow_i16x8(quarter_of_pairs(upper0, lower0), quarter_of_pairs(upper1, lower1));
}

TEXTPLANE_SIMD_INLINE vb geb(vb a, vb b) noexcept { return wasm_u8x16_ge(a, b); }
TEXTPLANE_SIMD_INLINE bool anyb(vb a) noexcept { return wasm_v128_any_true(a); }
TEXTPLANE_SIMD_INLINE std::uint64_t bitsb(vb mask) noexcept {
  return static_cast<std::uint32_t>(wasm_i8x16_bitmask(mask));
}

// --- int16 ---
enum : int { k16Lanes = 8 };
using v16 = v128_t;
using vw = v128_t;
constexpr int kPairsReach = 9;

TEXTPLANE_SIMD_INLINE v16 set16(int value) noexcept { return wasm_i16x8_splat(static_cast<std::int16_t>(value)); }
TEXTPLANE_SIMD_INLINE v16 load16(const std::int16_t* p) noexcept { return wasm_v128_load(p); }
TEXTPLANE_SIMD_INLINE void store16(std::int16_t* p, v16 v) noexcept { wasm_v128_store(p, v); }
TEXTPLANE_SIMD_INLINE v16 add16(v16 x, v16 y) noexcept { return wasm_i16x8_add(x, y); }
TEXTPLANE_SIMD_INLINE v16 sub16(v16 x, v16 y) noexcept { return wasm_i16x8_sub(x, y); }
TEXTPLANE_SIMD_INLINE v16 and16(v16 x, v16 y) noexcept { return wasm_v128_and(x, y); }
TEXTPLANE_SIMD_INLINE v16 half16(v16 x) noexcept { return wasm_i16x8_shr(x, 1); }
TEXTPLANE_SIMD_INLINE v16 first16(int n) noexcept {
  const int limit = n < 0 ? 0 : (n < k16Lanes ? n : k16Lanes);
  return wasm_i16x8_lt(wasm_i16x8_const(0, 1, 2, 3, 4, 5, 6, 7), set16(limit));
}
// Of the two bytes of each lane, unsigned: low * w0 + high * w1; it wraps.
TEXTPLANE_SIMD_INLINE v16 weigh_bytes(v16 t, v16 w0, v16 w1) noexcept {
  return wasm_i16x8_add(wasm_i16x8_mul(wasm_v128_and(t, set16(255)), w0), wasm_i16x8_mul(wasm_u16x8_shr(t, 8), w1));
}
TEXTPLANE_SIMD_INLINE v16 mix_pairs(const std::uint8_t* p, v16 weights) noexcept {
  // The 128s leave the sum at once: what all rows of a patch share.
  const v16 w0 = wasm_v128_and(weights, set16(255)), w1 = wasm_u16x8_shr(weights, 8);
  const v16 sum =
      wasm_i16x8_add(wasm_i16x8_mul(wasm_u16x8_load8x8(p), w0), wasm_i16x8_mul(wasm_u16x8_load8x8(p + 1), w1));
  return wasm_i16x8_sub(sum, wasm_i16x8_shl(wasm_i16x8_add(w0, w1), 7));
}
TEXTPLANE_SIMD_INLINE v16 dot_pair(v16 t, int w0, int w1) noexcept { return weigh_bytes(t, set16(w0), set16(w1)); }
TEXTPLANE_SIMD_INLINE v16 mul15(v16 x, v16 y) noexcept { return wasm_i16x8_q15mulr_sat(x, y); }
TEXTPLANE_SIMD_INLINE vi add_dot16(vi sum, v16 x, v16 y) noexcept { return addi(sum, wasm_i32x4_dot_i16x8(x, y)); }
TEXTPLANE_SIMD_INLINE v16 pack16(vi low, vi high) noexcept { return wasm_i16x8_narrow_i32x4(low, high); }
TEXTPLANE_SIMD_INLINE int reduce_sum_int(vi v) noexcept {
  const vi two = addi(v, wasm_i32x4_shuffle(v, v, 2, 3, 2, 3));
  return wasm_i32x4_extract_lane(addi(two, wasm_i32x4_shuffle(two, two, 1, 1, 1, 1)), 0);
}
TEXTPLANE_SIMD_INLINE v16 gather_pairs8(const std::uint8_t* p, const int* offset) noexcept {
  v128_t v = wasm_v128_load16_lane(p + offset[0], wasm_i32x4_const(0, 0, 0, 0), 0);
  v = wasm_v128_load16_lane(p + offset[1], v, 1);
  v = wasm_v128_load16_lane(p + offset[2], v, 2);
  v = wasm_v128_load16_lane(p + offset[3], v, 3);
  v = wasm_v128_load16_lane(p + offset[4], v, 4);
  v = wasm_v128_load16_lane(p + offset[5], v, 5);
  v = wasm_v128_load16_lane(p + offset[6], v, 6);
  return wasm_v128_load16_lane(p + offset[7], v, 7);
}
TEXTPLANE_SIMD_INLINE void gather16(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset, v16* first,
                                    v16* second) noexcept {
  *first = gather_pairs8(upper, offset);
  *second = gather_pairs8(lower, offset);
}
TEXTPLANE_SIMD_INLINE vi gather_pairs(const std::uint16_t* p, const int* offset) noexcept {
  v128_t v = wasm_v128_load32_zero(p + offset[0]);
  v = wasm_v128_load32_lane(p + offset[1], v, 1);
  v = wasm_v128_load32_lane(p + offset[2], v, 2);
  return wasm_v128_load32_lane(p + offset[3], v, 3);
}
TEXTPLANE_SIMD_INLINE v16 low16(vi a, vi b) noexcept { return wasm_i16x8_shuffle(a, b, 0, 2, 4, 6, 8, 10, 12, 14); }
TEXTPLANE_SIMD_INLINE v16 high16(vi a, vi b) noexcept { return wasm_i16x8_shuffle(a, b, 1, 3, 5, 7, 9, 11, 13, 15); }
TEXTPLANE_SIMD_INLINE vi widen_low16(v16 v) noexcept { return wasm_i32x4_extend_low_i16x8(v); }
TEXTPLANE_SIMD_INLINE vi widen_high16(v16 v) noexcept { return wasm_i32x4_extend_high_i16x8(v); }
