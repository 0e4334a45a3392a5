#include "textslam_map/server/push_map.hpp"

#include "textslam/map_file/schema.hpp"
#include "textslam/map_file/tables.hpp"
#include "textslam_map/server/origins.hpp"
#include "textslam_map/server/server_tables.hpp"

namespace textslam {
namespace {

void copy_value(const Statement& row, int column, const ServerColumn& of, CopyIn* copy) {
  if (row.is_null(column)) return copy->null();
  switch (of.kind) {
    case Kind::integer: return copy->integer(row.integer(column, INT64_MIN, INT64_MAX));
    case Kind::real: return copy->real(row.number(column));
    case Kind::text: return copy->bytes(row.text(column));
    default: return copy->bytes(row.bytes(column));
  }
}

std::int64_t copy_table(Database& file, Connection& connection, const std::string& map, const ServerTable& table) {
  Statement row(file, "select " + table.list() + " from " + table.name);
  CopyIn copy(connection, "textslam." + table.name + " (map, " + table.list() + ")");
  std::int64_t rows = 0;
  for (; row.next(); ++rows) {
    copy.begin_row(table.columns.size() + 1);
    copy.bytes(map);
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      copy_value(row, static_cast<int>(i), table.columns[i], &copy);
  }
  copy.finish();
  return rows;
}

std::int64_t replace_rows(Database& file, Connection& connection, const std::string& map) {
  const std::vector<ServerTable> tables = server_tables();
  // Those that refer to others go first.
  for (auto table = tables.rbegin(); table != tables.rend(); ++table)
    connection.run("delete from textslam." + table->name + " where map = $1", {map});
  std::int64_t rows = 0;
  for (const ServerTable& table : tables) rows += copy_table(file, connection, map, table);
  return rows;
}

// The server's map, which nobody else can push until the transaction ends; made where there is none.
ServerMap locked_map(Connection& connection, const std::string& map, bool* is_new) {
  auto known = find_server_map(connection, map, true);
  *is_new = !known;
  if (known) return *known;
  const bool made = connection.run(
                        "insert into textslam.maps (name, revision, schema_version) values ($1, 0, $2) "
                        "on conflict (name) do nothing",
                        {map, std::to_string(schema_version())}) == 1;
  *is_new = made;
  known = find_server_map(connection, map, true);
  if (!known) connection.refuse("map '" + map + "' was removed in the meantime");
  return *known;
}

void remember(const std::string& path, const std::string& id, const Origin& origin) {
  Database file = open_for_map(path);
  Transaction transaction(file);
  migrate(file);
  set_origin(file, id, origin);
  transaction.commit();
}

}  // namespace

Pushed push_map(const std::string& path, const std::string& database, const std::string& map) {
  Database file = open_map(path);
  file.continue_in_memory();  // one state of the file, which others may save meanwhile
  migrate(file);
  load_tables(file, {});  // a damaged map stays where it is
  check_can_save(path);   // it has to remember the revision
  Connection connection(database);
  prepare_server(connection);
  ServerTransaction transaction(connection);
  bool is_new = false;
  const ServerMap server = locked_map(connection, map, &is_new);
  const std::int64_t saved = file_revision(file);
  const auto origin = origin_of(file, server.id);
  Pushed done;
  done.revision = server.revision;
  done.refused = !is_new && (!origin || origin->revision != server.revision);
  done.known = !done.refused && origin && origin->saved == saved;
  if (done.refused || done.known) return done;
  done.rows = replace_rows(file, connection, map);
  ++done.revision;
  connection.run(
      "update textslam.maps set revision = $2, schema_version = $3, pushed = now(), pushed_by = session_user "
      "where name = $1",
      {map, std::to_string(done.revision), std::to_string(schema_version())});
  transaction.commit();
  remember(path, server.id, {done.revision, saved});
  return done;
}

std::string pushed_text(const Pushed& pushed, const std::string& map) {
  return "'" + map + "' on the server has revision " + std::to_string(pushed.revision) + ", " +
         (pushed.known ? "which is this file" : std::to_string(pushed.rows) + " rows sent");
}

}  // namespace textslam
