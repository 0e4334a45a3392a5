// The commands of textslam-map for maps on a server. Needs CLI11; without libpq they say that they are not built.
#ifndef TEXTSLAM_MAP_SERVER_COMMANDS_HPP
#define TEXTSLAM_MAP_SERVER_COMMANDS_HPP

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "io/input_error.hpp"
#ifdef TEXTSLAM_WITH_POSTGRESQL
#include "textslam_map/server/pull_map.hpp"
#include "textslam_map/server/push_map.hpp"
#endif

namespace textslam {

/// push and pull.
class ServerCommands {
 public:
  explicit ServerCommands(CLI::App& app) {
    push_ = app.add_subcommand("push", "Put a map file's map on a PostgreSQL server, which many share");
    pull_ = app.add_subcommand("pull", "Write a map of a PostgreSQL server into a map file");
    const char* const database = "postgresql://HOST/DATABASE, or 'host=... dbname=...'";
    push_->add_option("FILE", file_, "Map file")->required();
    push_->add_option("DATABASE", database_, database)->required();
    push_->add_flag("--merge", merge_,
                    "Where others have pushed since, join their map and the file's; the file then holds both");
    pull_->add_option("DATABASE", database_, database)->required();
    pull_->add_option("FILE", file_, "Map file: a new one, or one that has no changes of its own")->required();
    for (CLI::App* command : {push_, pull_})
      command->add_option("--map", map_, "Name of the map on the server; by default the file's, without its ending");
  }
  /// Runs the one that was given; empty: none of them was.
  std::optional<int> run() {
    if (!push_->parsed() && !pull_->parsed()) return std::nullopt;
    if (map_.empty()) map_ = std::filesystem::path(file_).stem().string();
    return push_->parsed() ? push() : pull();
  }

 private:
#ifdef TEXTSLAM_WITH_POSTGRESQL
  int push() const {
    if (merge_) {
      std::printf("%s\n", push_merged(file_, database_, map_).c_str());
      return 0;
    }
    const Pushed done = push_map(file_, database_, map_);
    if (done.refused)
      throw InputError(file_, 0,
                       "the server's map '" + map_ + "' has revision " + std::to_string(done.revision) +
                           ", which this file does not come from: push with --merge, or pull");
    std::printf("%s\n", pushed_text(done, map_).c_str());
    return 0;
  }
  int pull() const {
    const Pulled done = pull_map(database_, map_, file_);
    std::printf("%s: revision %lld of '%s', %lld rows%s\n", file_.c_str(), static_cast<long long>(done.revision),
                map_.c_str(), static_cast<long long>(done.rows), done.known ? ": it has all of it" : "");
    return 0;
  }
#else
  static int push() { throw InputError("push", 0, "this program was built without PostgreSQL (Debian: libpq-dev)"); }
  static int pull() { throw InputError("pull", 0, "this program was built without PostgreSQL (Debian: libpq-dev)"); }
#endif

  CLI::App *push_ = nullptr, *pull_ = nullptr;
  std::string file_, database_, map_;
  bool merge_ = false;
};

}  // namespace textslam

#endif  // TEXTSLAM_MAP_SERVER_COMMANDS_HPP
