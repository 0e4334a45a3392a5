// Spanning places: where a detector takes for a text what lies on two planes: a shadow gap in a room's corner, a box
// before a wall. They stand in the world, so that every frame shows the same ones.
#ifndef TEXTSLAM_RENDERER_SPANNING_HPP
#define TEXTSLAM_RENDERER_SPANNING_HPP

#include <array>
#include <cstdint>
#include <vector>

#include "io/detections.hpp"
#include "renderer/detector_model.hpp"
#include "renderer/kinds.hpp"

namespace textslam {

/// Corners in the world, clockwise from the top left as the camera sees it. The left two lie on one plane and the right
/// two on another, each clearly off the other's plane. What carries them stands.
using SpanningPlace = std::array<Vector3<double>, 4>;

/// What a shot shows in its first `frames`, at this many seconds a frame: in the mean, `in_view` of them a frame can be
/// detected. Fewer where the scene has no more. No two lie on one another, and none on a sign.
std::vector<SpanningPlace> spanning_places(const Shot& shot, const CameraModel& camera, int frames, double interval,
                                           double in_view, std::uint64_t seed);

/// Those that the camera sees at that time, missed and jittered as signs are, and unread.
std::vector<Detection> detect_spanning(const std::vector<SpanningPlace>& places, const Scene& scene,
                                       const CameraModel& camera, const SE3d& T_w_c, double time,
                                       const DetectorErrors& errors, Random random);

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_SPANNING_HPP
