#include "textslam_map/server/origins.hpp"

namespace textslam {

std::int64_t file_revision(Database& file) { return file.integer("select coalesce(max(revision), 0) from map"); }

std::optional<Origin> origin_of(Database& file, const std::string& server_map) {
  Statement row(file, "select revision, saved from origins where server_map = ?");
  row.bind_all(server_map);
  if (!row.next()) return std::nullopt;
  return Origin{row.integer(0, 0, INT64_MAX), row.integer(1, 0, INT64_MAX)};
}

void set_origin(Database& file, const std::string& server_map, const Origin& origin) {
  Statement(file, "insert or replace into origins values (?, ?, ?)").run(server_map, origin.revision, origin.saved);
}

}  // namespace textslam
