#include "textslam_map/text_query.hpp"

#include <algorithm>
#include <cctype>

#include "io/json_file.hpp"
#include "textplane/landmarks/words.hpp"

namespace textslam {
namespace {

constexpr int kNoMatch = 6;

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// 0 is best.
int rank(const IndexedText& text, const std::string& word) {
  const auto holds = [&](const std::string& reading) { return lower(reading).find(word) != std::string::npos; };
  if (lower(text.text) == word) return 0;
  if (is_read(text.text) && holds(text.text)) {
    if (lower(text.text).compare(0, word.size(), word) == 0) return 1;
    return lower(text.text).find(" " + word) != std::string::npos ? 2 : 3;
  }
  for (const auto& [reading, votes] : text.readings)
    if (holds(reading)) return 4;
  for (const auto& [reading, votes] : text.readings)
    if (textplane::word_similarity(lower(reading), word) >= Parameters{}.text.same_word) return 5;
  return kNoMatch;
}

}  // namespace

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

LargestAngle largest_angle(const std::vector<IndexedText>& texts) {
  LargestAngle largest;
  for (std::size_t i = 0; i < texts.size(); ++i)
    for (std::size_t j = i + 1; j < texts.size(); ++j) {
      const double angle = angle_between(texts[i], texts[j]);
      if (largest.first < 0 || angle > largest.degrees) largest = {angle, texts[i].id, texts[j].id};
    }
  return largest;
}

std::string angles_json(const std::vector<IndexedText>& texts) {
  using nlohmann::json;
  json list = json::array(), degrees = json::array();
  for (const IndexedText& text : texts) {
    const auto& n = text.normal;
    list.push_back({{"id", text.id}, {"text", text.text}, {"score", text.score}, {"normal", {n.x(), n.y(), n.z()}}});
    json row = json::array();
    for (const IndexedText& other : texts) row.push_back(angle_between(text, other));
    degrees.push_back(row);
  }
  const LargestAngle most = largest_angle(texts);
  const json largest =
      texts.size() < 2 ? json() : json{{"degrees", most.degrees}, {"texts", {most.first, most.second}}};
  return json{{"texts", list}, {"degrees", degrees}, {"largest", largest}}.dump(1) + "\n";
}

}  // namespace textslam
