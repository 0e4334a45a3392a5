#include "textslam/evaluate_text.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/input_error.hpp"
#include "io/text_file.hpp"
#include "textslam/statistics.hpp"

namespace textslam {
namespace {

constexpr int kMinVisibleFrames = 10;  // that a sign must be seen whole to count
constexpr double kWhole = 0.99;

Vec3 centre_of(const std::array<Vec3, 4>& corners) { return (corners[0] + corners[1] + corners[2] + corners[3]) / 4; }

// Counts the frames of truth/quads (x1,...,y4,text,sign,visible a line) that show each sign whole.
void count_visible(const Sequence& sequence, std::vector<TrueSign>& signs) {
  for (const FrameRef& frame : sequence.frames) {
    const std::string path = sequence.folder + "/truth/quads/" + frame.stem + ".txt";
    if (!std::filesystem::exists(path)) continue;
    for (const TextLine& line : read_lines(path)) {
      const std::size_t last = line.text.rfind(','), before = line.text.rfind(',', last - 1);
      if (last == std::string::npos || before == std::string::npos)
        throw InputError(path, line.number, "eight coordinates, a text, a sign and a share expected");
      const double id = require_number(line.text.substr(before + 1, last - before - 1), path, line.number, "a sign");
      const double visible = require_number(line.text.substr(last + 1), path, line.number, "a visible share");
      for (TrueSign& sign : signs)
        if (sign.id == static_cast<int>(id) && visible > kWhole) ++sign.visible_frames;
    }
  }
}

Vec3 to_vec3(const nlohmann::json& j) { return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()}; }

}  // namespace

std::vector<TrueSign> read_true_signs(const Sequence& sequence) {
  const std::string path = sequence.folder + "/truth/signs.json";
  std::vector<TrueSign> signs;
  if (!std::filesystem::exists(path)) return signs;
  try {
    const nlohmann::json json = nlohmann::json::parse(read_file(path));
    for (const nlohmann::json& s : json.at("signs")) {
      TrueSign sign;
      sign.id = s.at("id").get<int>();
      sign.word = s.at("text").get<std::string>();
      for (std::size_t i = 0; i < 4; ++i) sign.corners[i] = to_vec3(s.at("corners").at(i));
      sign.normal = to_vec3(s.at("normal"));
      signs.push_back(sign);
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(path, 0, error.what());
  }
  count_visible(sequence, signs);
  return signs;
}

std::array<Vec3, 4> world_corners(const Map& map, const TextObject& text) {
  std::array<Vec3, 4> corners;
  const SE3d& T_w_h = map.keyframe(text.host).T_w_c;
  for (std::size_t i = 0; i < 4; ++i)
    corners[i] = T_w_h * textplane::plane_point<double>(text.theta, map.camera.unproject(text.patch.quad.corner[i]));
  return corners;
}

TextEvaluation evaluate_text(const Map& map, const std::vector<TrueSign>& signs, const Similarity& alignment) {
  TextEvaluation out;
  out.available = !signs.empty();
  std::vector<double> angles, centres;
  std::vector<int> mapped;
  for (const TextObject& text : map.texts) {
    if (text.state != TextState::mapped || !out.available) continue;
    std::array<Vec3, 4> corners = world_corners(map, text);
    for (Vec3& corner : corners) corner = alignment * corner;
    const Vec3 centre = centre_of(corners);
    const Vec3 normal = alignment.R * (map.keyframe(text.host).T_w_c.R * textplane::plane_normal(text.theta));
    SignMatch match;
    match.text = text.id;
    double nearest = 0;
    for (const TrueSign& sign : signs) {
      const double distance = (centre - centre_of(sign.corners)).norm();
      // The text stands for the sign when its centre falls within the sign.
      if (distance > 0.5 * (sign.corners[1] - sign.corners[0]).norm() || (match.sign >= 0 && distance >= nearest))
        continue;
      nearest = distance;
      match.sign = sign.id;
      match.centre = distance;
      match.angle = std::acos(std::clamp(normal.dot(sign.normal.normalized()), -1.0, 1.0)) * 180 / M_PI;
      match.word = text.word() == sign.word;
    }
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
    if (sign.visible_frames < kMinVisibleFrames) continue;
    ++out.signs;
    out.mapped += std::find(mapped.begin(), mapped.end(), sign.id) != mapped.end() ? 1 : 0;
  }
  out.median_angle = median(angles);
  out.max_angle = angles.empty() ? 0 : *std::max_element(angles.begin(), angles.end());
  out.median_centre = median(centres);
  return out;
}

}  // namespace textslam
