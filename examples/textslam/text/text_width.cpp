#include "textslam/text/text_width.hpp"

#include <algorithm>
#include <cmath>

#include "textplane/geometry/plane.hpp"
#include "textslam/common/algorithms.hpp"
#include "textslam/map/text_views.hpp"

namespace textslam {
namespace {

constexpr double kBorder = 2;       // px
constexpr double kCornerSigma = 2;  // px, of a box where too few tell
constexpr double kFar = 3;          // standard deviations

struct Box {
  double width, weight;
};

double width_on_plane(const Vec3& theta, const std::array<Vec3, 4>& rays) {
  std::array<Vec3, 4> p;
  for (std::size_t i = 0; i < 4; ++i)
    if (!textplane::is_ok(textplane::plane_point(theta, rays[i], &p[i]))) return 0;
  return 0.5 * ((p[1] - p[0]).norm() + (p[2] - p[3]).norm());
}

// The best box around the text in a key frame.
void add_box(const Map& map, const Parameters& parameters, const TextObject& text, int id, std::vector<Box>* boxes) {
  const SE3d T_c_w = map.keyframe(id).T_w_c.inverse();
  Quad<double> expected;
  if (facing(map, text, T_c_w) <= 0 || !project_text(map, text, T_c_w, &expected)) return;
  const Quad<double>* best = nullptr;
  double most = parameters.text_shown_iou;
  for (const Detection& detection : map.keyframe(id).frame.detections) {
    const double iou = textplane::iou(expected, detection.quad);
    if (iou < most || !textplane::inside_image(detection.quad, map.width, map.height, kBorder)) continue;
    most = iou;
    best = &detection.quad;
  }
  std::array<Vec3, 4> rays;
  Vec3 theta;
  if (!best || !rays_of(map.camera, *best, &rays)) return;
  const SE3d T_r_w = map.T_c_w_at(id, textplane::centroid(*best));
  if (!textplane::is_ok(textplane::reanchor_plane<double>(text.theta, map.T_c_h(T_r_w, text.host), &theta))) return;
  const auto& c = best->corner;
  const double px = 0.5 * ((c[1] - c[0]).norm() + (c[2] - c[3]).norm()), width = width_on_plane(theta, rays);
  if (width > 0 && px > 0) boxes->push_back({width, px * px});
}

void drop_far_ones(std::vector<Box>* boxes) {
  std::vector<double> widths, off;
  for (const Box& box : *boxes) widths.push_back(box.width);
  const double middle = median(widths);
  for (const double width : widths) off.push_back(std::abs(width - middle));
  const double limit = std::max(kFar * 1.4826 * median(std::move(off)), 1e-9 * middle);
  erase_if(*boxes, [&](const Box& box) { return std::abs(box.width - middle) > limit; });
}

// What the covariance of the plane makes of the width in the host.
double plane_sigma(const TextObject& text) {
  std::array<Vec3, 4> rays;
  for (std::size_t i = 0; i < 4; ++i) rays[i] = text.patch.camera.unproject(text.patch.quad.corner[i]);
  Vec3 J;
  const double step = 1e-6 * text.theta.norm();
  for (int k = 0; k < 3; ++k) {
    Vec3 more = text.theta, less = text.theta;
    more[k] += step;
    less[k] -= step;
    J[k] = (width_on_plane(more, rays) - width_on_plane(less, rays)) / (2 * step);
  }
  return std::sqrt(std::max(0.0, J.dot(text.covariance * J)));
}

}  // namespace

TextWidth text_width(const Map& map, const Parameters& parameters, const TextObject& text) {
  std::vector<Box> boxes;
  add_box(map, parameters, text, text.host, &boxes);
  for (const int id : text.views) add_box(map, parameters, text, id, &boxes);
  TextWidth out;
  if (boxes.empty()) return out;
  drop_far_ones(&boxes);
  double sum = 0, weights = 0, squares = 0, spread = 0;
  for (const Box& box : boxes) {
    sum += box.weight * box.width;
    weights += box.weight;
    squares += box.weight * box.weight;
  }
  out.boxes = static_cast<int>(boxes.size());
  out.width = sum / weights;
  for (const Box& box : boxes) spread += box.weight * (box.width - out.width) * (box.width - out.width);
  // Boxes as bad as they are by experience, until there are enough to tell.
  const double expected = out.width * kCornerSigma / std::sqrt(weights / out.boxes);
  const double many = out.boxes - 1, variance = (expected * expected * 3 + spread / weights * out.boxes) / (3 + many);
  out.sigma = std::hypot(std::sqrt(variance * squares / (weights * weights)), plane_sigma(text));
  return out;
}

}  // namespace textslam
