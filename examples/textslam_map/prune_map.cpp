#include "textslam_map/prune_map.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "textplane/landmarks/text_view.hpp"
#include "textslam/common/geometry.hpp"
#include "textslam/map_file/schema.hpp"
#include "textslam/map_file/tables.hpp"

namespace textslam {
namespace {

// What goes is listed first, in tables of this connection alone. Sets of ids are named where they are read twice.
constexpr const char* kLists = R"sql(
create temp table gone_texts (id integer primary key);
create temp table gone_keyframes (id integer primary key);
)sql";

// ?1: the session.
constexpr const char* kTextsOfSession = R"sql(
insert into gone_texts select id from texts t where
  (select session from keyframes where id = t.host) = ?1 and not exists (
    select 1 from text_views v join keyframes k on k.id = v.keyframe where v.text = t.id and k.session <> ?1)
)sql";
constexpr const char* kKeyFramesOfSession = R"sql(
insert into gone_keyframes select id from keyframes where session = ?1 and id <> 0 and id not in (
  select host from texts where id not in (select id from gone_texts))
)sql";

constexpr const char* kDropKeyFrames = R"sql(
delete from text_views where keyframe in (select id from gone_keyframes);
create temp table touched as select distinct point from observations where keyframe in (select id from gone_keyframes);
delete from observations where keyframe in (select id from gone_keyframes);
create temp table gone_points as select point as id from touched
  where (select count(distinct keyframe) from observations o where o.point = touched.point) < 2;
delete from observations where point in (select id from gone_points);
delete from points where id in (select id from gone_points);
)sql";

// The first observation that is left is the host: numbers begin with 0.
constexpr const char* kRenumber = R"sql(
create temp table renumbered as select point, row_number() over (partition by point order by number) - 1 as number,
  keyframe, u, v from observations where point in (select point from touched);
delete from observations where point in (select point from touched);
insert into observations select point, number, keyframe, u, v from renumbered;
)sql";

constexpr const char* kDropRest = R"sql(
delete from text_views where text in (select id from gone_texts);
delete from votes where text in (select id from gone_texts);
delete from patches where text in (select id from gone_texts);
delete from words where text in (select id from gone_texts);
delete from text_boxes where id in (select id from gone_texts);
delete from texts where id in (select id from gone_texts);
delete from detections where keyframe in (select id from gone_keyframes);
delete from keyframes where id in (select id from gone_keyframes);
delete from images where keyframe not in (select id from keyframes);
)sql";

constexpr const char* kEnd = R"sql(
drop table gone_texts; drop table gone_keyframes; drop table touched; drop table gone_points; drop table renumbered;
update map set revision = revision + 1;
)sql";

void list_session(Database& database, int session) {
  const std::string id = std::to_string(session);
  if (database.integer("select count(*) from sessions where id = " + id) == 0)
    database.refuse("it has no session " + id);
  if (database.integer("select count(*) from keyframes where session <> " + id) == 0)
    database.refuse("session " + id + " is all that it holds");
  Statement(database, kTextsOfSession).run(session);
  Statement(database, kKeyFramesOfSession).run(session);
}

// Those of `texts` that are left; by their views that are left.
void list_texts(Database& database, const PruneRules& rules) {
  Statement add(database, "insert or ignore into gone_texts values (?)");
  Statement row(database,
                "select id, theta_x, theta_y, theta_z, c_xx, c_xy, c_xz, c_yy, c_yz, c_zz, "
                "1 + (select count(*) from text_views v where v.text = texts.id) from texts");
  while (row.next()) {
    Vec3 theta;
    Eigen::Matrix3d covariance;
    for (int i = 0; i < 3; ++i) theta[i] = row.number(1 + i);
    int column = 4;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j, ++column)
        covariance(i, j) = covariance(j, i) = row.is_null(column) ? 0 : row.number(column);
    const double sigma = textplane::normal_sigma(theta, covariance) * 180 / M_PI;
    const bool few = rules.min_observations && row.integer(10, 1, INT64_MAX) < *rules.min_observations;
    const bool wide = rules.max_sigma && !(sigma <= *rules.max_sigma);
    if (few || wide) add.run(row.index(0, kMostId));
  }
}

using Counts = std::array<std::int64_t, 6>;

Counts counts_of(Database& database) {
  Counts counts{};
  std::size_t i = 0;
  for (const char* table : {"texts", "keyframes", "images", "points", "observations", "sessions"})
    counts[i++] = database.integer(std::string("select count(*) from ") + table);
  return counts;
}

void apply(Database& database, const PruneRules& rules) {
  database.execute(kLists);
  if (rules.session) list_session(database, *rules.session);
  database.execute(kDropKeyFrames);
  database.execute(kRenumber);
  list_texts(database, rules);
  database.execute(kDropRest);
  if (rules.session)
    Statement(database,
              "delete from sessions where id = ?1 and not exists (select 1 from keyframes where session = ?1)")
        .run(*rules.session);
  database.execute(kEnd);
}

// It needs as much room again for a moment. Without it the map is whole all the same.
void give_space_back(Database& database) {
  try {
    database.execute("vacuum");
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(std::string(error.what()) +
                             "; what the rules name is gone, but the file is as long as before");
  }
}

std::int64_t bytes_of(Database& database) {
  return database.integer("pragma page_count") * database.integer("pragma page_size");
}

}  // namespace

Pruned prune_map(const std::string& path, const PruneRules& rules, bool dry_run) {
  Database database = open_map(path);  // refuses what is no map, and makes no file
  if (dry_run)
    database.continue_in_memory();
  else
    database = open_for_map(path);
  database.execute("pragma foreign_keys = off");  // each key frame that goes would be looked for in every observation
  const std::int64_t bytes = bytes_of(database);
  Counts before{}, after{};
  {
    Transaction transaction(database);
    migrate(database);
    before = counts_of(database);
    apply(database, rules);
    after = counts_of(database);
    if (after == before) return {};
    if (Statement(database, "pragma foreign_key_check").next())
      database.refuse("damaged: rows refer to rows that are gone");
    transaction.commit();
  }
  give_space_back(database);
  const auto gone = [&](std::size_t i) { return before[i] - after[i]; };
  return {gone(0), gone(1), gone(2), gone(3), gone(4), gone(5), bytes - bytes_of(database)};
}

std::string pruned_text(const Pruned& pruned, bool dry_run) {
  char line[240];
  const auto count = [](std::int64_t value) { return static_cast<long long>(value); };
  std::snprintf(
      line, sizeof line,
      "%s %lld texts, %lld key frames, %lld images, %lld points, %lld observations, %lld sessions; %lld bytes\n",
      dry_run ? "would go:" : "gone:", count(pruned.texts), count(pruned.keyframes), count(pruned.images),
      count(pruned.points), count(pruned.observations), count(pruned.sessions), count(pruned.bytes));
  return line;
}

}  // namespace textslam
