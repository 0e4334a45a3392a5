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
constexpr double kClearSide = 9, kClearSlant = 72;  // px, degrees
constexpr double kToDegrees = 57.295779513082320877;

using Corners = std::array<Vector3<double>, 4>;

Vector3<double> centre_of(const Corners& corners) { return (corners[0] + corners[1] + corners[2] + corners[3]) / 4; }

// A line of truth/quads.
struct SignView {
  std::array<Vector2<double>, 4> corners;
  double id = -1, visible = 0;
};

SignView parse_view(const TextLine& line, const std::string& path) {
  std::vector<std::string> parts(1);
  for (const char c : line.text) {
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  if (parts.size() < 11)  // a text may have commas
    throw InputError(path, line.number, "eight coordinates, a text, a sign and a share expected");
  SignView view;
  for (std::size_t i = 0; i < 8; ++i)
    view.corners[i / 2][static_cast<int>(i % 2)] = require_number(parts[i], path, line.number, "a coordinate");
  view.id = require_number(parts[parts.size() - 2], path, line.number, "a sign");
  view.visible = require_number(parts.back(), path, line.number, "a visible share");
  return view;
}

// Large and square enough for a detector?
bool is_clear(const SignView& view, const TrueSign& sign, const Vector3<double>& to_camera) {
  for (std::size_t i = 0; i < 4; ++i)
    if ((view.corners[i] - view.corners[(i + 1) % 4]).norm() < kClearSide) return false;
  return to_camera.dot(sign.normal) >= std::cos(kClearSlant / kToDegrees);
}

double largest_angle(const std::vector<Vector3<double>>& directions) {
  double cosine = 1;
  for (std::size_t i = 0; i < directions.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) cosine = std::min(cosine, directions[i].dot(directions[k]));
  return kToDegrees * std::acos(std::max(-1.0, cosine));
}

// Counts the frames of truth/quads that show each sign whole, and those that show it clearly.
void count_views(const std::string& folder, const std::vector<FrameRef>& frames, const std::vector<StampedPose>& truth,
                 std::vector<TrueSign>& signs) {
  std::vector<StampedPose> times;
  for (const FrameRef& frame : frames) times.push_back({frame.timestamp, {}});
  std::vector<const StampedPose*> poses(frames.size(), nullptr);
  for (const PosePair& pair : associate(times, truth, EvaluationOptions{}.tolerance))
    poses[pair.estimate] = &truth[pair.truth];
  std::vector<std::vector<Vector3<double>>> directions(signs.size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const std::string path = folder + "/truth/quads/" + frames[f].stem + ".txt";
    if (!std::filesystem::exists(path)) continue;
    for (const TextLine& line : read_lines(path)) {
      const SignView view = parse_view(line, path);
      for (std::size_t s = 0; s < signs.size(); ++s) {
        if (signs[s].id != view.id || !(view.visible > kWhole)) continue;
        ++signs[s].visible_frames;
        if (!poses[f]) continue;
        const Vector3<double> to_camera = (poses[f]->T_w_c.t - centre_of(signs[s].corners)).normalized();
        if (is_clear(view, signs[s], to_camera)) directions[s].push_back(to_camera);
      }
    }
  }
  for (std::size_t s = 0; s < signs.size(); ++s) {
    signs[s].clear_frames = static_cast<int>(directions[s].size());
    signs[s].parallax = largest_angle(directions[s]);
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

std::vector<TrueSign> read_true_signs(const std::string& folder, const std::vector<FrameRef>& frames,
                                      const std::vector<StampedPose>& truth) {
  const std::string path = folder + "/truth/signs.json";
  std::vector<TrueSign> signs;
  if (!std::filesystem::exists(path)) return signs;
  for_each_entry(read_json(path), "signs", path, [&](const nlohmann::json& entry) {
    signs.push_back(read_sign<TrueSign>(entry));
    if (entry.contains("radius")) signs.back().radius = entry.at("radius").get<double>();
  });
  count_views(folder, frames, truth, signs);
  return signs;
}

std::vector<MappedText> read_text_map(const std::string& path) {
  std::vector<MappedText> texts;
  for_each_entry(read_json(path), "texts", path, [&](const nlohmann::json& entry) {
    texts.push_back(read_sign<MappedText>(entry));
    if (entry.contains("normal_sigma_deg")) texts.back().sigma = entry.at("normal_sigma_deg").get<double>();
  });
  return texts;
}

TextEvaluation evaluate_texts(const std::vector<MappedText>& texts, const std::vector<TrueSign>& signs,
                              const Similarity& alignment) {
  TextEvaluation out;
  out.available = !signs.empty();
  if (!out.available) return out;
  std::vector<double> angles, centres, in_sigmas;
  std::vector<int> mapped;
  for (const MappedText& text : texts) {
    const Vector3<double> centre = alignment * centre_of(text.corners), normal = alignment.R * text.normal;
    SignMatch match;
    match.text = text.id;
    match.sigma = text.sigma;
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
      if (match.sigma > 0) in_sigmas.push_back(match.angle / match.sigma);
      centres.push_back(match.centre);
      mapped.push_back(match.sign);
    }
    out.matches.push_back(match);
  }
  for (const TrueSign& sign : signs) {
    if (sign.visible_frames < kMinVisibleFrames || sign.radius > 0) continue;
    const int has_text = std::find(mapped.begin(), mapped.end(), sign.id) != mapped.end() ? 1 : 0;
    ++out.signs;
    out.mapped += has_text;
    if (!sign.is_clear()) continue;
    ++out.clear;
    out.clear_mapped += has_text;
  }
  out.angle = error_statistics(std::move(angles));
  out.centre = error_statistics(std::move(centres));
  out.angle_over_sigma = error_statistics(std::move(in_sigmas));
  return out;
}

}  // namespace textslam
