#include "textslam_map/server/server_tables.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "io/input_error.hpp"
#include "textslam/map_file/schema.hpp"

namespace textslam {
namespace {

// Whoever makes the tables holds it, so that two first pushes do not meet.
constexpr const char* kLock = "select pg_advisory_xact_lock(1414549616)";

// `revision` counts the pushes of a map and decides between writers; map.revision is what the file counts.
constexpr const char* kMaps = R"sql(
create table if not exists textslam.maps (
  name text primary key, id uuid not null unique default gen_random_uuid(), revision bigint not null,
  schema_version bigint not null, pushed timestamp with time zone not null default now(),
  pushed_by text not null default session_user))sql";
const std::set<std::string> kMapsColumns = {"name", "id", "revision", "schema_version", "pushed", "pushed_by"};

// A map that is renamed or removed takes all its rows along.
constexpr const char* kFollows = " on update cascade on delete cascade";

// Tables behind the file's virtual ones, and what belongs to the file alone.
constexpr const char* kTablesOfFile =
    "select name from sqlite_master where type = 'table' and upper(sql) not like 'CREATE VIRTUAL%' and "
    "name not like 'words~_%' escape '~' and name not like 'text~_boxes~_%' escape '~' and "
    "name not like 'sqlite~_%' escape '~' and name <> 'origins' order by rowid";

std::string joined(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

Kind kind_of(const std::string& type) {
  if (type == "REAL") return Kind::real;
  if (type == "TEXT") return Kind::text;
  return type == "BLOB" ? Kind::bytes : Kind::integer;
}

std::string type_name(Kind kind) {
  switch (kind) {
    case Kind::integer: return "bigint";
    case Kind::real: return "double precision";
    case Kind::text: return "text";
    default: return "bytea";
  }
}

void read_references(Database& file, ServerTable* table) {
  Statement reference(file, "select \"from\", \"table\" from pragma_foreign_key_list('" + table->name + "')");
  while (reference.next()) {
    const std::string column = reference.text(0);
    Statement key(file, "select name from pragma_table_info('" + reference.text(1) + "') where pk = 1");
    if (!key.next()) file.refuse("a reference to a table without a key");
    table->constraints.push_back("foreign key (map, " + column + ") references textslam." + reference.text(1) +
                                 " (map, " + key.text(0) + ")" + kFollows + " deferrable initially deferred");
    if (table->key.front() != column) table->indices.push_back(column);
  }
}

ServerTable table_of(Database& file, const std::string& name) {
  ServerTable table;
  table.name = name;
  std::map<std::int64_t, std::string> key;
  Statement column(file, "select name, upper(type), \"notnull\", pk from pragma_table_info('" + name + "')");
  while (column.next()) {
    const std::int64_t at = column.integer(3, 0, 100);
    table.columns.push_back({column.text(0), kind_of(column.text(1)), column.integer(2, 0, 1) == 1 || at > 0});
    if (at > 0) key[at] = column.text(0);
  }
  for (const auto& [at, part] : key) table.key.push_back(part);
  return table;
}

ServerTable boxes() {
  ServerTable table;
  table.name = "text_boxes";
  table.columns = {{"id", Kind::integer, true}};
  for (const char* name : {"min_x", "max_x", "min_y", "max_y", "min_z", "max_z"})
    table.columns.push_back({name, Kind::real, true});
  table.key = {"id"};
  table.constraints = {std::string("foreign key (map, id) references textslam.texts (map, id)") + kFollows +
                       " deferrable initially deferred"};
  return table;
}

std::string definition(const ServerColumn& column) {
  return column.name + " " + type_name(column.kind) + (column.needed ? " not null" : "");
}

std::string definition(const ServerTable& table) {
  std::string sql = "create table if not exists textslam." + table.name + " (map text not null";
  // A row that refers to another is of that one's map: checked again, each would take twice as long to push.
  if (table.constraints.empty()) sql += std::string(" references textslam.maps (name)") + kFollows;
  for (const ServerColumn& column : table.columns) sql += ", " + definition(column);
  sql += ", primary key (map, " + joined(table.key) + ")";
  return sql + ")";
}

using Columns = std::map<std::string, std::set<std::string>>;

// From the catalogue, which everybody may read.
Columns columns_of(Connection& connection) {
  Columns found;
  connection.rows(
      "select c.relname::text, coalesce(a.attname::text, '') from pg_namespace n join pg_class c on c.relnamespace = "
      "n.oid left join pg_attribute a on a.attrelid = c.oid and a.attnum > 0 and not a.attisdropped "
      "where n.nspname = 'textslam' and c.relkind in ('r', 'p', 'v', 'm', 'f')",
      {}, {Kind::text, Kind::text}, [&](const ServerRow& row) { found[row.text(0)].insert(row.text(1)); });
  return found;
}

bool has_all(const std::set<std::string>& columns, const std::set<std::string>& wanted) {
  return std::includes(columns.begin(), columns.end(), wanted.begin(), wanted.end());
}

void check_is_ours(const Connection& connection, const Columns& found) {
  const auto maps = found.find("maps");
  if (!found.empty() && (maps == found.end() || !has_all(maps->second, kMapsColumns)))
    connection.refuse("its schema 'textslam' holds other tables than maps of textslam: it stays as it is");
}

// What a table lacks; "" where all of it is there.
std::string missing(const Columns& found, const ServerTable& table) {
  const auto there = found.find(table.name);
  if (there == found.end()) return table.name;
  if (there->second.count("map") == 0) return table.name + ".map";
  for (const ServerColumn& column : table.columns)
    if (there->second.count(column.name) == 0) return table.name + "." + column.name;
  return "";
}

// Only where the server has the extension, and this role may make it.
void index_words(Connection& connection) {
  connection.run("savepoint words");
  try {
    connection.run("create extension if not exists pg_trgm");
    connection.run("create index if not exists texts_word on textslam.texts using gin (word gin_trgm_ops)");
    connection.run("create index if not exists votes_word on textslam.votes using gin (word gin_trgm_ops)");
  } catch (const InputError&) {
    connection.run("rollback to savepoint words");
  }
}

void make_table(Connection& connection, const Columns& found, const ServerTable& table) {
  if (found.count(table.name) == 0) {
    connection.run(definition(table));
    for (const std::string& constraint : table.constraints)
      connection.run("alter table textslam." + table.name + " add " + constraint);
    for (const std::string& column : table.indices)
      connection.run("create index on textslam." + table.name + " (map, " + column + ")");
    return;
  }
  // Rows that older programs push leave them empty.
  for (const ServerColumn& column : table.columns)
    if (found.at(table.name).count(column.name) == 0)
      connection.run("alter table textslam." + table.name + " add column " + column.name + " " +
                     type_name(column.kind));
}

}  // namespace

std::string ServerTable::list() const {
  std::vector<std::string> names;
  for (const ServerColumn& column : columns) names.push_back(column.name);
  return joined(names);
}

std::vector<Kind> ServerTable::kinds() const {
  std::vector<Kind> all;
  for (const ServerColumn& column : columns) all.push_back(column.kind);
  return all;
}

std::vector<ServerTable> server_tables() {
  Database file(":memory:", Access::write);
  migrate(file);
  std::vector<ServerTable> tables;
  Statement name(file, kTablesOfFile);
  while (name.next()) {
    tables.push_back(table_of(file, name.text(0)));
    read_references(file, &tables.back());
  }
  tables.push_back(boxes());
  return tables;
}

void prepare_server(Connection& connection) {
  const std::vector<ServerTable> tables = server_tables();
  const auto lacks_nothing = [&](const Columns& found) {
    return std::all_of(tables.begin(), tables.end(), [&](const ServerTable& t) { return missing(found, t).empty(); });
  };
  Columns found = columns_of(connection);
  check_is_ours(connection, found);
  if (lacks_nothing(found)) return;
  ServerTransaction transaction(connection);
  connection.run(kLock);
  found = columns_of(connection);  // of whoever held the lock
  check_is_ours(connection, found);
  if (lacks_nothing(found)) return;
  if (!connection.integer("select 1::bigint from pg_namespace where nspname = 'textslam'"))
    connection.run("create schema textslam");
  connection.run(kMaps);
  for (const ServerTable& table : tables) make_table(connection, found, table);
  index_words(connection);
  transaction.commit();
}

std::optional<ServerMap> find_server_map(Connection& connection, const std::string& map, bool lock) {
  const Columns found = columns_of(connection);
  if (found.empty()) return std::nullopt;
  check_is_ours(connection, found);
  for (const ServerTable& table : server_tables()) {
    const std::string gap = missing(found, table);
    if (!gap.empty()) connection.refuse("foreign or older tables: it has no textslam." + gap);
  }
  std::optional<ServerMap> known;
  std::int64_t version = 0;
  const std::string locking = lock ? " for update" : "";
  connection.rows("select id::text, revision, schema_version from textslam.maps where name = $1" + locking, {map},
                  {Kind::text, Kind::integer, Kind::integer}, [&](const ServerRow& row) {
                    known = {row.text(0), row.integer(1)};
                    version = row.integer(2);
                  });
  if (version > schema_version())
    connection.refuse("map '" + map + "' is of schema version " + std::to_string(version) +
                      "; this program knows versions up to " + std::to_string(schema_version()));
  return known;
}

}  // namespace textslam
