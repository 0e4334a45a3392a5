// The commands of textslam-map for map files alone. Needs CLI11.
#ifndef TEXTSLAM_MAP_FILE_COMMANDS_HPP
#define TEXTSLAM_MAP_FILE_COMMANDS_HPP

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "io/input_error.hpp"
#include "io/output_file.hpp"
#include "textslam_map/export_geojson.hpp"
#include "textslam_map/export_map.hpp"
#include "textslam_map/map_queries.hpp"
#include "textslam_map/map_report.hpp"
#include "textslam_map/merge_maps.hpp"
#include "textslam_map/prune_map.hpp"

namespace textslam {

/// Writes a map file as other programs read it.
class ExportCommand {
 public:
  explicit ExportCommand(CLI::App& app) {
    command_ = app.add_subcommand("export", "Write a map file as other programs read it");
    command_->add_option("--colmap", colmap_,
                         "Folder for COLMAP's model, as text and binary, and the key frames' images");
    command_->add_option("--ply", ply_, "File for texts, points and key frames as PLY");
    command_->add_option("--tum", tum_, "File for the key frames' poses in TUM's format");
    command_->add_option("--session", session_, "Of --tum; by default the last")->check(CLI::PositiveNumber);
    command_->add_option("--geojson", geojson_, "File for signs and paths of a metric map as GeoJSON");
    command_->add_option("--origin", origin_,
                         "LAT,LON[,ALT] of the map's origin for --geojson: WGS84, degrees, metres");
    command_
        ->add_option("--north", reference_.north,
                     "For --geojson: where the map's z axis points, degrees clockwise from true north")
        ->check(within(-360, 360));
    command_->add_option("FILE", file_, "Map file")->required();
  }
  bool parsed() const { return command_->parsed(); }
  int run() {
    if (colmap_.empty() && ply_.empty() && tum_.empty() && geojson_.empty())
      throw InputError("export", 0, "give --colmap, --ply, --tum or --geojson");
    if (!geojson_.empty()) check_reference();
    const LoadedMap map = load_map(file_, {});
    if (!geojson_.empty()) export_geojson(map, file_, reference_, geojson_);
    if (!colmap_.empty()) export_colmap(map, colmap_);
    if (!ply_.empty()) export_ply(map, ply_);
    if (!tum_.empty()) export_tum(map, session_, tum_);
    return 0;
  }

 private:
  void check_reference() {
    if (origin_.empty() || command_->count("--north") == 0)
      throw InputError("--geojson", 0, "give --origin LAT,LON and --north DEG too");
    if (!parse_geo_position(origin_, &reference_.origin))
      throw InputError("--origin", 0,
                       "should be LAT,LON or LAT,LON,ALT in degrees and metres, not '" + shown(origin_) + "'");
  }

  CLI::App* command_ = nullptr;
  std::string file_, colmap_, ply_, tum_, geojson_, origin_;
  GeoReference reference_;
  int session_ = 0;
};

/// Shows a map in one page.
class ReportCommand {
 public:
  explicit ReportCommand(CLI::App& app) {
    command_ = app.add_subcommand("report", "The page of textslam for a map file alone, with its sessions in colours");
    command_->add_option("FILE", file_, "Map file")->required();
    command_->add_option("--output", output_, "Page to write; one that is there is replaced")->required();
  }
  bool parsed() const { return command_->parsed(); }
  int run(const std::vector<std::string>& command) const {
    const Parameters parameters;
    write_file(output_, map_report_html(load_map(file_, parameters), file_, parameters, command));
    return 0;
  }

