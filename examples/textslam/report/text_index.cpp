#include "textslam/report/text_index.hpp"

#include <algorithm>
#include <cctype>

#include "io/json_file.hpp"
#include "textplane/geometry/plane.hpp"
#include "textslam/common/report_json.hpp"
#include "textslam/map/text_geometry.hpp"
#include "textslam/map/text_words.hpp"
#include "textslam/report/evaluate_text.hpp"

namespace textslam {
namespace {

constexpr int kNoMatch = 4;

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// 0 is best.
int rank(const IndexedText& text, const std::string& word) {
  const auto holds = [&](const std::string& reading) { return lower(reading).find(word) != std::string::npos; };
  if (lower(text.text) == word) return 0;
  if (is_read(text.text) && holds(text.text)) return 1;
  for (const auto& [reading, votes] : text.readings)
    if (holds(reading)) return 2;
  for (const auto& [reading, votes] : text.readings)
    if (word_similarity(lower(reading), word) >= Parameters{}.same_word) return 3;
  return kNoMatch;
}

}  // namespace

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
    entry.text = text.word();
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

std::vector<IndexedText> read_text_index(const std::string& path) {
  std::vector<IndexedText> texts;
  for_each_entry(read_json(path), "texts", path, [&](const nlohmann::json& entry) {
    IndexedText text;
    text.id = to_int(entry.at("id"));
    entry.at("text").get_to(text.text);
    entry.at("score").get_to(text.score);
    entry.at("readings").get_to(text.readings);
    text.position = to_vector3(entry.at("position"));
    text.normal = to_vector3(entry.at("normal"));
    entry.at("image").get_to(text.image);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 2; ++k)
        text.quad.corner[i][static_cast<int>(k)] = entry.at("quad").at(i).at(k).get<double>();
    entry.at("timestamp").get_to(text.timestamp);
    texts.push_back(text);
  });
  return texts;
}

std::vector<IndexedText> query(const std::vector<IndexedText>& texts, const std::string& word) {
  const std::string wanted = lower(word);
  std::vector<IndexedText> found;
  for (const IndexedText& text : texts)
    if (!wanted.empty() && rank(text, wanted) < kNoMatch) found.push_back(text);
  std::stable_sort(found.begin(), found.end(), [&](const IndexedText& a, const IndexedText& b) {
    const int rank_a = rank(a, wanted), rank_b = rank(b, wanted);
    return rank_a != rank_b ? rank_a < rank_b : a.score > b.score;
  });
  return found;
}

double angle_between(const IndexedText& a, const IndexedText& b) { return degrees_between(a.normal, b.normal); }

}  // namespace textslam
