// Which targets give the same bits where madd() decides.
#ifndef TESTS_SIMD_ROUNDING_SUPPORT_HPP
#define TESTS_SIMD_ROUNDING_SUPPORT_HPP

#include "textplane/simd/targets.hpp"

namespace textplane_test {

enum Rounding {
  rounds_twice,
  rounds_once,
  as_the_engine_does,  ///< Of a WebAssembly module with relaxed vectors: like neither of the others, perhaps.
  kRoundings
};

/// How madd() of the target rounds; targets of one kind give the same bits.
inline Rounding rounding(textplane::simd::Target target) {
#ifdef __wasm_relaxed_simd__
  if (target == textplane::simd::Target::simd128) return as_the_engine_does;
#endif
  return textplane::simd::fused(target) ? rounds_once : rounds_twice;
}

}  // namespace textplane_test

#endif  // TESTS_SIMD_ROUNDING_SUPPORT_HPP
