// report_format RESULTS ROOT
//
// RESULTS: the folder of bench/report's measurements: single.json and growth.json of textplane_bench; where they exist,
// convergence.json of textplane_convergence and room/timing.json of textslam. ROOT: the repository, or a copy of its
// docs/. Writes docs/benchmarks.md, docs/images/growth_*.svg and the table of docs/policy.md.
#include <filesystem>
#include <iostream>

#include "format/basin.hpp"
#include "format/page.hpp"
#include "format/plot.hpp"
#include "format/program.hpp"
#include "format/results.hpp"
#include "format/tables.hpp"
#include "format/text.hpp"

namespace textplane_bench {
namespace {

constexpr double kTrackingAim = 5;  // ms a frame

std::string machine(const Json& context, const Json& benchmarks) {
  const std::string date = context.value("date", "");
  return context.value("cpu", "unknown CPU") + ", " + context.value("compiler", "") + ", ours `" +
         context.value("flags", "") + "`, peers in headers `-O3 -march=native`, " +
         benchmarks.at(0).at("repetitions").dump() + " interleaved repetitions, " + date.substr(0, date.find('T'));
}

// The versions of the peers, as a sentence; empty where there are none.
std::string versions(const Json& context) {
  std::string list;
  for (const char* peer : {"OpenCV", "Ceres", "ViSP", "dlib"})
    if (context.contains(peer))
      list += (list.empty() ? " Peers: " : ", ") + std::string(peer) + " " + context.at(peer).get<std::string>();
  return list.empty() ? list : list + ".";
}

std::string basin_section(const Json& rows) {
  return "\n## Basin\n\nSuccess is a final corner error below 0.5 px, from starts that are off by so many px on "
         "average; a 100 x 40 patch.\n\n" +
         basin_line(rows, 8, 99) + basin_line(rows, 12, 60) + "\n" + basin_table(rows);
}

std::string tracking_section(const Json& timing) {
  const double median = timing.at("stages").at("tracking").at("median");
  return "\n## textslam on the rendered `room`\n\nTracking takes " + fixed(median, 2) +
         " ms a frame (median, 640 x 480, one core); aim " + fixed(kTrackingAim, 0) +
         " ms: " + (median < kTrackingAim ? "met" : "**not met**") + ".\n";
}

// Writes the plot and returns the line of the page that shows it; neither where nothing was measured.
std::string growth_plot(const Results& all, const std::string& best, const std::string& docs, const std::string& kind,
                        const char* title, const char* item) {
  const std::string svg = plot(title, item + std::string("s"),
                               std::string("ns ") + (*item == 'o' ? "an " : "a ") + item, growth(all, kind, best));
  if (svg.empty()) return "";
  write(docs + "images/" + kind + ".svg", svg);
  return std::string("![") + title + "](images/" + kind + ".svg)\n\n";
}

int run(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: report_format RESULTS ROOT\n";
    return 2;
  }
  const std::string from = std::string(argv[1]) + "/", docs = std::string(argv[2]) + "/docs/";
  Json benchmarks = read_json(from + "single.json");
  const Json context = benchmarks.at("context");
  benchmarks = benchmarks.at("benchmarks");
  const Json growing = read_json(from + "growth.json");
  for (const Json& b : growing.at("benchmarks")) benchmarks.push_back(b);
  const Results all = results(benchmarks);
  const std::string best = context.at("target"), table = comparison_table(all, best);

  std::string page =
      "# Benchmarks\n\nWritten by `bench/report`, in one process, single thread unless said. Ratios are of the peer's "
      "time to ours.\n\nMachine: " +
      machine(context, benchmarks) + ". Best target: `" + best + "`." + versions(context) +
      "\n\n## Against the peers\n\nErrors are those of the results that were timed, against the double reference (H "
      "over sqrt(H_ii H_jj), b over sqrt(H_ii)), or against the truth of the scene (corners, end points). An item is a "
      "pixel, a pixel and iteration, or a point; for convergence the whole is divided by the pixels.\n\n" +
      table;
  if (std::filesystem::exists(from + "convergence.json")) {
    const Json rows = read_json(from + "convergence.json");
    page += basin_section(rows);
    replace_block(docs + "policy.md", "policies", basin_table(rows));
  }
  if (std::filesystem::exists(from + "room/timing.json"))
    page += tracking_section(read_json(from + "room/timing.json"));
  page +=
      "\n## Every kernel\n\nns an item, minimum and median.\n\n" + kernel_table(all) +
      "\n## How cost grows\n\nTime is elapsed time: with two threads each works on its own, and the time is divided "
      "by the work of both.\n\n" +
      growth_plot(all, best, docs, "growth_pixels", "Normal equations, 9 parameters, one object", "pixel") +
      growth_plot(all, best, docs, "growth_objects", "Batch, 6 parameters, 15 pixels an object", "object");
  write(docs + "benchmarks.md", page);
  std::cout << table;
  return 0;
}

}  // namespace
}  // namespace textplane_bench

int main(int argc, char** argv) { return textplane_bench::guarded("report_format", argc, argv, textplane_bench::run); }
