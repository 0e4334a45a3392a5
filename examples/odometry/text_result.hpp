// What an odometry's texts are in the end: OUTPUT/text_map.json, as textslam writes it and textslam-eval reads it, and
// against the true signs of a rendered sequence.
#ifndef ODOMETRY_TEXT_RESULT_HPP
#define ODOMETRY_TEXT_RESULT_HPP

#include <cstddef>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/evaluate_signs.hpp"
#include "io/output_file.hpp"
#include "io/sequence.hpp"
#include "textplane/landmarks/text_map.hpp"

namespace odometry {

/// The mapped texts, in the world.
inline std::vector<textslam::MappedText> mapped_texts(const textplane::TextMap& texts) {
  std::vector<textslam::MappedText> mapped;
  for (const textplane::TextObject& text : texts.objects()) {
    textslam::MappedText out;
    if (text.state != textplane::TextState::mapped || !texts.corners(text, &out.corners)) continue;
    out.id = text.id;
    out.word = textplane::consensus(text.votes);
    out.normal = texts.keyframes().text_keyframe(text.host).T_w_c.R * textplane::plane_normal(text.theta);
    out.sigma = textplane::normal_sigma(text) * 180 / textplane::detail::kHalfTurn;
    mapped.push_back(out);
  }
  return mapped;
}

/// Writes the file; prints how many texts there are, and where the signs are known, how many lie on none of them. The
/// same of the certain ones, whose normal is known to refine_max_sigma: textslam keeps no others in the end. The world
/// is that of the truth: the odometry began there.
inline void finish_texts(const textplane::TextMap& texts, const textslam::Sequence& sequence,
                         const std::string& sequence_folder, const std::string& output) {
  const auto mapped = mapped_texts(texts);
  const auto numbers = [](const auto& v) { return nlohmann::json{v.x(), v.y(), v.z()}; };
  nlohmann::json list = nlohmann::json::array();
  for (const textslam::MappedText& text : mapped) {
    nlohmann::json corners = nlohmann::json::array();
    for (const auto& corner : text.corners) corners.push_back(numbers(corner));
    list.push_back({{"id", text.id},
                    {"text", text.word},
                    {"corners", corners},
                    {"normal", numbers(text.normal)},
                    {"normal_sigma_deg", text.sigma}});
  }
  textslam::write_file(output + "/text_map.json", nlohmann::json{{"texts", list}}.dump(1) + "\n");
  std::printf("texts %zu\n", mapped.size());
  const auto signs = textslam::read_true_signs(sequence_folder, sequence.frames, sequence.groundtruth);
  const auto found = textslam::evaluate_texts(mapped, signs, textslam::Similarity{});
  if (!found.available) return;
  const double limit = textplane::TextOptions{}.refine_max_sigma;
  int certain = 0, false_certain = 0;
  for (std::size_t i = 0; i < mapped.size(); ++i) {
    certain += mapped[i].sigma <= limit ? 1 : 0;
    false_certain += mapped[i].sigma <= limit && found.matches[i].sign < 0 ? 1 : 0;
  }
  std::printf("false texts %d\ncertain texts %d\nfalse certain texts %d\nsigns mapped %d of %d\n", found.false_texts,
              certain, false_certain, found.mapped, found.signs);
  if (found.angle.n > 0) std::printf("angle median %.2f deg, largest %.2f deg\n", found.angle.median, found.angle.max);
}

}  // namespace odometry

#endif  // ODOMETRY_TEXT_RESULT_HPP
