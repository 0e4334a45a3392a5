// Bytes that the program holds on the heap, counted by this program's own malloc(), which libraries reach too. glibc only.
#ifndef TEXTPLANE_BENCH_WINDOW_HEAP_HPP
#define TEXTPLANE_BENCH_WINDOW_HEAP_HPP

#include <cstddef>

namespace textplane_bench {

/// Starts a measurement: the peak becomes what is held now.
void start_heap_peak();
/// The most that was held since, less what was held at the start.
std::size_t heap_peak();

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_WINDOW_HEAP_HPP
