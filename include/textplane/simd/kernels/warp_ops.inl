// Vector operations of the warp alone (see vec_scalar.inl for the others).
//
// kWindowLanes consecutive pixels share a window of 16 x 3 bytes where they lie close together, and then one shuffle a row
// replaces two loads a pixel:
//   per_window(b)     lane i gets b[i - i % kWindowLanes]
//   in_two_rows(y)    every lane is 0 or 1
//   window_taps(...)  the taps of cells (x, y), 0 <= x <= 14 and 0 <= y <= 1, of the window at corner[i / kWindowLanes]
// kWindowLanes 0: the target has no shuffle.
//   load2(p, a, b)    a gets the even, b the odd ones of 2 kLanes floats
//   store_u8(p, v)    the low bytes of the lanes, 0 <= v <= 255
#if TEXTPLANE_SIMD_REGION == 0

enum : int { kWindowLanes = 0 };
TEXTPLANE_SIMD_INLINE vi per_window(const int* b) noexcept { return b[0]; }
TEXTPLANE_SIMD_INLINE bool in_two_rows(vi) noexcept { return false; }
TEXTPLANE_SIMD_INLINE taps_t window_taps(const std::uint8_t* const*, std::ptrdiff_t, vi, vi) noexcept {
  return taps_t{0};
}
TEXTPLANE_SIMD_INLINE void load2(const float* p, vf* a, vf* b) noexcept {
  *a = p[0];
  *b = p[1];
}
TEXTPLANE_SIMD_INLINE void store_u8(std::uint8_t* p, vi v) noexcept { *p = static_cast<std::uint8_t>(v); }

#elif TEXTPLANE_SIMD_REGION == 1

enum : int { kWindowLanes = 4 };
TEXTPLANE_SIMD_INLINE vi per_window(const int* b) noexcept { return seti(b[0]); }
TEXTPLANE_SIMD_INLINE bool in_two_rows(vi y) noexcept { return _mm_testz_si128(y, _mm_set1_epi32(~1)) != 0; }
TEXTPLANE_SIMD_INLINE taps_t window_taps(const std::uint8_t* const* corner, std::ptrdiff_t stride, vi x,
                                         vi y) noexcept {
  const __m128i spread = _mm_set_epi8(12, 12, 12, 12, 8, 8, 8, 8, 4, 4, 4, 4, 0, 0, 0, 0);
  const __m128i pick = _mm_add_epi8(_mm_shuffle_epi8(x, spread), _mm_set1_epi32(0x01000100));
  const std::uint8_t* p = corner[0];
  const __m128i a = _mm_shuffle_epi8(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)), pick);
  const __m128i b = _mm_shuffle_epi8(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p + stride)), pick);
  const __m128i c = _mm_shuffle_epi8(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p + 2 * stride)), pick);
  const __m128i lower = _mm_sub_epi32(_mm_setzero_si128(), y);
  return taps_t{_mm_blendv_epi8(_mm_blend_epi16(a, b, 0xAA), _mm_blend_epi16(b, c, 0xAA), lower)};
}
TEXTPLANE_SIMD_INLINE void load2(const float* p, vf* a, vf* b) noexcept {
  const __m128 lo = _mm_loadu_ps(p), hi = _mm_loadu_ps(p + 4);
  *a = _mm_shuffle_ps(lo, hi, 0x88);
  *b = _mm_shuffle_ps(lo, hi, 0xDD);
}
TEXTPLANE_SIMD_INLINE void store_u8(std::uint8_t* p, vi v) noexcept {
  const __m128i pick = _mm_set_epi8(-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, 12, 8, 4, 0);
  const int word = _mm_cvtsi128_si32(_mm_shuffle_epi8(v, pick));
  __builtin_memcpy(p, &word, 4);
}

#elif TEXTPLANE_SIMD_REGION == 2

