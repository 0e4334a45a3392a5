#include "io/evaluate_signs.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/input_error.hpp"
#include "io/json_file.hpp"
#include "io/text_file.hpp"

namespace textslam {
namespace {

constexpr int kMinVisibleFrames = 10;  // a sign counts if so many frames show it whole
constexpr double kWhole = 0.99;
constexpr double kToDegrees = 57.295779513082320877;

using Corners = std::array<Vector3<double>, 4>;

Vector3<double> centre_of(const Corners& corners) { return (corners[0] + corners[1] + corners[2] + corners[3]) / 4; }

// Counts the frames of truth/quads that show each sign whole.
void count_visible(const std::string& folder, const std::vector<std::string>& stems, std::vector<TrueSign>& signs) {
  for (const std::string& stem : stems) {
    const std::string path = folder + "/truth/quads/" + stem + ".txt";
    if (!std::filesystem::exists(path)) continue;
    for (const TextLine& line : read_lines(path)) {
      const std::size_t last = line.text.rfind(','), before = line.text.rfind(',', last - 1);
      if (last == std::string::npos || before == std::string::npos)
        throw InputError(path, line.number, "eight coordinates, a text, a sign and a share expected");
      const double id = require_number(line.text.substr(before + 1, last - before - 1), path, line.number, "a sign");
      const double visible = require_number(line.text.substr(last + 1), path, line.number, "a visible share");
      for (TrueSign& sign : signs)
        if (sign.id == id && visible > kWhole) ++sign.visible_frames;
    }
  }
}

// The fields that signs and texts share. Throws nlohmann::json::exception.
template <class Sign>
Sign read_sign(const nlohmann::json& json) {
  Sign sign;
  sign.id = to_int(json.at("id"));
  sign.word = json.at("text").get<std::string>();
  for (std::size_t i = 0; i < 4; ++i) sign.corners[i] = to_vector3(json.at("corners").at(i));
  sign.normal = to_vector3(json.at("normal"));
  return sign;
}

}  // namespace

std::vector<TrueSign> read_true_signs(const std::string& folder, const std::vector<std::string>& stems) {
  const std::string path = folder + "/truth/signs.json";
  std::vector<TrueSign> signs;
  if (!std::filesystem::exists(path)) return signs;
  for_each_entry(read_json(path), "signs", path, [&](const nlohmann::json& entry) {
    signs.push_back(read_sign<TrueSign>(entry));
    if (entry.contains("radius")) signs.back().radius = entry.at("radius").get<double>();
  });
  count_visible(folder, stems, signs);
  return signs;
}

std::vector<MappedText> read_text_map(const std::string& path) {
  std::vector<MappedText> texts;
  for_each_entry(read_json(path), "texts", path,
                 [&](const nlohmann::json& entry) { texts.push_back(read_sign<MappedText>(entry)); });
  return texts;
}

TextEvaluation evaluate_texts(const std::vector<MappedText>& texts, const std::vector<TrueSign>& signs,
                              const Similarity& alignment) {
  TextEvaluation out;
  out.available = !signs.empty();
  if (!out.available) return out;
  std::vector<double> angles, centres;
  std::vector<int> mapped;
  for (const MappedText& text : texts) {
    const Vector3<double> centre = alignment * centre_of(text.corners), normal = alignment.R * text.normal;
    SignMatch match;
    match.text = text.id;
    bool flat = true;
    for (const TrueSign& sign : signs) {
      const double distance = (centre - centre_of(sign.corners)).norm();
      if (distance > 0.5 * (sign.corners[1] - sign.corners[0]).norm() || (match.sign >= 0 && distance >= match.centre))
        continue;
      match.sign = sign.id;
      match.centre = distance;
      match.angle = kToDegrees * std::atan2(normal.cross(sign.normal).norm(), normal.dot(sign.normal));
      match.word = text.word == sign.word;
      flat = !(sign.radius > 0);
    }
    if (!flat) match = {text.id};
    if (match.sign < 0) {
      ++out.false_texts;
    } else {
      angles.push_back(match.angle);
      centres.push_back(match.centre);
      mapped.push_back(match.sign);
    }
    out.matches.push_back(match);
  }
  for (const TrueSign& sign : signs) {
    if (sign.visible_frames < kMinVisibleFrames || sign.radius > 0) continue;
    ++out.signs;
    out.mapped += std::find(mapped.begin(), mapped.end(), sign.id) != mapped.end() ? 1 : 0;
  }
  out.angle = error_statistics(std::move(angles));
  out.centre = error_statistics(std::move(centres));
  return out;
}

}  // namespace textslam
