// PhotometricInput: one host patch, one target image and their cameras, all of one pyramid level.
#ifndef TEXTPLANE_PHOTOMETRY_PHOTOMETRIC_INPUT_HPP
#define TEXTPLANE_PHOTOMETRY_PHOTOMETRIC_INPUT_HPP

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "textplane/core/cameras/camera_view.hpp"
#include "textplane/core/image_view.hpp"
#include "textplane/core/numeric.hpp"
#include "textplane/photometry/patch.hpp"
#include "textplane/photometry/prepared_target.hpp"
#include "textplane/photometry/pyramid.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// One host patch seen in one target image; T is the pixel type of the target. All three are of one pyramid level: the
/// cameras are Pinhole::at_level() of it.
template <class T>
struct BasicPhotometricInput {
  static_assert(std::is_same<T, std::uint8_t>::value || std::is_same<T, float>::value,
                "textplane: target images are 8-bit or float; T is the pixel's type without const");

  PatchView patch;                ///< Host pixels of one level.
  Pinhole<double> host_camera;    ///< Of the level that `patch` is of.
  Pinhole<double> target_camera;  ///< Of the level that `target` is.
  ImageView<const T> target;      ///< Image of one level.
  PairView pairs = {};            ///< Optional, for an 8-bit target: PreparedTarget of the same image.
  const LensMap* lens = nullptr;  ///< Before the target camera, on all levels the same; null: none.
  /// How host and target move while their rows are taken (geometry/row_warp.hpp); null: all at once.
  const PatchRows* host_rows = nullptr;
  const RowMotion* rows = nullptr;  ///< Of the target.
  int level = 0;                    ///< Of the target's pyramid.
};
using PhotometricInput = BasicPhotometricInput<std::uint8_t>;  ///< Of an 8-bit target.
using PhotometricInputF = BasicPhotometricInput<float>;        ///< Of a float target.

namespace detail {
template <class View>
using PixelOf = std::remove_const_t<typename std::decay_t<decltype(std::declval<View>().level[0])>::Pixel>;

// photometric_input() for PyramidView and anything like it.
template <class View>
BasicPhotometricInput<PixelOf<View>> level_input(const TextPatch& patch, int level, const View& target,
                                                 const CameraView& target_camera, int scale_shift) noexcept {
  BasicPhotometricInput<PixelOf<View>> in;
  if (level < 0 || level >= kMaxPyramidLevels || scale_shift < -kMaxPyramidLevels || scale_shift > kMaxPyramidLevels)
    return in;
  const int host_level = scale_shift < 0 ? level - scale_shift : level;
  const int target_level = scale_shift > 0 ? level + scale_shift : level;
  if (host_level >= patch.level_count() || target_level >= target.levels || target_level >= kMaxPyramidLevels)
    return in;
  in.patch = patch.levels[static_cast<std::size_t>(host_level)].view();
  in.host_camera = patch.camera.at_level(host_level);
  in.target_camera = target_camera.pinhole.at_level(target_level);
  in.lens = target_camera.lens;
  in.host_rows = &patch.rows;
  in.rows = target_camera.rows;
  in.level = target_level;
  in.target = target.level[static_cast<std::size_t>(target_level)];
  return in;
}
}  // namespace detail

/// The input of pyramid level `level`; `target_camera` is that of level 0.
///
/// `scale_shift` s pairs levels of one scale where host and target see the object at different sizes: with s > 0 the
/// target's level is `level` + s, with s < 0 the host's is `level` - s. Neither side is then sampled more coarsely than
/// its pixels, which would alias. See scale_shift(). A level that patch or target lacks gives an input that every
/// kernel answers with Status::invalid_argument.
inline PhotometricInput photometric_input(const TextPatch& patch, int level, const PyramidView& target,
                                          const CameraView& target_camera, int scale_shift = 0) noexcept {
  return detail::level_input(patch, level, target, target_camera, scale_shift);
}

/// The shift of photometric_input() for an object of these areas (px^2, level 0) in host and target: the difference of
/// their scales in octaves, rounded, at most `limit` either way. 0 for areas that are not positive and finite.
inline int scale_shift(double host_area, double target_area, int limit = 1) noexcept {
  if (!(host_area > 0) || !(target_area > 0) || !is_finite(host_area) || !is_finite(target_area)) return 0;
  const double octaves = std::round(0.5 * std::log2(target_area / host_area));
  return octaves > limit ? limit : octaves < -limit ? -limit : static_cast<int>(octaves);
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_PHOTOMETRY_PHOTOMETRIC_INPUT_HPP
