// The tables and curves of docs/benchmarks.md, from the measurements of textplane_bench.
#ifndef TEXTPLANE_BENCH_FORMAT_TABLES_HPP
#define TEXTPLANE_BENCH_FORMAT_TABLES_HPP

#include <string>
#include <vector>

#include "format/plot.hpp"
#include "format/results.hpp"

namespace textplane_bench {

/// A row for each of kComparisons. `best`: the best SIMD target of the machine.
std::string comparison_table(const Results& all, const std::string& best);

/// A row for each kernel and size, a column for each SIMD target.
std::string kernel_table(const Results& all);

/// ns an item against size, a line for each number of threads.
std::vector<Line> growth(const Results& all, const std::string& kind, const std::string& target);

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_FORMAT_TABLES_HPP
