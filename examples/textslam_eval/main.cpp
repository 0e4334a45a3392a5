// textslam-eval: the errors of runs against the truth.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "cli/command_line.hpp"
#include "io/input_error.hpp"
#include "textslam_eval/format.hpp"
#include "textslam_eval/map_run.hpp"

namespace {

using textslam::kInputError;

void print(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0)
    throw std::runtime_error("cannot write to standard output");
}

int execute(int argc, char** argv) {
  std::vector<std::string> runs;
  std::string truth, map_run, scale = "sim3";
  bool markdown = false, csv = false;
  CLI::App app{
      "Errors of runs against the truth: absolute (ATE) and relative (RPE, over 0.1 m and per frame) of the "
      "trajectory,\n"
      "coverage, angles and centres of the signs. Lengths in the unit of the truth, angles in degrees."};
  app.add_option("RUN", runs, "Output folders of textslam: trajectory.txt, and text_map.json where there is one")
      ->required();
  app.add_option("--truth", truth,
                 "Folder with groundtruth.txt, and truth/signs.json where there is one, or in EuRoC's layout; without "
                 "it RUN/sequence");
  app.add_option("--scale", scale, "sim3: aligned with scale; se3: without")
      ->check(CLI::IsMember({"sim3", "se3"}))
      ->capture_default_str();
  CLI::Option* markdown_flag = app.add_flag("--markdown", markdown, "A Markdown table, a column a run");
  CLI::Option* csv_flag = app.add_flag("--csv", csv, "CSV, a line a run")->excludes(markdown_flag);
  app.add_option(
         "--map-run", map_run,
         "The runs were localised in the map of this run: judge their poses in the map's frame, a line of JSON a "
         "run. Its truth is its folder sequence")
      ->excludes(markdown_flag)
      ->excludes(csv_flag);
  if (const auto code = textslam::parse_command_line(app, "textslam-eval", argc, argv)) return *code;

  if (!map_run.empty()) {
    for (const std::string& run : runs)
      print(textslam::format_localised(textslam::evaluate_localised(run, truth, map_run)));
    return 0;
  }
  std::vector<textslam::RunEvaluation> evaluations;
  for (const std::string& run : runs) evaluations.push_back(textslam::evaluate_run(run, truth, scale == "sim3"));
  const textslam::Format format = markdown ? textslam::Format::markdown
                                  : csv    ? textslam::Format::csv
                                           : textslam::Format::text;
  print(textslam::format_evaluations(evaluations, format));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return execute(argc, argv);
  } catch (const textslam::InputError& error) {
    std::fprintf(stderr, "textslam-eval: %s\n", error.what());
    return kInputError;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "textslam-eval: %s\n", error.what());
    return 1;
  }
}
