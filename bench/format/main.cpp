// report_format BENCH.json... --root REPOSITORY [--cpu NAME] [--repetitions N] [--convergence FILE] [--textslam TIMING.json]
//
// Writes docs/benchmarks.json, docs/benchmarks.md, docs/images/growth_*.svg, and the block of README.md between
// `<!-- speed: begin -->` and `<!-- speed: end -->`.
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <set>
#include <sstream>

#include "basin.hpp"
#include "comparisons.hpp"
#include "page.hpp"
#include "plot.hpp"
#include "results.hpp"
#include "text.hpp"

namespace textplane_bench {
namespace {

// How an error reads in a cell, or nothing.
std::string error_text(const std::map<std::string, double>& e) {
  const auto has = [&e](const char* key) { return e.count(key) != 0; };
  if (has("corner_error")) return "corners " + short_number(e.at("corner_error")) + " px";
  if (has("error_p90"))
    return "end point " + short_number(e.at("error_median")) + " px, p90 " + short_number(e.at("error_p90")) + ", " +
           fixed(100 * e.at("within_1px"), 0) + " % within 1 px";
  if (has("different_from_ours"))
    return fixed(e.at("corners"), 0) + " corners, " + fixed(e.at("different_from_ours"), 0) + " differ";
  if (has("error_H")) return "H " + short_number(e.at("error_H")) + ", b " + short_number(e.at("error_b"));
  if (has("error_J")) return "J " + short_number(e.at("error_J"));
  if (has("error")) return short_number(std::max(0.0, e.at("error"))) + " grey levels";
  return "";
}

struct Report {
  Json document;
  std::string table, speed;
};

Report compare(const Results& all, const std::string& best) {
  Report report;
  report.document = Json::array();
  report.table =
      "| versus | N | target | aim | reached: minima | medians | | ours, ns: min, median | peer, ns: min, median | "
      "error of ours | error of the peer |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  report.speed =
      "| versus | N | target | times as fast | ns an item | error of ours | error of the peer |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const Comparison& c : comparisons()) {
    const std::string target = std::string(c.target) == "best" ? best : c.target;
    const auto ours = all.find(std::string(c.ours) + "/" + target + "/" + c.size), peer = all.find(c.peer);
    Json row = {{"versus", c.versus}, {"size", c.size}, {"target", target}};
    row["aim"] = c.aim > 0 ? Json(c.aim) : Json();
    const std::string aim = c.aim > 0 ? short_number(c.aim) + "x" : "";
    const std::string head = std::string("| ") + c.versus + " | " + c.size + " | " + target + " | " + aim + " | ";
    if (ours == all.end() || peer == all.end()) {
      const bool cpu = ours == all.end() && (target == "avx512" || target == "neon");
      const std::string why = cpu                 ? "not run: this CPU lacks it"
                              : peer == all.end() ? "not run: the peer is not installed"
                                                  : "not run";
      if (!cpu || c.aim > 0) {
        row["reached"] = why;
        report.document.push_back(row);
        report.table += head + why + " | | | | | | |\n";
      }
      continue;
    }
    const Measured &a = ours->second, &b = peer->second;
    const double ratio = b.min() / a.min(), medians = b.median() / a.median();
    row["reached"] = ratio;
    row["reached_medians"] = medians;
    if (c.aim > 0) row["met"] = ratio >= c.aim;
    row["ours_ns"] = {{"min", a.min()}, {"median", a.median()}};
    row["peer_ns"] = {{"min", b.min()}, {"median", b.median()}};
    row["ours_error"] = a.errors;
    row["peer_error"] = b.errors;
    report.document.push_back(row);
    report.table += head + short_number(ratio) + "x | " + short_number(medians) + "x | " +
                    (c.aim > 0 ? ratio >= c.aim ? "met" : "**not met**" : "") + " | " + short_number(a.min()) + ", " +
                    short_number(a.median()) + " | " + short_number(b.min()) + ", " + short_number(b.median()) + " | " +
                    error_text(a.errors) + " | " + error_text(b.errors) + " |\n";
    if (c.aim > 0)
      report.speed += std::string("| ") + c.versus + " | " + c.size + " | " + target + " | " + short_number(ratio) +
                      " | " + short_number(a.min()) + " | " + error_text(a.errors) + " | " + error_text(b.errors) +
                      " |\n";
  }
  return report;
}

// Every kernel of ours, one row a size, one column a target.
std::string kernels(const Results& all) {
  std::map<std::string, std::map<std::string, const Measured*>> rows;
  std::set<std::string> targets;
  for (const auto& [name, m] : all) {
    const std::size_t a = name.find('/'), b = name.find('/', a + 1);
    const std::string target = name.substr(a + 1, b - a - 1);
    static const std::set<std::string> known = {"scalar", "sse41", "avx2", "avx512", "neon"};
    if (!known.count(target) || name.compare(0, 6, "growth") == 0 || m.ns_item.empty()) continue;
    targets.insert(target);
    rows[name.substr(0, a) + " | " + name.substr(b + 1)][target] = &m;
  }
  std::string out = "| kernel | size |", rule = "| --- | --- |";
  for (const std::string& t : targets) {
    out += " " + t + " |";
    rule += " --- |";
  }
  out += " error |\n" + rule + " --- |\n";
  for (const auto& [name, row] : rows) {
    out += "| " + name + " |";
    std::string error;
    for (const std::string& t : targets) {
      const auto found = row.find(t);
      out += found == row.end()
                 ? " |"
                 : " " + short_number(found->second->min()) + ", " + short_number(found->second->median()) + " |";
      if (found != row.end()) error = error_text(found->second->errors);
    }
    out += " " + error + " |\n";
  }
  return out;
}

// ns an item against size, one line for each number of threads.
std::vector<Line> growth(const Results& all, const std::string& kind, const std::string& target, double items) {
  std::vector<Line> lines;
  for (const char* threads : {"1", "2"}) {
    Line line;
    line.label = std::string(threads) + (*threads == '1' ? " thread" : " threads");
    const std::string prefix = kind + "_" + threads + "threads/" + target + "/";
    for (const auto& [name, m] : all) {
      if (name.compare(0, prefix.size(), prefix) != 0) continue;
      const double size = std::stod(name.substr(prefix.size()));
      line.points.emplace_back(size, Measured::least(m.ns_call) / (size * items));
    }
    std::sort(line.points.begin(), line.points.end());
    if (!line.points.empty()) lines.push_back(line);
  }
  return lines;
}

int run(int argc, char** argv) {
  std::string convergence, textslam, root, cpu = "unknown CPU", repetitions = "?";
  std::vector<std::string> runs;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    std::string* value = argument == "--convergence"   ? &convergence
                         : argument == "--textslam"    ? &textslam
                         : argument == "--root"        ? &root
                         : argument == "--cpu"         ? &cpu
                         : argument == "--repetitions" ? &repetitions
                                                       : nullptr;
    if (value && i + 1 < argc) {
      *value = argv[++i];
    } else {
      runs.push_back(argument);
    }
  }
  if (runs.empty() || root.empty()) {
    std::cerr << "usage: report_format BENCH.json... --root REPOSITORY [--cpu NAME] [--repetitions N] [--convergence "
                 "FILE] [--textslam FILE]\n";
    return 2;
  }
  Json raw = read_json(runs[0]);
  for (std::size_t i = 1; i < runs.size(); ++i) {
    const Json more = read_json(runs[i]);
    for (const Json& b : more.at("benchmarks")) raw["benchmarks"].push_back(b);
  }
  const Json context = raw.at("context");
  const Results all = results(raw);
  const std::string best = context.at("target"), docs = root + "/docs/";
  const Report report = compare(all, best);

