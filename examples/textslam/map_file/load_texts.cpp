// Texts: planes, words and patches.
#include <algorithm>

#include "textplane/geometry/quad.hpp"
#include "textslam/map_file/pixel_bytes.hpp"
#include "textslam/map_file/tables.hpp"

namespace textslam {
namespace {

void load_rows(Database& database, Map* map, int most) {
  Statement row(database,
                "select id, host, theta_x, theta_y, theta_z, c_xx, c_xy, c_xz, c_yy, c_yz, c_zz, x1, y1, x2, y2, x3, "
                "y3, x4, y4, area, zncc, variance_factor, detections, shown, failures from texts");
  while (row.next()) {
    TextObject& text = map->text(row.index(0, most));
    text.state = TextState::mapped;
    text.host = row.index(1, map->newest_keyframe());
    if (map->keyframe(text.host).culled) database.refuse("damaged: the host of a text is missing");
    text.theta = {row.number(2), row.number(3), row.number(4)};
    int column = 5;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j, ++column)
        text.covariance(i, j) = text.covariance(j, i) = row.is_null(column) ? 0 : row.number(column);
    for (int i = 0; i < 4; ++i)
      text.patch.quad.corner[static_cast<std::size_t>(i)] = {row.number(11 + 2 * i), row.number(12 + 2 * i)};
    if (text.theta.isZero() || !textplane::is_convex(text.patch.quad))
      database.refuse("damaged: text " + std::to_string(text.id) + " has no plane or no shape");
    text.patch.area = row.number(19);
    text.zncc = row.number(20);
    text.variance_factor = row.number(21);
    text.detections = row.index(22, INT32_MAX);
    text.shown = row.index(23, INT32_MAX);
    text.failures = row.index(24, INT32_MAX);
    text.patch.camera = map->camera.pinhole;
    text.patch.status = textplane::Status::ok;
  }
}

void load_patches(Database& database, Map* map, int most) {
  Statement row(database, "select text, level, arrays, pixels from patches order by text, level");
  while (row.next()) {
    TextObject& text = map->text(row.index(0, most));
    const auto level = static_cast<int>(row.integer(1, 0, textplane::kMaxPyramidLevels - 1));
    text.patch.levels.emplace_back();
    if (level != text.patch.level_count() - 1 ||
        !from_bytes(row.bytes(3), row.index(2, kLensArrays), &text.patch.levels.back()))
      database.refuse("damaged: the patch of text " + std::to_string(text.id));
  }
  for (const TextObject& text : map->texts)
    if (text.state == TextState::mapped && text.patch.max_pixels() == 0)
      database.refuse("damaged: text " + std::to_string(text.id) + " has no patch");
}

void load_views_and_votes(Database& database, Map* map, int most) {
  Statement view(database, "select text, keyframe from text_views order by text, keyframe");
  while (view.next()) {
    const int keyframe = view.index(1, map->newest_keyframe());
    if (map->keyframe(keyframe).culled) database.refuse("damaged: a text is seen by a key frame that is missing");
    map->text(view.index(0, most)).views.push_back(keyframe);
  }
  Statement vote(database, "select text, word, score from votes");
  while (vote.next()) map->text(vote.index(0, most)).votes[vote.text(1)] = vote.number(2);
}

}  // namespace

void load_texts(Database& database, Map* map) {
  const std::int64_t most = database.integer("select coalesce(max(id), -1) from texts");
  if (most > kMostId) database.refuse("damaged: the id of a text is out of range");
  map->texts.resize(static_cast<std::size_t>(most + 1));
  for (std::size_t i = 0; i < map->texts.size(); ++i) {
    map->texts[i].id = static_cast<int>(i);
    map->texts[i].state = TextState::dropped;
  }
  load_rows(database, map, static_cast<int>(most));
  load_patches(database, map, static_cast<int>(most));
  load_views_and_votes(database, map, static_cast<int>(most));
  // The patches move as their hosts' rows do.
  for (const int id : map->keyframe_ids())
    if (const auto rows = map->keyframe(id).frame.rows) map->set_rows(id, rows);
}

}  // namespace textslam
