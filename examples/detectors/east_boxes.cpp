#include "detectors/east_boxes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace textslam {
namespace {

constexpr double kCell = 4;  // px

}  // namespace

std::vector<Detection> decode_east(const EastMaps& maps, const EastParameters& parameters) {
  const auto size = static_cast<std::size_t>(maps.rows) * static_cast<std::size_t>(maps.columns);
  std::vector<Detection> boxes;
  for (std::size_t i = 0; i < size; ++i) {
    const double score = static_cast<double>(maps.score[i]);
    if (!(score >= parameters.min_score)) continue;
    std::array<double, 5> g;
    bool good = std::isfinite(score);
    for (std::size_t k = 0; k < 5; ++k) {
      g[k] = static_cast<double>(maps.geometry[k * size + i]);
      good = good && std::isfinite(g[k]);
    }
    const auto [top, right, bottom, left, angle] = g;
    if (!good || !(top + bottom > 0) || !(left + right > 0)) continue;
    const auto columns = static_cast<std::size_t>(maps.columns);
    const Vector2<double> p(kCell * static_cast<double>(i % columns), kCell * static_cast<double>(i / columns));
    const Vector2<double> along(std::cos(angle), -std::sin(angle)), down(std::sin(angle), std::cos(angle));
    Detection box;
    box.score = std::min(score, 1.0);
    box.quad.corner = {p - left * along - top * down, p + right * along - top * down, p + right * along + bottom * down,
                       p - left * along + bottom * down};
    boxes.push_back(box);
  }
  std::stable_sort(boxes.begin(), boxes.end(),
                   [](const Detection& a, const Detection& b) { return a.score > b.score; });
  std::vector<Detection> kept;
  for (const Detection& box : boxes)
    if (std::none_of(kept.begin(), kept.end(), [&](const Detection& other) {
          return textplane::iou(box.quad, other.quad) > parameters.max_overlap;
        }))
      kept.push_back(box);
  return kept;
}

}  // namespace textslam
