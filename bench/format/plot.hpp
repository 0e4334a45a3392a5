// A line plot with logarithmic axes as SVG.
#ifndef TEXTPLANE_BENCH_FORMAT_PLOT_HPP
#define TEXTPLANE_BENCH_FORMAT_PLOT_HPP

#include <string>
#include <utility>
#include <vector>

namespace textplane_bench {

struct Line {
  std::string label;
  std::vector<std::pair<double, double>> points;  ///< Positive coordinates.
};

std::string plot(const std::string& title, const std::string& x_label, const std::string& y_label,
                 const std::vector<Line>& lines);

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_FORMAT_PLOT_HPP
