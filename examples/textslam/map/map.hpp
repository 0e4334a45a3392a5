// Map: what the system knows of the world. Plain data; the steps of the system read and change it.
//
// Frames: T_w_c maps camera to world, in arbitrary units. Ids are indices and never change: what leaves is flagged.
#ifndef TEXTSLAM_MAP_MAP_HPP
#define TEXTSLAM_MAP_MAP_HPP

#include <memory>
#include <vector>

#include "textplane/landmarks/keyframe.hpp"
#include "textplane/landmarks/text_object.hpp"
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

using textplane::TextObject;
using textplane::TextState;

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
  /// A frame's image as the library takes it; an empty one where the frame has none.
  textplane::TextImage text_image(const Frame& frame) const {
    return {{frame.noise, frame.smoothing}, frame.image ? frame.image->view() : textplane::PyramidView(), camera};
  }
  /// As textplane::KeyframeLookup asks for it.
  textplane::TextKeyframe text_keyframe(int id) const { return {text_image(keyframe(id).frame), keyframe(id).T_w_c}; }
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
