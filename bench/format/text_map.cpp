// From the JSON of textplane_bench, its benchmarks text_map, to the tables of docs/scaling.md, between its marks.
#include <set>
#include <string>

#include "format/program.hpp"
#include "format/results.hpp"
#include "format/text.hpp"

namespace textplane_bench {

namespace {

// In microseconds; `unit` nanoseconds else.
std::string cell(const Results& all, const std::string& name, double unit = 1e3) {
  const auto found = all.find(name);
  if (found == all.end()) return " |";
  return " " + short_number(least(found->second.ns_item) / unit) + ", " +
         short_number(median(found->second.ns_item) / unit) + " |";
}

// The sizes that a benchmark was run with.
std::set<int> sizes_of(const Results& all, const std::string& kind) {
  std::set<int> sizes;
  for (const auto& [name, m] : all)
    if (name.compare(0, kind.size() + 1, kind + "/") == 0) sizes.insert(std::stoi(name.substr(name.rfind('/') + 1)));
  return sizes;
}

// Of AVX2 and, where the CPU has more, of the best target.
std::string frames(const Results& all, const std::string& best) {
  const std::set<std::string> targets = {"avx2", best};
  std::string head = "| mapped texts |", line = "| ---: |";
  for (const std::string& target : targets) {
    head += " `" + target + "`: texts and points | texts alone |";
    line += " --- | --- |";
  }
  std::string out = head + " error of the position, mm | texts alone |\n" + line + " ---: | ---: |\n";
  for (const int size : sizes_of(all, "text_map")) {
    const std::string n = "/" + std::to_string(size);
    out += "| " + std::to_string(size) + " |";
    for (const std::string& target : targets)
      for (const char* kind : {"text_map/", "text_map_without_points/"}) out += cell(all, kind + target + n);
    for (const char* kind : {"text_map/", "text_map_without_points/"})
      out += " " + fixed(all.at(kind + best + n).errors.at("error"), 2) + " |";
    out += "\n";
  }
  return out;
}

std::string parts(const Results& all) {
  std::string out =
      "| pixels a text, `avx2` | packing | ZNCC: batch | one by one | normal equations, 9 parameters: batch | one by "
      "one | `refine_pose()`, ns a text and iteration: together | one by one |\n"
      "| ---: | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const int size : sizes_of(all, "text_map_pack")) {
    out += "| " + std::to_string(size) + " |";
    for (const char* part : {"pack", "cost_batch", "cost_single", "equations_batch", "equations_single"})
      out += cell(all, std::string("text_map_") + part + "/avx2/" + std::to_string(size));
    for (const char* part : {"pose_batch", "pose_single"})
      out += cell(all, std::string("text_map_") + part + "/avx2/" + std::to_string(size), 1);
    out += "\n";
  }
  return out;
}

std::string tables(const Json& run) {
  const Json& context = run.at("context");
  const Results all = results(run.at("benchmarks"));
  return context.value("cpu", "unknown CPU") + ", " + context.value("compiler", "") + ", `" +
         context.value("flags", "") + "`, one thread, " + run.at("benchmarks").at(0).at("repetitions").dump() +
         " repetitions.\n\n" + frames(all, context.at("target")) + "\n" + parts(all);
}

}  // namespace
}  // namespace textplane_bench

int main(int argc, char** argv) {
  return textplane_bench::fill_block("report_text_map", "text_map", argc, argv, textplane_bench::tables);
}
