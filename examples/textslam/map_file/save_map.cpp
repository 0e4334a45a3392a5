#include <filesystem>

#include "textslam/map_file/map_file.hpp"
#include "textslam/map_file/schema.hpp"
#include "textslam/map_file/tables.hpp"

namespace textslam {
namespace {

// Everything but the images, which are large and never change.
constexpr const char* kEmpty = R"sql(
delete from words; delete from text_boxes; delete from patches; delete from votes; delete from text_views;
delete from texts; delete from observations; delete from points; delete from detections; delete from keyframes;
delete from cameras; delete from sessions;
)sql";

std::int64_t revision_of(Database& database) { return database.integer("select max(revision) from map"); }

}  // namespace

void save_map(const std::string& path, const Map& map, const MapRecord& record) {
  Database database = open_for_map(path);
  Transaction transaction(database);
  migrate(database);
  Statement(database, "insert or ignore into map (id, revision) values (1, 0)").run();
  const std::int64_t now = revision_of(database);
  if (record.revision > 0 && record.revision != now)
    database.refuse("another session was saved into this map in the meantime: it stays as that left it");
  database.execute(kEmpty);
  // Images of the file stay where its key frames do: coded again, they would lose a little each time.
  if (record.revision == 0 || !record.same_ids) database.execute("delete from images");
  // Another map takes the place of what was there, and is none of what was pushed or pulled.
  if (record.revision == 0) database.execute("delete from origins");
  save_sessions(database, record);
  save_keyframes(database, map, record);
  save_points(database, map);
  save_texts(database, map);
  database.execute("delete from images where keyframe not in (select id from keyframes)");
  Statement(database, "update map set revision = ?, scale_sigma = null").run(now + 1);
  if (record.scale_sigma) Statement(database, "update map set scale_sigma = ?").run(*record.scale_sigma);
  transaction.commit();
}

void check_can_save(const std::string& path) {
  std::error_code error;
  const bool existed = std::filesystem::exists(path, error);
  {
    Database database = open_for_map(path);
    Transaction transaction(database);
    // It fails where the file or its folder may not be written; a transaction that writes nothing begins there too.
    database.execute("pragma user_version = " + std::to_string(database.integer("pragma user_version")));
  }
  if (!existed) std::filesystem::remove(path, error);  // a run that fails leaves no empty file
}

}  // namespace textslam
