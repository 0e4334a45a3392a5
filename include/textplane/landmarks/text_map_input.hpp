// What a host system gives to TextMap: points and detections of an image.
#ifndef TEXTPLANE_LANDMARKS_TEXT_MAP_INPUT_HPP
#define TEXTPLANE_LANDMARKS_TEXT_MAP_INPUT_HPP

#include <string>
#include <utility>
#include <vector>

#include "textplane/geometry/quad.hpp"
#include "textplane/geometry/undistorted.hpp"
#include "textplane/landmarks/words.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// A point that the host sees in an image: where, and what it knows of its place. Of the three kinds, a frame may have
/// any mixture.
struct TextPoint {
  Vector2<double> px = Vector2<double>::Zero();   ///< Of the image as it is given, level 0.
  Vector3<double> p_w = Vector3<double>::Zero();  ///< In the world, where has_position.
  double depth = 0;                               ///< Along the optical axis, where positive and not has_position.
  bool has_position = false;                      ///< Whether p_w is known.
  int id = -1;       ///< Of the host's track or landmark: the same one in several key frames is a match. -1: none.
  double sigma = 1;  ///< px: standard deviation of px.

  /// A point of the host's map.
  static TextPoint at(const Vector2<double>& px, const Vector3<double>& p_w, int id = -1, double sigma = 1) noexcept {
    return {px, p_w, 0, true, id, sigma};
  }
  /// A pixel with depth, as of a stereo or RGB-D camera.
  static TextPoint with_depth(const Vector2<double>& px, double depth, int id = -1, double sigma = 1) noexcept {
    return {px, Vector3<double>::Zero(), depth, false, id, sigma};
  }
  /// A tracked corner of unknown depth.
  static TextPoint track(const Vector2<double>& px, int id, double sigma = 1) noexcept {
    return {px, Vector3<double>::Zero(), 0, false, id, sigma};
  }
};

/// A quad that a detector found in an image, and what it read there.
struct TextDetection {
  Quad<double> quad;               ///< px of level 0 of the image as it is given, clockwise from the text's top left.
  std::string word = kUnreadText;  ///< UTF-8.
  double score = 1;                ///< Of the reading.

  TextDetection() = default;
  /// A quad, and a word where it was read.
  TextDetection(const Quad<double>& q, std::string w = kUnreadText, double s = 1)
      : quad(q), word(std::move(w)), score(s) {}
};

/// Detections of a raw image, of any lens (geometry/undistorted.hpp), as the pinhole image has them: without those of
/// which a corner has no place there.
template <class Lens>
std::vector<TextDetection> undistorted(std::vector<TextDetection> raw, const Lens& lens,
                                       const Pinhole<double>& pinhole) {
  std::vector<TextDetection> straight;
  for (TextDetection& seen : raw)
    if (is_ok(undistorted(seen.quad, lens, pinhole, &seen.quad))) straight.push_back(std::move(seen));
  return straight;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_MAP_INPUT_HPP
