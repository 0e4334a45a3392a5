#include <stdlib.h>

#include <filesystem>

#include "io/input_error.hpp"
#include "textslam_map/join_branches.hpp"
#include "textslam_map/server/pull_map.hpp"
#include "textslam_map/server/push_map.hpp"

namespace textslam {
namespace {

constexpr int kMostAttempts = 50;  // each lost one is a push of another, so this is many robots

// A folder of this process, with what is in it.
class WorkFolder {
 public:
  WorkFolder() : path_((std::filesystem::temp_directory_path() / "textslam-map-XXXXXX").string()) {
    if (!mkdtemp(path_.data())) throw std::runtime_error(path_ + ": cannot be made");
  }
  ~WorkFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  std::string path(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

// The file takes what was pushed, if it is still the one that was joined.
void take_back(const std::string& file, const std::string& database, const std::string& map, std::int64_t saved) {
  try {
    pull_map(database, map, file, saved);
  } catch (const InputError& error) {
    throw InputError(file, 0, "its map was joined with the server's and pushed, but not pulled: " + error.message());
  }
}

}  // namespace

std::string push_merged(const std::string& file, const std::string& database, const std::string& map) {
  const Parameters parameters;
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    const Pushed direct = push_map(file, database, map);
    if (!direct.refused) return pushed_text(direct, map);
    const WorkFolder work;
    const std::string server = work.path("server.db");
    pull_map(database, map, server);
    LoadedMap theirs = load_map(server, parameters), ours = load_map(file, parameters);
    const std::int64_t revision = theirs.record.revision, saved = ours.record.revision;
    auto joined = join_branches(std::move(theirs), std::move(ours), file, parameters);
    if (!joined)
      throw InputError(file, 0, "it and the server's map '" + map + "' have no common place: nothing was pushed");
    joined->record.revision = revision;
    save_map(server, joined->map, joined->record);
    const Pushed pushed = push_map(server, database, map);
    if (pushed.refused) continue;  // another was faster
    take_back(file, database, map, saved);
    return pushed_text(pushed, map) + ", joined with what others pushed; " +
           std::to_string(joined->record.sessions.size()) + " sessions, " +
           std::to_string(joined->map.keyframe_ids().size()) + " key frames";
  }
  throw InputError(file, 0, "others pushed '" + map + "' again and again meanwhile: nothing was pushed");
}

}  // namespace textslam
