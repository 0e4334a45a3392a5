// Heap memory of the program, libraries included, counted by its own malloc(). glibc only.
#ifndef TEXTPLANE_BENCH_WINDOW_HEAP_HPP
#define TEXTPLANE_BENCH_WINDOW_HEAP_HPP

#include <cstddef>

namespace textplane_bench {

/// Starts a measurement.
void start_heap_peak();
/// The largest growth since the start of the measurement, bytes.
std::size_t heap_peak();

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_WINDOW_HEAP_HPP
