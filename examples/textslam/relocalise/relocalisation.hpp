// Relocalisation: the pose of a frame after tracking was lost, from the signs that it shows, from the key frames
// that look most like it, and from points that look like those of key frames.
#ifndef TEXTSLAM_RELOCALISE_RELOCALISATION_HPP
#define TEXTSLAM_RELOCALISE_RELOCALISATION_HPP

#include <vector>

#include "textslam/relocalise/places.hpp"
#include "textslam/relocalise/text_hypotheses.hpp"
#include "textslam/track/tracker.hpp"

namespace textslam {

/// What gave a frame its pose.
enum class FoundBy {
  nothing,
  tracking,  ///< The frames before it.
  texts,     ///< Signs that it shows.
  images,    ///< A key frame that looks like it.
  points,    ///< Points that look like those of key frames.
};

/// How the frame was tracked from there. Unless ok, nothing else counts.
struct Relocalisation : TrackReport {
  FoundBy by = FoundBy::nothing;
  std::vector<Track> tracks;  ///< Map points found in the frame: what a tracker that starts there follows.

  /// What of the map the frame shows from there.
  int shown() const { return inliers + texts; }
};

/// The frame as seen from about T_c_w: texts and map points are looked for where that pose expects them, and the pose
/// is fitted to them.
Relocalisation observe_from(const Map& map, const Parameters& parameters, const Frame& frame, const SE3d& T_c_w);

/// Whether a pose holds: the image shows enough of the points that it should see, and two texts agree with it or enough
/// points lie off the signs. The same sign may hang in several places.
bool holds(const Map& map, const Parameters& parameters, const TrackReport& found, const std::vector<Track>& tracks);

/// The same as observe_from(), refused where the pose does not hold.
Relocalisation recognise_from(const Map& map, const Parameters& parameters, const Frame& frame, const SE3d& T_c_w);

/// Of the poses that the frame's detections suggest, one that holds and from which the frame shows most of the map:
/// from a few corners another may hold by chance. `ways` to compare words are tried one after another until one gives a
/// clear pose: the image shows most of what the map expects (relocalise_clear_share). With the frame's `looks`, points
/// that look like those around a sign help where its own pose is not clear.
Relocalisation relocalise_by_texts(const Map& map, const Parameters& parameters, const Frame& frame,
                                   const std::vector<WordMatch>& ways, FrameLooks* looks = nullptr);

/// The first pose that holds of those by the looks of points, in key frames that rank_places() found.
Relocalisation relocalise_by_places(const Map& map, const Parameters& parameters, const Frame& frame, FrameLooks& looks,
                                    const std::vector<PlaceRank>& places);

/// Tries the poses that the frame's detections suggest (mode text). Where none is clear, tries the key frames whose
/// coarsest images correlate best with the frame's, then those with points that look alike, and takes the pose from
/// which the frame shows most; where that confirms the pose of what was tried before, `by` names the first. `looks` are
/// the frame's. A frame that is not lost, but may show this map too, is compared with fewer of these.
Relocalisation relocalise(const Map& map, const Parameters& parameters, const Frame& frame, FrameLooks& looks,
                          bool lost);

/// The same of a lost frame in a single map.
Relocalisation relocalise(const Map& map, const Parameters& parameters, const Frame& frame);

}  // namespace textslam

#endif  // TEXTSLAM_RELOCALISE_RELOCALISATION_HPP