 private:
  CLI::App* command_ = nullptr;
  std::string file_, output_;
};

/// Takes away what is not wanted any more.
class PruneCommand {
 public:
  explicit PruneCommand(CLI::App& app) {
    command_ = app.add_subcommand("prune", "Take texts or a session out of a map file, and what nothing else needs");
    observations_ = command_->add_option("--min-observations", least_, "Texts that fewer key frames observe go")
                        ->check(CLI::PositiveNumber);
    sigma_ = command_->add_option("--max-sigma", most_, "Texts whose normals are less certain go: degrees")
                 ->check(within(0, 180));
    session_ =
        command_->add_option("--session", number_, "The key frames of this session go, but those that others need")
            ->check(CLI::PositiveNumber);
    command_->add_flag("--dry-run", dry_run_, "Only say what would go");
    command_->add_option("FILE", file_, "Map file")->required();
  }
  bool parsed() const { return command_->parsed(); }
  int run() const {
    PruneRules rules;
    if (observations_->count() > 0) rules.min_observations = least_;
    if (sigma_->count() > 0) rules.max_sigma = most_;
    if (session_->count() > 0) rules.session = number_;
    if (!rules.min_observations && !rules.max_sigma && !rules.session)
      throw InputError("prune", 0, "give --min-observations, --max-sigma or --session");
    std::printf("%s", pruned_text(prune_map(file_, rules, dry_run_), dry_run_).c_str());
    return 0;
  }

 private:
  CLI::App* command_ = nullptr;
  CLI::Option *observations_ = nullptr, *sigma_ = nullptr, *session_ = nullptr;
  std::string file_;
  int least_ = 0, number_ = 0;
  double most_ = 0;
  bool dry_run_ = false;
};

/// Joins two maps of one place.
class MergeCommand {
 public:
  explicit MergeCommand(CLI::App& app) {
    command_ = app.add_subcommand(
        "merge", "Join two map files of one place by the signs in both; exit code 1 where they have no common place");
    command_->add_option("A", a_, "Map file whose world and ids stay")->required();
    command_->add_option("B", b_, "Map file that is joined to it")->required();
    command_->add_option("--output", output_, "Map file to write; one that is there is replaced")->required();
  }
  bool parsed() const { return command_->parsed(); }
  int run() const {
    const std::string joined = merge_map_files(a_, b_, output_);
    if (joined.empty())
      std::fprintf(stderr, "textslam-map: %s and %s: no common place found\n", a_.c_str(), b_.c_str());
    std::printf("%s", joined.c_str());
    return joined.empty() ? 1 : 0;
  }

 private:
  CLI::App* command_ = nullptr;
  std::string a_, b_, output_;
};

/// All of them.
class FileCommands {
 public:
  explicit FileCommands(CLI::App& app) : export_(app), report_(app), prune_(app), merge_(app) {
    info_ = app.add_subcommand("info", "What is in a map file? Its camera, its sessions, and how much of what");
    info_->add_flag("--json", json_, "Print it as JSON");
    check_ = app.add_subcommand(
        "check", "Is a map file whole? Integrity, references, finite numbers; exit code 2 and a line each where not");
    for (CLI::App* command : {info_, check_}) command->add_option("FILE", file_, "Map file")->required();
  }
  /// Runs the one that was given; empty: none of them was. `command`: the command line.
  std::optional<int> run(const std::vector<std::string>& command) {
    if (info_->parsed()) return info();
    if (check_->parsed()) return check();
    if (export_.parsed()) return export_.run();
    if (report_.parsed()) return report_.run(command);
    if (prune_.parsed()) return prune_.run();
    if (merge_.parsed()) return merge_.run();
    return std::nullopt;
  }

 private:
  int info() const {
    const MapInfo info = read_map_info(file_);
    std::printf("%s", (json_ ? info_json(info) : info_text(info)).c_str());
    return 0;
  }
  int check() const {
    const std::vector<std::string> problems = problems_of(file_);
    for (const std::string& problem : problems)
      std::fprintf(stderr, "textslam-map: %s: %s\n", file_.c_str(), problem.c_str());
    if (problems.empty()) std::printf("%s: ok\n", file_.c_str());
    return problems.empty() ? 0 : kInputError;
  }

  ExportCommand export_;
  ReportCommand report_;
  PruneCommand prune_;
  MergeCommand merge_;
  CLI::App *info_ = nullptr, *check_ = nullptr;
  std::string file_;
  bool json_ = false;
};

}  // namespace textslam

#endif  // TEXTSLAM_MAP_FILE_COMMANDS_HPP
