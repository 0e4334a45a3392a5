// Map: what the system knows of the world. Plain data; the steps of the system read and change it.
//
// Frames: T_w_c maps camera to world, in arbitrary units. Ids are indices and never change: what leaves is flagged.
#ifndef TEXTSLAM_MAP_MAP_HPP
#define TEXTSLAM_MAP_MAP_HPP

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "textplane/photometry/patch.hpp"
#include "textslam/common/geometry.hpp"
#include "textslam/common/parameters.hpp"
#include "textslam/input/frame.hpp"

namespace textslam {

struct PointObservation {
  int keyframe;
  Vec2 px;
};

struct MapPoint {
  Vec3 p_w;
  std::vector<PointObservation> observations = {};  ///< The first is the host.
  int visible = 0;                                  ///< Frames that should have seen it.
  int found = 0;                                    ///< Frames that did.
  bool bad = false;
};

struct KeyFrameLooks;

struct KeyFrame {
  Frame frame;
  SE3d T_w_c;
  std::vector<int> points;  ///< Ids of the map points observed here.
  bool culled = false;      ///< Out of the map (culling.hpp): it has no image, and its pose means nothing.
  mutable std::shared_ptr<const KeyFrameLooks> looks = {};  ///< Kept by places.hpp, which makes them when needed.
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
  std::vector<int> views;               ///< Key frames (without the host) that observe it well.
  std::map<std::string, double> votes;  ///< Words read: sums of the scores of their readings.
  int detections = 0;                   ///< Frames in which the detector saw it.
  int shown = 0;                        ///< Frames with detections that could have shown it, those included.
  int failures = 0;                     ///< Key frames in a row that should have seen it and did not.
  double zncc = 0;                      ///< Mean over its last refinement.

  bool has_plane() const { return state == TextState::tentative || state == TextState::mapped; }
  /// See consensus() in text_words.hpp, where it is defined; kUnreadText where none was read.
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
  SE3d T_c_h(const SE3d& T_c_w, int host) const { return T_c_w * keyframe(host).T_w_c; }
  KeyFrame& keyframe(int id) { return keyframes[static_cast<std::size_t>(id)]; }
  const KeyFrame& keyframe(int id) const { return keyframes[static_cast<std::size_t>(id)]; }
  /// Ids of the key frames, without those culled.
  std::vector<int> keyframe_ids() const {
    std::vector<int> ids;
    for (std::size_t i = 0; i < keyframes.size(); ++i)
      if (!keyframes[i].culled) ids.push_back(static_cast<int>(i));
    return ids;
  }
  int newest_keyframe() const { return static_cast<int>(keyframes.size()) - 1; }
  MapPoint& point(int id) { return points[static_cast<std::size_t>(id)]; }
  const MapPoint& point(int id) const { return points[static_cast<std::size_t>(id)]; }
  TextObject& text(int id) { return texts[static_cast<std::size_t>(id)]; }
  const TextObject& text(int id) const { return texts[static_cast<std::size_t>(id)]; }
  /// Removes key frames, points and texts.
  void clear() {
    keyframes.clear();
    points.clear();
    texts.clear();
  }
};

}  // namespace textslam

#endif  // TEXTSLAM_MAP_MAP_HPP
