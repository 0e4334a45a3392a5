// A benchmark is named `<kernel>/<target>/<N>`, gives the time of one call, and has counters:
//   ns_pixel   nanoseconds for one pixel, or for one of the items that the name says
//   error, ... the error of the result, measured before the timing
#ifndef TEXTPLANE_BENCH_REGISTRY_HPP
#define TEXTPLANE_BENCH_REGISTRY_HPP

#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "textplane/simd/dispatch.hpp"

namespace textplane_bench {

using Errors = std::map<std::string, double>;

/// What a benchmark does. `call` is one iteration; it gets the number of the iteration, to cycle through operands.
struct Work {
  std::function<void(std::size_t)> call;
  double items = 1;
  Errors errors;
};

/// Registers `make` under a name. The first repetition makes the work and checks its result; later ones reuse it.
inline benchmark::internal::Benchmark* add(const std::string& name, const std::function<Work()>& make,
                                           const char* target = nullptr) {
  const auto kept = std::make_shared<Work>();
  textplane::simd::Target wanted = textplane::simd::Target::scalar;
  const bool fixed = target && textplane::simd::target_from_string(target, wanted);
  return benchmark::RegisterBenchmark(name.c_str(), [kept, make, fixed, wanted](benchmark::State& state) {
    const textplane::simd::Target before = textplane::simd::active_target();
    if (fixed) textplane::simd::set_target(wanted);
    if (!kept->call) *kept = make();
    std::size_t i = 0;
    for (auto _ : state) kept->call(i++);
    state.counters["ns_pixel"] = benchmark::Counter(
        kept->items * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    for (const auto& [key, value] : kept->errors) state.counters[key] = value;
    textplane::simd::set_target(before);
  });
}

/// Registers `<kernel>/<target>/<size>` for every SIMD target of this machine.
inline void add_targets(const std::string& kernel, const std::string& size, const std::function<Work()>& make) {
  for (int i = 0; i < textplane::simd::kTargetCount; ++i) {
    const auto target = static_cast<textplane::simd::Target>(i);
    if (!textplane::simd::supported(target)) continue;
    const char* name = textplane::simd::to_string(target);
    add(kernel + "/" + name + "/" + size, make, name);
  }
}

/// Keeps the compiler from dropping a result.
template <class T>
void keep(T&& value) {
  benchmark::DoNotOptimize(value);
}

void add_equations();        ///< kernels/equations.cpp: normal equations of all kinds, ours.
void add_images();           ///< kernels/images.cpp: warp, FAST, KLT, pyramid, ours.
void add_converge();         ///< kernels/converge.cpp: ours to convergence.
void add_growth();           ///< kernels/growth.cpp: cost against pixels, objects and threads.
void add_text_map();         ///< kernels/text_map.cpp: frames tracked by a map of texts.
void add_straightforward();  ///< peers/straightforward.cpp: Eigen double; Ceres and numeric differences where built.
void add_opencv();           ///< peers/opencv.cpp
void add_ecc();              ///< peers/ecc.cpp
void add_dlib();             ///< peers/boxes.cpp
void add_visp();             ///< peers/visp.cpp

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_REGISTRY_HPP
