#include "format/basin.hpp"

#include <set>

#include "format/text.hpp"

namespace textplane_bench {

namespace {

std::string key(const Json& row) {
  return "| " + row.at("method").get<std::string>() + " | " + row.at("unknowns").get<std::string>() + " | " +
         row.at("levels").dump() + " |";
}

std::string percent(double share) { return " " + fixed(100 * share, 1) + " |"; }

}  // namespace

std::string basin_table(const Json& rows) {
  std::set<double> distances;
  for (const Json& r : rows) distances.insert(r.at("px").get<double>());
  std::string out = "| method | unknown | levels |", rule = "| --- | --- | --- |";
  for (const double px : distances) {
    out += " " + short_number(px) + " px |";
    rule += " --- |";
  }
  out += " slanted, 4 px | slanted, 8 px | error, px | time, us |\n" + rule + " --- | --- | --- | --- |\n";
  std::set<std::string> done;
  for (const Json& first : rows) {
    if (!done.insert(key(first)).second) continue;
    out += key(first);
    std::string slanted, end;
    for (const Json& r : rows) {
      if (key(r) != key(first)) continue;
      out += percent(r.at("success").get<double>());
      const double px = r.at("px").get<double>(), scenes = static_cast<double>(r.at("by_scene").size());
      if (px == 4 || px == 8)
        slanted += percent(r.at("by_scene").at("slanted print").get<double>() * scenes / r.at("trials").get<double>());
      if (px == 4)
        end = " " + short_number(r.at("median_error").get<double>()) + " | " +
              short_number(r.at("median_us").get<double>()) + " |\n";
    }
    out += slanted + end;
  }
  return out;
}

std::string basin_line(const Json& rows, double px, double aim) {
  for (const Json& r : rows)
    if (r.value("recommended", false) && r.at("px").get<double>() == px) {
      const double success = 100 * r.at("success").get<double>();
      return "- " + r.at("method").get<std::string>() + ", " + short_number(px) + " px: " + fixed(success, 1) +
             " % of " + r.at("trials").dump() + " trials, aim " + short_number(aim) +
             " %: " + (success >= aim ? "met" : "**not met**") + "\n";
    }
  return "";
}

}  // namespace textplane_bench
