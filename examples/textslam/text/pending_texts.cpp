#include "textslam/text/pending_texts.hpp"

#include <algorithm>

#include "textplane/geometry/quad.hpp"
#include "textslam/common/algorithms.hpp"

namespace textslam {
namespace {

// Median depth of what the newest key frame observes within a quad's longer side of its centre; 0 where too little.
double depth_about(const Map& map, const Parameters& parameters, const SE3d& T_c_w, const Quad<double>& quad) {
  const auto& c = quad.corner;
  const double near = std::max((c[1] - c[0]).norm(), (c[3] - c[0]).norm());
  const Vec2 middle = textplane::centroid(quad);
  std::vector<double> depths;
  for (const int id : map.keyframes.back().points) {
    const Vec3 p = T_c_w * map.point(id).p_w;
    if (!map.point(id).bad && map.camera.in_domain(p) && (map.camera.project(p) - middle).norm() <= near)
      depths.push_back(p.z());
  }
  return static_cast<int>(depths.size()) < parameters.text_carried_corners ? 0 : median(std::move(depths));
}

}  // namespace

bool PendingTexts::project(const Map& map, const SE3d& T_c_w, const Pending& pending, Quad<double>* quad) const {
  if (pending.map != map.number) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 p = T_c_w * pending.corners[i];
    if (!map.camera.in_domain(p)) return false;
    quad->corner[i] = map.camera.project(p);
  }
  return true;
}

void PendingTexts::add(const Map& map, const Frame& frame, const SE3d& T_c_w,
                       const std::vector<Detection>& detections) {
  erase_if(all_, [&](const Pending& p) {
    return p.map != map.number || !(frame.timestamp - p.seen <= parameters_.text_pending);
  });
  if (map.keyframes.empty()) return;
  for (Pending& pending : all_) ++pending.count.shown;
  const SE3d T_w_c = T_c_w.inverse();
  for (const Detection& detection : detections) {
    const double depth = depth_about(map, parameters_, T_c_w, detection.quad);
    std::array<Vec3, 4> rays;
    if (!(depth > 0) || !rays_of(map.camera, detection.quad, &rays)) continue;
    Pending pending;
    pending.map = map.number;
    pending.seen = frame.timestamp;
    pending.count = take(map, T_c_w, detection.quad);
    ++pending.count.detections;
    pending.count.shown = std::max(1, pending.count.shown);
    pending.newest = detection;
    for (std::size_t i = 0; i < 4; ++i) pending.corners[i] = T_w_c * Vec3(depth * rays[i]);
    all_.push_back(std::move(pending));
  }
}

std::vector<Detection> PendingTexts::carried_to(const Map& map, const SE3d& T_c_w) const {
  std::vector<Detection> carried;
  for (const Pending& pending : all_) {
    Detection detection = pending.newest;
    if (pending.count.detections >= 2 && project(map, T_c_w, pending, &detection.quad))
      carried.push_back(std::move(detection));
  }
  return carried;
}

PendingTexts::Count PendingTexts::take(const Map& map, const SE3d& T_c_w, const Quad<double>& quad) {
  Count count;
  erase_if(all_, [&](const Pending& pending) {
    Quad<double> there;
    if (!project(map, T_c_w, pending, &there) || textplane::iou(there, quad) < parameters_.text.confirm_iou)
      return false;
    if (pending.count.detections > count.detections) count = pending.count;
    return true;
  });
  return count;
}

}  // namespace textslam
