#include "textslam/report/text_index.hpp"

#include "textplane/geometry/plane.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/common/report_json.hpp"
#include "textslam/map/text_views.hpp"

namespace textslam {
int best_view(const Map& map, const TextObject& text, Quad<double>* quad) {
  std::vector<int> views = {text.host};
  views.insert(views.end(), text.views.begin(), text.views.end());
  int best = text.host;
  double most = -1;
  for (const int id : views) {
    Quad<double> seen;
    const SE3d T_c_w = map.keyframe(id).T_w_c.inverse();
    if (facing(map, text, T_c_w) <= 0 || !project_text(map, text, T_c_w, &seen)) continue;
    const double area = textplane::area(textplane::clip_to_image(seen, map.width, map.height));
    const bool whole = textplane::inside_image(seen, map.width, map.height, 0.0);
    const double worth = whole ? 1 + area : area / (1 + area);  // any that shows all of it before any that does not
    if (worth <= most) continue;
    most = worth;
    best = id;
    *quad = seen;
  }
  return best;
}

std::vector<IndexedText> index_texts(const Map& map, const std::function<std::string(int)>& image) {
  std::vector<IndexedText> texts;
  for (const TextObject& text : map.texts) {
    if (text.state != TextState::mapped) continue;
    IndexedText entry;
    entry.id = text.id;
    entry.text = textplane::consensus(text.votes);
    entry.readings = text.votes;
    double votes = 0;
    for (const auto& [word, count] : text.votes) votes += count;
    if (votes > 0) entry.score = text.votes.at(entry.text) / votes;
    const std::array<Vec3, 4> corners = world_corners(map, text);
    entry.position = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
    entry.normal = map.keyframe(text.host).T_w_c.R * textplane::plane_normal(text.theta);
    const Frame& view = map.keyframe(best_view(map, text, &entry.quad)).frame;
    entry.image = image(view.index);
    entry.timestamp = view.timestamp;
    texts.push_back(entry);
  }
  return texts;
}

std::string text_index_json(const std::vector<IndexedText>& texts) {
  const auto vector = [](const auto& v) {
    Json out = Json::array();
    for (const double value : v) out.push_back(value);
    return out;
  };
  Json list = Json::array();
  for (const IndexedText& text : texts) {
    Json quad = Json::array();
    for (const Vec2& corner : text.quad.corner) quad.push_back(vector(corner));
    list.push_back({{"id", text.id},
                    {"text", text.text},
                    {"score", text.score},
                    {"readings", text.readings},
                    {"position", vector(text.position)},
                    {"normal", vector(text.normal)},
                    {"image", text.image},
                    {"quad", quad},
                    {"timestamp", text.timestamp}});
  }
  return Json{{"texts", list}}.dump(1) + "\n";
}

}  // namespace textslam
