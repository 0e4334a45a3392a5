// Map: what the system knows of the world. Plain data; the steps of the system read and change it.
//
// Frames: T_w_c maps camera to world, in arbitrary units. Ids are indices and never change: what leaves is flagged.
#ifndef TEXTSLAM_MAP_MAP_HPP
#define TEXTSLAM_MAP_MAP_HPP

#include <memory>
#include <vector>

#include "textplane/landmarks/keyframe.hpp"
#include "textplane/landmarks/text_object.hpp"
#include "textslam/common/parameters.hpp"
#include "textslam/common/rays.hpp"
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
  /// Unit normal of its surface, away from the camera; zero where it is not known (point_normals.hpp).
  Vec3 normal_w = Vec3::Zero();
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
  int number = -1;    ///< Maps are numbered in the order in which they began.
  CameraView camera;  ///< Of all images, level 0. Its lens outlives the map.
  int width = 0, height = 0;
  textplane::RollingShutter shutter;  ///< Of the camera, by the time of its middle row, to which poses belong.
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
  /// The camera as it took the frame, with the motion of its rows.
  CameraView view_of(const Frame& frame) const { return {camera.pinhole, camera.lens, frame.rows.get()}; }
  CameraView view_of(int id) const { return view_of(keyframe(id).frame); }
  /// World to camera of key frame `id`, at the row of a pixel.
  SE3d T_c_w_at(int id, const Vec2& px) const { return pose_at_row(view_of(id), keyframe(id).T_w_c.inverse(), px); }
  /// A frame's image as the library takes it; an empty one where the frame has none.
  textplane::TextImage text_image(const Frame& frame) const {
    return {
        {frame.noise, frame.smoothing}, frame.image ? frame.image->view() : textplane::PyramidView(), view_of(frame)};
  }
  /// As textplane::KeyframeLookup asks for it.
  textplane::TextKeyframe text_keyframe(int id) const { return {text_image(keyframe(id).frame), keyframe(id).T_w_c}; }
  /// A key frame moves so from here on, and the patches that it hosts with it.
  void set_rows(int id, std::shared_ptr<const textplane::RowMotion> rows) {
    keyframe(id).frame.rows = std::move(rows);
    const CameraView view = view_of(id);
    for (TextObject& text : texts) {
      if (text.host != id) continue;
      const Vec3 centre = text.patch.camera.unproject(textplane::centroid(text.patch.quad));
      text.patch.rows = view.rows ? patch_rows(*view.rows, view, centre) : textplane::PatchRows();
    }
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

/// Whether the rows' motion counts, or may once the readout is found.
inline bool is_rolling(const Map& map, const Parameters& parameters) {
  return map.shutter.active() || parameters.estimate_readout;
}

}  // namespace textslam

#endif  // TEXTSLAM_MAP_MAP_HPP
