// AVX-512 intrinsics on AVX2, so that the avx512 bodies run, with their sixteen lanes and their masks, on a machine
// that has none: SIMDe's, and the few that SIMDe 0.7.4 lacks. TEXTPLANE_EMULATED_AVX512 names this header
// (simd/targets.hpp). An intrinsic that neither of them has is a compile error, never a silent gap.
#ifndef TEXTPLANE_TESTS_SIMD_EMULATED_AVX512_HPP
#define TEXTPLANE_TESTS_SIMD_EMULATED_AVX512_HPP

#define SIMDE_ENABLE_NATIVE_ALIASES
#include <simde/x86/avx512.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace emulated {

template <class T, class Vector>
using Lanes = std::array<T, sizeof(Vector) / sizeof(T)>;

template <class T, class Vector>
Lanes<T, Vector> lanes(const Vector& v) {
  Lanes<T, Vector> result;
  std::memcpy(&result, &v, sizeof v);
  return result;
}

template <class Vector, class T, std::size_t N>
Vector vector(const std::array<T, N>& values) {
  static_assert(sizeof(Vector) == sizeof values);
  Vector result;
  std::memcpy(&result, &values, sizeof result);
  return result;
}

/// One lane of the result a call of f(i) where the mask says so, zero elsewhere.
template <class T, class Vector, class F>
Vector masked(std::uint64_t mask, F f) {
  Lanes<T, Vector> result{};
  for (std::size_t i = 0; i < result.size(); ++i) {
    if ((mask >> i & 1u) != 0) result[i] = f(i);
  }
  return vector<Vector>(result);
}

/// Memory of lanes that the mask leaves out is not touched.
template <class T, class Vector>
Vector load(std::uint64_t mask, const void* p) {
  return masked<T, Vector>(mask, [p](std::size_t i) {
    T value;
    std::memcpy(&value, static_cast<const unsigned char*>(p) + i * sizeof(T), sizeof value);
    return value;
  });
}
template <class T, class Vector>
void store(void* p, std::uint64_t mask, const Vector& v) {
  const auto values = lanes<T>(v);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if ((mask >> i & 1u) != 0) std::memcpy(static_cast<unsigned char*>(p) + i * sizeof(T), &values[i], sizeof(T));
  }
}

/// The lanes of `from`, the lowest ones first, converted one by one.
template <class To, class From, class VectorTo, class VectorFrom>
VectorTo convert(std::uint64_t mask, const VectorFrom& from) {
  const auto values = lanes<From>(from);
  return masked<To, VectorTo>(mask, [&](std::size_t i) { return static_cast<To>(values[i]); });
}

inline std::int32_t truncate(float value) {
  return value >= -2147483648.0f && value < 2147483648.0f ? static_cast<std::int32_t>(value) : INT32_MIN;
}

inline float round(float value, int mode) {
  switch (mode & 3) {
    case _MM_FROUND_TO_NEG_INF: return std::floor(value);
    case _MM_FROUND_TO_POS_INF: return std::ceil(value);
    case _MM_FROUND_TO_ZERO: return std::trunc(value);
    default: return std::nearbyint(value);
  }
}

}  // namespace emulated

#undef _mm512_maskz_loadu_ps
#define _mm512_maskz_loadu_ps(m, p) (emulated::load<float, __m512>((m), (p)))
#undef _mm512_maskz_loadu_epi8
#define _mm512_maskz_loadu_epi8(m, p) (emulated::load<std::int8_t, __m512i>((m), (p)))
#undef _mm512_mask_storeu_ps
#define _mm512_mask_storeu_ps(p, m, v) (emulated::store<float>((p), (m), (v)))
#undef _mm512_mask_storeu_epi8
#define _mm512_mask_storeu_epi8(p, m, v) (emulated::store<std::int8_t>((p), (m), (v)))
#undef _mm512_maskz_cvtepi32_ps
#define _mm512_maskz_cvtepi32_ps(m, a) (emulated::convert<float, std::int32_t, __m512>((m), (a)))
#undef _mm512_maskz_cvtepi32_epi8
#define _mm512_maskz_cvtepi32_epi8(m, a) (emulated::convert<std::int8_t, std::int32_t, __m128i>((m), (a)))
#undef _mm512_maskz_cvtepi32_pd
#define _mm512_maskz_cvtepi32_pd(m, a) (emulated::convert<double, std::int32_t, __m512d>((m), (a)))
#undef _mm512_maskz_cvtps_pd
#define _mm512_maskz_cvtps_pd(m, a) (emulated::convert<double, float, __m512d>((m), (a)))
#undef _mm512_maskz_cvtepi16_epi32
#define _mm512_maskz_cvtepi16_epi32(m, a) (emulated::convert<std::int32_t, std::int16_t, __m512i>((m), (a)))
#undef _mm512_maskz_cvtpd_ps
#define _mm512_maskz_cvtpd_ps(m, a) (emulated::convert<float, double, __m256>((m), (a)))
#undef _mm512_maskz_cvttps_epi32
#define _mm512_maskz_cvttps_epi32(m, a)     \
  (emulated::masked<std::int32_t, __m512i>( \
      (m), [&](std::size_t i) { return emulated::truncate(emulated::lanes<float>(a)[i]); }))
#undef _mm512_maskz_extractf32x8_ps
#define _mm512_maskz_extractf32x8_ps(m, a, half) \
  (emulated::masked<float, __m256>((m), [&](std::size_t i) { return emulated::lanes<float>(a)[8 * (half) + i]; }))
#undef _mm512_maskz_sqrt_ps
#define _mm512_maskz_sqrt_ps(m, a) \
  (emulated::masked<float, __m512>((m), [&](std::size_t i) { return std::sqrt(emulated::lanes<float>(a)[i]); }))
#undef _mm512_maskz_rsqrt14_ps
#define _mm512_maskz_rsqrt14_ps(m, a) \
  (emulated::masked<float, __m512>((m), [&](std::size_t i) { return 1.0f / std::sqrt(emulated::lanes<float>(a)[i]); }))
#undef _mm512_maskz_sra_epi32
#define _mm512_maskz_sra_epi32(m, a, bits)  \
  (emulated::masked<std::int32_t, __m512i>( \
      (m), [&](std::size_t i) { return emulated::lanes<std::int32_t>(a)[i] >> _mm_cvtsi128_si32(bits); }))
// SIMDe's own leaves 0.5 as it is when it rounds down.
#undef _mm512_maskz_roundscale_ps
#define _mm512_maskz_roundscale_ps(m, a, mode) \
  (emulated::masked<float, __m512>(            \
      (m), [&](std::size_t i) { return emulated::round(emulated::lanes<float>(a)[i], (mode)); }))

#endif  // TEXTPLANE_TESTS_SIMD_EMULATED_AVX512_HPP
