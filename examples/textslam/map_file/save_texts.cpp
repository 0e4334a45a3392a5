// Texts: planes, words, patches, and the two indices over them.
#include <algorithm>

#include "textplane/geometry/plane.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/map/text_views.hpp"
#include "textslam/map_file/pixel_bytes.hpp"
#include "textslam/map_file/tables.hpp"

namespace textslam {
namespace {

class TextWriter {
 public:
  explicit TextWriter(Database& database)
      : text_(database,
              "insert into texts values (?,?, ?,?,?, ?,?,?, ?,?, ?, ?,?,?, ?,?,?,?,?,?, ?,?,?,?,?,?,?,?, ?,?,?, "
              "?,?,?)"),
        view_(database, "insert into text_views values (?, ?)"),
        vote_(database, "insert into votes values (?, ?, ?)"),
        patch_(database, "insert into patches values (?, ?, ?, ?)"),
        word_(database, "insert into words (word, text) values (?, ?)"),
        box_(database, "insert into text_boxes values (?, ?, ?, ?, ?, ?, ?)") {}

  void write(const Map& map, const TextObject& text) {
    const std::array<Vec3, 4> corners = world_corners(map, text);
    if (!is_finite(text, corners)) return;
    write_row(map, text, corners);
    for (const int view : text.views) view_.run(text.id, view);
    for (const auto& [word, score] : text.votes) {
      vote_.run(text.id, word, score);
      word_.run(word, text.id);
    }
    for (int level = 0; level < text.patch.level_count(); ++level) {
      const textplane::PatchLevel& pixels = text.patch.levels[static_cast<std::size_t>(level)];
      const std::string bytes = to_bytes(pixels);
      patch_.run(text.id, level, arrays_of(pixels), std::string_view(bytes));
    }
    Vec3 low = corners[0], high = corners[0];
    for (const Vec3& corner : corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    box_.run(text.id, low.x(), high.x(), low.y(), high.y(), low.z(), high.z());
  }

 private:
  static bool is_finite(const TextObject& text, const std::array<Vec3, 4>& corners) {
    return text.theta.allFinite() && textplane::all_finite(text.patch.quad) &&
           std::all_of(corners.begin(), corners.end(), [](const Vec3& corner) { return corner.allFinite(); });
  }

  void write_row(const Map& map, const TextObject& text, const std::array<Vec3, 4>& corners) {
    const Vec3 centre = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
    const Vec3 normal = map.keyframe(text.host).T_w_c.R * textplane::plane_normal(text.theta);
    const double width = 0.5 * ((corners[1] - corners[0]).norm() + (corners[2] - corners[3]).norm());
    const double height = 0.5 * ((corners[3] - corners[0]).norm() + (corners[2] - corners[1]).norm());
    const Eigen::Matrix3d& c = text.covariance;
    const auto& q = text.patch.quad.corner;
    text_.run(text.id, textplane::consensus(text.votes), centre.x(), centre.y(), centre.z(), normal.x(), normal.y(),
              normal.z(), width, height, text.host, text.theta.x(), text.theta.y(), text.theta.z(), c(0, 0), c(0, 1),
              c(0, 2), c(1, 1), c(1, 2), c(2, 2), q[0].x(), q[0].y(), q[1].x(), q[1].y(), q[2].x(), q[2].y(), q[3].x(),
              q[3].y(), text.patch.area, text.zncc, text.variance_factor, text.detections, text.shown, text.failures);
  }

  Statement text_, view_, vote_, patch_, word_, box_;
};

}  // namespace

void save_texts(Database& database, const Map& map) {
  TextWriter writer(database);
  for (const TextObject& text : map.texts)
    if (text.state == TextState::mapped) writer.write(map, text);
}

}  // namespace textslam
