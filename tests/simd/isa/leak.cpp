// What the checker must find: LEAK selects one fault each; 0 is a sound object.
#define TARGET(list) __attribute__((target(list), noinline, used))

typedef int Int4 __attribute__((vector_size(16)));
typedef float Float8 __attribute__((vector_size(32)));
typedef float Float16 __attribute__((vector_size(64)));

namespace textplane::v0::detail {
namespace sse41 {
TARGET("sse4.1") void kernel(Int4* a) { *a = *a * *a; }
}  // namespace sse41
namespace avx2 {
TARGET("avx2,popcnt") int kernel(Float8* a, int word) {
  *a = *a + *a;
  return __builtin_popcount(static_cast<unsigned>(word));
}
#if LEAK == 1
TARGET("avx512f") void wider(Float16* a) { *a = *a + *a; }
#endif
}  // namespace avx2
#if LEAK != 2
namespace avx512 {
TARGET("avx512f") void kernel(Float16* a) { *a = *a + *a; }
}  // namespace avx512
#endif
}  // namespace textplane::v0::detail

#if LEAK == 3
TARGET("avx") float wide_outside(const float* p) { return p[0] + p[1]; }
#elif LEAK == 4
TARGET("popcnt") int popcnt_outside(unsigned word) { return __builtin_popcount(word); }
#elif LEAK == 5
namespace other::detail::avx2 {
TARGET("avx2") float namesake(const float* p) { return p[0] + p[1]; }
}  // namespace other::detail::avx2
#elif LEAK == 6
namespace textplane::v0::detail::avx2 {
struct Vector {
  float value;
};
}  // namespace textplane::v0::detail::avx2
TARGET("avx2") float by_parameter(textplane::v0::detail::avx2::Vector* v) { return v->value + v->value; }
#elif LEAK == 7
TARGET("bmi") unsigned bmi_outside(unsigned a, unsigned b) { return ~a & b; }
#endif
