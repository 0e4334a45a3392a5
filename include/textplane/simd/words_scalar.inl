// Two int16 in plain C++: the definition of every operation on words. Sums and differences must fit int16.

enum : int { k16Lanes = 2 };
struct v16 {
  std::int16_t a, b;
};

TEXTPLANE_SIMD_INLINE v16 make16(int a, int b) noexcept {
  return v16{static_cast<std::int16_t>(a), static_cast<std::int16_t>(b)};
}
TEXTPLANE_SIMD_INLINE v16 set16(int value) noexcept { return make16(value, value); }
TEXTPLANE_SIMD_INLINE v16 load16(const std::int16_t* p) noexcept { return v16{p[0], p[1]}; }
TEXTPLANE_SIMD_INLINE void store16(std::int16_t* p, v16 v) noexcept {
  p[0] = v.a;
  p[1] = v.b;
}
TEXTPLANE_SIMD_INLINE v16 add16(v16 x, v16 y) noexcept { return make16(x.a + y.a, x.b + y.b); }
TEXTPLANE_SIMD_INLINE v16 sub16(v16 x, v16 y) noexcept { return make16(x.a - y.a, x.b - y.b); }
// x y / 2^15, rounded to the nearest, halves up; not both -2^15.
TEXTPLANE_SIMD_INLINE v16 mul15(v16 x, v16 y) noexcept {
  return make16((x.a * y.a + 16384) >> 15, (x.b * y.b + 16384) >> 15);
}
// Of each word's two bytes, unsigned: low * w0 + high * w1, weights in [-64, 64].
TEXTPLANE_SIMD_INLINE v16 dot_pair(v16 t, int w0, int w1) noexcept {
  return make16((t.a & 255) * w0 + ((t.a >> 8) & 255) * w1, (t.b & 255) * w0 + ((t.b >> 8) & 255) * w1);
}
// int32 lane i: sum[i] + x[2i] y[2i] + x[2i+1] y[2i+1].
TEXTPLANE_SIMD_INLINE vi add_dot16(vi sum, v16 x, v16 y) noexcept { return sum + (x.a * y.a + x.b * y.b); }
// 2 kLanes int32 that fit int16, in order.
TEXTPLANE_SIMD_INLINE v16 pack16(vi low, vi high) noexcept { return make16(low, high); }
// Sum of the lanes; it wraps.
TEXTPLANE_SIMD_INLINE int hsumi(vi v) noexcept { return v; }
// Word i: the two bytes at upper (lower) + offset[i], the first of them low. Reads these bytes alone.
TEXTPLANE_SIMD_INLINE void gather16(const std::uint8_t* upper, const std::uint8_t* lower, const int* offset, v16* first,
                                    v16* second) noexcept {
  *first = make16(static_cast<int>(load_half(upper + offset[0])), static_cast<int>(load_half(upper + offset[1])));
  *second = make16(static_cast<int>(load_half(lower + offset[0])), static_cast<int>(load_half(lower + offset[1])));
}
// Word i: the low (high) half of lane i of the 2 kLanes int32 in a and b.
TEXTPLANE_SIMD_INLINE v16 low16(vi a, vi b) noexcept { return make16(a, b); }
TEXTPLANE_SIMD_INLINE v16 high16(vi a, vi b) noexcept { return make16(a >> 16, b >> 16); }
// Lane i: the two words at p + offset[i], the first of them low. Reads these words alone.
TEXTPLANE_SIMD_INLINE vi gather_pairs(const std::uint16_t* p, const int* offset) noexcept {
  return static_cast<int>(word_pair(p + offset[0]));
}
// The words' first and second half as int32.
TEXTPLANE_SIMD_INLINE vi widen_low16(v16 v) noexcept { return v.a; }
TEXTPLANE_SIMD_INLINE vi widen_high16(v16 v) noexcept { return v.b; }
