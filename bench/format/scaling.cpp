// From the JSON of textplane_scaling to the table of docs/scaling.md, between its marks.
#include <sstream>
#include <string>

#include "format/program.hpp"
#include "format/results.hpp"
#include "format/text.hpp"

namespace textplane_bench {

namespace {

std::string megabytes(const Json& solver) { return short_number(solver.at("bytes").get<double>() / 1e6); }
std::string milliseconds(const Json& solver) {
  return short_number(solver.at("cpu_ms_min").get<double>()) + ", " +
         short_number(solver.at("cpu_ms_median").get<double>());
}
double least_ms(const Json& solver) { return solver.at("cpu_ms_min").get<double>(); }
std::string scientific(double v) {
  char out[32];
  std::snprintf(out, sizeof out, "%.0e", v);
  return out;
}
// Differences: relative cost, then camera position and rotation, point, plane.
std::string difference(const Json& r, const char* kind) {
  if (!r.contains(kind)) return "| ";
  std::string out = scientific(r.at(kind).at("cost").get<double>()) + " |";
  std::string separator = " ";
  for (const char* what : {"position", "rotation", "point", "plane"}) {
    out += separator + scientific(r.at(kind).at(what).get<double>());
    separator = ", ";
  }
  return out;
}

std::string row(const Json& r) {
  const Json &ours = r.at("ours"), &sparse = r.at("sparse_schur");
  const bool dense = r.contains("dense_schur");
  std::ostringstream out;
  out << "| " << r.at("path").get<std::string>() << " | " << r.at("frames") << " | " << r.at("points") << " | "
      << r.at("texts") << " | " << r.at("point_observations") << " + " << r.at("text_observations") << " | "
      << milliseconds(ours) << " | " << milliseconds(sparse) << " | "
      << (dense ? milliseconds(r.at("dense_schur")) : "") << " | " << fixed(least_ms(sparse) / least_ms(ours), 1)
      << (dense ? ", " + fixed(least_ms(r.at("dense_schur")) / least_ms(ours), 1) : "") << " | " << megabytes(ours)
      << ", " << megabytes(sparse) << " | " << ours.at("iterations") << ", " << sparse.at("iterations") << " | "
      << scientific(r.at("difference").at("cost").get<double>()) << " | " << difference(r, "optimum") << " |\n";
  return out.str();
}

std::string table(const Json& run) {
  std::string out = run.at("cpu").get<std::string>() + ", " + run.at("compiler").get<std::string>() + ", `" +
                    run.at("flags").get<std::string>() + "`, kernels `" + run.at("target").get<std::string>() +
                    "`; Ceres " + run.at("ceres").get<std::string>() + " as packaged; one thread, 3 to " +
                    std::to_string(run.at("repetitions").get<int>()) + " repetitions in turn.\n\n";
  out +=
      "| path | key frames | points | texts | observations | ours, ms | SPARSE_SCHUR, ms | DENSE_SCHUR, ms | times as "
      "fast | MB: ours, Ceres | steps: ours, Ceres | cost of Ceres above ours | the same at the optimum | apart there: "
      "m, rad, point m, plane |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const Json& r : run.at("rows")) out += row(r);
  return out;
}

}  // namespace
}  // namespace textplane_bench

int main(int argc, char** argv) {
  return textplane_bench::fill_block("report_scaling", "scaling", argc, argv, textplane_bench::table);
}
