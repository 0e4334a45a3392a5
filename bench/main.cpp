// textplane_bench: our kernels and the peers in one process on one thread. It takes Google Benchmark's options.
#include <cstdio>

#include "registry.hpp"

int main(int argc, char** argv) {
  using namespace textplane_bench;
  add_equations();
  add_images();
  add_converge();
  add_growth();
  add_text_map();
  add_straightforward();
#if defined(TEXTPLANE_BENCH_OPENCV)
  add_opencv();
  add_ecc();
#endif
#if defined(TEXTPLANE_BENCH_VISP)
  add_visp();
#endif
#if defined(TEXTPLANE_BENCH_DLIB)
  add_dlib();
#endif
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::AddCustomContext("target", textplane::simd::to_string(textplane::simd::best_target()));
#if defined(__clang__)
  benchmark::AddCustomContext("compiler", "clang++ " __clang_version__);
#else
  benchmark::AddCustomContext("compiler", "g++ " __VERSION__);
#endif
  benchmark::AddCustomContext("flags", TEXTPLANE_BENCH_FLAGS);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