enum : int { kWindowLanes = 8 };
TEXTPLANE_SIMD_INLINE vi per_window(const int* b) noexcept { return seti(b[0]); }
TEXTPLANE_SIMD_INLINE bool in_two_rows(vi y) noexcept { return _mm256_testz_si256(y, _mm256_set1_epi32(~1)) != 0; }
TEXTPLANE_SIMD_INLINE __m256i window_row(const std::uint8_t* p) noexcept {
  return _mm256_broadcastsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
}
TEXTPLANE_SIMD_INLINE taps_t window_taps(const std::uint8_t* const* corner, std::ptrdiff_t stride, vi x,
                                         vi y) noexcept {
  const __m256i spread = _mm256_set_epi8(12, 12, 12, 12, 8, 8, 8, 8, 4, 4, 4, 4, 0, 0, 0, 0,  //
                                         12, 12, 12, 12, 8, 8, 8, 8, 4, 4, 4, 4, 0, 0, 0, 0);
  const __m256i pick = _mm256_add_epi8(_mm256_shuffle_epi8(x, spread), _mm256_set1_epi32(0x01000100));
  const std::uint8_t* p = corner[0];
  const __m256i a = _mm256_shuffle_epi8(window_row(p), pick);
  const __m256i b = _mm256_shuffle_epi8(window_row(p + stride), pick);
  const __m256i c = _mm256_shuffle_epi8(window_row(p + 2 * stride), pick);
  const __m256i lower = _mm256_sub_epi32(_mm256_setzero_si256(), y);
  return taps_t{_mm256_blendv_epi8(_mm256_blend_epi16(a, b, 0xAA), _mm256_blend_epi16(b, c, 0xAA), lower)};
}
TEXTPLANE_SIMD_INLINE void load2(const float* p, vf* a, vf* b) noexcept {
  const __m256 lo = _mm256_loadu_ps(p), hi = _mm256_loadu_ps(p + 8);
  const __m256 even = _mm256_shuffle_ps(lo, hi, 0x88), odd = _mm256_shuffle_ps(lo, hi, 0xDD);
  *a = _mm256_castpd_ps(_mm256_permute4x64_pd(_mm256_castps_pd(even), 0xD8));
  *b = _mm256_castpd_ps(_mm256_permute4x64_pd(_mm256_castps_pd(odd), 0xD8));
}
TEXTPLANE_SIMD_INLINE void store_u8(std::uint8_t* p, vi v) noexcept {
  const __m128i words = _mm_packus_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
  _mm_storel_epi64(reinterpret_cast<__m128i*>(p), _mm_packus_epi16(words, words));
}

#elif TEXTPLANE_SIMD_REGION == 3

