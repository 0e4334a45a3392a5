// TextMap: text objects for a system that has its own poses and points.
//
//   TextMap texts(camera);
//   auto fit = texts.track(pyramid, T_c_w, points);            // each frame: fit.T_c_w
//   texts.add_keyframe(id, pyramid, T_c_w, quads, points);     // key frame
//   texts.move([&](int id) { return T_c_w_of(id); });          // after the host's adjustment
//   for (const TextObject& text : texts.objects()) ...
//
// A text becomes an object when key frames show it from different sides. A frame's pose is refined where the texts in
// view know it clearly better than the points do, and the points do not contradict; else the host's own pose comes
// back, to the bit. What is hidden, blurred, uncertain or wrong counts less, or not at all: TextFit tells. What keeps
// disagreeing with all the rest is dropped.
//
// All poses are of world to camera. Images, quads and points are as the camera takes them. Not thread-safe; no thread
// of its own; the same calls give the same results. Throws nothing but std::bad_alloc.
#ifndef TEXTPLANE_LANDMARKS_TEXT_MAP_HPP
#define TEXTPLANE_LANDMARKS_TEXT_MAP_HPP

#include <array>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "textplane/landmarks/text_tracking.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// See the head of this file.
TEXTPLANE_DEFERRED
class BasicTextMap {
 public:
  /// `camera`: of all images but those that are given with their own.
  explicit BasicTextMap(const CameraView& camera, const TextMapOptions& options = {})
      : camera_(camera), options_(options), mapping_(options_.text, store_), tracking_(options_, mapping_, bounds_) {}
  BasicTextMap(const BasicTextMap&) = delete;
  BasicTextMap& operator=(const BasicTextMap&) = delete;

  /// The pose of a frame, from the host's `T_c_w` (by its points, or predicted), by the mapped texts in view and the
  /// points with p_w: the host's own, unless the texts tell enough and half of those in view fit. Without points the
  /// texts decide alone. Nothing of the map changes before the next key frame, which drops what kept disagreeing. The
  /// result is the map's, and valid until the next call, which allocates nothing where this one saw as much: copy what
  /// is to be kept.
  const TextFit& track(const PyramidView& pyramid, const SE3d& T_c_w, const std::vector<TextPoint>& points) {
    return track(image_of(pyramid), T_c_w, points);
  }

  /// The same for an image with a camera of its own, as in a rig: T_c_w is of that camera.
  const TextFit& track(const TextImage& image, const SE3d& T_c_w, const std::vector<TextPoint>& points) {
    return tracking_.track(image, T_c_w, points);
  }

  /// A key frame: new texts, observations, planes, better hosts, and what is dropped. The host keeps the image until
  /// it calls remove_keyframe(id). invalid_argument for an id in use, an empty image or a camera that is not valid(),
  /// non_finite for such a pose; nothing changes then. Quads and points that are not finite are passed over.
  Status add_keyframe(int id, const PyramidView& pyramid, const SE3d& T_c_w, const std::vector<TextDetection>& quads,
                      const std::vector<TextPoint>& points) {
    return add(id, image_of(pyramid), nullptr, T_c_w, quads, points);
  }
  /// The same with an image that the map owns from here on.
  Status add_keyframe(int id, Pyramid&& pyramid, const SE3d& T_c_w, const std::vector<TextDetection>& quads,
                      const std::vector<TextPoint>& points) {
    auto own = std::make_unique<Pyramid>(std::move(pyramid));
    const PyramidView view = own->view();
    return add(id, image_of(view), std::move(own), T_c_w, quads, points);
  }

  /// The same for an image with a camera of its own, which the host keeps.
  Status add_keyframe(int id, const TextImage& image, const SE3d& T_c_w, const std::vector<TextDetection>& quads,
                      const std::vector<TextPoint>& points) {
    return add(id, image, nullptr, T_c_w, quads, points);
  }

  /// A key frame has left the host's map. Texts that it hosts move to their best other view, or are dropped.
  void remove_keyframe(int id) {
    mapping_.keyframe_left(id);
    store_.erase(id);
    bounds_.update(mapping_.objects(), store_);
  }

  /// A key frame of an earlier map, of which its texts need the pose alone: before restore_text(). As add_keyframe()
  /// says; the next key frame lets go of those that host nothing.
  Status restore_keyframe(int id, const SE3d& T_c_w) {
    if (!all_finite(T_c_w)) return Status::non_finite;
    TextKeyframe keyframe;
    keyframe.T_w_c = T_c_w.inverse();
    return store_.add(id, keyframe, nullptr) ? Status::ok : Status::invalid_argument;
  }

