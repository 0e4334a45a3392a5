#include "textslam/report/evaluate_text.hpp"

#include "textplane/geometry/plane.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/map/text_views.hpp"

namespace textslam {

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
