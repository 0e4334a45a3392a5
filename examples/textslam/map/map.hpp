// Map: what the system knows of the world. Plain data; the steps of the system read and change it.
//
// Frames: T_w_c maps camera to world. World units are arbitrary (monocular). Ids are indices and never change; what is
// dropped is flagged, not erased.
#ifndef TEXTSLAM_MAP_MAP_HPP
#define TEXTSLAM_MAP_MAP_HPP

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/detections.hpp"
#include "textplane/photometry/patch.hpp"
#include "textplane/photometry/pyramid.hpp"
#include "textslam/common/parameters.hpp"

namespace textslam {

using textplane::Pyramid;
using Vec2 = Eigen::Vector2d;
using Vec2f = Eigen::Vector2f;
using Vec3 = Eigen::Vector3d;

/// One image on its way through the system: undistorted, as a pyramid, with what the detector found (undistorted px).
struct Frame {
  int index = -1;
  double timestamp = 0;
  std::shared_ptr<const Pyramid> image;
  std::vector<Detection> detections;
};

struct PointObservation {
  int keyframe;
  Vec2 px;
};

struct MapPoint {
  Vec3 p_w;
  std::vector<PointObservation> observations;  ///< The first is the host.
  int visible = 0;                             ///< Frames that should have seen it.
  int found = 0;                               ///< Frames that did.
  bool bad = false;
};

struct KeyFrame {
  Frame frame;
  SE3d T_w_c;
  std::vector<int> points;  ///< Ids of the map points observed here.
  bool culled = false;      ///< Out of the map (keyframe_culling.hpp): without an image, and its pose is of no use.
};

enum class TextState {
  candidate,  ///< Detected; its plane is not known yet.
  tentative,  ///< Has a plane, waits for n_min observations.
  mapped,     ///< Takes part in tracking and adjustment.
  dropped,
};

/// A planar text object: a quad in its host key frame and the plane theta = -n/d in the host's frame.
struct TextObject {
  int id = -1;
  TextState state = TextState::candidate;
  int host = -1;  ///< Key frame.
  textplane::TextPatch patch;
  Vec3 theta = Vec3::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::vector<int> targets;             ///< Key frames (without the host) that observe it well.
  std::map<std::string, double> votes;  ///< Words read, without those unread: sums of the scores of their readings.
  int detections = 0;                   ///< Frames in which the detector saw it.
  int failures = 0;                     ///< Key frames in a row that should have seen it and did not.
  double zncc = 0;                      ///< Mean over its last refinement.

  bool has_plane() const { return state == TextState::tentative || state == TextState::mapped; }
  /// See consensus() in text_words.hpp; kUnreadText where none was read.
  std::string word() const;
};

struct Map {
  int number = -1;  ///< Maps are numbered in the order in which they began.
  Pinhole<double> camera;
  int width = 0, height = 0;
  std::vector<KeyFrame> keyframes;
  std::vector<MapPoint> points;
  std::vector<TextObject> texts;

  /// Motion of host-frame points of key frame `host` to a camera with world-to-camera pose T_c_w.
  SE3d T_c_h(const SE3d& T_c_w, int host) const { return T_c_w * keyframes[static_cast<std::size_t>(host)].T_w_c; }
  KeyFrame& keyframe(int id) { return keyframes[static_cast<std::size_t>(id)]; }
  const KeyFrame& keyframe(int id) const { return keyframes[static_cast<std::size_t>(id)]; }
  /// Ids of the key frames, without those culled.
  std::vector<int> keyframe_ids() const {
    std::vector<int> ids;
    for (std::size_t i = 0; i < keyframes.size(); ++i)
      if (!keyframes[i].culled) ids.push_back(static_cast<int>(i));
    return ids;
  }
  MapPoint& point(int id) { return points[static_cast<std::size_t>(id)]; }
  const MapPoint& point(int id) const { return points[static_cast<std::size_t>(id)]; }
};

/// A corner followed from frame to frame.
struct Track {
  Vec2f px = Vec2f::Zero();
  int point = -1;                              ///< Id of its map point, -1 while it has none.
  std::vector<PointObservation> observations;  ///< In key frames, while it has no point.
  bool inlier = true;                          ///< Of the last pose.
};

/// By how much a rotation turns, degrees.
double degrees(const Eigen::Matrix3d& R);
/// Between two directions of any length, degrees.
double degrees_between(const Vec3& a, const Vec3& b);

/// At most `count` of the ids, evenly spread, the first and the last among them.
std::vector<int> spread(const std::vector<int>& ids, std::size_t count);

/// Between the rays to a point from its host and from another camera: below it the point's patch is not looked for there.
constexpr double kMinViewCosine = 0.6;

/// Overlap, IoU, of a detection with the quad of a text from which on it shows that text.
constexpr double kSameTextOverlap = 0.3;

/// The text object's quad as seen by a camera with world-to-camera pose T_c_w; false where a corner is behind the camera.
bool project_text(const Map& map, const TextObject& text, const SE3d& T_c_w, Quad<double>* quad);

/// As project_text(), where the camera sees enough of the text's front to compare it with the host: neither too slanted nor too
/// small, text_min_share of it inside the image.
bool text_in_view(const Map& map, const Parameters& parameters, const TextObject& text, const SE3d& T_c_w,
                  Quad<double>* quad);

/// Which pyramid levels of host and view show the text at one scale, for its quad in the view: see photometric_input().
int scale_shift(const TextObject& text, const Quad<double>& quad);

/// Cosine of the angle between a text's normal and the ray to its centre, seen from T_c_w; positive towards the camera.
double facing(const Map& map, const TextObject& text, const SE3d& T_c_w);

/// Largest standard deviation of the direction of a text's normal, radians: n = -theta / |theta|.
double normal_sigma(const TextObject& text);

/// Takes a text out of the map. Its number stays; its patch and what was seen of it, most of its memory, go.
void drop(TextObject& text);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_MAP_HPP