  /// A text of an earlier map, as objects() had it there; in the order of the ids, and before the key frames that add
  /// new texts. It is tracked, and observed by new key frames, from here on. invalid_argument, and nothing changed, for
  /// a host that is not known, a text without plane or pixels or with numbers that are not finite, or an id that is not
  /// higher than those of all texts so far.
  Status restore_text(TextObject text) {
    if (!store_.has(text.host) || !mapping_.restore(std::move(text))) return Status::invalid_argument;
    bounds_.update(mapping_.objects(), store_, mapping_.objects().size() - 1);
    return Status::ok;
  }

  /// Poses of the key frames anew: f(id) is that of world to camera. One that is not finite changes nothing. f is asked
  /// for the ids that texts or images still need, in their order.
  template <class PoseOf>
  void move(PoseOf f) {
    store_.move(f);
    bounds_.update(mapping_.objects(), store_);
  }

  /// The texts of now, in the order of their ids. Valid until the next key frame is added or removed.
  const std::vector<TextObject>& objects() const noexcept { return mapping_.objects(); }
  const KeyframeStore& keyframes() const noexcept { return store_; }   ///< What it knows of the key frames.
  const TextMapOptions& options() const noexcept { return options_; }  ///< Its settings.

  /// A text's plane from the host's own adjustment, in the frame of its host. False, and nothing changed, for an
  /// unknown id, and for a plane that is not finite or does not show the text's front to its host.
  bool set_plane(int id, const Vector3<double>& theta) {
    const int index = mapping_.set_plane(id, theta);
    if (index < 0) return false;
    bounds_.update_plane(static_cast<std::size_t>(index), mapping_.objects()[static_cast<std::size_t>(index)]);
    return true;
  }

  /// The standard deviation of the points' residuals in the last frame that had at least eight, in units of their
  /// sigmas; 1 before. By it texts and points are weighed in the host's own adjustment.
  double point_scale() const noexcept { return tracking_.point_scale(); }

  /// Its corners in the world, clockwise from the top left; false where it has no plane.
  bool corners(const TextObject& text, std::array<Vector3<double>, 4>* out) const {
    if (!text.has_plane() || !is_ok(text_corners(text, out))) return false;
    const SE3d T_w_h = store_.text_keyframe(text.host).T_w_c;
    for (Vector3<double>& corner : *out) corner = T_w_h * corner;
    return true;
  }

 private:
  TextImage image_of(const PyramidView& pyramid) const {
    TextImage image;
    image.pyramid = pyramid;
    image.camera = camera_;
    return image;
  }

  Status add(int id, const TextImage& image, std::unique_ptr<Pyramid> own, const SE3d& T_c_w,
             const std::vector<TextDetection>& quads, const std::vector<TextPoint>& points) {
    if (image.pyramid.levels < 1 || !image.camera.valid()) return Status::invalid_argument;
    if (!all_finite(T_c_w)) return Status::non_finite;
    TextKeyframe keyframe;
    static_cast<TextImage&>(keyframe) = image;
    keyframe.T_w_c = T_c_w.inverse();
    if (!store_.add(id, keyframe, std::move(own))) return Status::invalid_argument;
    mapping_.keyframe_left(id);  // views may name a key frame of this id that the store forgot
    std::vector<TextDetection> finite_quads;
    std::vector<TextPoint> finite_points;
    for (const TextDetection& quad : quads)
      if (all_finite(quad.quad) && is_finite(quad.score)) finite_quads.push_back(quad);
    for (const TextPoint& point : points)
      if (all_finite(point.px) && all_finite(point.p_w) && is_finite(point.depth)) finite_points.push_back(point);
    mapping_.judge(tracking_.conflicts());
    tracking_.forget_conflicts();
    mapping_.update(id, finite_quads, finite_points);
    store_.forget_oldest(options_.max_images, [this](int other) { return mapping_.needs(other); });
    bounds_.update(mapping_.objects(), store_);
    return Status::ok;
  }

  CameraView camera_;
  TextMapOptions options_;
  KeyframeStore store_;
  TextMapping mapping_;
  TextBounds bounds_;
  TextTracking tracking_;
};
using TextMap = BasicTextMap<>;  ///< It is compiled only where it is used.

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_MAP_HPP
