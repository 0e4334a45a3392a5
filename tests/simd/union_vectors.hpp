// Vectors as MSVC has them, for g++ and clang++: unions without operators of their own. The intrinsics take and give
// the compiler's vectors, which convert. Where the command line allows all instruction sets, the regions of textplane
// compile as they do for MSVC, and run (simd/compiler.hpp, TEXTPLANE_UNION_VECTORS). What uses vectors otherwise comes
// first.
#ifndef TEXTPLANE_TESTS_SIMD_UNION_VECTORS_HPP
#define TEXTPLANE_TESTS_SIMD_UNION_VECTORS_HPP

#include <immintrin.h>

#include <Eigen/Dense>
#include <type_traits>

namespace union_vectors {

/// Clang's intrinsics with constants are macros, which cast by hand.
template <class From, class Native, class Union>
using IfCast = std::enable_if_t<sizeof(From) == sizeof(Native) && !std::is_same<From, Union>::value>;

#define TEXTPLANE_TESTS_UNION(Name, Native)                                     \
  union Name {                                                                  \
    Native native;                                                              \
    Name() = default;                                                           \
    __attribute__((always_inline)) Name(Native v) : native(v) {}                \
    __attribute__((always_inline)) operator Native() const { return native; }   \
    template <class From, class = IfCast<From, Native, Name>>                   \
    __attribute__((always_inline)) explicit Name(From v) : native((Native)v) {} \
    template <class To, class = IfCast<To, Native, Name>>                       \
    __attribute__((always_inline)) explicit operator To() const {               \
      return (To)native;                                                        \
    }                                                                           \
  };                                                                            \
  inline const Native* in(const Name* p) { return &p->native; }                 \
  inline Native* in(Name* p) { return &p->native; }
TEXTPLANE_TESTS_UNION(M128, __m128)
TEXTPLANE_TESTS_UNION(M128i, __m128i)
TEXTPLANE_TESTS_UNION(M128d, __m128d)
TEXTPLANE_TESTS_UNION(M256, __m256)
TEXTPLANE_TESTS_UNION(M256i, __m256i)
TEXTPLANE_TESTS_UNION(M256d, __m256d)
TEXTPLANE_TESTS_UNION(M512, __m512)
TEXTPLANE_TESTS_UNION(M512i, __m512i)
TEXTPLANE_TESTS_UNION(M512d, __m512d)
#undef TEXTPLANE_TESTS_UNION

}  // namespace union_vectors

// Those that take pointers to vectors.
#define _mm_loadu_si128(p) (_mm_loadu_si128)(union_vectors::in(p))
#define _mm_storeu_si128(p, v) (_mm_storeu_si128)(union_vectors::in(p), v)
#define _mm_storel_epi64(p, v) (_mm_storel_epi64)(union_vectors::in(p), v)
#define _mm256_loadu_si256(p) (_mm256_loadu_si256)(union_vectors::in(p))
#define _mm256_storeu_si256(p, v) (_mm256_storeu_si256)(union_vectors::in(p), v)

#define __m128 union_vectors::M128
#define __m128i union_vectors::M128i
#define __m128d union_vectors::M128d
#define __m256 union_vectors::M256
#define __m256i union_vectors::M256i
#define __m256d union_vectors::M256d
#define __m512 union_vectors::M512
#define __m512i union_vectors::M512i
#define __m512d union_vectors::M512d

#endif  // TEXTPLANE_TESTS_SIMD_UNION_VECTORS_HPP
