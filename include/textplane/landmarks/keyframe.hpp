// What the texts know of a key frame: its image, its camera and its pose. The map that holds it is the host system's.
#ifndef TEXTPLANE_LANDMARKS_KEYFRAME_HPP
#define TEXTPLANE_LANDMARKS_KEYFRAME_HPP

#include "textplane/core/cameras/camera_view.hpp"
#include "textplane/core/se3.hpp"
#include "textplane/photometry/pyramid.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// What is known of the noise of an image.
struct ImageNoise {
  double noise = 0;      ///< Grey levels: standard deviation of a pixel of level 0 (estimate_noise()); 0: clear.
  double smoothing = 0;  ///< px^2: variance of a Gaussian that the image was smoothed with.
};

/// An image and the camera that took it: a pinhole where it is undistorted, else with its lens. Not owned.
struct TextImage : ImageNoise {
  PyramidView pyramid;  ///< Level 0 first.
  CameraView camera;    ///< Of level 0.

  int width() const noexcept { return pyramid.level[0].width(); }    ///< px of level 0.
  int height() const noexcept { return pyramid.level[0].height(); }  ///< px of level 0.
};

/// A key frame: an image and where its camera stood.
struct TextKeyframe : TextImage {
  SE3d T_w_c;  ///< Camera to world.

  TEXTPLANE_DEFERRED
  SE3d T_c_w() const noexcept { return T_w_c.inverse(); }  ///< World to camera.
  /// Motion of points of key frame `host` to this one.
  TEXTPLANE_DEFERRED
  SE3d from(const TextKeyframe& host) const noexcept { return T_c_w() * host.T_w_c; }
};

/// Key frames by their ids, wherever they are kept: a pointer to the keeper and a function that looks one up. Not
/// owning, like a view.
class KeyframeLookup {
 public:
  /// `keeper` has `TextKeyframe text_keyframe(int id) const` and outlives the lookup. It is asked for ids that it gave
  /// to the texts, and for no others.
  template <class Keeper>
  explicit KeyframeLookup(const Keeper& keeper) noexcept
      : keeper_(&keeper),
        look_up_([](const void* k, int id) { return static_cast<const Keeper*>(k)->text_keyframe(id); }) {}

  TextKeyframe operator()(int id) const { return look_up_(keeper_, id); }  ///< The key frame of this id.

 private:
  const void* keeper_;
  TextKeyframe (*look_up_)(const void*, int);
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_KEYFRAME_HPP
