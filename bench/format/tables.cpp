#include "format/tables.hpp"

#include <algorithm>
#include <set>

#include "format/comparisons.hpp"
#include "format/text.hpp"

namespace textplane_bench {

namespace {

// The error of a result as its cell says it; empty where there is none.
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

std::string least_and_median(const Measured& m) {
  return short_number(least(m.ns_item)) + ", " + short_number(median(m.ns_item));
}

std::string measured_cells(const Comparison& c, const Measured& ours, const Measured& peer) {
  const double ratio = least(peer.ns_item) / least(ours.ns_item);
  const double medians = median(peer.ns_item) / median(ours.ns_item);
  const std::string verdict = !(c.aim > 0) ? "" : ratio >= c.aim ? "met" : "**not met**";
  return short_number(ratio) + "x | " + short_number(medians) + "x | " + verdict + " | " + least_and_median(ours) +
         " | " + least_and_median(peer) + " | " + error_text(ours.errors) + " | " + error_text(peer.errors) + " |\n";
}

// Why there is no ratio; empty where the row is left out: a CPU without a target need not say so where there is no aim,
// nor a peer that has another form.
std::string reason(const Comparison& c, const std::string& target, bool has_ours, bool has_peer) {
  const bool lacks_target = !has_ours && (target == "avx512" || target == "neon");
  if (lacks_target) return c.aim > 0 ? "not run: this CPU lacks it" : "";
  if (c.alternative && !has_peer) return "";
  return has_peer ? "not run" : "not run: the peer is not installed";
}

}  // namespace

std::string comparison_table(const Results& all, const std::string& best) {
  std::string table =
      "| versus | N | target | aim | reached: minima | medians | | ours, ns: min, median | peer, ns: min, median | "
      "error of ours | error of the peer |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const Comparison& c : kComparisons) {
    const std::string target = std::string(c.target) == "best" ? best : c.target;
    const auto ours = all.find(std::string(c.ours) + "/" + target + "/" + c.size), peer = all.find(c.peer);
    const std::string aim = c.aim > 0 ? short_number(c.aim) + "x" : "";
    const std::string head = std::string("| ") + c.versus + " | " + c.size + " | " + target + " | " + aim + " | ";
    if (ours != all.end() && peer != all.end()) {
      table += head + measured_cells(c, ours->second, peer->second);
    } else {
      const std::string why = reason(c, target, ours != all.end(), peer != all.end());
      if (!why.empty()) table += head + why + " | | | | | | |\n";
    }
  }
  return table;
}

std::string kernel_table(const Results& all) {
  std::map<std::string, std::map<std::string, const Measured*>> rows;
  std::set<std::string> targets;
  for (const auto& [name, m] : all) {
    const std::size_t a = name.find('/'), b = name.find('/', a + 1);
    const std::string target = name.substr(a + 1, b - a - 1);
    static const std::set<std::string> known = {"scalar", "sse41", "avx2", "avx512", "neon", "simd128"};
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
      out += found == row.end() ? " |" : " " + least_and_median(*found->second) + " |";
      if (found != row.end()) error = error_text(found->second->errors);
    }
    out += " " + error + " |\n";
  }
  return out;
}

std::vector<Line> growth(const Results& all, const std::string& kind, const std::string& target) {
  std::vector<Line> lines;
  for (const char* threads : {"1", "2"}) {
    Line line;
    line.label = std::string(threads) + (*threads == '1' ? " thread" : " threads");
    const std::string prefix = kind + "_" + threads + "threads/" + target + "/";
    for (const auto& [name, m] : all) {
      if (name.compare(0, prefix.size(), prefix) != 0) continue;
      const double size = std::stod(name.substr(prefix.size()));
      line.points.emplace_back(size, least(m.ns_call) / size);
    }
    std::sort(line.points.begin(), line.points.end());
    if (!line.points.empty()) lines.push_back(line);
  }
  return lines;
}

}  // namespace textplane_bench
