// The rows of textplane_convergence as Markdown.
#ifndef TEXTPLANE_BENCH_FORMAT_BASIN_HPP
#define TEXTPLANE_BENCH_FORMAT_BASIN_HPP

#include <string>

#include "format/results.hpp"

namespace textplane_bench {

/// A row for each method, unknowns and number of levels: success in % by distance of the start; success in the slanted
/// scene at 4 and 8 px; median final error and median time at 4 px.
std::string basin_table(const Json& rows);

/// The success of the recommended method at `px` beside its aim, in %.
std::string basin_line(const Json& rows, double px, double aim);

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_FORMAT_BASIN_HPP
