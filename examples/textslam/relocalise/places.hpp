// Places: which key frames show what a frame shows, by the looks of points alone.
//
// A frame's corners are described on several pyramid levels, a key frame's map points at several sizes. Key frames are
// ranked by matches of a few strong, coarse corners. The points of the best ones give a pose, by which more are found.
#ifndef TEXTSLAM_RELOCALISE_PLACES_HPP
#define TEXTSLAM_RELOCALISE_PLACES_HPP

#include <memory>
#include <vector>

#include "textslam/map/map.hpp"
#include "textslam/relocalise/descriptors.hpp"
#include "textslam/relocalise/three_point_pose.hpp"

namespace textslam {

/// A corner as it looks at one size: a pixel of the pattern is 2^(size / 2) px of level 0.
struct CornerLook {
  Vec2f px = Vec2f::Zero();
  int size = 0;
  int point = -1;  ///< Of the map, in a key frame.
  Descriptor descriptor = {};
};

/// What is kept beside a key frame.
struct KeyFrameLooks {
  std::vector<int> points;          ///< That it observed when they were described, in order; none before that.
  std::vector<CornerLook> looks;    ///< Of these points, all sizes of one together.
  std::vector<CornerLook> corners;  ///< Strong corners for the ranking, likewise.
};

/// A frame's looks, made when first asked for.
class FrameLooks {
 public:
  FrameLooks(const Frame& frame, const Parameters& parameters) : frame_(frame), parameters_(parameters) {}

  const std::vector<CornerLook>& all();       ///< Corners of all levels, strongest first on each.
  const std::vector<CornerLook>& strong();    ///< Of the coarser levels, few.
  const std::vector<CornerLook>& in_sizes();  ///< The same at three sizes, as a key frame keeps them.
  const Frame& frame() const { return frame_; }

 private:
  const SmoothedLevels& levels();

  const Frame& frame_;
  const Parameters& parameters_;
  std::unique_ptr<SmoothedLevels> levels_;
  bool has_all_ = false, has_strong_ = false, has_sizes_ = false;
  std::vector<CornerLook> all_, strong_, in_sizes_;
};

/// A key frame keeps the strong corners of its own frame's looks, so that no ranking describes it again.
void keep_corners(const Map& map, int keyframe, FrameLooks& looks);

struct PlaceRank {
  int keyframe = -1;
  int matches = 0;  ///< Of strong corners.
};

/// Of the key frames `ids`, those that may show the same, the best first, at most place_candidates. About `most` of
/// the ids are compared, others with each index `frame`.
std::vector<PlaceRank> rank_places(const Map& map, const Parameters& parameters, FrameLooks& looks,
                                   const std::vector<int>& ids, int most, int frame);

/// The pose that the matches with the points of these key frames give, then the corners found where it expects points;
/// without inliers where they are too few. The first key frame is the one most alike.
MatchedPose pose_by_places(const Map& map, const Parameters& parameters, FrameLooks& looks,
                           const std::vector<int>& keyframes);

}  // namespace textslam

#endif  // TEXTSLAM_RELOCALISE_PLACES_HPP