enum : int { kWindowLanes = 8 };
TEXTPLANE_SIMD_INLINE vi per_window(const int* b) noexcept {
  return _mm512_mask_blend_epi32(0xFF00, _mm512_set1_epi32(b[0]), _mm512_set1_epi32(b[8]));
}
TEXTPLANE_SIMD_INLINE bool in_two_rows(vi y) noexcept { return _mm512_test_epi32_mask(y, _mm512_set1_epi32(~1)) == 0; }
TEXTPLANE_SIMD_INLINE __m512i window_row(const std::uint8_t* p, const std::uint8_t* q) noexcept {
  const __m512i a = _mm512_maskz_broadcast_i32x4(0xFFFF, _mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
  return _mm512_mask_broadcast_i32x4(a, 0xFF00, _mm_loadu_si128(reinterpret_cast<const __m128i*>(q)));
}
TEXTPLANE_SIMD_INLINE taps_t window_taps(const std::uint8_t* const* corner, std::ptrdiff_t stride, vi x,
                                         vi y) noexcept {
  // Each byte of a lane gets the lane's x, which is below 16.
  const __m512i pick = _mm512_add_epi32(_mm512_mullo_epi32(x, _mm512_set1_epi32(0x01010101)),  //
                                        _mm512_set1_epi32(0x01000100));
  const std::uint8_t *p = corner[0], *q = corner[1];
  const __m512i a = _mm512_shuffle_epi8(window_row(p, q), pick);
  const __m512i b = _mm512_shuffle_epi8(window_row(p + stride, q + stride), pick);
  const __m512i c = _mm512_shuffle_epi8(window_row(p + 2 * stride, q + 2 * stride), pick);
  const __m512i upper = _mm512_mask_blend_epi16(0xAAAAAAAAU, a, b), lower = _mm512_mask_blend_epi16(0xAAAAAAAAU, b, c);
  return taps_t{_mm512_mask_blend_epi32(_mm512_test_epi32_mask(y, y), upper, lower)};
}
TEXTPLANE_SIMD_INLINE void load2(const float* p, vf* a, vf* b) noexcept {
  const __m512 lo = _mm512_loadu_ps(p), hi = _mm512_loadu_ps(p + 16);
  const __m512i even = _mm512_set_epi32(30, 28, 26, 24, 22, 20, 18, 16, 14, 12, 10, 8, 6, 4, 2, 0);
  const __m512i odd = _mm512_set_epi32(31, 29, 27, 25, 23, 21, 19, 17, 15, 13, 11, 9, 7, 5, 3, 1);
  *a = _mm512_permutex2var_ps(lo, even, hi);
  *b = _mm512_permutex2var_ps(lo, odd, hi);
}
TEXTPLANE_SIMD_INLINE void store_u8(std::uint8_t* p, vi v) noexcept {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm512_maskz_cvtepi32_epi8(0xFFFF, v));
}

#elif TEXTPLANE_SIMD_REGION == 4

enum : int { kWindowLanes = 4 };
TEXTPLANE_SIMD_INLINE vi per_window(const int* b) noexcept { return seti(b[0]); }
TEXTPLANE_SIMD_INLINE bool in_two_rows(vi y) noexcept {
  return vmaxvq_u32(vreinterpretq_u32_s32(vbicq_s32(y, vdupq_n_s32(1)))) == 0;
}
TEXTPLANE_SIMD_INLINE taps_t window_taps(const std::uint8_t* const* corner, std::ptrdiff_t stride, vi x,
                                         vi y) noexcept {
  // Each byte of a lane gets the lane's x, which is below 16.
  const uint32x4_t pick = vmlaq_n_u32(vdupq_n_u32(0x01000100U), vreinterpretq_u32_s32(x), 0x01010101U);
  const std::uint8_t* p = corner[0];
  const uint8x16_t index = vreinterpretq_u8_u32(pick);
  const uint32x4_t a = vreinterpretq_u32_u8(vqtbl1q_u8(vld1q_u8(p), index));
  const uint32x4_t b = vreinterpretq_u32_u8(vqtbl1q_u8(vld1q_u8(p + stride), index));
  const uint32x4_t c = vreinterpretq_u32_u8(vqtbl1q_u8(vld1q_u8(p + 2 * stride), index));
  const uint32x4_t top = vdupq_n_u32(0x0000FFFFU), lower = vtstq_s32(y, y);
  return taps_t{vbslq_u32(lower, vbslq_u32(top, b, c), vbslq_u32(top, a, b))};
}
TEXTPLANE_SIMD_INLINE void load2(const float* p, vf* a, vf* b) noexcept {
  const float32x4x2_t v = vld2q_f32(p);
  *a = v.val[0];
  *b = v.val[1];
}
TEXTPLANE_SIMD_INLINE void store_u8(std::uint8_t* p, vi v) noexcept {
  const uint16x4_t half = vmovn_u32(vreinterpretq_u32_s32(v));
  const uint8x8_t bytes = vmovn_u16(vcombine_u16(half, half));
  const unsigned word = vget_lane_u32(vreinterpret_u32_u8(bytes), 0);
  __builtin_memcpy(p, &word, 4);
}

#endif
