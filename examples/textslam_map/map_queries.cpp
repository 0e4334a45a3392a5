#include "textslam_map/map_queries.hpp"

#include <algorithm>
#include <filesystem>

#include "io/camera_formats/formats.hpp"
#include "io/input_error.hpp"
#include "textslam/common/report_json.hpp"
#include "textslam/map_file/schema.hpp"
#include "textslam/map_file/tables.hpp"

namespace textslam {
namespace {

std::vector<std::string> lines_of(Database& database, const std::string& sql, int column = 0) {
  std::vector<std::string> lines;
  Statement row(database, sql);
  while (row.next()) lines.push_back(row.text(column));
  return lines;
}

// Columns of numbers that hold something else. NaN cannot be stored.
void check_numbers(Database& database, std::vector<std::string>* problems) {
  Statement column(database,
                   "select t.name, c.name, c.\"notnull\" from sqlite_master t, pragma_table_info(t.name) c "
                   "where t.type = 'table' and upper(c.type) = 'REAL' order by 1, 2");
  while (column.next()) {
    const std::string table = column.text(0), name = column.text(1);
    const std::string missing = column.integer(2, 0, 1) == 1 ? name + " is null or " : "";
    const std::int64_t count = database.integer("select count(*) from \"" + table + "\" where " + missing + "(" + name +
                                                " is not null and (typeof(" + name +
                                                ") not in ('real', 'integer') or " + name + " in (9e999, -9e999)))");
    if (count > 0) problems->push_back(table + "." + name + ": " + std::to_string(count) + " not finite");
  }
}

void check_indices(Database& database, std::vector<std::string>* problems) {
  for (const std::string& line : lines_of(database, "select rtreecheck('text_boxes')"))
    if (line != "ok") problems->push_back("text_boxes: " + line);
  const std::int64_t boxes = database.integer("select count(*) from texts where id not in (select id from text_boxes)");
  if (boxes > 0) problems->push_back("text_boxes: " + std::to_string(boxes) + " texts are not in it");
  const std::int64_t words = database.integer(
      "select count(*) from votes v where not exists (select 1 from words w where w.word = v.word and w.text = "
      "v.text)");
  if (words > 0) problems->push_back("words: " + std::to_string(words) + " readings are not in it");
}

Json camera_json(const CameraModel& camera) {
  return {{"model", camera.raw.name()},
          {"width", camera.width},
          {"height", camera.height},
          {"parameters", parameters_of(camera)}};
}

}  // namespace

std::vector<IndexedText> read_map_texts(const std::string& path) {
  Database database = open_map(path);
  std::vector<IndexedText> texts;
  Statement row(database,
                "select t.id, t.word, t.x, t.y, t.z, t.nx, t.ny, t.nz, t.x1, t.y1, t.x2, t.y2, t.x3, t.y3, t.x4, t.y4, "
                "k.image, k.timestamp from texts t join keyframes k on k.id = t.host order by t.id");
  Statement vote(database, "select word, score from votes where text = ?");
  while (row.next()) {
    IndexedText text;
    text.id = row.index(0, kMostId);
    text.text = row.text(1);
    text.position = {row.number(2), row.number(3), row.number(4)};
    text.normal = {row.number(5), row.number(6), row.number(7)};
    for (int i = 0; i < 4; ++i)
      text.quad.corner[static_cast<std::size_t>(i)] = {row.number(8 + 2 * i), row.number(9 + 2 * i)};
    text.image = row.text(16);
    text.timestamp = row.number(17);
    double votes = 0;
    vote.bind_all(text.id);
    while (vote.next()) votes += text.readings[vote.text(0)] = vote.number(1);
    const auto own = text.readings.find(text.text);
    if (votes > 0 && own != text.readings.end()) text.score = own->second / votes;
    texts.push_back(text);
  }
  return texts;
}

MapInfo read_map_info(const std::string& path) {
  Database database = open_map(path);
  MapInfo info;
  MapRecord record;
  load_sessions(database, &record);
  info.camera = record.camera;
  info.given_camera = record.given_camera;
  info.sessions = record.sessions;
  info.version = database.integer("pragma user_version");
  info.revision = database.integer("select max(revision) from map");
  info.bytes = static_cast<std::int64_t>(std::filesystem::file_size(path));
  const auto count = [&](const std::string& of) { return database.integer("select count(*) from " + of); };
  info.keyframes = count("keyframes");
  info.points = count("points");
  info.observations = count("observations");
  info.texts = count("texts");
  info.words = database.integer("select count(distinct word) from texts");
  for (const SavedSession& session : info.sessions) {
    const std::string id = std::to_string(session.id);
    info.keyframes_of.push_back(count("keyframes where session = " + id));
    info.texts_of.push_back(count("texts t join keyframes k on k.id = t.host where k.session = " + id));
  }
  return info;
}

std::string info_text(const MapInfo& info) {
  std::string out;
  char line[200];
  const auto add = [&](const char* format, auto... values) {
    std::snprintf(line, sizeof line, format, values...);
    out += line;
  };
  add("map       schema %lld, saved %lld times, %.1f MB\n", static_cast<long long>(info.version),
      static_cast<long long>(info.revision), 1e-6 * static_cast<double>(info.bytes));
  const auto add_camera = [&](const char* what, const CameraModel& camera) {
    add("%s %s, %d x %d,", what, camera.raw.name(), camera.width, camera.height);
    for (const double parameter : parameters_of(camera)) add(" %.6g", parameter);
    out += "\n";
  };
  add_camera("camera   ", info.camera);
  if (info.given_camera) add_camera("given    ", *info.given_camera);
  add("holds     %lld key frames, %lld points, %lld observations, %lld texts of %lld words\n",
      static_cast<long long>(info.keyframes), static_cast<long long>(info.points),
      static_cast<long long>(info.observations), static_cast<long long>(info.texts),
      static_cast<long long>(info.words));
  for (std::size_t i = 0; i < info.sessions.size(); ++i) {
    const SavedSession& s = info.sessions[i];
    add("session %d %s  %d of %d frames, %lld key frames, %lld texts  ", s.id, s.started.c_str(), s.tracked, s.frames,
        static_cast<long long>(info.keyframes_of[i]), static_cast<long long>(info.texts_of[i]));
    out += s.sequence + "\n";
  }
  return out;
}

Json session_json(const SavedSession& session, std::int64_t keyframes, std::int64_t texts) {
  return {{"id", session.id},           {"started", session.started}, {"sequence", session.sequence},
          {"mode", session.mode},       {"version", session.version}, {"frames", session.frames},
          {"tracked", session.tracked}, {"keyframes", keyframes},     {"texts", texts}};
}

std::string info_json(const MapInfo& info) {
  Json sessions = Json::array();
  for (std::size_t i = 0; i < info.sessions.size(); ++i)
    sessions.push_back(session_json(info.sessions[i], info.keyframes_of[i], info.texts_of[i]));
  return Json{{"schema", info.version},
              {"revision", info.revision},
              {"bytes", info.bytes},
              {"camera", camera_json(info.camera)},
              {"given_camera", info.given_camera ? camera_json(*info.given_camera) : Json()},
              {"keyframes", info.keyframes},
              {"points", info.points},
              {"observations", info.observations},
              {"texts", info.texts},
              {"words", info.words},
              {"sessions", sessions}}
             .dump(1) +
         "\n";
}

std::vector<std::string> problems_of(const std::string& path) {
  std::vector<std::string> problems;
  Database database = open_map(path);
  try {
    for (const std::string& line : lines_of(database, "pragma integrity_check(10)"))
      if (line != "ok") problems.push_back(line);
    const std::vector<std::string> from = lines_of(database, "pragma foreign_key_check"),
                                   to = lines_of(database, "pragma foreign_key_check", 2);
    for (std::size_t i = 0; i < std::min(from.size(), std::size_t{10}); ++i)
      problems.push_back("a row of " + from[i] + " refers to one of " + to[i] + " that is gone");
    check_numbers(database, &problems);
    check_indices(database, &problems);
    load_map(path, Parameters());
  } catch (const InputError& error) {
    problems.push_back(error.message());
  }
  return problems;
}

}  // namespace textslam
