#include "textslam_map/server/pull_map.hpp"

#include <algorithm>
#include <filesystem>

#include "io/input_error.hpp"
#include "textslam/map_file/schema.hpp"
#include "textslam/map_file/tables.hpp"
#include "textslam_map/server/origins.hpp"
#include "textslam_map/server/server_tables.hpp"

namespace textslam {
namespace {

void bind_value(const ServerRow& row, int column, Kind kind, Statement* insert) {
  if (row.is_null(column)) return;
  switch (kind) {
    case Kind::integer: return insert->bind(column + 1, row.integer(column));
    case Kind::real: return insert->bind(column + 1, row.real(column));
    case Kind::text: return insert->bind(column + 1, row.text(column));
    default: return insert->bind(column + 1, row.bytes(column));
  }
}

std::int64_t insert_table(Connection& connection, const std::string& map, const ServerTable& table, Database& file) {
  std::string places = "?";
  for (std::size_t i = 1; i < table.columns.size(); ++i) places += ", ?";
  Statement insert(file, "insert into " + table.name + " (" + table.list() + ") values (" + places + ")");
  const std::vector<Kind> kinds = table.kinds();
  std::int64_t rows = 0;
  connection.rows("select " + table.list() + " from textslam." + table.name + " where map = $1", {map}, kinds,
                  [&](const ServerRow& row) {
                    insert.reset();
                    for (std::size_t i = 0; i < kinds.size(); ++i)
                      bind_value(row, static_cast<int>(i), kinds[i], &insert);
                    while (insert.next()) {
                    }
                    ++rows;
                  });
  return rows;
}

std::int64_t insert_rows(Connection& connection, const std::string& map, Database& file) {
  const std::vector<ServerTable> tables = server_tables();
  file.execute("delete from words");
  for (const ServerTable& table : tables) file.execute("delete from " + table.name);
  std::int64_t rows = 0;
  for (const ServerTable& table : tables) rows += insert_table(connection, map, table, file);
  file.execute("insert into words (word, text) select word, text from votes order by text, word");
  return rows;
}

// All that loading looks at, and that each text has its box.
void check(Database& file) {
  if (file.integer("select count(*) from map where revision > 0") != 1)
    file.refuse("damaged: it does not say how often it was saved");
  load_tables(file, {});
  if (file.integer("select count(*) from texts where id not in (select id from text_boxes)") > 0)
    file.refuse("damaged: a text has no box");
}

// Whether the file, as it is, may go.
void check_replaceable(Database& file, const std::optional<Origin>& origin, std::int64_t saved,
                       const std::optional<std::int64_t>& replaces) {
  if (saved == 0) return;
  if (replaces) {
    if (*replaces != saved)
      file.refuse("another session was saved into this map in the meantime: it stays as that left it");
    return;
  }
  if (!origin) file.refuse("it holds a map that is not this one of the server: it stays as it is");
  if (origin->saved != saved) file.refuse("it has changes that were not pushed: it stays as it is");
}

// One that was not there stays none where the pull fails.
class NewFile {
 public:
  explicit NewFile(const std::string& path) : path_(path) {
    std::error_code error;
    is_new_ = !std::filesystem::exists(path, error);
  }
  ~NewFile() {
    std::error_code error;
    if (is_new_) std::filesystem::remove(path_, error);
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  void keep() { is_new_ = false; }

 private:
  std::string path_;
  bool is_new_ = false;
};

// What is wrong with the server's rows is found in the file's tables: the message is of the server.
std::int64_t take_rows(Connection& connection, const std::string& map, Database& file) {
  try {
    const std::int64_t rows = insert_rows(connection, map, file);
    check(file);
    return rows;
  } catch (const InputError& error) {
    const std::string& part = error.file();  // of the file: an image, say
    const bool is_of_file = part.compare(0, file.path().size(), file.path()) == 0;
    throw InputError(connection.name() + ", map '" + map + "'" + (is_of_file ? part.substr(file.path().size()) : ""), 0,
                     error.message());
  }
}

}  // namespace

Pulled pull_map(const std::string& database, const std::string& map, const std::string& path,
                std::optional<std::int64_t> replaces) {
  Connection connection(database);
  ServerTransaction snapshot(connection, "isolation level repeatable read read only");
  const auto server = find_server_map(connection, map, false);
  if (!server) connection.refuse("there is no map '" + map + "'");
  NewFile made(path);
  Database file = open_for_map(path);
  Transaction transaction(file);
  migrate(file);
  const std::int64_t saved = file_revision(file);
  const auto origin = origin_of(file, server->id);
  check_replaceable(file, origin, saved, replaces);
  Pulled done;
  done.revision = server->revision;
  done.known = origin && origin->saved == saved && origin->revision == server->revision;
  if (done.known) return done;
  done.rows = take_rows(connection, map, file);
  // A session that began in the file as it was must not be saved over this.
  Statement(file, "update map set revision = max(revision, ?)").run(saved + 1);
  file.execute("delete from origins");
  set_origin(file, server->id, {server->revision, file_revision(file)});
  transaction.commit();
  made.keep();
  return done;
}

}  // namespace textslam
