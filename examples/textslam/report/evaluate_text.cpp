#include "textslam/report/evaluate_text.hpp"

#include "textplane/geometry/plane.hpp"
#include "textplane/landmarks/text_view.hpp"
#include "textplane/landmarks/words.hpp"

namespace textslam {

std::array<Vec3, 4> world_corners(const Map& map, const TextObject& text) {
  std::array<Vec3, 4> corners = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  textplane::text_corners(text, &corners);
  const SE3d& T_w_h = map.keyframe(text.host).T_w_c;
  for (Vec3& corner : corners) corner = T_w_h * corner;
  return corners;
}

std::vector<TrueSign> read_true_signs(const Sequence& sequence) {
  return read_true_signs(sequence.folder, sequence.frames, sequence.groundtruth);
}

TextEvaluation evaluate_text(const Map& map, const std::vector<TrueSign>& signs, const Similarity& alignment) {
  std::vector<MappedText> texts;
  for (const TextObject& text : map.texts) {
    if (text.state != TextState::mapped) continue;
    const Vec3 normal = map.keyframe(text.host).T_w_c.R * textplane::plane_normal(text.theta);
    texts.push_back(
        {text.id, textplane::consensus(text.votes), world_corners(map, text), normal, normal_sigma(text) / radians(1)});
  }
  return evaluate_texts(texts, signs, alignment);
}

}  // namespace textslam
