#include "textslam/map_file/schema.hpp"

#include <array>
#include <filesystem>

#include "io/input_error.hpp"

namespace textslam {
namespace {

constexpr const char* kFirst = R"sql(
create table map (
  id integer primary key check (id = 1),
  revision integer not null);  -- counts the saves

create table sessions (
  id integer primary key, started text not null, sequence text not null, command text not null, mode text not null,
  version text not null, frames integer not null, tracked integer not null);

create table cameras (
  id integer primary key, model text not null, width integer not null, height integer not null,
  fx real not null, fy real not null, cx real not null, cy real not null, coefficients text not null,
  fps real not null, readout real not null, readout_row real not null);

create table keyframes (
  id integer primary key,
  session integer not null references sessions deferrable initially deferred,
  camera integer not null references cameras deferrable initially deferred,
  timestamp real not null, image text not null,
  x real not null, y real not null, z real not null,
  qx real not null, qy real not null, qz real not null, qw real not null,
  noise real not null, smoothing real not null,
  vx real, vy real, vz real, wx real, wy real, wz real);

create table images (
  keyframe integer primary key references keyframes deferrable initially deferred,
  format text not null, bytes blob not null);

create table detections (
  keyframe integer not null references keyframes deferrable initially deferred, number integer not null,
  word text not null, score real not null,
  x1 real not null, y1 real not null, x2 real not null, y2 real not null,
  x3 real not null, y3 real not null, x4 real not null, y4 real not null,
  primary key (keyframe, number)) without rowid;

create table points (
  id integer primary key, x real not null, y real not null, z real not null,
  nx real not null, ny real not null, nz real not null, visible integer not null, found integer not null);

create table observations (
  point integer not null references points deferrable initially deferred, number integer not null,
  keyframe integer not null references keyframes deferrable initially deferred,
  u real not null, v real not null,
  primary key (point, number)) without rowid;

create table texts (
  id integer primary key, word text not null,
  x real not null, y real not null, z real not null,
  nx real not null, ny real not null, nz real not null, width real not null, height real not null,
  host integer not null references keyframes deferrable initially deferred,
  theta_x real not null, theta_y real not null, theta_z real not null,
  c_xx real, c_xy real, c_xz real, c_yy real, c_yz real, c_zz real,
  x1 real not null, y1 real not null, x2 real not null, y2 real not null,
  x3 real not null, y3 real not null, x4 real not null, y4 real not null,
  area real not null, zncc real not null, variance_factor real not null,
  detections integer not null, shown integer not null, failures integer not null);

create table text_views (
  text integer not null references texts deferrable initially deferred,
  keyframe integer not null references keyframes deferrable initially deferred,
  primary key (text, keyframe)) without rowid;

create table votes (
  text integer not null references texts deferrable initially deferred, word text not null, score real not null,
  primary key (text, word)) without rowid;

create table patches (
  text integer not null references texts deferrable initially deferred, level integer not null,
  arrays integer not null, pixels blob not null,
  primary key (text, level)) without rowid;

create virtual table words using fts5 (word, text unindexed, tokenize = 'trigram');
create virtual table text_boxes using rtree (id, min_x, max_x, min_y, max_y, min_z, max_z);
)sql";

// A map in metres says how well they are known.
constexpr const char* kMetres = "alter table map add column scale_sigma real";

// What a file has in common with maps on servers (textslam_map/server/origins.hpp): it holds all that revision
// `revision` of the map `server_map` held, and was saved `saved` times when they were the same.
constexpr const char* kOrigins =
    "create table origins (server_map text primary key, revision integer not null, saved integer not null)";

// Step i makes version i + 1 of version i.
constexpr std::array<const char*, 3> kSteps = {kFirst, kMetres, kOrigins};

bool is_map(Database& database) { return database.integer("pragma application_id") == kMapApplication; }

std::int64_t version_of(Database& database) {
  const std::int64_t version = database.integer("pragma user_version");
  if (version < 1 || version > schema_version())
    database.refuse("a map of schema version " + std::to_string(version) + "; this program knows versions up to " +
                    std::to_string(schema_version()));
  return version;
}

bool is_empty(Database& database) { return database.integer("select count(*) from sqlite_master") == 0; }

}  // namespace

int schema_version() { return static_cast<int>(kSteps.size()); }

Database open_map(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw InputError(path, 0, "a folder, not a map");
  if (!std::filesystem::exists(path, error)) throw InputError(path, 0, "no such file");
  Database database(path, Access::read);
  if (is_empty(database)) database.refuse("empty: it holds no map");
  if (!is_map(database)) database.refuse("an SQLite database, but no map of textslam");
  if (version_of(database) < schema_version()) {
    database.continue_in_memory();
    migrate(database);
  }
  return database;
}

Database open_for_map(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw InputError(path, 0, "a folder, not a map");
  Database database(path, Access::write);
  if (is_empty(database)) return database;
  if (!is_map(database)) database.refuse("an SQLite database, but no map of textslam: it stays as it is");
  version_of(database);
  return database;
}

void migrate(Database& database) {
  const std::int64_t from = is_empty(database) ? 0 : version_of(database);
  for (auto step = static_cast<std::size_t>(from); step < kSteps.size(); ++step) database.execute(kSteps[step]);
  database.execute("pragma application_id = " + std::to_string(kMapApplication) +
                   "; pragma user_version = " + std::to_string(schema_version()));
}

}  // namespace textslam
