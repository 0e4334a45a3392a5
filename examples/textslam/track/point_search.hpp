// Search for a map point in a frame: where it should be, and where its key-frame patch is found.
#ifndef TEXTSLAM_TRACK_POINT_SEARCH_HPP
#define TEXTSLAM_TRACK_POINT_SEARCH_HPP

#include "textslam/map/map.hpp"

namespace textslam {

/// A map point as a frame should see it.
struct PointPrediction {
  const PointObservation* host = nullptr;  ///< In the key frame with the most similar direction of view.
  Vec2 px;
  Eigen::Matrix2f A;  ///< px displacement in the host per px in the frame, of a patch on the point's surface.
};

/// False where the frame, with its camera at `centre`, cannot see the point, or too differently from all key frames.
bool predict_point(const Map& map, const Parameters& parameters, const MapPoint& point, const CameraView& camera,
                   const SE3d& T_c_w, const Vec3& centre, PointPrediction* out);

/// Finds the host's patch in the frame from the start *px (level 0), on levels `coarsest` to 0. False, too, where that
/// pixel has no ray.
bool find_point(const Map& map, const Parameters& parameters, const PointPrediction& prediction, const Frame& frame,
                int coarsest, Vec2f* px);

}  // namespace textslam

#endif  // TEXTSLAM_TRACK_POINT_SEARCH_HPP