  std::string md =
      "# Benchmarks\n\nWritten by `bench/report`, in one process, single thread unless said. Ratios are of the peer's "
      "time to ours.\n\n";
  const std::string date = context.value("date", "");
  const std::string machine = cpu + ", " + context.value("compiler", "") + ", ours `" + context.value("flags", "") +
                              "`, peers in headers `-O3 -march=native`, " + repetitions + " interleaved repetitions, " +
                              date.substr(0, date.find('T'));
  md += "Machine: " + machine + ". Best target: `" + best + "`.\n\n";
  md +=
      "## Against the peers\n\nErrors are those of the results that were timed, against the double reference (H over "
      "sqrt(H_ii H_jj), b over sqrt(H_ii)), or "
      "against the truth of the scene (corners, end points). An item is a pixel, a pixel and iteration, or a point; "
      "for convergence "
      "the whole is divided by the pixels.\n\n" +
      report.table;

  Json out = {{"machine", machine}, {"target", best}, {"comparisons", report.document}};
  if (!convergence.empty()) {
    const Json rows = read_json(convergence);
    md +=
        "\n## Basin\n\nSuccess is a final corner error below 0.5 px, from starts that are off by so many px on "
        "average; a 100 x 40 patch.\n\n" +
        basin_line(rows, 8, 99) + basin_line(rows, 12, 60) + "\n" + basin_table(rows);
    replace_block(docs + "policy.md", "policies", basin_table(rows));
    out["convergence"] = rows;
  }
  if (!textslam.empty()) {
    const Json timing = read_json(textslam);
    const double median = timing.at("stages").at("tracking").at("median");
    md += "\n## textslam on the rendered `room`\n\nTracking takes " + fixed(median, 2) +
          " ms a frame (median, 640 x 480, one core); aim 5 ms: " + (median < 5 ? "met" : "**not met**") + ".\n";
    out["textslam_tracking_ms"] = median;
  }
  md += "\n## Every kernel\n\nns an item, minimum and median.\n\n" + kernels(all);

  const auto plots = [&](const char* kind, const char* file, const char* title, const char* x_label,
                         const char* y_label, double items) {
    const std::vector<Line> lines = growth(all, kind, best, items);
    const std::string svg = plot(title, x_label, y_label, lines);
    if (svg.empty()) return;
    write(docs + "images/" + file, svg);
    md += std::string("![") + title + "](images/" + file + ")\n\n";
    for (const Line& l : lines) out["growth"][kind][l.label] = l.points;
  };
  md +=
      "\n## How cost grows\n\nTime is elapsed time: with two threads each works on its own, and the time is divided by "
      "the work of both.\n\n";
  plots("growth_pixels", "growth_pixels.svg", "Normal equations, 9 parameters, one object", "pixels", "ns a pixel", 1);
  plots("growth_objects", "growth_objects.svg", "Batch, 6 parameters, 15 pixels an object", "objects", "ns an object",
        1);

  write(docs + "benchmarks.md", md);
  write(docs + "benchmarks.json", out.dump(1) + "\n");
  replace_block(root + "/README.md", "speed",
                machine + "; more in [docs/benchmarks.md](docs/benchmarks.md).\n\n" + report.speed);
  std::cout << report.table;
  return 0;
}

}  // namespace
}  // namespace textplane_bench

int main(int argc, char** argv) {
  try {
    return textplane_bench::run(argc, argv);
  } catch (const std::exception& e) {
    std::cerr << "report_format: " << e.what() << "\n";
    return 1;
  }
}
