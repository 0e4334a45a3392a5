// What one run of textplane_bench measured: Google Benchmark's JSON, with the repetitions of a benchmark together.
#ifndef TEXTPLANE_BENCH_FORMAT_RESULTS_HPP
#define TEXTPLANE_BENCH_FORMAT_RESULTS_HPP

#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "statistics.hpp"

namespace textplane_bench {

using Json = nlohmann::ordered_json;

/// Google Benchmark prints NaN, which is not JSON, where it divides by a mean of zero.
inline Json read_json(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::string nan = ": NaN";
  for (std::size_t at = text.find(nan); at != std::string::npos; at = text.find(nan, at))
    text.replace(at, nan.size(), ": null");
  return Json::parse(text);
}

/// One benchmark: nanoseconds for one item (a pixel, a point, a pixel and iteration) in each repetition.
struct Measured {
  std::vector<double> ns_item, ns_call;
  std::map<std::string, double> errors;
};

using Results = std::map<std::string, Measured>;

inline Results results(const Json& benchmarks) {
  Results out;
  for (const Json& b : benchmarks) {
    if (b.at("run_type") != "iteration" || b.contains("error_occurred")) continue;
    Measured& m = out[b.at("run_name").get<std::string>()];
    const std::string unit = b.at("time_unit");
    const double scale = unit == "ns" ? 1 : unit == "us" ? 1e3 : unit == "ms" ? 1e6 : 1e9;
    m.ns_call.push_back(b.at("real_time").get<double>() * scale);
    if (b.contains("ns_pixel")) m.ns_item.push_back(b.at("ns_pixel").get<double>());
    for (const char* key : {"error_H", "error_b", "error_cost", "error_J", "error", "corner_error", "error_median",
                            "error_p90", "within_1px", "corners", "different_from_ours", "iterations"})
      if (b.contains(key)) m.errors[key] = b.at(key).get<double>();
  }
  return out;
}

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_FORMAT_RESULTS_HPP
