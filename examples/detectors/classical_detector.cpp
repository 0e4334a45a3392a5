#include "detectors/classical_detector.hpp"

#include <algorithm>
#include <cmath>

namespace textslam {

std::vector<Detection> ClassicalDetector::detect(const FrameRef&, ImageView8 raw_image) {
  quads_.clear();
  if (!raw_image.valid()) return {};
  pyramid_.build(raw_image, std::clamp(parameters_.levels, 1, textplane::kMaxPyramidLevels));
  for (int level = 0; level < pyramid_.levels(); ++level) {
    const ImageView8 image = pyramid_.level(level);
    if (std::min(image.width(), image.height()) < parameters_.min_side && level > 0) break;
    mark_ink(image, parameters_, ink_scratch_, ink_);
    find_letters(image, ink_, parameters_, letter_scratch_, letters_);
    find_lines(letters_, parameters_, line_scratch_, lines_);
    for (const std::vector<int>& line : lines_) {
      TextQuad found = fit_quad(letters_, line, parameters_);
      if (!(found.score > 0)) continue;
      found.score *= std::pow(parameters_.level_penalty, level);
      for (auto& c : found.quad.corner) c = ((c.array() + 0.5) * std::ldexp(1.0, level) - 0.5).matrix();
      quads_.push_back(found);
    }
  }
  suppress_overlaps(quads_, parameters_);

  std::vector<Detection> detections;
  for (const TextQuad& found : quads_) detections.push_back({found.quad, kUnreadText, found.score});
  return detections;
}

}  // namespace textslam
