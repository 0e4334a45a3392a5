// The rows of textplane_convergence as Markdown.
#ifndef TEXTPLANE_BENCH_FORMAT_BASIN_HPP
#define TEXTPLANE_BENCH_FORMAT_BASIN_HPP

#include <string>

#include "format/results.hpp"

namespace textplane_bench {

/// A row a method, unknowns and number of levels: success in % by distance of the start, then of the slanted scene alone at 4
/// and 8 px, the median final error and the median time at 4 px.
std::string basin_table(const Json& rows);

/// Success at `px` of the recommended method against its aim, in %.
std::string basin_line(const Json& rows, double px, double aim);

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_FORMAT_BASIN_HPP
